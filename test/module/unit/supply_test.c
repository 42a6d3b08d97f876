/* SPDX-License-Identifier: MIT */
/* supply.h: which codes are within the limits, for how long others may come. */
#include "exhand/supply.h"

#include "exhand/error.h"

#include "check.h"

#define V(n)    EXH_Q(n, 1, EXH_Q_SUPPLY)
#define QUARTER EXH_Q(4 * 10, 32768, EXH_Q_VPRAW) /* through 1:4: 24 V are 19660.8 codes */

static const struct exh_supply_par par = {V(20), V(28), QUARTER, 10};
static const struct exh_period kHz = {1, 1000};

static int16_t code(int32_t mV) { return (int16_t)(mV * INT64_C(32768) / 40000); }

TEST(limits_become_codes)
{
    struct exh_supply_cfg cfg;
    CHECK_EQ_I64(exh_supply_setup(&cfg, &par, kHz), 0);
    CHECK_EQ_I64(cfg.min_raw, 16384); /* 20 V exactly */
    CHECK_EQ_I64(cfg.max_raw, 22937); /* 28 V are 22937.6 */
    CHECK_EQ_I64(cfg.ticks, 11);
}

/* Each code of the converter, against the exact voltage. */
TEST(a_code_is_within_the_limits_exactly_when_its_voltage_is)
{
    static const struct exh_supply_par row[] = {{V(20), V(28), QUARTER, 1},
        {1, V(100), EXH_Q(1, 100, EXH_Q_VPRAW), 1}, {V(20), V(20), QUARTER, 1},
        {V(12) + 1, V(12) + 2000, 1000000, 1}, {V(1), V(9), 327680, 1},
        {V(24) - 7, V(24) + 999, 1234567, 1}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_supply_cfg cfg;
        CHECK_EQ_I64(exh_supply_setup(&cfg, &row[i], (struct exh_period){1, 1}), 0);
        for (int32_t raw = INT16_MIN; raw <= INT16_MAX; raw++) {
            struct exh_supply s = {0};
            const int64_t V_q30 = (int64_t)raw * row[i].scale_V_q30;
            const int out = V_q30 < (int64_t)row[i].min_V_q20 * 1024 ||
                            V_q30 > (int64_t)row[i].max_V_q20 * 1024;
            CHECK(exh_supply_step(&s, &cfg, (int16_t)raw, 0) == out, "row %zu, code %ld", i,
                (long)raw);
        }
    }
}

TEST(it_is_told_after_its_time_and_not_before)
{
    static const struct {
        struct exh_period T;
        int32_t ms;
        uint32_t ticks;
    } row[] = {{{1, 1}, 10, 1}, {{1, 90}, 10, 1}, {{1, 90}, 100, 10}, {{1, 1000}, 10, 11},
        {{1, 2000}, 10, 21}, {{1, 20000}, 10, 201}, {{1, 20000}, 1000, 20001},
        {{597, 1193182}, 10, 20}};
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_supply_par p = {V(20), V(28), QUARTER, row[i].ms};
        struct exh_supply_cfg cfg;
        struct exh_supply s = {0};
        CHECK_EQ_I64(exh_supply_setup(&cfg, &p, row[i].T), 0);
        CHECK(cfg.ticks == row[i].ticks, "row %zu: %" PRIu32, i, cfg.ticks);
        for (int again = 0; again < 2; again++) {
            for (uint32_t n = 1; n <= row[i].ticks + 3; n++) {
                const int told = exh_supply_step(&s, &cfg, code(again ? 30000 : 18000), 0);
                CHECK(told == (n >= row[i].ticks), "row %zu, tick %" PRIu32, i, n);
            }
            CHECK(exh_supply_step(&s, &cfg, code(24000), 0) == 0, "row %zu: gone", i);
        }
    }
}

/* A dip that is shorter is none, however often it comes. */
TEST(one_tick_within_the_limits_begins_anew)
{
    struct exh_supply_cfg cfg;
    struct exh_supply s = {0};
    CHECK_EQ_I64(exh_supply_setup(&cfg, &par, kHz), 0);
    for (int n = 0; n < 200; n++) {
        const int16_t raw = code(n % 11 == 10 ? 20001 : 5000);
        CHECK(exh_supply_step(&s, &cfg, raw, 0) == 0, "tick %d", n);
    }
}

TEST(missed_ticks_count)
{
    static const struct {
        uint32_t missed;
        int told;
    } row[] = {{0, 0}, {8, 0}, {9, 1}, {10, 1}, {11, 1}, {UINT32_MAX, 1}};
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_supply_cfg cfg;
        struct exh_supply s = {0};
        CHECK_EQ_I64(exh_supply_setup(&cfg, &par, kHz), 0);
        CHECK_EQ_I64(exh_supply_step(&s, &cfg, 0, 0), 0);
        CHECK(exh_supply_step(&s, &cfg, 0, row[i].missed) == row[i].told, "row %zu", i);
        CHECK(s.off_ticks <= cfg.ticks, "row %zu: %" PRIu32, i, s.off_ticks);
    }
}

TEST(without_a_least_voltage_nothing_is_judged)
{
    const struct exh_supply_par off = {0, V(30), QUARTER, 1};
    struct exh_supply_cfg cfg;
    struct exh_supply s = {0};
    CHECK_EQ_I64(exh_supply_setup(&cfg, &off, kHz), 0);
    for (int32_t raw = INT16_MIN; raw <= INT16_MAX; raw += 17) {
        CHECK(exh_supply_step(&s, &cfg, (int16_t)raw, 0) == 0, "code %ld", (long)raw);
    }
}

