/* SPDX-License-Identifier: MIT */
/* fix.h against exact 128-bit arithmetic: all corners of all arguments, then
 * random ones. */
#include "exhand/fix.h"

#include "exhand/error.h"

#include "check.h"
#include "wide.h"

/* A shift within lo..hi, both ends favoured. */
static unsigned shift_in(unsigned lo, unsigned hi)
{
    return (unsigned)check_i32_in((int32_t)lo, (int32_t)hi);
}

static uint64_t u64_mix(void)
{
    const uint64_t u = (uint64_t)check_i64(), how = check_u64();
    return u >> (how % 2 * (how >> 8) % 64);
}

/* --- saturation --- */

static void sat32_case(int64_t v)
{
    const uint32_t before = check_saturations;
    const int32_t got = exh_sat32(v);
    const int fits = v >= INT32_MIN && v <= INT32_MAX;
    CHECK(got == wide_sat32(wide_of(v)), "%" PRId64 ": %" PRId32, v, got);
    CHECK(check_saturations - before == !fits, "%" PRId64 ": audit", v);
}

TEST(sat32_limits_and_reports)
{
    for (size_t i = 0; i < CHECK_CORNERS * CHECK_CORNERS; i++) {
        const int64_t a = check_corner[i / CHECK_CORNERS], b = check_corner[i % CHECK_CORNERS];
        sat32_case(a + b);
        sat32_case(a - b);
        sat32_case(a * b);
    }
    while (check_case(1)) { sat32_case(check_i64()); }
}

TEST(clamp_is_the_median)
{
    while (check_case(1)) {
        const int64_t u = check_i64(), v = u >> (check_u64() % 2 * 32);
        const int32_t a = check_i32(), b = check_i32();
        const int32_t lo = a < b ? a : b, hi = a < b ? b : a;
        const int32_t got = exh_clamp(v, lo, hi);
        CHECK(got >= lo && got <= hi, "%" PRId64 ": %" PRId32, v, got);
        CHECK(got == v || (got == lo && v < lo) || (got == hi && v > hi), "%" PRId64 ": %" PRId32,
            v, got);
    }
}

/* --- rounding --- */

static void shr_case(int64_t v, unsigned n)
{
    const int64_t want = wide_sat64(wide_shr_half_up(wide_of(v), n));
    CHECK(exh_shr_round(v, n) == want, "%" PRId64 " >> %u: %" PRId64 ", want %" PRId64, v, n,
        exh_shr_round(v, n), want);
}

TEST(shr_round_is_exact)
{
    static const int64_t corner[] = {INT64_MIN, INT64_MIN + 1, INT32_MIN, -65536, -1, 0, 1, 65535,
        INT32_MAX, INT64_MAX - 1, INT64_MAX};
    for (size_t i = 0; i < sizeof corner / sizeof corner[0]; i++) {
        for (unsigned n = 1; n <= 63; n++) { shr_case(corner[i], n); }
    }
    while (check_case(1)) {
        const int64_t v = check_i64();
        shr_case(v, shift_in(1, 63));
    }
}

static void mul_case(int32_t a, int32_t b, unsigned n)
{
    const int64_t want = wide_sat64(wide_shr_half_up(wide_mul(a, b), n));
    CHECK(exh_mul_shr(a, b, n) == want, "%" PRId32 " * %" PRId32 " >> %u: %" PRId64, a, b, n,
        exh_mul_shr(a, b, n));
}

TEST(mul_shr_is_exact)
{
    for (size_t i = 0; i < CHECK_CORNERS * CHECK_CORNERS; i++) {
        for (unsigned n = 1; n <= 62; n++) {
            mul_case(check_corner[i / CHECK_CORNERS], check_corner[i % CHECK_CORNERS], n);
        }
    }
    while (check_case(1)) {
        const int32_t a = check_i32(), b = check_i32();
        mul_case(a, b, shift_in(1, 62));
    }
}

TEST(mul64_q31_is_exact)
{
    while (check_case(1)) {
        const int64_t a = check_i64();
        const int32_t b = check_i32_in(0, INT32_MAX);
        const int64_t want = wide_sat64(wide_shr_half_up(wide_mul(a, b), 31));
        CHECK(exh_mul64_q31(a, b) == want, "%" PRId64 " * %" PRId32 ": %" PRId64, a, b,
            exh_mul64_q31(a, b));
    }
}

/* --- the one place that wraps --- */

