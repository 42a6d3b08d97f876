/* SPDX-License-Identifier: MIT */
/* probe: the motions of calibration, over a toy of a string with a mass. */
#include "modules.h"

#include "exhand/fix.h"
#include "exhand/probe.h"

/* Where the string is after a tick: slack comes in, a mass lifts above a current, or sinks. */
static int32_t toy(struct golden_rng *r, uint32_t k, int32_t cnt, int32_t cur_A_q26,
    int32_t lift_A_q26, int32_t quick)
{
    const int32_t way = k % 32 < 6 || cur_A_q26 > lift_A_q26        ? -1
                        : cur_A_q26 < lift_A_q26 / 2 && k % 32 > 20 ? 1
                                                                    : 0;
    int32_t moved = way * quick + (int32_t)golden_draw(r, -1, 1);
    if (golden_draw(r, 0, 31) == 0) { moved += (int32_t)golden_draw(r, -4, 4) * quick; }
    return exh_wrap_add(cnt, moved);
}

/* What is common to the three: scale, and how long a tick is. */
struct any {
    struct exh_probe_scale scale;
    int32_t few_ms; /* a little more than a tick */
    int32_t lift_A_q26, quick, cnt;
};

static void any_scale(struct golden_rng *r, struct any *a, uint32_t rate_Hz, uint32_t k)
{
    a->scale.T = golden_period(rate_Hz, k);
    a->scale.step_m_q42 = golden_step(r);
    a->few_ms = (int32_t)(UINT64_C(1000) * a->scale.T.num / a->scale.T.den + 1);
}

static struct exh_probe_par any_par(
    struct golden_rng *r, struct any *a, uint32_t rate_Hz, uint32_t k)
{
    struct exh_probe_par p;
    int falls;
    int64_t v;
    any_scale(r, a, rate_Hz, k);
    falls = golden_draw(r, 0, 1) != 0;
    v = golden_draw(r, 67, 33554432);
    v >>= golden_draw(r, 0, 4);
    if (v < 67) { v = 67; }
    p.step_A_q26 = (int32_t)(falls ? -v : v);
    p.end_A_q26 = (int32_t)golden_draw(r, 0, EXH_PROBE_CUR_MAX_A_Q26);
    p.end_A_q26 >>= golden_draw(r, 0, 2);
    p.move_m_q30 = (int32_t)golden_draw(r, 1, INT32_C(1) << 22);
    v = a->few_ms * golden_draw(r, 1, 3);
    p.dwell_ms = v > 10000 ? 10000 : (int32_t)v;
    v = a->few_ms * golden_draw(r, 8, 64);
    p.time_ms = v > 1000000 ? 1000000 : (int32_t)v;
    p.travel_m_q30 = (int32_t)golden_draw(r, INT32_C(1) << 23, INT32_C(1) << 26);
    return p;
}

static void put_probe(struct golden *g, const struct exh_probe *s)
{
    golden_put(g, s->cur_A_q26);
    golden_put(g, s->start_cnt);
    golden_put(g, s->dwell_cnt);
    golden_put(g, s->dwell);
    golden_put(g, s->tick);
    golden_put(g, s->settled);
    golden_put(g, s->result);
}

void golden_probe(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("probe", rate_Hz, 0);
    struct exh_probe_cfg cfg = {.ticks = 0};
    struct exh_probe s = {.tick = 0};
    struct any a = {.cnt = 0};
    while (g->tick < GOLDEN_TICKS) {
        if (g->tick % 32 == 0) {
            const struct exh_probe_par par = any_par(&r, &a, rate_Hz, g->tick);
            int32_t cur;
            CHECK_EQ_I64(exh_probe_setup(&cfg, &par, a.scale), 0);
            a.cnt = exh_from_u32((uint32_t)(golden_u64(&r) & UINT32_MAX));
            cur = (int32_t)golden_draw(&r, -1000, EXH_PROBE_CUR_MAX_A_Q26 + 1000);
            a.lift_A_q26 = (int32_t)golden_draw(&r, 0, EXH_PROBE_CUR_MAX_A_Q26);
            a.quick = cfg.move_cnt / 2 + 1;
            exh_probe_start(&s, a.cnt, cur);
        }
        a.cnt = toy(&r, g->tick, a.cnt, s.cur_A_q26, a.lift_A_q26, a.quick);
        golden_put(g, a.cnt);
        golden_put(g, exh_probe_step(&s, &cfg, a.cnt));
        put_probe(g, &s);
        golden_tick(g);
    }
}

/* --- home --- */

static int32_t shifted(struct golden_rng *r, int32_t most, int32_t places)
{
    const int64_t any = golden_draw(r, 0, most);
    return (int32_t)(any >> golden_draw(r, 0, places));
}

static struct exh_home_par home_par(
    struct golden_rng *r, struct any *a, uint32_t rate_Hz, uint32_t k)
{
    struct exh_home_par p;
    int64_t v;
    any_scale(r, a, rate_Hz, k);
    p.cur_A_q26 = (int32_t)golden_draw(r, 1, 33554432);
    v = a->few_ms * golden_draw(r, 1, 3);
    p.dwell_ms = v > 10000 ? 10000 : (int32_t)v;
    v = a->few_ms * golden_draw(r, 4, 32);
    p.time_ms = v > 1000000 ? 1000000 : (int32_t)v;
    p.move_m_q30 = (int32_t)golden_draw(r, 1, INT32_C(1) << 21);
    p.least_m_q30 = shifted(r, INT32_C(1) << 23, 3);
    p.most_m_q30 = (int32_t)golden_draw(r, INT32_C(1) << 23, INT32_C(1) << 25);
    return p;
}

