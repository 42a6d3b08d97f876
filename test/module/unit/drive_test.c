/* SPDX-License-Identifier: MIT */
/* drive.h: limits, I2t and slew, on numbers worked out by hand. */
#include "exhand/drive.h"
#include "exhand/frame.h"
#include "exhand/table.h"

#include "exhand/error.h"

#include "check.h"

/* --- one axis: 10 N per A --- */

#define NEWTON (1 << EXH_Q_FORCE)

struct axis {
    struct exh_drive_par par;
    struct exh_knot knot[2], inv[2];
    struct exh_drive_cfg cfg;
    struct exh_drive s;
};

static void axis_par(struct exh_drive_par *par)
{
    int32_t *field = &par->f_max_N_q20; /* all fields int32_t, in the order of the rows */
    for (size_t i = 0; i < EXH_DRIVE_ROWS; i++) { field[i] = exh_drive_rows[i].dflt; }
}

static int axis_setup(struct axis *a, struct exh_period T)
{
    const struct exh_table none = {NULL, 0};
    struct exh_table there, back;
    a->knot[0] = (struct exh_knot){0, 0, {0, 1}};
    a->knot[1] = (struct exh_knot){EXH_Q(100, 1, EXH_Q_FORCE), EXH_Q(10, 1, EXH_Q_CUR), {0, 1}};
    if (exh_table_setup(a->knot, 2) < 0 || exh_table_invert(a->inv, a->knot, 2) < 0) { return 1; }
    there = (struct exh_table){a->knot, 2};
    back = (struct exh_table){a->inv, 2};
    a->s = (struct exh_drive){0, 0, 0};
    return exh_drive_setup(&a->cfg, &a->par, T, there, a->par.mon_zero_raw == 77 ? none : back);
}

TEST(setup_rejections)
{
    static const struct {
        size_t field;
        int32_t v;
        const char *what;
    } row[] = {
        {3, EXH_Q(3, 1, EXH_Q_CUR), "i_peak below i_cont"},
        {8, 0, "no D/A scale"},
        {10, 0, "no monitor scale, though a monitor table is given"},
        {7, -12184, "a negative D/A span, which would code a current outside RUN"},
        {6, 70000, "a D/A zero beyond 16 bits"},
        {0, -1, "a negative force limit"},
        {0, EXH_Q(101, 1, EXH_Q_FORCE), "a force limit beyond its range"},
        {1, 0, "no rise of force"},
        {2, 999, "a release that takes longer than a finger bears"},
        {2, -1, "a negative release"},
        {3, 0, "no peak current"},
        {3, EXH_Q(67, 10, EXH_Q_CUR), "a peak beyond the drive's"},
        {4, EXH_Q(34, 10, EXH_Q_CUR), "a continuous current beyond the drive's"},
        {4, -1, "a negative continuous current"},
        {5, 0, "no peak time"},
        {5, 2701, "a peak longer than the drive's"},
        {9, 32768, "a monitor zero beyond 16 bits"},
        {11, (1 << 17) - 1, "no ceiling of force"},
        {11, EXH_Q(101, 1, EXH_Q_FORCE), "a ceiling of force beyond its range"},
        {12, -1, "a negative ceiling of current"},
        {12, EXH_Q(67, 10, EXH_Q_CUR), "a ceiling of current beyond the drive's"},
    };
    /* None, one whose newtons a tick have no room, one in which 2.7 s are more heat than there is
     * room for. */
    static const struct exh_period period[] = {{0, 2000}, {1, 0}, {UINT32_MAX, 1}, {1, 1000000000}};
    struct axis a;
    axis_par(&a.par);
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
    a.par.mon_zero_raw = 77; /* marks: no monitor table */
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
    for (size_t i = 0; i < LEN(row); i++) {
        axis_par(&a.par);
        ((int32_t *)&a.par)[row[i].field] = row[i].v;
        CHECK(axis_setup(&a, (struct exh_period){1, 2000}) == -EXH_E_RANGE, "%s", row[i].what);
    }
    axis_par(&a.par);
    for (size_t i = 0; i < LEN(period); i++) {
        CHECK(axis_setup(&a, period[i]) == -EXH_E_RATE, "period %zu", i);
    }
}

