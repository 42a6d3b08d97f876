/* SPDX-License-Identifier: MIT */
/* Bench motions: the probe, which checks the polarity of a drive, and homing. */
#include "exhand/probe.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#define STEP_MIN_A_Q26 EXH_Q(1, 1000000, EXH_Q_CUR)
#define STEP_MAX_A_Q26 EXH_Q(1, 2, EXH_Q_CUR)
#define HOME_MAX_A_Q26 EXH_Q(1, 2, EXH_Q_CUR)
#define DWELL_MAX_MS   10000
#define TIME_MAX_MS    1000000
#define MOVE_MIN_CNT   2
#define FAR_CNT        (INT32_C(1) << 30) /* a higher limit would wrap */
#define MAX_M_Q30      EXH_Q(1, 1, EXH_Q_POS)

const char *exh_probe_result_text(unsigned result)
{
    static const char *const text[EXH_PROBE_RESULTS] = {
        "busy",
        "done",
        "went the wrong way",
        "did not move",
        "moved too far",
        "took too long",
        "jammed",
    };
    return result < EXH_PROBE_RESULTS ? text[result] : "unknown";
}

/* --- set-up --- */

uint32_t exh_probe_ticks(int32_t ms, struct exh_period T)
{
    const uint32_t n = exh_ticks_in(ms, T);
    return n < 1 ? 1 : n; /* 10^6 ms at 20 kHz are 2*10^7 */
}

/* At least 2 ticks, since one tick shows no movement. */
static uint32_t dwell_of(int32_t ms, struct exh_period T)
{
    const uint32_t n = exh_probe_ticks(ms, T);
    return n < 2 ? 2 : n;
}

static int32_t counts_of(int32_t m_q30, int32_t step_m_q42, int32_t least)
{
    const uint64_t n = exh_udiv64(
        (uint64_t)(uint32_t)m_q30 << (EXH_Q_STEP - EXH_Q_POS), (uint32_t)step_m_q42, NULL);
    return n < (uint32_t)least ? least : exh_clamp((int64_t)n, least, INT32_MAX);
}

static int scale_ok(struct exh_probe_scale scale)
{
    return scale.step_m_q42 > 0 && exh_period_ok(scale.T);
}

int exh_probe_setup(
    struct exh_probe_cfg *cfg, const struct exh_probe_par *par, struct exh_probe_scale scale)
{
    const int64_t step = par->step_A_q26;
    const int64_t size = step < 0 ? -step : step;
    if (!scale_ok(scale) || size < STEP_MIN_A_Q26 || size > STEP_MAX_A_Q26 ||
        !exh_inside(par->end_A_q26, 0, EXH_PROBE_CUR_MAX_A_Q26) ||
        !exh_inside(par->dwell_ms, 1, DWELL_MAX_MS) || !exh_inside(par->time_ms, 1, TIME_MAX_MS) ||
        !exh_inside(par->move_m_q30, 1, MAX_M_Q30) ||
        !exh_inside(par->travel_m_q30, par->move_m_q30, MAX_M_Q30)) {
        return -EXH_E_RANGE;
    }
    cfg->step_A_q26 = par->step_A_q26;
    cfg->end_A_q26 = par->end_A_q26;
    cfg->dwell_ticks = dwell_of(par->dwell_ms, scale.T);
    cfg->ticks = exh_probe_ticks(par->time_ms, scale.T);
    cfg->move_cnt = counts_of(par->move_m_q30, scale.step_m_q42, MOVE_MIN_CNT);
    cfg->travel_cnt = counts_of(par->travel_m_q30, scale.step_m_q42, 1);
    return cfg->travel_cnt > cfg->move_cnt && cfg->travel_cnt <= FAR_CNT ? 0 : -EXH_E_RANGE;
}

/* --- probe --- */

void exh_probe_start(struct exh_probe *s, int32_t cnt, int32_t cur_A_q26)
{
    *s = (struct exh_probe){.cur_A_q26 = exh_clamp(cur_A_q26, 0, EXH_PROBE_CUR_MAX_A_Q26),
        .start_cnt = cnt,
        .dwell_cnt = cnt,
        .result = EXH_PROBE_BUSY};
}

/* The result from the counts; BUSY: none yet. out: counts moved outwards in this dwell. */
static uint8_t judge(
    const struct exh_probe *s, const struct exh_probe_cfg *cfg, int32_t cnt, int64_t out)
{
    const int64_t far = exh_wrap_diff(cnt, s->start_cnt);
    const int rises = cfg->step_A_q26 > 0;
    if (far > cfg->travel_cnt || far < -cfg->travel_cnt) { return EXH_PROBE_TRAVEL; }
    if (rises && out >= cfg->move_cnt) { return EXH_PROBE_WRONG_WAY; }
    if (!rises && out >= cfg->move_cnt) { return EXH_PROBE_DONE; }
    if (rises && s->settled && -out >= cfg->move_cnt) { return EXH_PROBE_DONE; }
    return s->tick >= cfg->ticks ? EXH_PROBE_TIME : EXH_PROBE_BUSY;
}

