/* SPDX-License-Identifier: MIT */
/* drive: tables, from force to current, and the monitor back. */
#include "modules.h"

#include "exhand/drive.h"
#include "exhand/table.h"

#define KNOTS 8

/* --- table --- */

static int32_t any_rise(struct golden_rng *r, int32_t most)
{
    const int64_t any = golden_draw(r, 1, most);
    const int64_t rise = any >> golden_draw(r, 0, 20);
    return rise > 0 ? (int32_t)rise : 1;
}

static unsigned any_knots(struct golden_rng *r, struct exh_knot *knot)
{
    const int32_t n = (int32_t)golden_draw(r, 2, KNOTS);
    int32_t rise[2][KNOTS];
    knot[0].x = (int32_t)golden_draw(r, INT32_MIN, 0);
    knot[0].y = (int32_t)golden_draw(r, INT32_MIN, 0);
    for (int axis = 0; axis < 2; axis++) {
        for (int32_t i = 1; i < n; i++) { rise[axis][i] = any_rise(r, INT32_MAX / n); }
    }
    for (int32_t i = 1; i < n; i++) {
        knot[i].x = knot[i - 1].x + rise[0][i];
        knot[i].y = knot[i - 1].y + rise[1][i];
    }
    return (unsigned)n;
}

void golden_table(struct golden *g, uint32_t rate_Hz)
{
    struct golden_rng r = golden_rng("table", rate_Hz, 0);
    static struct exh_knot there[KNOTS];
    static struct exh_knot back[KNOTS];
    unsigned n = 2;
    while (g->tick < GOLDEN_TICKS) {
        unsigned i;
        int64_t x;
        int64_t y;
        struct exh_gain s;
        if (g->tick % 64 == 0) {
            n = any_knots(&r, there);
            CHECK_EQ_I64(exh_table_setup(there, n), 0);
            CHECK_EQ_I64(exh_table_invert(back, there, n), 0);
        }
        i = (unsigned)golden_draw(&r, 0, n - 1);
        x = there[i].x + golden_draw(&r, -2, 2);
        y = there[i].y + golden_draw(&r, -2, 2);
        if (g->tick & 1) {
            x = golden_draw(&r, there[0].x, there[n - 1].x);
            y = golden_draw(&r, there[0].y, there[n - 1].y);
        }
        x = exh_sat32(x);
        y = exh_sat32(y);
        i = (unsigned)golden_draw(&r, 0, 2 * (n - 1) - 1);
        s = i < n - 1 ? there[i].slope : back[i - (n - 1)].slope;
        golden_put(g, x);
        golden_put(g, y);
        golden_put(g, exh_table_at((struct exh_table){there, (uint8_t)n}, (int32_t)x));
        golden_put(g, exh_table_at((struct exh_table){back, (uint8_t)n}, (int32_t)y));
        golden_put(g, s.mant);
        golden_put(g, s.shift);
        golden_tick(g);
    }
}

/* --- drive --- */

static struct exh_table rising(
    struct golden_rng *r, struct exh_knot *knot, int32_t x, int32_t y, int32_t dx, int32_t dy)
{
    const unsigned n = (unsigned)golden_draw(r, 2, 6);
    for (unsigned i = 0; i < n; i++) {
        if (i > 0) {
            x += (int32_t)golden_draw(r, 1000, dx);
            y += (int32_t)golden_draw(r, 1000, dy);
        }
        knot[i].x = x;
        knot[i].y = y;
    }
    CHECK_EQ_I64(exh_table_setup(knot, n), 0);
    return (struct exh_table){knot, (uint8_t)n};
}

/* 0.1 to 10 N a tick, or the least allowed. */
static int32_t slew(struct golden_rng *r, uint32_t rate_Hz, int32_t least)
{
    const int64_t any = rate_Hz * golden_draw(r, 10, 1000) / 100;
    return any < least ? least : (int32_t)any;
}

void golden_drive_par(struct exh_drive_par *p, struct golden_rng *r, uint32_t rate_Hz)
{
    const int32_t cont_max = 221459251;
    const int32_t least_peak = 6710886;
    const int32_t ms_max = (int32_t)(12000 / rate_Hz + 1);
    p->f_max_N_q20 = (int32_t)golden_draw(r, INT32_C(1) << 20, 104857600);
    p->slew_up_Nps = slew(r, rate_Hz, 1);
    p->slew_down_Nps = slew(r, rate_Hz, 1000);
    p->i_peak_A_q26 = (int32_t)golden_draw(r, least_peak, 442918502);
    p->i_peak_A_q26 >>= golden_draw(r, 0, 4);
    if (p->i_peak_A_q26 < least_peak) { p->i_peak_A_q26 = least_peak; }
    p->i_cont_A_q26 =
        (int32_t)golden_draw(r, 0, p->i_peak_A_q26 - 1 < cont_max ? p->i_peak_A_q26 - 1 : cont_max);
    p->i_cont_A_q26 >>= golden_draw(r, 0, 2);
    p->peak_ms = (int32_t)golden_draw(r, 1, ms_max < 2700 ? ms_max : 2700);
    p->dac_zero_raw = (int32_t)golden_draw(r, 0, 65535);
    p->dac_span_raw = (int32_t)golden_draw(r, 0, 32767);
    p->dac_span_raw >>= golden_draw(r, 0, 8);
    p->dac_rawpA_q16 = (int32_t)golden_draw(r, 65536, INT32_MAX);
    p->mon_zero_raw = (int32_t)golden_draw(r, -32768, 32767);
    p->mon_A_q40 = (int32_t)golden_draw(r, 1, INT32_MAX);
    p->person_N_q20 = (int32_t)golden_draw(r, INT32_C(1) << 20, INT32_C(1) << 28);
    if (p->person_N_q20 > 104857600) { p->person_N_q20 = 104857600; }
    p->person_A_q26 = (int32_t)golden_draw(r, 0, INT32_C(1) << 30);
    if (p->person_A_q26 > 442918502) { p->person_A_q26 = 442918502; }
}