/* A current at no force would hold the string without being asked. */
TEST(setup_refuses_tables_that_pull_at_no_force)
{
    static const struct exh_knot row[][2] = {
        {{1, 0, {0, 1}}, {9, 9, {0, 1}}},   /* begins above no force */
        {{0, 1, {0, 1}}, {9, 9, {0, 1}}},   /* a current at no force */
        {{-9, -9, {0, 1}}, {9, 5, {0, 1}}}, /* a push at no force */
        {{-9, -9, {0, 1}}, {-1, -1, {0, 1}}},
        {{-9, -9, {0, 1}}, {0, 0, {0, 1}}}, /* ends there */
        {{-9, -9, {0, 1}}, {-1, 0, {0, 1}}},
    };
    const struct exh_table none = {NULL, 0};
    struct exh_drive_par par;
    struct exh_drive_cfg cfg;
    axis_par(&par);
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_knot k[2] = {row[i][0], row[i][1]};
        const struct exh_table t = {k, 2}, one = {k, 1};
        CHECK_EQ_I64(exh_table_setup(k, 2), 0);
        CHECK(exh_drive_setup(&cfg, &par, (struct exh_period){1, 2000}, t, none) == -EXH_E_RANGE,
            "table %zu", i);
        CHECK_EQ_I64(
            exh_drive_setup(&cfg, &par, (struct exh_period){1, 2000}, one, none), -EXH_E_RANGE);
        CHECK_EQ_I64(
            exh_drive_setup(&cfg, &par, (struct exh_period){1, 2000}, none, none), -EXH_E_RANGE);
    }
}

TEST(setup_takes_every_documented_period)
{
    static const struct exh_period T[] = {{1, 20000}, {1, 1}, {65, 1193182}, {1, 90},
        {4294967, 4294967295}, {214748, 4294967295}, {4294967295, 4294967295}};
    for (size_t i = 0; i < LEN(T); i++) {
        struct axis a;
        axis_par(&a.par);
        CHECK(axis_setup(&a, T[i]) == 0, "period %zu", i);
    }
}

static const struct exh_permit open_permit = {EXH_PERMIT_OPEN, 1 << 30, 0, 1, {0, 1}};
static const struct exh_permit closed = {EXH_PERMIT_CLOSED, 1 << 30, INT32_MAX, 1, {0, 1}};

static uint32_t force(struct axis *a, int64_t spring, struct exh_force_ledger *f)
{
    const struct exh_force_ledger zero = {0};
    *f = zero;
    f->spring_N_q20 = spring;
    return exh_drive_force_step(&a->s, &a->cfg, &open_permit, f);
}

/* f_max 40 N; slew 200 kN/s at 2 kHz: 100 N a tick, so not in the way. */
TEST(force_limit_and_pull_only)
{
    static const struct {
        int64_t asked_N;
        int64_t want_N;
        uint32_t limits;
    } row[] = {{0, 0, 0}, {39, 39, 0}, {40, 40, 0}, {41, 40, EXH_LIMIT_FORCE},
        {1000000, 40, EXH_LIMIT_FORCE}, {-1, 0, EXH_LIMIT_PULL}, {-1000000, 0, EXH_LIMIT_PULL},
        {12, 12, 0}};
    struct axis a;
    axis_par(&a.par);
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_force_ledger f;
        CHECK_EQ_I64(force(&a, row[i].asked_N * NEWTON, &f), row[i].limits);
        CHECK_EQ_I64(f.force_N_q20, row[i].want_N * NEWTON);
        CHECK_EQ_I64(f.clamp_N_q20, (row[i].want_N - row[i].asked_N) * NEWTON);
        CHECK_EQ_I64(f.slew_N_q20, 0);
        CHECK_EQ_I64(a.s.force_N_q20, f.force_N_q20);
    }
}

/* For any f_max between two ticks, and any value of 1 N in the table. The limit that is reported is
 * the lower of the two. Of two equal ones it is f_max. */
TEST(no_force_or_current_beyond_the_persons_ceiling)
{
    static const struct {
        int32_t f_max, person, dA, asked, want, mA;
        uint32_t limits;
    } row[] = {{40, 2, 66, 30, 2, 200, EXH_LIMIT_PERSON}, {100, 2, 66, 2, 2, 200, 0},
        {1, 2, 66, 30, 1, 100, EXH_LIMIT_FORCE}, {2, 2, 66, 30, 2, 200, EXH_LIMIT_FORCE},
        {40, 40, 1, 30, 30, 100, EXH_LIMIT_PERSON}, {40, 40, 0, 30, 30, 0, EXH_LIMIT_PERSON},
        {40, 2, 1, 30, 2, 100, EXH_LIMIT_PERSON}, {100, 100, 66, 80, 80, 6600, EXH_LIMIT_PEAK}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_force_ledger f;
        struct exh_current_ledger c;
        struct axis a;
        int64_t most;
        uint32_t limits;
        axis_par(&a.par);
        a.par.person_N_q20 = row[i].person * NEWTON;
        a.par.person_A_q26 = EXH_Q(row[i].dA, 10, EXH_Q_CUR);
        CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
        a.par.f_max_N_q20 = row[i].f_max * NEWTON;
        limits = force(&a, (int64_t)row[i].asked * NEWTON, &f);
        limits |= exh_drive_current_step(&a.s, &a.cfg, &f, &c);
        CHECK(limits == row[i].limits, "row %zu: limits %x", i, (unsigned)limits);
        CHECK_EQ_I64(f.force_N_q20, row[i].want * NEWTON);
        most = (int64_t)row[i].mA * (1 << 26) / 1000 + 1;
        CHECK(c.table_A_q26 + c.peak_A_q26 + c.i2t_A_q26 <= most &&
                  c.table_A_q26 + c.peak_A_q26 + c.i2t_A_q26 >= most - (1 << 26) / 1846,
            "row %zu: %" PRId64, i, c.table_A_q26 + c.peak_A_q26 + c.i2t_A_q26);
    }
}

