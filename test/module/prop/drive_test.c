/* SPDX-License-Identifier: MIT */
/* table.h and drive.h against exact arithmetic: tables, both ledgers, the monitor. */
#include "exhand/drive.h"
#include "exhand/table.h"

#include "exhand/error.h"

#include "check.h"
#include "wide.h"

/* --- tables --- */

/* n knots rising strictly, by up to 2^bits each; 0 if they span too far. */
static int any_table(struct exh_knot *k, unsigned n, int32_t bits)
{
    int64_t x = check_i32(), y = check_i32();
    const unsigned dx_bits = (unsigned)check_i32_in(0, bits);
    const unsigned dy_bits = (unsigned)check_i32_in(0, bits);
    for (unsigned i = 0; i < n; i++) {
        k[i].x = (int32_t)x;
        k[i].y = (int32_t)y;
        x += 1 + (int64_t)(check_u64() & ((UINT64_C(1) << dx_bits) - 1));
        y += 1 + (int64_t)(check_u64() & ((UINT64_C(1) << dy_bits) - 1));
        if (x > INT32_MAX || y > INT32_MAX) { return 0; }
    }
    return (int64_t)k[n - 1].x - k[0].x <= INT32_MAX && (int64_t)k[n - 1].y - k[0].y <= INT32_MAX;
}

/* |got - line| <= 1 LSB between the knots around x (1.5 where they are 2^30 and
 * more apart), exact at the knots, the ends outside. */
static int on_table(const struct exh_knot *k, unsigned n, int32_t x, int32_t got)
{
    unsigned i = 0;
    int64_t dx, dy;
    struct wide err;
    if (x <= k[0].x) { return got == k[0].y; }
    if (x >= k[n - 1].x) { return got == k[n - 1].y; }
    while (x >= k[i + 1].x) { i++; }
    dx = (int64_t)k[i + 1].x - k[i].x;
    dy = (int64_t)k[i + 1].y - k[i].y;
    err = wide_sub(wide_mul((int64_t)got - k[i].y, dx), wide_mul((int64_t)x - k[i].x, dy));
    return wide_within(err, wide_of(x == k[i].x ? 0 : dy < 1 << 30 ? dx : dx + dx / 2));
}

static const struct exh_permit open_permit = {EXH_PERMIT_OPEN, 1 << 30, 0, 1, {0, 1}};
static const struct exh_permit closed = {EXH_PERMIT_CLOSED, 1 << 30, INT32_MAX, 1, {0, 1}};

TEST(table_is_near_its_lines_and_monotone)
{
    while (check_case(2)) {
        struct exh_knot k[8];
        const unsigned n = (unsigned)check_i32_in(2, 8);
        const struct exh_table t = {k, (uint8_t)n};
        int32_t x, y;
        if (!any_table(k, n, 31) || exh_table_setup(k, n) < 0) { continue; }
        x = check_u64() % 2 ? check_i32() : check_i32_in(k[0].x, k[n - 1].x);
        y = exh_table_at(t, x);
        CHECK(on_table(k, n, x, y),
            "x %" PRId32 " y %" PRId32 " of %u knots from %" PRId32 ",%" PRId32 " to %" PRId32
            ",%" PRId32,
            x, y, n, k[0].x, k[0].y, k[n - 1].x, k[n - 1].y);
        if (x < INT32_MAX) { CHECK(exh_table_at(t, x + 1) >= y, "falls after %" PRId32, x); }
        x = k[check_u64() % n].x;
        CHECK(on_table(k, n, x, exh_table_at(t, x)), "knot at %" PRId32, x);
    }
}

