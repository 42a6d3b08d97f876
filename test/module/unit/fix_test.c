/* SPDX-License-Identifier: MIT */
/* fix.h: every primitive at its documented edges, by hand. */
#include "exhand/fix.h"

#include "exhand/error.h"

#include "check.h"
#include "wide.h"

TEST(sat32_keeps_the_sign_and_is_audited)
{
    static const struct {
        int64_t v;
        int32_t want;
        uint32_t audited;
    } row[] = {
        {0, 0, 0},
        {INT32_MAX, INT32_MAX, 0},
        {INT32_MIN, INT32_MIN, 0},
        {(int64_t)INT32_MAX + 1, INT32_MAX, 1},
        {(int64_t)INT32_MIN - 1, INT32_MIN, 1},
        {INT64_MAX, INT32_MAX, 1},
        {INT64_MIN, INT32_MIN, 1},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const uint32_t before = check_saturations;
        CHECK_EQ_I64(exh_sat32(row[i].v), row[i].want);
        CHECK(check_saturations - before == row[i].audited, "row %zu", i);
    }
}

TEST(clamp_is_a_limit_not_an_overflow)
{
    const uint32_t before = check_saturations;
    CHECK_EQ_I64(exh_clamp(INT64_MAX, -5, 7), 7);
    CHECK_EQ_I64(exh_clamp(INT64_MIN, -5, 7), -5);
    CHECK_EQ_I64(exh_clamp(-5, -5, 7), -5);
    CHECK_EQ_I64(exh_clamp(7, -5, 7), 7);
    CHECK_EQ_I64(exh_clamp(3, -5, 7), 3);
    CHECK_EQ_I64(exh_clamp(9, 4, 4), 4);
    CHECK_EQ_I64(exh_clamp(INT64_MIN, INT32_MIN, INT32_MAX), INT32_MIN);
    CHECK(check_saturations == before, "a designed limit counted as a saturation");
}

TEST(shr_round_is_half_up)
{
    static const struct {
        int64_t v;
        unsigned n;
        int64_t want;
    } row[] = {
        {1, 1, 1},
        {-1, 1, 0},
        {3, 1, 2},
        {-3, 1, -1},
        {5, 2, 1},
        {6, 2, 2},
        {-6, 2, -1},
        {-7, 2, -2},
        {INT64_MAX, 1, INT64_C(1) << 62},
        {INT64_MIN, 1, -(INT64_C(1) << 62)},
        {INT64_MAX, 63, 1},
        {INT64_MIN, 63, -1},
        {INT64_C(1) << 62, 63, 1},
        {(INT64_C(1) << 62) - 1, 63, 0},
        {-(INT64_C(1) << 62), 63, 0},
        {-(INT64_C(1) << 62) - 1, 63, -1},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        CHECK_EQ_I64(exh_shr_round(row[i].v, row[i].n), row[i].want);
    }
}

TEST(mul_shr_is_half_up)
{
    static const struct {
        int32_t a, b;
        unsigned n;
        int64_t want;
    } row[] = {
        {3, 1, 1, 2},
        {-3, 1, 1, -1},
        {INT32_MIN, INT32_MIN, 62, 1},
        {INT32_MIN, INT32_MIN, 1, INT64_C(1) << 61},
        {INT32_MIN, INT32_MAX, 62, -1},
        {INT32_MAX, INT32_MAX, 62, 1},
        {INT32_MAX, 1, 31, 1},
        {INT32_MIN, 1, 32, 0},
        {1 << 20, 1 << 20, 20, 1 << 20},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        CHECK_EQ_I64(exh_mul_shr(row[i].a, row[i].b, row[i].n), row[i].want);
    }
}

TEST(mul64_q31_at_its_ends)
{
    CHECK_EQ_I64(exh_mul64_q31(INT64_MIN, INT32_MAX), INT64_MIN + (INT64_C(1) << 32));
    CHECK_EQ_I64(exh_mul64_q31(INT64_MAX, INT32_MAX), INT64_MAX - (INT64_C(1) << 32));
    CHECK_EQ_I64(exh_mul64_q31(INT64_MAX, 0), 0);
    CHECK_EQ_I64(exh_mul64_q31(INT64_C(1) << 31, 12345), 12345);
    CHECK_EQ_I64(exh_mul64_q31(1, 1 << 30), 1);  /* 1/2, up */
    CHECK_EQ_I64(exh_mul64_q31(-1, 1 << 30), 0); /* -1/2, up */
}

TEST(from_u32_is_twos_complement)
{
    CHECK_EQ_I64(exh_from_u32(0), 0);
    CHECK_EQ_I64(exh_from_u32(0x7FFFFFFFu), INT32_MAX);
    CHECK_EQ_I64(exh_from_u32(0x80000000u), INT32_MIN);
    CHECK_EQ_I64(exh_from_u32(0xFFFFFFFFu), -1);
}

TEST(counters_wrap_both_ways)
{
    CHECK_EQ_I64(exh_wrap_diff(INT32_MIN, INT32_MAX), 1);
    CHECK_EQ_I64(exh_wrap_diff(INT32_MAX, INT32_MIN), -1);
    CHECK_EQ_I64(exh_wrap_diff(0, INT32_MIN), INT32_MIN);
    CHECK_EQ_I64(exh_wrap_diff(-5, 10), -15);
    CHECK_EQ_I64(exh_wrap_add(INT32_MAX, 1), INT32_MIN);
    CHECK_EQ_I64(exh_wrap_add(INT32_MIN, -1), INT32_MAX);
    CHECK_EQ_I64(exh_wrap_add(-7, 9), 2);
}