/* The table ends at 22 N: a force beyond it can't be had, and is not claimed. */
TEST(no_force_beyond_the_table)
{
    struct exh_knot k[2] = {
        {0, 0, {0, 1}}, {EXH_Q(22, 1, EXH_Q_FORCE), EXH_Q(66, 10, EXH_Q_CUR), {0, 1}}};
    const struct exh_table t = {k, 2}, none = {NULL, 0};
    struct exh_force_ledger f = {30 * (int64_t)NEWTON, 0, 0, 0, 0, 0, 0, 0};
    struct axis a;
    axis_par(&a.par);
    a.s = (struct exh_drive){0, 0, 0};
    CHECK_EQ_I64(exh_table_setup(k, 2), 0);
    CHECK_EQ_I64(exh_drive_setup(&a.cfg, &a.par, (struct exh_period){1, 2000}, t, none), 0);
    CHECK_EQ_I64(exh_drive_force_step(&a.s, &a.cfg, &open_permit, &f), EXH_LIMIT_FORCE);
    CHECK_EQ_I64(f.force_N_q20, 22 * NEWTON);
    CHECK_EQ_I64(f.clamp_N_q20, -8 * NEWTON);
    CHECK_EQ_I64(exh_drive_monitor_N_q20(&a.cfg, exh_drive_monitor_A_q26(&a.cfg, 1000)),
        0); /* no monitor, no force of it */
}

/* Slopes not filled in, as in a table of one's own in ROM: 0 A up to its very end. */
TEST(setup_refuses_a_table_that_was_not_set)
{
    const struct exh_knot k[2] = {
        {0, 0, {0, 1}}, {EXH_Q(22, 1, EXH_Q_FORCE), EXH_Q(66, 10, EXH_Q_CUR), {0, 1}}};
    struct exh_knot good[2] = {k[0], k[1]};
    const struct exh_table raw = {k, 2}, set = {good, 2}, none = {NULL, 0};
    const struct exh_period T = {1, 2000};
    struct exh_drive_par par;
    struct exh_drive_cfg cfg;
    axis_par(&par);
    CHECK_EQ_I64(exh_table_setup(good, 2), 0);
    CHECK_EQ_I64(exh_drive_setup(&cfg, &par, T, set, none), 0);
    CHECK_EQ_I64(exh_drive_setup(&cfg, &par, T, set, set), 0);
    CHECK_EQ_I64(exh_drive_setup(&cfg, &par, T, raw, none), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_drive_setup(&cfg, &par, T, set, raw), -EXH_E_RANGE);
    good[1].x = good[0].x; /* was set, and was changed */
    CHECK_EQ_I64(exh_drive_setup(&cfg, &par, T, set, none), -EXH_E_RANGE);
}

/* Outside RUN nothing is commanded and nothing is remembered. */
TEST(not_running_is_no_force)
{
    struct axis a;
    struct exh_force_ledger f;
    axis_par(&a.par);
    a.par.slew_up_Nps = 2000; /* 1 N a tick */
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
    for (int n = 0; n < 5; n++) { (void)force(&a, 5 * NEWTON, &f); }
    CHECK_EQ_I64(f.force_N_q20, 5 * NEWTON);
    for (int sign = -1; sign <= 1; sign++) {
        f = (struct exh_force_ledger){sign * (INT64_C(1) << 40), 0, 0, 0, 7, 7, 7, 7};
        CHECK_EQ_I64(exh_drive_force_step(&a.s, &a.cfg, &closed, &f),
            sign > 0   ? EXH_LIMIT_GATE | EXH_LIMIT_FORCE
            : sign < 0 ? EXH_LIMIT_PULL
                       : 0);
        CHECK(
            f.force_N_q20 == 0 && f.slew_N_q20 == 0 && f.clamp_N_q20 == -f.spring_N_q20, "ledger");
        CHECK_EQ_I64(a.s.force_N_q20, 0);
    }
    CHECK_EQ_I64(force(&a, 5 * NEWTON, &f), EXH_LIMIT_SLEW);
    CHECK_EQ_I64(f.force_N_q20, NEWTON); /* rises from nothing */
}

/* The release against its definition, at every number of ticks that any rate and time give, from
 * any force. In every tick the force changes by at most force/R + 1 LSB, whatever the law commands,
 * and R ticks are enough. */