static void wrap_case(int32_t a, int32_t b)
{
    const int64_t turn = INT64_C(1) << 32;
    const int64_t d = exh_wrap_diff(a, b), s = exh_wrap_add(a, b);
    const int64_t miss_d = (int64_t)a - b - d, miss_s = (int64_t)a + b - s;
    CHECK(miss_d == 0 || miss_d == turn || miss_d == -turn, "%" PRId32 " - %" PRId32, a, b);
    CHECK(miss_s == 0 || miss_s == turn || miss_s == -turn, "%" PRId32 " + %" PRId32, a, b);
    CHECK(exh_wrap_add(b, (int32_t)d) == a, "%" PRId32 " - %" PRId32 " + it", a, b);
}

TEST(counters_wrap_modulo_2_32)
{
    for (size_t i = 0; i < CHECK_CORNERS * CHECK_CORNERS; i++) {
        wrap_case(check_corner[i / CHECK_CORNERS], check_corner[i % CHECK_CORNERS]);
    }
    while (check_case(1)) {
        const int32_t a = check_i32();
        wrap_case(a, check_i32());
    }
}

/* --- set-up arithmetic --- */

TEST(udiv64_is_exact)
{
    while (check_case(4)) {
        const uint64_t num = u64_mix(), bit = check_u64() % 2 * 31, den = u64_mix() | 1u << bit;
        uint64_t rem;
        const uint64_t quot = exh_udiv64(num, den, &rem);
        const struct wide rest = {0, rem}, whole = {0, num};
        CHECK(rem < den, "%" PRIu64 " / %" PRIu64, num, den);
        CHECK(wide_cmp(wide_add(wide_mulu(quot, den), rest), whole) == 0,
            "%" PRIu64 " / %" PRIu64 " = %" PRIu64 " rest %" PRIu64, num, den, quot, rem);
    }
}

/* |mant/2^shift - num/den| <= num/den * 2^-31, that is
 * |mant*den - num*2^shift| * 2^31 <= num * 2^shift; the terms stay below 2^126. */
static void gain_case(uint64_t num, uint64_t den)
{
    struct exh_gain g;
    const int err = exh_gain_set(&g, num, den);
    const struct wide n = {0, num}, d = {0, den};
    /* rounds to 2^31 or more: 2 num >= (2^32 - 1) den */
    const int too_big =
        den != 0 && !(den >> 63) && wide_cmp(wide_shl(n, 1), wide_sub(wide_shl(d, 32), d)) >= 0;
    const int too_small = num != 0 && den != 0 && wide_cmp(wide_shl(n, 32), d) < 0;
    const int bad = den == 0 || den >> 63 || too_big || too_small;
    CHECK((err != 0) == bad, "%" PRIu64 " / %" PRIu64 ": error %d", num, den, err);
    CHECK(err == 0 || err == -EXH_E_RANGE, "error %d", err);
    if (err == 0 && num != 0) {
        const struct wide exact = wide_shl(n, g.shift);
        const struct wide off = wide_sub(wide_mulu((uint64_t)g.mant, den), exact);
        CHECK(g.mant >= 1 << 30 && g.shift <= 62, "%" PRIu64 " / %" PRIu64 ": %" PRId32 " >> %d",
            num, den, g.mant, g.shift);
        CHECK(wide_cmp(wide_abs(off), wide_shr_floor(exact, 31)) <= 0,
            "%" PRIu64 " / %" PRIu64 ": %" PRId32 " >> %d", num, den, g.mant, g.shift);
    }
}

TEST(gain_error_is_bounded)
{
    while (check_case(4)) {
        const uint64_t num = u64_mix();
        gain_case(num, u64_mix());
    }
    while (check_case(4)) { /* quotients that are in range more often than not */
        const uint64_t how = check_u64();
        const uint64_t den = 1 + (check_u64() >> (1 + how % 40));
        const uint64_t num = check_u64() >> (how >> 8) % 40;
        gain_case(num, den);
    }
}

TEST(gain_mul_is_rounded_once)
{
    while (check_case(1)) {
        const struct exh_gain g = {check_i32_in(1 << 30, INT32_MAX), (uint8_t)shift_in(0, 62)};
        const int32_t x = check_i32();
        const int64_t want = wide_sat64(wide_shr_half_up(wide_mul(x, g.mant), g.shift));
        CHECK(exh_gain_mul(g, x) == want, "%" PRId32 " * %" PRId32 " >> %d", x, g.mant, g.shift);
    }
}

TEST_MAIN("prop/fix", sat32_limits_and_reports, clamp_is_the_median, shr_round_is_exact,
    mul_shr_is_exact, mul64_q31_is_exact, counters_wrap_modulo_2_32, udiv64_is_exact,
    gain_error_is_bounded, gain_mul_is_rounded_once);
