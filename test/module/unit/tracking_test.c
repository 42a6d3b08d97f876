/* SPDX-License-Identifier: MIT */
/* tracking.h: the ranges, when it reports a fault, and when not. */
#include "exhand/tracking.h"

#include "exhand/error.h"

#include "check.h"

#define TOL    EXH_Q(1, 4, EXH_Q_CUR)
#define AMPERE EXH_Q(1, 1, EXH_Q_CUR)

static const struct exh_tracking_par par = {TOL, 20};

static struct exh_tracking_cfg config(uint32_t rate_Hz)
{
    struct exh_tracking_cfg cfg = {0, 0};
    CHECK_EQ_I64(exh_tracking_setup(&cfg, &par, (struct exh_period){1, rate_Hz}), 0);
    return cfg;
}

/* A tick: what is monitored, then what is coded. */
static int tick(
    struct exh_tracking *s, const struct exh_tracking_cfg *cfg, int32_t mon, int32_t coded)
{
    const int astray = exh_tracking_step(s, cfg, mon);
    exh_tracking_update(s, coded);
    return astray;
}

TEST(ticks_are_the_time_and_four_more)
{
    static const struct {
        struct exh_period T;
        int32_t ms;
        uint32_t ticks;
    } row[] = {{{1, 1}, 20, 5}, {{1, 1}, 100, 5}, {{1, 90}, 20, 6}, {{1, 1000}, 20, 25},
        {{1, 2000}, 20, 45}, {{1, 20000}, 20, 405}, {{1, 20000}, 100, 2005},
        {{597, 1193182}, 20, 44}, {{1, 1000}, 1, 6}};
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_tracking_par p = {TOL, row[i].ms};
        struct exh_tracking_cfg cfg = {0, 0};
        CHECK_EQ_I64(exh_tracking_setup(&cfg, &p, row[i].T), 0);
        CHECK(cfg.ticks == row[i].ticks && cfg.tol_A_q26 == TOL, "row %zu: %" PRIu32, i, cfg.ticks);
    }
}

/* Neither can be set so that it is off. */
TEST(what_is_outside_its_range_is_refused)
{
    static const struct exh_tracking_par bad[] = {{0, 20}, {EXH_Q(1, 10, EXH_Q_CUR) - 1, 20},
        {AMPERE + 1, 20}, {INT32_MAX, 20}, {-1, 20}, {TOL, 0}, {TOL, 101}, {TOL, INT32_MAX},
        {TOL, INT32_MIN}};
    static const struct exh_tracking_par good[] = {
        {EXH_Q(1, 10, EXH_Q_CUR), 1}, {AMPERE, 100}, {TOL, 20}};
    struct exh_tracking_cfg cfg;
    for (size_t i = 0; i < LEN(bad); i++) {
        CHECK(exh_tracking_setup(&cfg, &bad[i], (struct exh_period){1, 1000}) == -EXH_E_RANGE,
            "%zu", i);
    }
    for (size_t i = 0; i < LEN(good); i++) {
        CHECK(exh_tracking_setup(&cfg, &good[i], (struct exh_period){1, 1000}) == 0, "%zu", i);
        CHECK(exh_tracking_setup(&cfg, &good[i], (struct exh_period){0, 1}) == -EXH_E_RATE &&
                  exh_tracking_setup(&cfg, &good[i], (struct exh_period){1, 30000}) == -EXH_E_RATE,
            "%zu", i);
    }
    CHECK(exh_tracking_rows[0].min == good[0].tol_A_q26 && exh_tracking_rows[0].max == AMPERE &&
              exh_tracking_rows[0].dflt == TOL && exh_tracking_rows[1].min == 1 &&
              exh_tracking_rows[1].max == 100 && exh_tracking_rows[1].dflt == 20,
        "the rows are not the ranges");
}

/* The D/A is stuck at 1 A and the command goes to 2 A: detected after so many ticks, not before. */
TEST(a_current_that_stands_is_told_in_time)
{
    static const uint32_t rate[] = {1, 90, 1000, 2000, 20000};
    for (size_t i = 0; i < LEN(rate); i++) {
        const struct exh_tracking_cfg cfg = config(rate[i]);
        struct exh_tracking s = {0, 0, 0};
        CHECK_EQ_I64(tick(&s, &cfg, 0, AMPERE), 0);
        CHECK_EQ_I64(tick(&s, &cfg, AMPERE, 2 * AMPERE), 0);
        for (uint32_t n = 1; n <= cfg.ticks + 5; n++) {
            CHECK(tick(&s, &cfg, AMPERE, 2 * AMPERE) == (n >= cfg.ticks),
                "%" PRIu32 " Hz, tick %" PRIu32, rate[i], n);
        }
        CHECK_EQ_I64(s.off_ticks, cfg.ticks);
        CHECK_EQ_I64(tick(&s, &cfg, 2 * AMPERE, 0), 0); /* the fault ends with its cause */
        CHECK(s.lo_A_q26 == 0 && s.hi_A_q26 == 0 && s.off_ticks == 0, "the band begins anew");
    }
}