TEST(release_is_bounded_and_ends)
{
    struct axis a;
    axis_par(&a.par);
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
    for (uint32_t k = 0; k < 360 * 64; k++) {
        const int32_t ticks = (int32_t)(3 + k % 358);
        const int32_t from = k < 358                ? 0
                             : k < 716              ? 100 * NEWTON
                             : check_u64() % 8 == 0 ? ticks * check_i32_in(0, 10000)
                                                    : check_i32_in(0, 100 * NEWTON);
        struct exh_permit p = {EXH_PERMIT_RELEASE, 0, 0, 1, {0, 1}};
        int32_t last = from;
        CHECK_EQ_I64(exh_gain_set(&p.fall, 1, (uint64_t)ticks), 0);
        a.s = (struct exh_drive){from, 0, 0};
        for (int32_t n = 1; n <= ticks; n += (int32_t)p.ticks) {
            struct exh_force_ledger f = {check_i64() >> 24, check_i32(), 0, 0, 5, 5, 5, 5};
            const int64_t asked = f.spring_N_q20 + f.damper_N_q20;
            p.ticks = check_u64() % 8 ? 1 : 1 + (uint32_t)(check_u64() % 3);
            CHECK_EQ_I64(exh_drive_force_step(&a.s, &a.cfg, &p, &f), EXH_LIMIT_RELEASE);
            CHECK(last - f.force_N_q20 >= 0 && (int64_t)(last - f.force_N_q20) * ticks <=
                                                   ((int64_t)from + ticks) * (int64_t)p.ticks,
                "%" PRId32 " of %" PRId32 " in %" PRId32, last - f.force_N_q20, from, ticks);
            CHECK((int64_t)f.force_N_q20 * ticks <= (int64_t)from * (ticks - n), "late");
            CHECK(f.force_N_q20 == asked + f.clamp_N_q20 + f.slew_N_q20 + f.release_N_q20, "sum");
            CHECK(f.clamp_N_q20 == 0 && f.slew_N_q20 == 0, "a term of its own");
            last = f.force_N_q20;
        }
        CHECK(last == 0, "%" PRId32 " left of %" PRId32 " after %" PRId32, last, from, ticks);
    }
}

/* A second release starts from the force that there is then. */
TEST(release_begins_anew)
{
    struct exh_permit p = {EXH_PERMIT_RELEASE, 0, 0, 1, {0, 1}};
    struct exh_force_ledger f = {0};
    struct axis a;
    axis_par(&a.par);
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
    CHECK_EQ_I64(exh_gain_set(&p.fall, 1, 4), 0);
    a.s.force_N_q20 = 8 * NEWTON;
    (void)exh_drive_force_step(&a.s, &a.cfg, &p, &f);
    CHECK_EQ_I64(f.force_N_q20, 6 * NEWTON - 1);
    (void)force(&a, 20 * NEWTON, &f);
    (void)exh_drive_force_step(&a.s, &a.cfg, &p, &f);
    CHECK_EQ_I64(f.force_N_q20, 15 * NEWTON - 1);
}

/* Half the limit is allowed: RAMP reports it, and so does FORCE beyond the whole limit. */
TEST(ramp_limits_the_force)
{
    static const struct {
        int64_t asked_N;
        int64_t want_N;
        uint32_t limits;
    } row[] = {{19, 19, 0}, {20, 20, 0}, {21, 20, EXH_LIMIT_RAMP},
        {41, 20, EXH_LIMIT_RAMP | EXH_LIMIT_FORCE}, {-1, 0, EXH_LIMIT_PULL}};
    const struct exh_permit half = {EXH_PERMIT_OPEN, 1 << 29, 0, 1, {0, 1}};
    struct axis a;
    axis_par(&a.par);
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_force_ledger f = {row[i].asked_N * NEWTON, 0, 0, 0, 0, 0, 0, 0};
        CHECK_EQ_I64(exh_drive_force_step(&a.s, &a.cfg, &half, &f), row[i].limits);
        CHECK_EQ_I64(f.force_N_q20, row[i].want_N * NEWTON);
    }
}

/* The force is in proportion to the share: no jump to the whole on the way, and no pause. */
TEST(ramp_is_a_share_all_the_way)
{
    struct axis a;
    axis_par(&a.par);
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
    for (int32_t k = 0; k <= 1024; k++) {
        const struct exh_permit p = {EXH_PERMIT_OPEN, k << 20, 0, 1, {0, 1}};
        struct exh_force_ledger f = {50 * (int64_t)NEWTON, 0, 0, 0, 0, 0, 0, 0};
        const uint32_t ramp = k < 1024 ? EXH_LIMIT_RAMP : 0;
        CHECK_EQ_I64(exh_drive_force_step(&a.s, &a.cfg, &p, &f), ramp | EXH_LIMIT_FORCE);
        CHECK(f.force_N_q20 == 40 * k * (NEWTON / 1024), "share %" PRId32 ": %" PRId32, k,
            f.force_N_q20);
    }
}