/* What set accepts and refuses follows from the knots alone. */
TEST(table_set_follows_its_contract)
{
    while (check_case(4)) {
        struct exh_knot k[3];
        int rises = 1, fits = 1, err;
        for (unsigned i = 0; i < 3; i++) {
            const uint64_t how = check_u64();
            k[i].x = check_i32_in(-9, 9) * (how % 4 ? 1 : 200000000);
            k[i].y = check_i32_in(-9, 9) * ((how >> 8) % 4 ? 1 : 200000000);
            rises &= i == 0 || (k[i].x > k[i - 1].x && k[i].y > k[i - 1].y);
        }
        fits = (int64_t)k[2].x - k[0].x <= INT32_MAX && (int64_t)k[2].y - k[0].y <= INT32_MAX;
        err = exh_table_setup(k, 3);
        CHECK((err == 0) == (rises && fits),
            "error %d, rises %d, fits %d: y %" PRId32 " %" PRId32 " %" PRId32 " at x %" PRId32
            " %" PRId32 " %" PRId32,
            err, rises, fits, k[0].y, k[1].y, k[2].y, k[0].x, k[1].x, k[2].x);
        CHECK(err == 0 || (err == -EXH_E_MONOTONE ? !rises : err == -EXH_E_RANGE), "error %d", err);
    }
}

/* The inverse and back, through the steeper direction. Each way adds half an LSB, each slope 2^-31
 * of the span. So the integer error is at most 1, or 2 from a span of 2^30 on. */
TEST(inverse_round_trip)
{
    while (check_case(2)) {
        struct exh_knot k[2], inv[2];
        const struct exh_table there = {k, 2}, back = {inv, 2};
        int64_t err, dx, dy;
        int32_t x, most;
        if (!any_table(k, 2, 31) || exh_table_setup(k, 2) < 0) { continue; }
        if (exh_table_invert(inv, k, 2) < 0) { continue; }
        dx = (int64_t)k[1].x - k[0].x;
        dy = (int64_t)k[1].y - k[0].y;
        most = (dx < dy ? dx : dy) >> 30 ? 2 : 1;
        if (dx <= dy) {
            x = check_i32_in(k[0].x, k[1].x);
            err = (int64_t)exh_table_at(back, exh_table_at(there, x)) - x;
        } else {
            x = check_i32_in(k[0].y, k[1].y);
            err = (int64_t)exh_table_at(there, exh_table_at(back, x)) - x;
        }
        CHECK(err >= -most && err <= most, "%" PRId32 " comes back off by %" PRId64, x, err);
    }
}

/* --- one axis with random parameters --- */

struct axis {
    struct exh_drive_par par;
    struct exh_knot knot[4];
    struct exh_drive_cfg cfg;
    struct exh_period T;
};

static int32_t in_row(unsigned r)
{
    return check_i32_in(exh_drive_rows[r].min, exh_drive_rows[r].max);
}

static int any_axis(struct axis *a)
{
    const struct exh_table t = {a->knot, 4}, none = {NULL, 0};
    int32_t *field = &a->par.f_max_N_q20;
    struct exh_knot zero;
    for (unsigned r = 0; r < EXH_DRIVE_ROWS; r++) { field[r] = in_row(r); }
    if (a->par.i_peak_A_q26 < a->par.i_cont_A_q26) {
        const int32_t swap = a->par.i_peak_A_q26;
        a->par.i_peak_A_q26 = a->par.i_cont_A_q26;
        a->par.i_cont_A_q26 = swap;
    }
    if (a->par.i_cont_A_q26 > exh_drive_rows[4].max) {
        a->par.i_cont_A_q26 = exh_drive_rows[4].max;
    }
    if (a->par.i_peak_A_q26 < exh_drive_rows[3].min) {
        a->par.i_peak_A_q26 = exh_drive_rows[3].min;
    }
    a->T.num = 1;
    a->T.den = (uint32_t)check_i32_in(1, 20000);
    if (!any_table(a->knot, 4, 28)) { return 0; }
    /* A drive's table goes through the origin: from one of the first three knots. */
    zero = a->knot[check_u64() % 3];
    for (unsigned i = 0; i < 4; i++) {
        a->knot[i].x -= zero.x;
        a->knot[i].y -= zero.y;
    }
    if (exh_table_setup(a->knot, 4) < 0) { return 0; }
    return exh_drive_setup(&a->cfg, &a->par, a->T, t, check_u64() % 2 ? t : none) == 0;
}

/* |change| * den <= slew * 2^20 * num, plus rounding, or 1 LSB. */
static int within_slew(const struct axis *a, int64_t change, int32_t slew_Nps)
{
    const int64_t rise = change < 0 ? -change : change;
    const struct wide allowed = wide_shl(wide_mul(slew_Nps, a->T.num), EXH_Q_FORCE);
    const struct wide slack = wide_add(wide_of(a->T.den), wide_shr_floor(allowed, 31));
    return wide_cmp(wide_mul(rise, a->T.den), wide_add(allowed, slack)) <= 0;
}

