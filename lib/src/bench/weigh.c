/* SPDX-License-Identifier: MIT */
/* Bench motion that lifts and sinks a known weight: one point of a force table. */
#include "exhand/probe.h"

#include "exhand/error.h"

#define HOLD_MAX_MS 100000

enum { UP, DOWN, REST, MEANS };

int exh_weigh_setup(
    struct exh_weigh_cfg *cfg, const struct exh_weigh_par *par, struct exh_probe_scale scale)
{
    struct exh_probe_par down = par->probe;
    int err;
    if (par->probe.step_A_q26 <= 0 || par->slack_A_q26 < 0 ||
        par->slack_A_q26 > par->probe.end_A_q26 || par->hold_ms < 1 || par->hold_ms > HOLD_MAX_MS) {
        return -EXH_E_RANGE;
    }
    down.step_A_q26 = -par->probe.step_A_q26;
    down.end_A_q26 = 0;
    err = exh_probe_setup(&cfg->up, &par->probe, scale);
    if (err == 0) { err = exh_probe_setup(&cfg->down, &down, scale); }
    if (err < 0) { return err; }
    cfg->slack_A_q26 = par->slack_A_q26;
    cfg->hold_ticks = exh_probe_ticks(par->hold_ms, scale.T);
    return 0;
}

void exh_weigh_start(struct exh_weigh *s, const struct exh_weigh_cfg *cfg, int32_t cnt)
{
    *s = (struct exh_weigh){.phase = UP, .result = EXH_PROBE_BUSY};
    exh_probe_start(&s->probe, cnt, cfg->slack_A_q26);
    s->cur_A_q26 = s->probe.cur_A_q26;
}

/* Friction holds the mass between lift and sink. Waits for rest, then averages. Movement restarts
 * it. */
static uint8_t hold(struct exh_weigh *s, const struct exh_weigh_cfg *cfg, int32_t cnt,
    int32_t coded_A_q26, int32_t mon_A_q26)
{
    const int64_t moved = exh_wrap_diff(cnt, s->probe.dwell_cnt);
    const int64_t far = exh_wrap_diff(cnt, s->probe.start_cnt);
    const int moves = moved >= cfg->up.move_cnt || -moved >= cfg->up.move_cnt;
    if (far > cfg->up.travel_cnt || -far > cfg->up.travel_cnt) { return EXH_PROBE_TRAVEL; }
    if (++s->tick >= cfg->up.ticks) { return EXH_PROBE_TIME; }
    s->probe.dwell++;
    if (moves || (s->phase == REST && s->probe.dwell >= cfg->up.dwell_ticks)) {
        s->phase = moves ? REST : MEANS;
        s->probe.dwell = 0;
        s->probe.dwell_cnt = cnt;
        s->coded = s->mon = (struct exh_mean){0, 0};
    } else if (s->phase == MEANS) {
        exh_mean_add(&s->coded, coded_A_q26);
        exh_mean_add(&s->mon, mon_A_q26);
        if (s->coded.n >= cfg->hold_ticks) { return EXH_PROBE_DONE; }
    }
    return EXH_PROBE_BUSY;
}

/* Runs the probe up or down; its end starts the next phase. */
static uint8_t lift_or_sink(struct exh_weigh *s, const struct exh_weigh_cfg *cfg, int32_t cnt)
{
    const int up = s->phase == UP;
    const uint8_t r = exh_probe_step(&s->probe, up ? &cfg->up : &cfg->down, cnt);
    const int32_t at_A_q26 = s->probe.cur_A_q26;
    const int32_t start_cnt = s->probe.start_cnt;
    s->cur_A_q26 = at_A_q26;
    if (r != EXH_PROBE_DONE) { return r; }
    if (up) {
        s->lift_A_q26 = at_A_q26;
    } else {
        s->sink_A_q26 = at_A_q26;
        s->cur_A_q26 = (s->lift_A_q26 + at_A_q26) >> 1; /* both <= 3.3 A */
    }
    s->phase = up ? DOWN : REST;
    exh_probe_start(&s->probe, cnt, s->cur_A_q26);
    s->probe.start_cnt = start_cnt; /* one travel limit for all phases */
    return EXH_PROBE_BUSY;
}

uint8_t exh_weigh_step(struct exh_weigh *s, const struct exh_weigh_cfg *cfg, int32_t cnt,
    int32_t coded_A_q26, int32_t mon_A_q26)
{
    if (s->result != EXH_PROBE_BUSY) { return s->result; }
    s->result =
        s->phase < REST ? lift_or_sink(s, cfg, cnt) : hold(s, cfg, cnt, coded_A_q26, mon_A_q26);
    if (s->result != EXH_PROBE_BUSY) { s->cur_A_q26 = 0; }
    return s->result;
}

struct exh_calib_point exh_weigh_point(const struct exh_weigh *s, int32_t force_N_q20)
{
    const struct exh_calib_point p = {force_N_q20, exh_mean_value(&s->coded),
        exh_mean_value(&s->mon), (s->lift_A_q26 - s->sink_A_q26) >> 1};
    return p;
}