/* With a closed gate, a commanded force is reported if it is not small, and only then. */
TEST(small_force_is_told)
{
    static const int32_t off_N_q20[] = {-(1 << 20), -1, 0, 1, 1 << 20};
    struct exh_permit p = {EXH_PERMIT_CLOSED, 1 << 30, NEWTON, 1, {0, 1}};
    struct axis a;
    axis_par(&a.par);
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
    for (size_t i = 0; i < LEN(off_N_q20); i++) {
        struct exh_force_ledger f = {NEWTON, 0, off_N_q20[i], 0, 0, 0, 0, 0};
        const uint32_t bits = exh_drive_force_step(&a.s, &a.cfg, &p, &f);
        CHECK_EQ_I64(bits, (i > 0 ? EXH_LIMIT_GATE : 0u) | (i > 2 ? EXH_LIMIT_FORCE : 0u));
        /* Passivity takes it away for a while: the wall is there. */
        f = (struct exh_force_ledger){NEWTON, 0, off_N_q20[i], -2 * NEWTON, 0, 0, 0, 0};
        CHECK_EQ_I64(exh_drive_force_step(&a.s, &a.cfg, &p, &f),
            i < 4 ? EXH_LIMIT_PULL | (i > 2 ? EXH_LIMIT_FORCE : 0u) : EXH_LIMIT_FORCE);
        CHECK_EQ_I64(f.force_N_q20, 0);
    }
}

/* 2000 N/s up, 4000 N/s down, 2 kHz: 1 N a tick up, 2 N down. */
TEST(slew_both_ways)
{
    struct axis a;
    struct exh_force_ledger f;
    axis_par(&a.par);
    a.par.slew_up_Nps = 2000;
    a.par.slew_down_Nps = 4000;
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
    for (int64_t n = 1; n <= 10; n++) {
        CHECK_EQ_I64(force(&a, 10 << 20, &f), n < 10 ? EXH_LIMIT_SLEW : 0);
        CHECK_EQ_I64(f.force_N_q20, n << 20);
        CHECK_EQ_I64(f.slew_N_q20, (n - 10) * NEWTON);
    }
    for (int64_t n = 1; n <= 5; n++) {
        CHECK_EQ_I64(force(&a, 0, &f), n < 5 ? EXH_LIMIT_SLEW : 0);
        CHECK_EQ_I64(f.force_N_q20, (10 - 2 * n) << 20);
    }
}

/* 1 N/s at 20 kHz is 52 LSB a tick. */
TEST(slowest_slew_still_moves)
{
    struct axis a;
    struct exh_force_ledger f;
    axis_par(&a.par);
    a.par.slew_up_Nps = 1;
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 20000}), 0);
    (void)force(&a, 1 << 20, &f);
    CHECK_EQ_I64(f.force_N_q20, 52);
}

static uint32_t current(struct axis *a, int32_t force_N_q20, struct exh_current_ledger *i)
{
    struct exh_force_ledger f = {0};
    f.force_N_q20 = force_N_q20;
    return exh_drive_current_step(&a->s, &a->cfg, &f, i);
}

static int64_t allowed_A_q26(const struct exh_current_ledger *i)
{
    return i->table_A_q26 + i->peak_A_q26 + i->i2t_A_q26;
}

/* The current of so many D/A codes, as in the set-up. */
static int64_t whole(const struct axis *a, int32_t codes)
{
    return exh_gain_floor(a->cfg.dac_A_q26, codes);
}

TEST(peak_limit)
{
    struct axis a;
    struct exh_current_ledger i = {9, 9, 9, 9, 9, 9};
    axis_par(&a.par);
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
    CHECK_EQ_I64(current(&a, EXH_Q(80, 1, EXH_Q_FORCE), &i), EXH_LIMIT_PEAK);
    CHECK_EQ_I64(i.table_A_q26, EXH_Q(8, 1, EXH_Q_CUR));
    /* 6.6 A are 12183.7 codes, and 12183 are what there is. */
    CHECK_EQ_I64(i.peak_A_q26, whole(&a, 12183) - EXH_Q(8, 1, EXH_Q_CUR));
    CHECK(i.i2t_A_q26 == 0 && i.gate_A_q26 == 0 && i.dac_A_q26 == 0, "rest of the ledger");
    CHECK_EQ_I64(i.coded_A_q26, 0);
    CHECK_EQ_I64(current(&a, EXH_Q(65995, 1000, EXH_Q_FORCE), &i), 0);
}

/* 6.6 A: untouched for at least 3/4 of 2.7 s and for less than 2.7 s; then down to
 * 3.3 A without a step; cold again after rest. Same at every rate. */