/* Ends a dwell: sets the next current, if the string was quiet in the last dwell. */
static void next_dwell(
    struct exh_probe *s, const struct exh_probe_cfg *cfg, int32_t cnt, int64_t out)
{
    const int64_t next = (int64_t)s->cur_A_q26 + cfg->step_A_q26;
    s->dwell = 0;
    s->dwell_cnt = cnt;
    if (cfg->step_A_q26 < 0 || -out < cfg->move_cnt) { s->settled = 1; }
    if (!s->settled) { return; }
    if (cfg->step_A_q26 > 0 ? next > cfg->end_A_q26 : next < cfg->end_A_q26) {
        s->result = EXH_PROBE_STILL;
    } else {
        s->cur_A_q26 = exh_clamp(next, 0, EXH_PROBE_CUR_MAX_A_Q26);
    }
}

uint8_t exh_probe_step(struct exh_probe *s, const struct exh_probe_cfg *cfg, int32_t cnt)
{
    const int64_t out = exh_wrap_diff(cnt, s->dwell_cnt);
    if (s->result != EXH_PROBE_BUSY) { return s->result; }
    s->tick++;
    s->dwell++;
    s->result = judge(s, cfg, cnt, out);
    if (s->result == EXH_PROBE_BUSY && s->dwell >= cfg->dwell_ticks) {
        next_dwell(s, cfg, cnt, out);
    }
    if (s->result > EXH_PROBE_DONE) { s->cur_A_q26 = 0; }
    return s->result;
}

/* --- home --- */

int exh_home_setup(
    struct exh_home_cfg *cfg, const struct exh_home_par *par, struct exh_probe_scale scale)
{
    if (!scale_ok(scale) || !exh_inside(par->cur_A_q26, 1, HOME_MAX_A_Q26) ||
        !exh_inside(par->dwell_ms, 1, DWELL_MAX_MS) || !exh_inside(par->time_ms, 1, TIME_MAX_MS) ||
        !exh_inside(par->move_m_q30, 1, MAX_M_Q30) ||
        !exh_inside(par->most_m_q30, par->move_m_q30, MAX_M_Q30) ||
        !exh_inside(par->least_m_q30, 0, par->most_m_q30)) {
        return -EXH_E_RANGE;
    }
    cfg->cur_A_q26 = par->cur_A_q26;
    cfg->dwell_ticks = dwell_of(par->dwell_ms, scale.T);
    cfg->ticks = exh_probe_ticks(par->time_ms, scale.T);
    cfg->move_cnt = counts_of(par->move_m_q30, scale.step_m_q42, MOVE_MIN_CNT);
    cfg->least_cnt = counts_of(par->least_m_q30, scale.step_m_q42, 0);
    cfg->most_cnt = counts_of(par->most_m_q30, scale.step_m_q42, 1);
    return cfg->most_cnt > cfg->move_cnt && cfg->most_cnt <= FAR_CNT ? 0 : -EXH_E_RANGE;
}

void exh_home_start(struct exh_home *s, int32_t cnt)
{
    *s = (struct exh_home){.start_cnt = cnt, .dwell_cnt = cnt, .result = EXH_PROBE_BUSY};
}

uint8_t exh_home_step(struct exh_home *s, const struct exh_home_cfg *cfg, int32_t cnt)
{
    const int64_t in = -(int64_t)exh_wrap_diff(cnt, s->dwell_cnt);
    const int64_t far = -(int64_t)exh_wrap_diff(cnt, s->start_cnt);
    if (s->result != EXH_PROBE_BUSY) { return s->result; }
    s->tick++;
    s->dwell++;
    s->cur_A_q26 = cfg->cur_A_q26;
    if (far > cfg->most_cnt) {
        s->result = EXH_PROBE_TRAVEL;
    } else if (-in >= cfg->move_cnt) {
        s->result = EXH_PROBE_WRONG_WAY;
    } else if (s->tick >= cfg->ticks) {
        s->result = EXH_PROBE_TIME;
    } else if (s->dwell >= cfg->dwell_ticks) {
        if (in < cfg->move_cnt) {
            s->result = far < cfg->least_cnt ? EXH_PROBE_JAM : EXH_PROBE_DONE;
        }
        s->home_cnt = cnt;
        s->dwell_cnt = cnt;
        s->dwell = 0;
    }
    if (s->result != EXH_PROBE_BUSY) { s->cur_A_q26 = 0; }
    return s->result;
}