TEST(gain_set_at_its_ends)
{
    static const struct {
        uint64_t num, den;
        int err;
    } row[] = {
        {0, 1, 0},
        {1, 1, 0},
        {1, 0, -EXH_E_RANGE},
        {1, UINT64_C(1) << 63, -EXH_E_RANGE},
        {UINT64_MAX, (UINT64_C(1) << 63) - 1, 0},
        {INT32_MAX, 1, 0},
        {UINT64_C(1) << 31, 1, -EXH_E_RANGE},
        {1, UINT64_C(1) << 32, 0},
        {1, (UINT64_C(1) << 32) + 1, -EXH_E_RANGE},
        {UINT64_MAX, 1, -EXH_E_RANGE},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct exh_gain g = {-1, 0};
        const int err = exh_gain_set(&g, row[i].num, row[i].den);
        CHECK(err == row[i].err, "row %zu: error %d, want %d", i, err, row[i].err);
        CHECK(err != 0 || row[i].num == 0 || (g.mant >= 1 << 30 && g.shift <= 62),
            "row %zu: mantissa %" PRId32 " shift %d", i, g.mant, g.shift);
        CHECK(err != 0 || row[i].num != 0 || (g.mant == 0 && g.shift >= 1), "row %zu", i);
    }
}

/* Quotients whose mantissa rounds up to a power of two, around the largest gain. */
TEST(gain_set_at_its_upper_end)
{
    struct exh_gain g;
    CHECK(exh_gain_set(&g, (UINT64_C(1) << 62) - 1, UINT64_C(1) << 32) == 0, "2^30 - 2^-32");
    CHECK_EQ_I64(exh_gain_mul(g, 3), 3 * (INT64_C(1) << 30));
    CHECK(exh_gain_set(&g, INT32_MAX, 1) == 0, "2^31 - 1");
    CHECK_EQ_I64(exh_gain_mul(g, -2), -2 * (int64_t)INT32_MAX);
    CHECK(
        exh_gain_set(&g, (UINT64_C(1) << 32) - 1, 2) == -EXH_E_RANGE, "2^31 - 1/2 rounds to 2^31");
}

TEST(gain_mul_is_exact_for_powers_of_two)
{
    struct exh_gain g;
    CHECK_EQ_I64(exh_gain_set(&g, 1, 4), 0);
    CHECK_EQ_I64(exh_gain_mul(g, 10), 3); /* 2.5, up */
    CHECK_EQ_I64(exh_gain_mul(g, -10), -2);
    CHECK_EQ_I64(exh_gain_set(&g, 1 << 20, 1), 0);
    CHECK_EQ_I64(exh_gain_mul(g, INT32_MIN), -(INT64_C(1) << 51));
    CHECK_EQ_I64(exh_gain_set(&g, 0, 9), 0);
    CHECK_EQ_I64(exh_gain_mul(g, INT32_MAX), 0);
}

TEST(udiv64_by_hand)
{
    static const struct {
        uint64_t num, den, quot, rem;
    } row[] = {
        {0, 1, 0, 0},
        {UINT64_MAX, 1, UINT64_MAX, 0},
        {UINT64_MAX, UINT64_MAX, 1, 0},
        {UINT64_MAX - 1, UINT64_MAX, 0, UINT64_MAX - 1},
        {UINT64_MAX, (UINT64_C(1) << 63) + 1, 1, (UINT64_C(1) << 63) - 2},
        {1000000007, 10, 100000000, 7},
        {UINT64_MAX, UINT64_MAX - 1, 1, 1},
        {UINT64_C(0xFEDCBA9876543210), UINT64_C(0xC000000000000001), 1,
            UINT64_C(0x3EDCBA987654320F)},
        /* Twice the remainder needs bit 64 and is less than the divisor without it. */
        {UINT64_C(0xFFFFFFFFFFFFFFFE), UINT64_MAX, 0, UINT64_C(0xFFFFFFFFFFFFFFFE)},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        uint64_t rem = 99;
        CHECK(exh_udiv64(row[i].num, row[i].den, &rem) == row[i].quot, "row %zu", i);
        CHECK(rem == row[i].rem, "row %zu: remainder %" PRIu64, i, rem);
        CHECK(exh_udiv64(row[i].num, row[i].den, NULL) == row[i].quot, "row %zu, no rem", i);
    }
}

TEST(high_words_by_hand)
{
    CHECK_EQ_I64(exh_umul_hi(UINT32_MAX, UINT32_MAX), UINT32_MAX - 1);
    CHECK_EQ_I64(exh_umul_hi(UINT32_C(1) << 16, UINT32_C(1) << 16), 1);
    CHECK_EQ_I64(exh_umul_hi(UINT32_C(1) << 16, (UINT32_C(1) << 16) - 1), 0);
    CHECK_EQ_I64(exh_mul_hi(INT32_MIN, INT32_MIN), 1 << 30);
    CHECK_EQ_I64(exh_mul_hi(-1, 1), -1);
}

TEST_MAIN("unit/fix", sat32_keeps_the_sign_and_is_audited, clamp_is_a_limit_not_an_overflow,
    shr_round_is_half_up, mul_shr_is_half_up, mul64_q31_at_its_ends, from_u32_is_twos_complement,
    counters_wrap_both_ways, gain_set_at_its_ends, gain_set_at_its_upper_end,
    gain_mul_is_exact_for_powers_of_two, udiv64_by_hand, high_words_by_hand);