TEST(what_cannot_be_judged_is_refused)
{
    static const struct exh_supply_par bad[] = {{-1, V(28), QUARTER, 10},
        {V(100) + 1, V(100) + 1, QUARTER, 10}, {V(28), V(20), QUARTER, 10},
        {V(20), V(101), QUARTER, 10}, {V(20), V(28), 0, 10}, {V(20), V(28), -1, 10},
        {V(20), V(28), QUARTER, 0}, {V(20), V(28), QUARTER, 1001},
        {V(20), V(40), QUARTER, 10},                            /* the converter ends there */
        {V(20), V(20) + 100, EXH_Q(1, 1, EXH_Q_VPRAW) / 3, 10}, /* no code between them */
        {V(20), INT32_MIN, QUARTER, 10}};
    struct exh_supply_cfg cfg;
    for (size_t i = 0; i < LEN(bad); i++) {
        CHECK(exh_supply_setup(&cfg, &bad[i], kHz) == -EXH_E_RANGE, "%zu", i);
    }
    CHECK_EQ_I64(exh_supply_setup(&cfg, &par, (struct exh_period){0, 1}), -EXH_E_RATE);
}

TEST(its_rows_are_its_parameters)
{
    struct exh_supply_par p;
    struct exh_supply_cfg cfg;
    int32_t *at = (int32_t *)&p;
    CHECK_EQ_I64(sizeof p, EXH_SUPPLY_ROWS * sizeof(int32_t));
    for (unsigned i = 0; i < EXH_SUPPLY_ROWS; i++) {
        CHECK(exh_supply_rows[i].min <= exh_supply_rows[i].dflt &&
                  exh_supply_rows[i].dflt <= exh_supply_rows[i].max,
            "row %u", i);
        at[i] = exh_supply_rows[i].dflt;
    }
    CHECK_EQ_I64(exh_supply_setup(&cfg, &p, kHz), 0);
    p.min_V_q20 = V(20);
    CHECK_EQ_I64(exh_supply_setup(&cfg, &p, kHz), 0);
    CHECK(cfg.min_raw <= code(24000) && cfg.max_raw >= code(24000), "24 V are refused");
}

TEST(its_state_goes_through_a_cursor)
{
    uint8_t byte[4];
    struct exh_supply s = {0x01020304}, back = {0};
    struct exh_supply_cfg cfg;
    struct exh_bytes c = exh_bytes_writer(byte, sizeof byte);
    exh_supply_serialize(&c, &s);
    CHECK(exh_bytes_ok(&c) && c.at == 4, "written");
    c = exh_bytes_reader(byte, sizeof byte);
    exh_supply_serialize(&c, &back);
    CHECK_EQ_I64(back.off_ticks, s.off_ticks);
    CHECK_EQ_I64(exh_supply_setup(&cfg, &par, kHz), 0);
    CHECK_EQ_I64(exh_supply_step(&back, &cfg, 0, 0), 1); /* more than there can be */
    CHECK_EQ_I64(exh_supply_step(&back, &cfg, code(24000), 0), 0);
}

/* After a refused set-up nothing is judged. A damaged count is still reported, and does not
 * wrap. */
TEST(what_comes_of_refusals_and_damage)
{
    const struct exh_supply_par none = {V(20), V(19), QUARTER, 10};
    struct exh_supply_cfg cfg;
    struct exh_supply s = {0};
    CHECK_EQ_I64(exh_supply_setup(&cfg, &none, kHz), -EXH_E_RANGE);
    CHECK_EQ_I64(exh_supply_step(&s, &cfg, INT16_MIN, 0), 0);
    CHECK_EQ_I64(exh_supply_step(&s, &cfg, INT16_MAX, 0), 0);
    CHECK_EQ_I64(exh_supply_setup(&cfg, &par, kHz), 0);
    s.off_ticks = UINT32_MAX;
    CHECK_EQ_I64(exh_supply_step(&s, &cfg, 0, 0), 1);
    CHECK_EQ_I64(exh_supply_step(&s, &cfg, 0, 5), 1);
    CHECK_EQ_I64(exh_supply_step(&s, &cfg, code(24000), 0), 0);
}

/* 100 V is the highest limit, of both; 1/64 V a code. */
TEST(the_highest_limits)
{
    const struct exh_supply_par most = {V(100), V(100), INT32_C(1) << (EXH_Q_VPRAW - 6), 10};
    const struct exh_supply_par more = {
        V(100) + 1, V(100) + 1, INT32_C(1) << (EXH_Q_VPRAW - 6), 10};
    struct exh_supply_cfg cfg;
    CHECK_EQ_I64(exh_supply_setup(&cfg, &most, kHz), 0);
    CHECK(cfg.min_raw == 6400 && cfg.max_raw == 6400, "%d .. %d", cfg.min_raw, cfg.max_raw);
    CHECK_EQ_I64(exh_supply_setup(&cfg, &more, kHz), -EXH_E_RANGE);
}

TEST_MAIN("supply", limits_become_codes, a_code_is_within_the_limits_exactly_when_its_voltage_is,
    it_is_told_after_its_time_and_not_before, one_tick_within_the_limits_begins_anew,
    missed_ticks_count, without_a_least_voltage_nothing_is_judged, what_cannot_be_judged_is_refused,
    its_rows_are_its_parameters, its_state_goes_through_a_cursor, what_comes_of_refusals_and_damage,
    the_highest_limits);
