/* SPDX-License-Identifier: MIT */
/* filter_cheap.h: what is refused, coefficients, a constant input, steps, full scale, states. */
#include "exhand/filter_cheap.h"

#include "exhand/error.h"

#include "check.h"

static const struct exh_filter_cheap_cfg *tuned(int32_t fc_Hz_q16, uint32_t rate_Hz)
{
    static struct exh_filter_cheap_cfg cfg;
    const struct exh_filter_par par = {2, fc_Hz_q16};
    CHECK(exh_filter_cheap_setup(&cfg, &par, (struct exh_period){1, rate_Hz}) == 0,
        "fc %" PRId32 " rate %" PRIu32, fc_Hz_q16, rate_Hz);
    return &cfg;
}

static int32_t one(struct exh_filter_cheap *s, const struct exh_filter_cheap_cfg *cfg, int32_t x)
{
    int32_t y;
    exh_filter_cheap_step(s, cfg, &x, &y, 1);
    return y;
}

/* Both kinds, and both sides of where one ends: 68.48 of 1000, and of what becomes of a rounding's
 * rest. */
static const struct {
    uint32_t rate_Hz;
    int32_t fc_Hz_q16;
} tune[] = {
    {1000, 5 << 16},
    {2000, 5 << 16},
    {1000, 20 << 16},
    {1000, 68 << 16},
    {1000, 69 << 16},
    {1000, 100 << 16},
    {90, 20 << 16},
    {200, 50 << 16},
    {1000, 199 << 16},
    {1000, 230 << 16},
    {1000, 270 << 16},
    {1000, 301 << 16},
    {1000, 400 << 16},
    {1, 30000},
    {10000, 1 << 16},
};

TEST(refusals_by_name)
{
    static const struct {
        int32_t order, fc;
        struct exh_period T;
        int want;
    } row[] = {
        {2, 45 << 16, {1, 90}, -EXH_E_CUTOFF},
        {2, (45 << 16) - 1, {1, 90}, 0},
        {1, 20 << 16, {1, 90}, -EXH_E_RANGE},
        {0, 20 << 16, {1, 90}, -EXH_E_RANGE},
        {3, 20 << 16, {1, 90}, -EXH_E_RANGE},
        {2, 0, {1, 1000}, -EXH_E_RANGE},
        {2, -1, {1, 1000}, -EXH_E_RANGE},
        {2, 624, {1, 20000}, -EXH_E_RANGE},
        {2, 625, {1, 20000}, 0},
        {2, 65536, {0, 1000}, -EXH_E_RATE},
        {2, 65536, {1, 0}, -EXH_E_RATE},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_filter_par par = {row[i].order, row[i].fc};
        struct exh_filter_cheap_cfg cfg;
        const int rc = exh_filter_cheap_setup(&cfg, &par, row[i].T);
        CHECK(rc == row[i].want, "row %zu: %d", i, rc);
    }
}

/* Coefficients of NUMERICS.md, each from its formula in 80 digits. */
TEST(coefficients_by_hand)
{
    static const struct {
        int32_t fc_Hz_q16;
        struct exh_period T;
        struct exh_filter_cheap_cfg want;
    } row[] = {
        {65536, {1, 15}, {-1918691214, 301493237, 2054077835, 0}},
        {65536, {1, 100}, {-365176009, 57381874, 303693265, 0}},
        {65536, {1, 1000}, {-37995016, 5970341, 30359434, 0}},
        {65536, {1, 10000}, {-3814712, 599424, 3035935, 0}},
        {655, {1, 20000}, {-19072, 2997, 15170, 0}},
        {1310720, {597, 1193182}, {-365415394, 57419490, 303901601, 0}},
        {65536, {1, 14}, {740286483, 20342381, -284785095, 1}},
        {13107200, {1, 1000}, {198388500, 110902543, -105127760, 1}},
        {65536, {1, 4}, {0, 157245850, -92112488, 1}},
        {2949120, {1, 100}, {-838065198, 429814774, -344322986, 1}},
        {32767, {1, 1}, {-1073669032, 536834517, -536798124, 1}},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const struct exh_filter_cheap_cfg *w = &row[i].want;
        const struct exh_filter_par par = {2, row[i].fc_Hz_q16};
        struct exh_filter_cheap_cfg c;
        CHECK_EQ_I64(exh_filter_cheap_setup(&c, &par, row[i].T), 0);
        CHECK(c.a == w->a && c.b == w->b && c.c == w->c && c.high == w->high,
            "row %zu: %" PRId32 " %" PRId32 " %" PRId32 " %d", i, c.a, c.b, c.c, c.high);
    }
}