/* Also a current without a command, outside RUN; and one below the command. */
TEST(both_ways_and_at_rest)
{
    static const int32_t mon[] = {AMPERE, -AMPERE, TOL + 1, -TOL - 1, INT32_MAX, INT32_MIN};
    const struct exh_tracking_cfg cfg = config(1000);
    for (size_t i = 0; i < LEN(mon); i++) {
        struct exh_tracking s = {0, 0, 0};
        for (uint32_t n = 1; n <= cfg.ticks; n++) {
            CHECK(tick(&s, &cfg, mon[i], 0) == (n == cfg.ticks), "%zu, tick %" PRIu32, i, n);
        }
    }
}

TEST(the_tolerance_is_met_to_the_last_bit)
{
    const struct exh_tracking_cfg cfg = config(1000);
    for (int32_t base = -AMPERE; base <= AMPERE; base += AMPERE) {
        struct exh_tracking s = {base, base, 0};
        CHECK(exh_tracking_step(&s, &cfg, base + TOL) == 0 && s.off_ticks == 0, "above");
        CHECK(exh_tracking_step(&s, &cfg, base - TOL) == 0 && s.off_ticks == 0, "below");
        (void)exh_tracking_step(&s, &cfg, base + TOL + 1);
        (void)exh_tracking_step(&s, &cfg, base - TOL - 1);
        CHECK_EQ_I64(s.off_ticks, 2);
    }
    for (int end = 0; end < 2; end++) { /* no overflow */
        const int32_t at = end ? INT32_MAX : INT32_MIN;
        struct exh_tracking s = {at, at, 0};
        (void)exh_tracking_step(&s, &cfg, at);
        CHECK_EQ_I64(s.off_ticks, 0);
        (void)exh_tracking_step(&s, &cfg, end ? INT32_MIN : INT32_MAX);
        CHECK_EQ_I64(s.off_ticks, 1);
    }
}

/* Full steps to and fro, seen d ticks late: reported if d is more than the ticks, and only then. */
TEST(late_by_so_many_ticks_follows)
{
    const struct exh_tracking_cfg cfg = config(1000);
    for (uint32_t d = 1; d <= cfg.ticks + 3; d++) {
        struct exh_tracking s = {0, 0, 0};
        int32_t coded[400];
        int told = 0;
        for (uint32_t n = 0; n < LEN(coded); n++) {
            coded[n] = n / 70 % 2 ? 6 * AMPERE : 0;
            told |= tick(&s, &cfg, n < d ? 0 : coded[n - d], coded[n]);
        }
        CHECK(told == (d > cfg.ticks), "%" PRIu32 " ticks late: %d", d, told);
    }
}

/* Without exh_tracking_update() no measured current follows. */
TEST(forgetting_the_code_is_a_fault)
{
    const struct exh_tracking_cfg cfg = config(1000);
    struct exh_tracking s = {0, 0, 0};
    int told = 0;
    for (uint32_t n = 0; n < cfg.ticks; n++) { told = exh_tracking_step(&s, &cfg, AMPERE); }
    CHECK_EQ_I64(told, 1);
}

TEST(state_through_bytes)
{
    const struct exh_tracking_cfg cfg = config(1000);
    const struct exh_tracking was = {-5, 0x01020304, 7};
    struct exh_tracking s = was, back = {0, 0, 0};
    uint8_t b[12];
    struct exh_bytes c = exh_bytes_writer(b, sizeof b);
    exh_tracking_serialize(&c, &s);
    CHECK(c.at == sizeof b && b[0] == 0xFB && b[4] == 4 && b[8] == 7, "%" PRIu32 " bytes",
        (uint32_t)c.at);
    c = exh_bytes_reader(b, sizeof b);
    exh_tracking_serialize(&c, &back);
    CHECK(back.lo_A_q26 == was.lo_A_q26 && back.hi_A_q26 == was.hi_A_q26 &&
              back.off_ticks == was.off_ticks,
        "not the same");
    back = (struct exh_tracking){AMPERE, -AMPERE, UINT32_MAX}; /* damaged: reported in this tick */
    CHECK_EQ_I64(tick(&back, &cfg, 2 * AMPERE, AMPERE), 1);
    CHECK_EQ_I64(tick(&back, &cfg, AMPERE, AMPERE), 0);
}

TEST_MAIN("unit/tracking", ticks_are_the_time_and_four_more, what_is_outside_its_range_is_refused,
    a_current_that_stands_is_told_in_time, both_ways_and_at_rest,
    the_tolerance_is_met_to_the_last_bit, late_by_so_many_ticks_follows,
    forgetting_the_code_is_a_fault, state_through_bytes);