TEST(i2t_holds_folds_back_and_recovers)
{
    static const uint32_t rate[] = {10, 90, 100, 200, 500, 1000, 2000, 20000};
    for (size_t r = 0; r < LEN(rate); r++) {
        const int64_t hz = rate[r];
        struct axis a;
        struct exh_current_ledger i;
        int64_t held = 0, before, peak, cont, step_max;
        axis_par(&a.par);
        CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, rate[r]}), 0);
        before = peak = whole(&a, 12183);
        cont = whole(&a, 6091);
        step_max = 4 * (peak - cont) * 10 / (27 * hz) + whole(&a, 1) + 1024;
        for (int64_t k = 0; k < 12 * hz; k++) {
            const uint32_t limits = current(&a, EXH_Q(80, 1, EXH_Q_FORCE), &i);
            const int64_t now = allowed_A_q26(&i);
            held += now == peak;
            CHECK(now <= before + whole(&a, 1) + 1,
                "%" PRId64 " Hz tick %" PRId64 ": rises under load", hz, k);
            CHECK(before - now <= step_max, "%" PRId64 " Hz tick %" PRId64 ": step", hz, k);
            CHECK((limits & EXH_LIMIT_I2T) != 0 || now == peak, "limit bit");
            CHECK((limits & EXH_LIMIT_I2T) == 0 || a.s.i2t_q32 * 4 > 3 * a.cfg.i2t_budget_q32,
                "limit bit while cold");
            CHECK(now >= cont, "below continuous: %" PRId64, now);
            before = now;
        }
        CHECK(held * 40 >= 3 * 27 * hz, "%" PRId64 " Hz: held %" PRId64 " ticks", hz, held);
        CHECK(held * 10 < 27 * hz, "%" PRId64 " Hz: held %" PRId64 " ticks", hz, held);
        CHECK(before - cont < (peak - cont) / 200, "%" PRId64 " Hz: stays at %" PRId64, hz, before);
        for (int64_t k = 0; k < 9 * hz; k++) { (void)current(&a, 0, &i); }
        (void)current(&a, EXH_Q(80, 1, EXH_Q_FORCE), &i);
        CHECK(allowed_A_q26(&i) == peak, "%" PRId64 " Hz: not recovered", hz);
        CHECK(a.s.i2t_q32 * 3 < a.cfg.i2t_budget_q32, "%" PRId64 " Hz: still warm", hz);
    }
}

TEST(continuous_current_is_for_ever)
{
    struct axis a;
    struct exh_current_ledger i;
    axis_par(&a.par);
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 1000}), 0);
    for (int k = 0; k < 60000; k++) {
        CHECK(current(&a, EXH_Q(32995, 1000, EXH_Q_FORCE), &i) == 0, "limited at tick %d", k);
    }
    CHECK_EQ_I64(a.s.i2t_q32, 0);
}

/* Four codes an ampere: what is coded is within both limits, and its mean square within i_cont. */
TEST(coarse_codes_stay_within_the_limits)
{
    static const int32_t cont_dA[] = {12, 33, 1}, peak_dA[] = {12, 66, 66};
    static const int32_t force_dN[] = {800, 329, 121, 13};
    for (size_t c = 0; c < LEN(cont_dA); c++) {
        for (size_t f = 0; f < LEN(force_dN); f++) {
            struct axis a;
            struct exh_current_ledger i;
            int64_t square_q20 = 0, cont_q10 = cont_dA[c] * 1024 / 10;
            axis_par(&a.par);
            a.par.dac_rawpA_q16 = EXH_Q(4, 1, EXH_Q_DAC);
            a.par.i_cont_A_q26 = EXH_Q(cont_dA[c], 10, EXH_Q_CUR);
            a.par.i_peak_A_q26 = EXH_Q(peak_dA[c], 10, EXH_Q_CUR);
            CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 100}), 0);
            for (int k = 0; k < 30000; k++) {
                int64_t code;
                (void)current(&a, EXH_Q(force_dN[f], 10, EXH_Q_FORCE), &i);
                code = (allowed_A_q26(&i) * 4 + (1 << 25)) >> 26;
                CHECK(code * 10 <= 4 * peak_dA[c], "%d dA, %d dN: code %d", peak_dA[c], force_dN[f],
                    (int)code);
                square_q20 += k >= 20000 ? code * code << 16 : 0; /* the peak is over by then */
            }
            CHECK(square_q20 / 10000 <= cont_q10 * cont_q10 + (1 << 16),
                "%d dA, %d dN: mean square %d q20", cont_dA[c], force_dN[f],
                (int)(square_q20 / 10000));
        }
    }
}

/* Bursts that spend no more than 3/4 of the budget leave the peak untouched; the
 * heat of one burst is still there in the next. */
TEST(bursts_add_up)
{
    struct axis a;
    struct exh_current_ledger i;
    uint32_t limits = 0;
    axis_par(&a.par);
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 1000}), 0);
    for (int k = 0; k < 1000; k++) { limits |= current(&a, EXH_Q(66, 1, EXH_Q_FORCE), &i); }
    for (int k = 0; k < 100; k++) { limits |= current(&a, 0, &i); }
    for (int k = 0; k < 1000; k++) { limits |= current(&a, EXH_Q(66, 1, EXH_Q_FORCE), &i); }
    CHECK((limits & EXH_LIMIT_I2T) == 0, "limited within the budget");
    for (int k = 0; k < 300; k++) { limits |= current(&a, EXH_Q(66, 1, EXH_Q_FORCE), &i); }
    CHECK((limits & EXH_LIMIT_I2T) != 0, "the pause of 0.1 s gave all the budget back");
}