static int32_t settling(size_t i)
{
    const int64_t rate_q16 = (int64_t)tune[i].rate_Hz << 16;
    const int64_t left_q16 = rate_q16 / 2 - tune[i].fc_Hz_q16;
    return (int32_t)(12 * rate_q16 / tune[i].fc_Hz_q16 + 12 * rate_q16 / left_q16) + 100;
}

TEST(a_constant_input_comes_out_exactly)
{
    static const int32_t level[] = {
        795000000, 1, -1, 0, -21474836, INT32_MAX, 2104533974, INT32_MIN, 10923 << 16, 0};
    for (size_t i = 0; i < LEN(tune); i++) {
        const struct exh_filter_cheap_cfg *cfg = tuned(tune[i].fc_Hz_q16, tune[i].rate_Hz);
        struct exh_filter_cheap s;
        exh_filter_cheap_reset(&s, cfg, &level[4], 1);
        for (size_t k = 0; k < LEN(level); k++) {
            for (int32_t t = settling(i); t > 0; t--) { (void)one(&s, cfg, level[k]); }
            for (int32_t t = 0; t < 100; t++) {
                const int32_t y = one(&s, cfg, level[k]);
                CHECK(y == level[k], "tune %zu level %" PRId32 ": %" PRId32, i, level[k], y);
            }
        }
    }
}

TEST(reset_is_settled)
{
    for (size_t i = 0; i < LEN(tune); i++) {
        const struct exh_filter_cheap_cfg *cfg = tuned(tune[i].fc_Hz_q16, tune[i].rate_Hz);
        for (size_t k = 0; k < CHECK_CORNERS; k++) {
            struct exh_filter_cheap s;
            exh_filter_cheap_reset(&s, cfg, &check_corner[k], 1);
            for (int t = 0; t < 100; t++) {
                CHECK_EQ_I64(one(&s, cfg, check_corner[k]), check_corner[k]);
            }
        }
    }
}

TEST(a_step_rises_once_and_overshoots)
{
    const struct exh_filter_cheap_cfg *cfg = tuned(1 << 16, 1000);
    struct exh_filter_cheap s;
    const int32_t zero = 0, x = 1000000000;
    int32_t before = 0, peak = 0, turns = 0, rising = 1;
    exh_filter_cheap_reset(&s, cfg, &zero, 1);
    for (int t = 0; t < 20000; t++) {
        const int32_t y = one(&s, cfg, x);
        if (rising ? y < before : y > before) {
            rising = !rising;
            turns++;
        }
        peak = y > peak ? y : peak;
        before = y;
    }
    CHECK(peak > 1043100000 && peak < 1043300000, "peak %" PRId32, peak);
    CHECK(turns == 6, "%" PRId32 " turns", turns);
}

/* Squares between both rails: the output is at the rail before the input leaves it, and on its way
 * never turns from one to the other against the input. */
TEST(full_scale_does_not_latch)
{
    for (size_t i = 0; i < LEN(tune); i++) {
        const struct exh_filter_cheap_cfg *cfg = tuned(tune[i].fc_Hz_q16, tune[i].rate_Hz);
        struct exh_filter_cheap s;
        const int32_t zero = 0;
        int32_t y = 0;
        exh_filter_cheap_reset(&s, cfg, &zero, 1);
        for (int half = 0; half < 6; half++) {
            const int32_t x = half & 1 ? INT32_MIN : INT32_MAX;
            for (int32_t t = settling(i); t > 0; t--) {
                const int32_t was = y;
                y = one(&s, cfg, x);
                CHECK(!(x > 0 && was > 1000000000 && y < 0), "tune %zu wraps", i);
                CHECK(!(x < 0 && was < -1000000000 && y > 0), "tune %zu wraps", i);
            }
            CHECK(y == x, "tune %zu: %" PRId32 " at %" PRId32, i, y, x);
        }
    }
}