void golden_home(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("home", rate_Hz, 0);
    struct exh_home_cfg cfg = {.ticks = 0};
    struct exh_home s = {.tick = 0};
    struct any a = {.cnt = 0};
    uint32_t stops = 0;
    while (g->tick < GOLDEN_TICKS) {
        if (g->tick % 16 == 0) {
            const struct exh_home_par par = home_par(&r, &a, rate_Hz, g->tick);
            CHECK_EQ_I64(exh_home_setup(&cfg, &par, a.scale), 0);
            a.cnt = exh_from_u32((uint32_t)(golden_u64(&r) & UINT32_MAX));
            a.quick = cfg.move_cnt / (int32_t)golden_draw(&r, 1, 3);
            if (a.quick < 1) { a.quick = 1; }
            stops = g->tick + (uint32_t)golden_draw(&r, 0, 15);
            exh_home_start(&s, a.cnt);
        }
        a.cnt = toy(&r, g->tick < stops ? 0 : 8, a.cnt, 0, 0, a.quick);
        golden_put(g, a.cnt);
        golden_put(g, exh_home_step(&s, &cfg, a.cnt));
        golden_put(g, s.cur_A_q26);
        golden_put(g, s.start_cnt);
        golden_put(g, s.dwell_cnt);
        golden_put(g, s.home_cnt);
        golden_put(g, s.dwell);
        golden_put(g, s.tick);
        golden_put(g, s.result);
        golden_tick(g);
    }
}

/* --- weigh --- */

static struct exh_weigh_par weigh_par(
    struct golden_rng *r, struct any *a, uint32_t rate_Hz, uint32_t k)
{
    struct exh_weigh_par p;
    int64_t v;
    any_scale(r, a, rate_Hz, k);
    p.probe.step_A_q26 = (int32_t)golden_draw(r, INT32_C(1) << 20, INT32_C(1) << 23);
    p.probe.end_A_q26 = (int32_t)golden_draw(r, INT32_C(1) << 26, EXH_PROBE_CUR_MAX_A_Q26);
    v = a->few_ms * golden_draw(r, 1, 2);
    p.probe.dwell_ms = v > 10000 ? 10000 : (int32_t)v;
    v = a->few_ms * golden_draw(r, 16, 40);
    p.probe.time_ms = v > 1000000 ? 1000000 : (int32_t)v;
    p.probe.move_m_q30 = (int32_t)golden_draw(r, 1, INT32_C(1) << 21);
    p.probe.travel_m_q30 = (int32_t)golden_draw(r, INT32_C(1) << 23, INT32_C(1) << 26);
    p.slack_A_q26 = (int32_t)golden_draw(r, INT32_C(1) << 23, INT32_C(1) << 26);
    p.hold_ms = a->few_ms * (int32_t)golden_draw(r, 4, 12);
    return p;
}

static void put_weigh(struct golden *g, const struct exh_weigh *s)
{
    const struct exh_calib_point p = exh_weigh_point(s, (int32_t)g->tick);
    golden_put(g, s->cur_A_q26);
    golden_put(g, s->lift_A_q26);
    golden_put(g, s->sink_A_q26);
    golden_put(g, s->coded.sum);
    golden_put(g, s->mon.sum);
    golden_put(g, s->coded.n);
    golden_put(g, s->tick);
    golden_put(g, s->phase);
    golden_put(g, s->result);
    put_probe(g, &s->probe);
    golden_put(g, p.force_N_q20);
    golden_put(g, p.cur_A_q26);
    golden_put(g, p.mon_A_q26);
    golden_put(g, p.friction_A_q26);
}

void golden_weigh(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("weigh", rate_Hz, 0);
    struct exh_weigh_cfg cfg = {.hold_ticks = 0};
    struct exh_weigh s = {.tick = 0};
    struct any a = {.cnt = 0};
    int32_t sink = 0;
    while (g->tick < GOLDEN_TICKS) {
        int32_t coded;
        int32_t mon;
        int64_t odd;
        if (g->tick % 32 == 0) {
            const struct exh_weigh_par par = weigh_par(&r, &a, rate_Hz, g->tick);
            CHECK_EQ_I64(exh_weigh_setup(&cfg, &par, a.scale), 0);
            a.cnt = exh_from_u32((uint32_t)(golden_u64(&r) & UINT32_MAX));
            a.lift_A_q26 = par.slack_A_q26 + par.probe.step_A_q26 * (int32_t)golden_draw(&r, 0, 4);
            sink = a.lift_A_q26 - par.probe.step_A_q26 * (int32_t)golden_draw(&r, 1, 4);
            a.quick = cfg.up.move_cnt / 2 + 1;
            exh_weigh_start(&s, &cfg, a.cnt);
        }
        a.cnt = exh_wrap_add(a.cnt, s.cur_A_q26 > a.lift_A_q26 ? -a.quick
                                    : s.cur_A_q26 < sink       ? a.quick
                                                               : 0);
        odd = golden_draw(&r, 0, 15); /* noise, or a knock */
        if (odd < 4) {
            const int32_t by = (int32_t)golden_draw(&r, -1, 1);
            const int knock = odd == 0 || s.phase > 1;
            a.cnt = exh_wrap_add(a.cnt, knock ? by * cfg.up.move_cnt : by);
        }
        coded = (int32_t)golden_draw(&r, -(INT32_C(1) << 20), INT32_C(1) << 28);
        mon = (int32_t)golden_draw(&r, -(INT32_C(1) << 20), INT32_C(1) << 28);
        golden_put(g, a.cnt);
        golden_put(g, coded);
        golden_put(g, mon);
        golden_put(g, exh_weigh_step(&s, &cfg, a.cnt, coded, mon));
        put_weigh(g, &s);
        golden_tick(g);
    }
}