TEST(peak_equal_to_continuous)
{
    struct axis a;
    struct exh_current_ledger i;
    axis_par(&a.par);
    a.par.i_peak_A_q26 = a.par.i_cont_A_q26;
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 1000}), 0);
    for (int k = 0; k < 5000; k++) {
        CHECK_EQ_I64(current(&a, EXH_Q(66, 1, EXH_Q_FORCE), &i) & EXH_LIMIT_I2T, 0);
    }
}

TEST(monitor_by_hand)
{
    struct axis a;
    axis_par(&a.par);
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 2000}), 0);
    CHECK_EQ_I64(exh_drive_monitor_A_q26(&a.cfg, 0), 0);
    /* 567787804 A/code q40: 516.4 uA; 12780 codes are 6.6 A */
    CHECK_EQ_I64(exh_drive_monitor_A_q26(&a.cfg, 1), 34655);
    CHECK_EQ_I64(exh_drive_monitor_A_q26(&a.cfg, -1), -34655);
    CHECK_EQ_I64(exh_drive_monitor_A_q26(&a.cfg, 12780), 442891122);
    a.par.mon_zero_raw = 100;
    CHECK_EQ_I64(exh_drive_monitor_A_q26(&a.cfg, 100), 0);
    CHECK_EQ_I64(exh_drive_monitor_N_q20(&a.cfg, exh_drive_monitor_A_q26(&a.cfg, 100)), 0);
    CHECK_EQ_I64(exh_drive_monitor_N_q20(&a.cfg, exh_drive_monitor_A_q26(&a.cfg, INT16_MIN)),
        0); /* the string only pulls */
    CHECK_EQ_I64(exh_drive_monitor_N_q20(&a.cfg, exh_drive_monitor_A_q26(&a.cfg, 1100)), 5414846);
}

/* --- frames and state --- */

TEST(frames_round_trip)
{
    struct exh_drive_in in = {{1, 0xFFFFFF, 0x80000000u, 7, 9}, {INT16_MIN, -1, 0, 1, INT16_MAX},
        -12345, EXH_DIN_ESTOP | (EXH_DIN_DRIVE0 << 4)};
    struct exh_drive_out out = {{0, 65535, 32768, 1, 2}, 0x1F, 200};
    for (unsigned n = 0; n <= EXH_FINGERS; n++) {
        struct exh_drive_in in2 = {{0}, {0}, 0, 0};
        struct exh_drive_out out2 = {{0}, 0, 0};
        uint8_t buf[64];
        struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
        exh_drive_in_serialize(&c, &in, n);
        CHECK_EQ_I64(c.at, 6 * n + 6);
        exh_drive_out_serialize(&c, &out, n);
        CHECK_EQ_I64(c.at, 8 * n + 8);
        c = exh_bytes_reader(buf, c.at);
        exh_drive_in_serialize(&c, &in2, n);
        exh_drive_out_serialize(&c, &out2, n);
        CHECK(exh_bytes_ok(&c), "n %u", n);
        CHECK(in2.supply_raw == in.supply_raw && in2.din == in.din, "n %u", n);
        CHECK(out2.enable == out.enable && out2.alive == out.alive, "n %u", n);
        for (unsigned k = 0; k < EXH_FINGERS; k++) {
            CHECK(in2.enc_raw[k] == (k < n ? in.enc_raw[k] : 0), "n %u finger %u", n, k);
            CHECK(in2.mon_raw[k] == (k < n ? in.mon_raw[k] : 0), "n %u finger %u", n, k);
            CHECK(out2.dac_raw[k] == (k < n ? out.dac_raw[k] : 0), "n %u finger %u", n, k);
        }
    }
}

TEST(state_round_trip)
{
    struct exh_drive s = {7, 9, INT64_C(0x0123456789ABCDEF)}, back = {0, 0, 0};
    uint8_t buf[16];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_drive_serialize(&c, &s);
    CHECK_EQ_I64(c.at, 16);
    c = exh_bytes_reader(buf, c.at);
    exh_drive_serialize(&c, &back);
    CHECK(back.force_N_q20 == s.force_N_q20 && back.fall_N_q20 == 9 && back.i2t_q32 == s.i2t_q32,
        "state differs");
    memset(buf, 0xFF, sizeof buf); /* damaged: no push, and as hot as can be */
    c = exh_bytes_reader(buf, sizeof buf);
    exh_drive_serialize(&c, &back);
    CHECK(back.force_N_q20 == 0 && back.fall_N_q20 == 0 && back.i2t_q32 == INT64_MAX / 2,
        "damaged state");
}

/* Whatever the bytes: no pull but what current limits allow, and none rises while it is released.
 */