/* An axis with its own tables. */
struct axis {
    struct exh_drive_par par;
    struct exh_drive_cfg cfg;
    struct exh_drive s;
    struct exh_knot to_cur[KNOTS], to_force[KNOTS];
};

static void axis_setup(struct axis *a, struct golden_rng *r, uint32_t rate_Hz, uint32_t k)
{
    struct exh_table to_cur;
    int32_t x;
    int32_t y;
    (void)memset(a, 0, sizeof *a);
    golden_drive_par(&a->par, r, rate_Hz);
    to_cur = rising(r, a->to_cur, 0, 0, INT32_C(1) << 25, INT32_C(1) << 28);
    x = (int32_t)golden_draw(r, -(INT32_C(1) << 29), 0);
    y = (int32_t)golden_draw(r, -(INT32_C(1) << 27), 0);
    CHECK_EQ_I64(exh_drive_setup(&a->cfg, &a->par, golden_period(rate_Hz, k), to_cur,
                     rising(r, a->to_force, x, y, INT32_C(1) << 28, INT32_C(1) << 25)),
        0);
}

static struct exh_permit any_permit(struct golden_rng *r, uint32_t k, struct exh_gain fall)
{
    static const uint8_t mode[] = {0, 2, 2, 2, 3};
    struct exh_permit p = {k < 4 || (k >= 70 && k < 76) ? 0
                           : k == 130                   ? 3
                                                        : 1,
        INT32_C(1) << 30, 0, 1, fall};
    int64_t any;
    if (k >= 100 && k < 110) { p.mode = EXH_PERMIT_RELEASE; }
    if (k >= 160 && (any = golden_draw(r, 0, 31)) < 5) { p.mode = mode[any]; }
    if (golden_draw(r, 0, 3) == 0) { p.share_q30 = (int32_t)golden_draw(r, 0, INT32_C(1) << 30); }
    p.small_N_q20 = (int32_t)golden_draw(r, 0, 10485760);
    if (golden_draw(r, 0, p.mode == EXH_PERMIT_RELEASE ? 1 : 7) == 0) {
        p.ticks = (uint32_t)golden_draw(r, 1, 3);
    }
    return p;
}

void golden_drive(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave spring;
    static struct golden_wave damper;
    static struct axis a;
    struct golden_rng r = golden_rng("drive", rate_Hz, 0);
    struct exh_gain fall = {0, 1};
    golden_wave(&spring, "drive", rate_Hz, 1, -(INT32_C(1) << 26), INT32_C(1) << 27,
        INT32_C(1) << golden_draw(&r, 10, 22));
    golden_wave(&damper, "drive", rate_Hz, 2, -(INT32_C(1) << 25), INT32_C(1) << 25,
        INT32_C(1) << golden_draw(&r, 10, 22));
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t k = g->tick;
        struct exh_permit permit;
        struct exh_force_ledger f = {.passivity_N_q20 = 0};
        struct exh_current_ledger i;
        uint32_t limits;
        int16_t raw;
        if (k == 0 || k == GOLDEN_AGAIN) {
            axis_setup(&a, &r, rate_Hz, k);
            CHECK_EQ_I64(exh_gain_set(&fall, 1, (uint64_t)golden_draw(&r, 3, 360)), 0);
        }
        f.spring_N_q20 = spring.at[k];
        f.damper_N_q20 = damper.at[k];
        f.pullback_N_q20 = k & 8 ? golden_draw(&r, 0, 20971520) : 0;
        if (k >= 180 && k < GOLDEN_AGAIN) {
            f.spring_N_q20 *= INT64_C(1) << golden_draw(&r, 0, 16);
        }
        permit = any_permit(&r, k, fall);
        golden_put(g, f.spring_N_q20);
        golden_put(g, f.damper_N_q20);
        golden_put(g, f.pullback_N_q20);
        golden_put(g, permit.mode);
        golden_put(g, permit.share_q30);
        golden_put(g, permit.small_N_q20);
        golden_put(g, permit.ticks);
        raw = (int16_t)golden_draw(&r, -32768, 32767);
        golden_put(g, raw);
        limits = exh_drive_force_step(&a.s, &a.cfg, &permit, &f);
        limits |= exh_drive_current_step(&a.s, &a.cfg, &f, &i);
        golden_put(g, f.clamp_N_q20);
        golden_put(g, f.slew_N_q20);
        golden_put(g, f.release_N_q20);
        golden_put(g, f.force_N_q20);
        golden_put(g, i.table_A_q26);
        golden_put(g, i.peak_A_q26);
        golden_put(g, i.i2t_A_q26);
        golden_put(g, limits);
        golden_put(g, exh_drive_monitor_A_q26(&a.cfg, raw));
        golden_put(g, exh_drive_monitor_N_q20(&a.cfg, exh_drive_monitor_A_q26(&a.cfg, raw)));
        GOLDEN_STATE(g, exh_drive_serialize, &a.s);
        golden_tick(g);
    }
}