TEST(force_ledger_sums_and_limits_hold)
{
    while (check_case(1)) {
        struct axis a;
        struct exh_drive s = {0, 0, 0};
        struct exh_force_ledger f;
        int64_t asked;
        uint32_t bits;
        int32_t last, slew, most;
        int run, person;
        if (!any_axis(&a)) { continue; }
        f.spring_N_q20 = check_i64() >> 8;
        f.damper_N_q20 = check_i64();
        f.damper_N_q20 >>= 8 + check_u64() % 32;
        f.pullback_N_q20 = check_i32();
        f.passivity_N_q20 = check_u64() % 2 ? check_i32() : 0;
        asked = f.spring_N_q20 + f.damper_N_q20 + f.pullback_N_q20 + f.passivity_N_q20;
        f.clamp_N_q20 = f.slew_N_q20 = f.force_N_q20 = 123;
        most = a.par.f_max_N_q20 < a.knot[3].x ? a.par.f_max_N_q20 : a.knot[3].x;
        person = a.par.person_N_q20 < most;
        if (person) { most = a.par.person_N_q20; }
        last = s.force_N_q20 = check_i32_in(0, most);
        run = check_u64() % 8 != 0;
        bits = exh_drive_force_step(&s, &a.cfg, run ? &open_permit : &closed, &f);
        CHECK(f.force_N_q20 == asked + f.clamp_N_q20 + f.slew_N_q20, "ledger: %" PRId32,
            f.force_N_q20);
        CHECK(s.force_N_q20 == f.force_N_q20, "state");
        CHECK(f.force_N_q20 >= 0 && f.force_N_q20 <= most, "force %" PRId32, f.force_N_q20);
        if (!run) {
            CHECK(f.force_N_q20 == 0 && f.slew_N_q20 == 0, "force %" PRId32 " outside RUN",
                f.force_N_q20);
            CHECK(((bits & EXH_LIMIT_GATE) != 0) == (asked > 0), "gate bit");
            continue;
        }
        slew = f.force_N_q20 >= last ? a.par.slew_up_Nps : a.par.slew_down_Nps;
        CHECK(within_slew(&a, (int64_t)f.force_N_q20 - last, slew), "from %" PRId32 " to %" PRId32,
            last, f.force_N_q20);
        CHECK(((bits & EXH_LIMIT_PULL) != 0) == (asked < 0), "pull bit, asked %" PRId64, asked);
        CHECK(((bits & EXH_LIMIT_FORCE) != 0) == (asked > most && !person), "force bit");
        CHECK(((bits & EXH_LIMIT_PERSON) != 0) == (asked > most && person), "person bit");
        CHECK(((bits & EXH_LIMIT_SLEW) != 0) == (f.slew_N_q20 != 0), "slew bit");
        CHECK((bits & ~(7u | EXH_LIMIT_PERSON)) == 0, "foreign bits %" PRIx32, bits);
        CHECK(f.slew_N_q20 == 0 || f.force_N_q20 != last, "stuck at %" PRId32, last);
    }
}

/* f_max lowered while the force is above it: down as fast as the slew lets it. */
TEST(force_above_a_lowered_limit_comes_down)
{
    while (check_case(4)) {
        struct axis a;
        struct exh_drive s = {0, 0, 0};
        struct exh_force_ledger f = {0};
        int32_t last, most;
        if (!any_axis(&a)) { continue; }
        most = a.par.f_max_N_q20 < a.knot[3].x ? a.par.f_max_N_q20 : a.knot[3].x;
        last = s.force_N_q20 = check_i32_in(most, INT32_MAX);
        f.spring_N_q20 = check_i64() >> 2;
        (void)exh_drive_force_step(&s, &a.cfg, &open_permit, &f);
        CHECK(f.force_N_q20 <= most || f.force_N_q20 < last, "stays at %" PRId32, last);
        CHECK(within_slew(&a, (int64_t)f.force_N_q20 - last, a.par.slew_down_Nps), "snaps");
        CHECK(f.force_N_q20 == f.spring_N_q20 + f.clamp_N_q20 + f.slew_N_q20, "ledger");
    }
}

