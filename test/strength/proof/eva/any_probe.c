/* SPDX-License-Identifier: MIT */
/* PROVES: probe, home, weigh
 * Set-up with any parameters and any scale states the range of accepted configurations. Each of
 * these runs a tick in any state, at any count, with any currents. The requested current is within
 * its bound, and the result is one of the seven.
 *
 * EVA: -eva-slevel 60
 * PLANT: lib/src/bench/probe.c: s->cur_A_q26 = exh_clamp(next, 0, EXH_PROBE_CUR_MAX_A_Q26); -> s->cur_A_q26 = (int32_t)next + cfg->end_A_q26;
 * PLANT: lib/src/bench/probe.c: const int64_t size = step < 0 ? -step : step; -> const int64_t size = step < 0 ? -par->step_A_q26 : step;
 * PLANT: lib/src/bench/probe.c: return scale.step_m_q42 > 0 && -> return
 * PLANT: lib/src/bench/probe.c: const int64_t in = -(int64_t)exh_wrap_diff -> const int64_t in = -exh_wrap_diff
 * PLANT: lib/src/bench/weigh.c: -moved >= cfg->up.move_cnt; -> -(int32_t)moved >= cfg->up.move_cnt;
 * PLANT: lib/src/bench/weigh.c: s->cur_A_q26 = (s->lift_A_q26 + at_A_q26) >> 1; -> s->cur_A_q26 = 100 * s->lift_A_q26 + at_A_q26;
 * PLANT: lib/src/bench/calibrate.c: if (m->n == 0) { return 0; } -> (void)0;
 */
#include "num/bytes.c"
#define exh_udiv64 udiv64_by_steps
#include "num/fix.c"
#undef exh_udiv64
#include "quotient.h"
#include "bench/calibrate.c"
#include "act/table.c"
#include "act/drive.c"
#include "bench/probe.c"
#undef TIME_MAX_MS
#include "bench/weigh.c"

#include "any.h"

#define MOST    EXH_PROBE_CUR_MAX_A_Q26
#define SUM_MAX ((INT64_C(1) << 62) - (INT64_C(1) << 31)) /* of 2^31 - 1 values */

static struct exh_probe_cfg cfg;
static struct exh_home_cfg home_cfg;
static struct exh_weigh_cfg weigh_cfg;
static struct exh_probe s;
static struct exh_home home;
static struct exh_weigh weigh;

static void set_up(int32_t step_m_q42, uint32_t least, uint32_t most)
{
    const struct exh_probe_scale scale = {
        step_m_q42, {Frama_C_unsigned_int_interval(least, most), any_u32()}};
    struct exh_probe_par par;
    struct exh_home_par home_par;
    struct exh_weigh_par weigh_par;
    ANY(par);
    ANY(home_par);
    ANY(weigh_par);
    if (exh_probe_setup(&cfg, &par, scale) == 0) {
        /*@ assert currents: -33554432 <= cfg.step_A_q26 <= 33554432 && 0 <= cfg.end_A_q26 <= 221459251; */
        /*@ assert counts: 1 <= cfg.move_cnt && 1 <= cfg.travel_cnt <= 1 << 30; */
    }
    if (exh_home_setup(&home_cfg, &home_par, scale) == 0) {
        /*@ assert home: 1 <= home_cfg.move_cnt && 1 <= home_cfg.most_cnt <= 1 << 30 && home_cfg.least_cnt >= 0; */
        /*@ assert low: 1 <= home_cfg.cur_A_q26 <= 33554432; */
    }
    (void)exh_weigh_setup(&weigh_cfg, &weigh_par, scale);
}

static void any_cfg(struct exh_probe_cfg *c, int32_t least, int32_t most)
{
    ANY(*c);
    c->step_A_q26 = Frama_C_interval(least, most);
    c->end_A_q26 = Frama_C_interval(0, MOST);
    c->move_cnt = Frama_C_interval(1, INT32_MAX);
    c->travel_cnt = Frama_C_interval(1, 1 << 30);
}

static void ticks(void)
{
    uint8_t result;
    any_cfg(&cfg, -33554432, 33554432);
    ANY(s);
    s.cur_A_q26 = Frama_C_interval(0, MOST);
    s.result = EXH_PROBE_BUSY;
    result = exh_probe_step(&s, &cfg, any32());
    /*@ assert probes: result < 7 && 0 <= s.cur_A_q26 <= 221459251; */
    exh_probe_start(&s, any32(), any32());
    ANY(home_cfg);
    home_cfg.cur_A_q26 = Frama_C_interval(1, 33554432);
    ANY(home);
    home.result = EXH_PROBE_BUSY;
    result = exh_home_step(&home, &home_cfg, any32());
    /*@ assert homes: result < 7 && 0 <= home.cur_A_q26 <= 33554432; */
    exh_home_start(&home, any32());
}

static void any_mean(struct exh_mean *m)
{
    m->n = Frama_C_unsigned_int_interval(0, INT32_MAX);
    m->sum = Frama_C_long_long_interval(-SUM_MAX, SUM_MAX);
}

static void weighs(uint8_t phase)
{
    uint8_t result;
    any_cfg(&weigh_cfg.up, 1, 33554432);
    any_cfg(&weigh_cfg.down, -33554432, -1);
    weigh_cfg.slack_A_q26 = Frama_C_interval(0, MOST);
    weigh_cfg.hold_ticks = any_u32();
    exh_weigh_start(&weigh, &weigh_cfg, any32());
    ANY(weigh);
    weigh.phase = phase;
    weigh.result = weigh.probe.result = EXH_PROBE_BUSY;
    weigh.probe.cur_A_q26 = Frama_C_interval(0, MOST);
    weigh.cur_A_q26 = Frama_C_interval(0, MOST);
    weigh.lift_A_q26 = Frama_C_interval(0, MOST);
    weigh.sink_A_q26 = Frama_C_interval(0, MOST);
    any_mean(&weigh.coded);
    any_mean(&weigh.mon);
    result = exh_weigh_step(&weigh, &weigh_cfg, any32(), any32(), any32());
    /*@ assert weighs: result < 7 && 0 <= weigh.cur_A_q26 <= 221459251 && weigh.phase <= 3; */
    (void)exh_weigh_point(&weigh, any32());
    (void)exh_probe_result_text(any_u32());
}

int main(void)
{
    set_up(0, 1, UINT32_MAX);
    set_up(any32(), 0, 0);
    set_up(Frama_C_interval(1, INT32_MAX), 1, UINT32_MAX);
    ticks();
    for (unsigned phase = 0; phase < 4; phase++) { weighs((uint8_t)phase); }
    END();
    return 0;
}