TEST(a_rail_is_the_end_of_a_move)
{
    const struct exh_filter_cheap_cfg *cfg = tuned(20 << 16, 1000);
    for (int sign = -1; sign <= 1; sign += 2) {
        const int64_t full = INT64_C(1) << 32;
        const int32_t rail = sign < 0 ? INT32_MIN : INT32_MAX, near = rail - 5 * sign;
        struct exh_filter_cheap s = {near * full, sign * (full << 24), near, near};
        CHECK_EQ_I64(one(&s, cfg, s.in1), rail);
        CHECK_EQ_I64(s.vel, 0);
        CHECK_EQ_I64(s.pos, (int64_t)rail * full + full / 2);
    }
}

TEST(channels_do_not_touch)
{
    for (size_t i = 3; i < 5; i++) { /* a kind each */
        const struct exh_filter_cheap_cfg *cfg = tuned(tune[i].fc_Hz_q16, tune[i].rate_Hz);
        struct exh_filter_cheap many[22], alone[22];
        int32_t x[22], y[22];
        for (int k = 0; k < 22; k++) { x[k] = check_i32(); }
        exh_filter_cheap_reset(many, cfg, x, 22);
        memcpy(alone, many, sizeof many);
        for (int t = 0; t < 300; t++) {
            for (int k = 0; k < 22; k++) { x[k] = check_i32(); }
            exh_filter_cheap_step(many, cfg, x, y, 22);
            for (int k = 0; k < 22; k++) { CHECK_EQ_I64(one(&alone[k], cfg, x[k]), y[k]); }
            exh_filter_cheap_step(many, cfg, x, x, 22); /* in place */
            memcpy(alone, many, sizeof many);
        }
    }
}

TEST(state_round_trip)
{
    struct exh_filter_cheap s = {INT64_C(-0x123456789ABCDEF), INT64_C(0x7EDCBA9876543210),
                                INT32_MIN, 0x1234567},
                            back = {0, 0, 0, 0};
    uint8_t buf[32];
    struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
    exh_filter_cheap_serialize(&c, &s);
    CHECK_EQ_I64(c.at, 24);
    c = exh_bytes_reader(buf, c.at);
    exh_filter_cheap_serialize(&c, &back);
    CHECK(exh_bytes_ok(&c) && back.pos == s.pos && back.vel == s.vel && back.in1 == s.in1 &&
              back.in2 == s.in2,
        "state differs");
}

/* Whatever is restored: no undefined step, and the input again in the end. */
TEST(recovers_from_any_state)
{
    for (size_t i = 0; i < LEN(tune); i++) {
        const struct exh_filter_cheap_cfg *cfg = tuned(tune[i].fc_Hz_q16, tune[i].rate_Hz);
        for (int k = 0; k < 20; k++) {
            struct exh_filter_cheap s;
            const int32_t x = check_i32();
            int32_t y = 0;
            s.pos = k < 4 ? (k & 1 ? INT64_MIN : INT64_MAX) : check_i64();
            s.vel = k < 4 ? (k & 2 ? INT64_MIN : INT64_MAX) : check_i64();
            s.in1 = check_i32();
            s.in2 = check_i32();
            for (int32_t t = 2 * settling(i); t > 0; t--) { y = one(&s, cfg, x); }
            CHECK(y == x, "tune %zu: %" PRId32 " at %" PRId32, i, y, x);
        }
    }
}

/* Coefficients of damaged memory: wrong, and no more. */
TEST(any_coefficients_are_defined)
{
    struct exh_filter_cheap s = {0, 0, 0, 0};
    for (int k = 0; k < 20000; k++) {
        const struct exh_filter_cheap_cfg cfg = {check_i32(), check_i32(), check_i32(), k & 1};
        (void)one(&s, &cfg, check_i32());
    }
    CHECK(1, "came here");
}

TEST_MAIN("unit/filter_cheap", refusals_by_name, coefficients_by_hand,
    a_constant_input_comes_out_exactly, reset_is_settled, a_step_rises_once_and_overshoots,
    full_scale_does_not_latch, a_rail_is_the_end_of_a_move, channels_do_not_touch, state_round_trip,
    recovers_from_any_state, any_coefficients_are_defined);