/* The largest whole number of D/A codes within a limit, as a current. */
static int32_t whole(const struct axis *a, int32_t limit_A_q26)
{
    const struct wide codes =
        wide_shr_floor(wide_mul(limit_A_q26, a->par.dac_rawpA_q16), EXH_Q_CUR + EXH_Q_DAC);
    const int64_t cur = exh_gain_floor(a->cfg.dac_A_q26, wide_sat32(codes));
    return cur < limit_A_q26 ? (int32_t)cur : limit_A_q26;
}

/* The current that the gate codes for one that is asked. */
static int64_t coded(const struct axis *a, int64_t cur_A_q26)
{
    const struct wide code =
        wide_shr_half_up(wide_mul(cur_A_q26, a->par.dac_rawpA_q16), EXH_Q_CUR + EXH_Q_DAC);
    return exh_gain_mul(a->cfg.dac_A_q26, wide_sat32(code));
}

/* What is allowed by I2t: all of the peak below 3/4 of the budget, never more than
 * the peak, never less than continuous, and falling as the heat rises. */
TEST(current_ledger_sums_and_limits_hold)
{
    while (check_case(1)) {
        struct axis a;
        struct exh_drive s;
        struct exh_force_ledger f = {0};
        struct exh_current_ledger i = {7, 7, 7, 7, 7, 7}, hotter;
        int64_t sum, heat, peaked;
        int32_t top;
        uint32_t bits;
        int person;
        if (!any_axis(&a)) { continue; }
        s.force_N_q20 = 0;
        s.i2t_q32 = heat = a.cfg.i2t_budget_q32 / 4096 * check_i32_in(0, 4096);
        f.force_N_q20 = check_u64() % 2 ? check_i32() : check_i32_in(a.knot[0].x, a.knot[3].x);
        bits = exh_drive_current_step(&s, &a.cfg, &f, &i);
        sum = i.table_A_q26 + i.peak_A_q26 + i.i2t_A_q26;
        peaked = i.table_A_q26 + i.peak_A_q26;
        CHECK(on_table(a.knot, 4, f.force_N_q20, (int32_t)i.table_A_q26), "table");
        person = a.par.person_A_q26 < a.par.i_peak_A_q26 &&
                 whole(&a, a.par.person_A_q26) < whole(&a, a.par.i_peak_A_q26);
        top = whole(&a, person ? a.par.person_A_q26 : a.par.i_peak_A_q26);
        CHECK(peaked == exh_clamp(i.table_A_q26, -top, top) ||
                  (i.i2t_A_q26 != 0 && !person &&
                      peaked == exh_clamp(i.table_A_q26, -a.par.i_peak_A_q26, a.par.i_peak_A_q26)),
            "peak");
        CHECK(sum >= -top && sum <= top, "beyond the peak");
        CHECK(coded(&a, sum) <= a.par.i_peak_A_q26 && coded(&a, sum) >= -a.par.i_peak_A_q26,
            "coded beyond the peak: %" PRId64, coded(&a, sum));
        CHECK(i.i2t_A_q26 == 0 || sum >= whole(&a, a.par.i_cont_A_q26) ||
                  sum <= -whole(&a, a.par.i_cont_A_q26),
            "below continuous: %" PRId64, sum);
        CHECK((sum ^ peaked) >= 0 || sum == 0, "I2t turned the sign");
        CHECK(i.i2t_A_q26 == 0 || heat >= a.cfg.i2t_budget_q32 / 4 * 3,
            "limited at heat %" PRId64 " of %" PRId64, heat, a.cfg.i2t_budget_q32);
        CHECK(i.gate_A_q26 == 0 && i.dac_A_q26 == 0 && i.coded_A_q26 == 0, "rest of the ledger");
        CHECK(((bits & EXH_LIMIT_PEAK) != 0) == (i.peak_A_q26 != 0 && !person), "peak bit");
        CHECK(((bits & EXH_LIMIT_PERSON) != 0) == (i.peak_A_q26 != 0 && person), "person bit");
        CHECK(((bits & EXH_LIMIT_I2T) != 0) == (i.i2t_A_q26 != 0), "I2t bit");
        CHECK((bits & ~(uint32_t)(EXH_LIMIT_PEAK | EXH_LIMIT_I2T | EXH_LIMIT_PERSON)) == 0,
            "foreign bits");
        /* one tick at 6.6 A may overshoot: 43.6 A^2 in q32 is below 44 * 2^32 */
        CHECK(s.i2t_q32 >= 0 && s.i2t_q32 <= a.cfg.i2t_budget_q32 + 44 * (INT64_C(1) << 32),
            "heat %" PRId64, s.i2t_q32);
        s.i2t_q32 = a.cfg.i2t_budget_q32 - (a.cfg.i2t_budget_q32 - heat) / 2;
        (void)exh_drive_current_step(&s, &a.cfg, &f, &hotter);
        CHECK(hotter.i2t_A_q26 <= 0 ? hotter.i2t_A_q26 <= i.i2t_A_q26 || i.i2t_A_q26 > 0
                                    : hotter.i2t_A_q26 >= i.i2t_A_q26,
            "hotter allows more");
    }
}