TEST(hostile_bytes_come_into_range)
{
    struct axis a;
    struct exh_permit let = {EXH_PERMIT_RELEASE, 1 << 30, 1 << 20, 1, {0, 0}};
    axis_par(&a.par);
    CHECK_EQ_I64(axis_setup(&a, (struct exh_period){1, 1000}), 0);
    CHECK_EQ_I64(exh_gain_set(&let.fall, 1, 15), 0);
    for (int k = 0; k < 20000; k++) {
        struct exh_force_ledger f = {0};
        struct exh_current_ledger i = {0};
        struct exh_drive s;
        uint8_t buf[16];
        struct exh_bytes c = exh_bytes_reader(buf, sizeof buf);
        int64_t cur_A_q26;
        int32_t last;
        for (size_t b = 0; b < sizeof buf; b++) { buf[b] = (uint8_t)(check_u64() & 255); }
        exh_drive_serialize(&c, &s);
        CHECK(s.force_N_q20 >= 0 && s.force_N_q20 <= 100 << 20, "force %" PRId32, s.force_N_q20);
        CHECK(s.fall_N_q20 >= 0 && s.fall_N_q20 <= (100 << 20) + 1, "fall %" PRId32, s.fall_N_q20);
        CHECK(s.i2t_q32 >= 0 && s.i2t_q32 <= INT64_MAX / 2, "heat %" PRId64, s.i2t_q32);
        last = s.force_N_q20;
        f.spring_N_q20 = (int32_t)check_i32_in(INT32_MIN, INT32_MAX);
        (void)exh_drive_force_step(&s, &a.cfg, &let, &f);
        (void)exh_drive_current_step(&s, &a.cfg, &f, &i);
        cur_A_q26 = i.table_A_q26 + i.peak_A_q26 + i.i2t_A_q26;
        CHECK(f.force_N_q20 >= 0 && f.force_N_q20 <= last, "released upwards");
        CHECK(cur_A_q26 >= 0 && cur_A_q26 <= a.par.i_peak_A_q26, "current %" PRId64, cur_A_q26);
    }
}

/* The heat that I2t may reach, at the highest rate, for the longest peak of the highest current. */
TEST(the_greatest_budget)
{
    struct exh_knot k[2] = {{0, 0, {0, 1}}, {1 << 20, 1 << 26, {0, 1}}};
    const int64_t peak_q16 = EXH_Q(66, 10, 26) >> 10;
    struct exh_drive_par par;
    struct exh_drive_cfg cfg;
    axis_par(&par);
    CHECK_EQ_I64(exh_table_setup(k, 2), 0);
    par.i_peak_A_q26 = EXH_Q(66, 10, 26);
    par.i_cont_A_q26 = 0;
    par.peak_ms = 2700;
    CHECK_EQ_I64(exh_drive_setup(&cfg, &par, (struct exh_period){1, 20000},
                     (struct exh_table){k, 2}, (struct exh_table){NULL, 0}),
        0);
    CHECK_EQ_I64(cfg.i2t_budget_q32, peak_q16 * peak_q16 * 54001);
    CHECK(cfg.i2t_budget_q32 < INT64_MAX / 2, "room for a tick more");
}

/* Where no peak is allowed above the lasting current nothing of an earlier set-up stays. */
TEST(no_peak_no_budget)
{
    struct exh_knot k[2] = {{0, 0, {0, 1}}, {1 << 20, 1 << 26, {0, 1}}};
    struct exh_drive_par par;
    struct exh_drive_cfg cfg;
    for (unsigned i = 0; i < EXH_DRIVE_ROWS; i++) {
        ((int32_t *)(void *)&par)[i] = exh_drive_rows[i].dflt;
    }
    CHECK_EQ_I64(exh_table_setup(k, 2), 0);
    memset(&cfg, 0x55, sizeof cfg);
    par.i_peak_A_q26 = par.i_cont_A_q26;
    CHECK_EQ_I64(exh_drive_setup(&cfg, &par, (struct exh_period){1, 1000}, (struct exh_table){k, 2},
                     (struct exh_table){NULL, 0}),
        0);
    CHECK(cfg.i2t_budget_q32 == 0 && cfg.i2t_shift == 0 && cfg.i2t_fold.mant == 0 &&
              cfg.i2t_fold.shift == 1,
        "a budget");
}

TEST_MAIN("unit/drive", setup_rejections, setup_refuses_tables_that_pull_at_no_force,
    no_force_or_current_beyond_the_persons_ceiling, no_force_beyond_the_table,
    setup_refuses_a_table_that_was_not_set, not_running_is_no_force,
    setup_takes_every_documented_period, force_limit_and_pull_only, release_is_bounded_and_ends,
    release_begins_anew, ramp_limits_the_force, ramp_is_a_share_all_the_way, small_force_is_told,
    slew_both_ways, hostile_bytes_come_into_range, slowest_slew_still_moves, peak_limit,
    i2t_holds_folds_back_and_recovers, continuous_current_is_for_ever,
    coarse_codes_stay_within_the_limits, bursts_add_up, peak_equal_to_continuous, monitor_by_hand,
    frames_round_trip, state_round_trip, no_peak_no_budget, the_greatest_budget);