/* The heat is the sum of (i^2 - i_cont^2), within what q16 amperes can resolve. */
TEST(heat_is_what_was_spent)
{
    while (check_case(1)) {
        struct axis a;
        struct exh_drive s;
        struct exh_force_ledger f = {0};
        struct exh_current_ledger i;
        int64_t spent, gained;
        struct wide cont2;
        if (!any_axis(&a)) { continue; }
        s.force_N_q20 = 0;
        s.i2t_q32 = a.cfg.i2t_budget_q32 / 2;
        f.force_N_q20 = check_i32();
        (void)exh_drive_current_step(&s, &a.cfg, &f, &i);
        spent = coded(&a, i.table_A_q26 + i.peak_A_q26 + i.i2t_A_q26);
        cont2 = wide_mul(a.par.i_cont_A_q26, a.par.i_cont_A_q26);
        spent = wide_sat64(wide_shr_floor(wide_sub(wide_mul(spent, spent), cont2), 20));
        gained = s.i2t_q32 - a.cfg.i2t_budget_q32 / 2;
        /* 6.6 A is 432538 in q16; each of two squares is off by less than 2*432538 + 1 */
        CHECK(s.i2t_q32 == 0 || (gained - spent < 1730154 && spent - gained < 1730154),
            "heat %" PRId64 ", spent %" PRId64, gained, spent);
    }
}

/* --- monitor --- */

static void monitor_case(const struct axis *a, int16_t raw)
{
    const int32_t got = exh_drive_monitor_A_q26(&a->cfg, raw);
    const struct wide exact = wide_mul((int64_t)raw - a->par.mon_zero_raw, a->par.mon_A_q40);
    CHECK(got == wide_sat32(wide_shr_half_up(exact, 14)),
        "code %d zero %" PRId32 " scale %" PRId32 ": %" PRId32, raw, a->par.mon_zero_raw,
        a->par.mon_A_q40, got);
    if (a->cfg.cur_to_force.n != 0) {
        CHECK(on_table(a->knot, 4, got,
                  exh_drive_monitor_N_q20(&a->cfg, exh_drive_monitor_A_q26(&a->cfg, raw))),
            "force of code %d", raw);
    }
}

TEST(monitor_is_within_half_an_lsb)
{
    static const int16_t corner[] = {INT16_MIN, INT16_MIN + 1, -1, 0, 1, INT16_MAX - 1, INT16_MAX};
    while (check_case(2)) {
        struct axis a;
        if (!any_axis(&a)) { continue; }
        monitor_case(&a, corner[check_u64() % 7]);
        monitor_case(&a, (int16_t)check_i32_in(INT16_MIN, INT16_MAX));
    }
}

TEST_MAIN("prop/drive", table_is_near_its_lines_and_monotone, table_set_follows_its_contract,
    inverse_round_trip, force_ledger_sums_and_limits_hold, force_above_a_lowered_limit_comes_down,
    current_ledger_sums_and_limits_hold, heat_is_what_was_spent, monitor_is_within_half_an_lsb);
