/* SPDX-License-Identifier: MIT */
/* angle.h: every angle within its bound of a series in wider integers, and the series
 * within its own bound of what defines sine and cosine. */
#include "exhand/angle.h"

#include "exhand/fix.h"

#include "check.h"
#include "turn.h"
#include "wide.h"

#define ONE_Q30 (INT64_C(1) << 30)
#define Q60     60u

/* Of angle.h, 2.25 LSB of q30. */
#define BOUND_Q60 (INT64_C(9) << (60 - 30 - 2))

/* --- the oracle --- */

/* |a*b + c*d - want| <= 2^-54, all q60 but the sum of products, which is q120. */
static int sum_is(int64_t a, int64_t b, int64_t c, int64_t d, int64_t want)
{
    const struct wide sum = wide_add(wide_mul(a, b), wide_mul(c, d));
    return wide_within(wide_sub(sum, wide_shl(wide_of(want), Q60)), wide_shl(wide_of(1), 66));
}

/* On the circle, angles add up, and near 0 the sine is the angle: that is sine and cosine. */
TEST(oracle_is_sine_and_cosine)
{
    const struct turn least = turn_of(1), none = turn_of(0);
    const int64_t lsb_q60 = (int64_t)((uint64_t)TURN_PI_Q60 + (1u << 30)) >> 31;
    CHECK(least.sin_q60 - lsb_q60 <= 1 && lsb_q60 - least.sin_q60 <= 1, "smallest angle");
    CHECK(none.sin_q60 == 0 && none.cos_q60 == INT64_C(1) << 60, "no angle");
    while (check_case(20)) {
        const int32_t x = check_i32_in(INT32_MIN / 2, INT32_MAX / 2);
        const int32_t y = check_i32_in(INT32_MIN / 2, INT32_MAX / 2);
        const struct turn a = turn_of(x), b = turn_of(y), sum = turn_of(x + y);
        CHECK(sum_is(a.sin_q60, a.sin_q60, a.cos_q60, a.cos_q60, INT64_C(1) << 60),
            "circle at %" PRId32, x);
        CHECK(sum_is(a.sin_q60, b.cos_q60, a.cos_q60, b.sin_q60, sum.sin_q60),
            "sine of %" PRId32 " + %" PRId32, x, y);
        CHECK(sum_is(a.cos_q60, b.cos_q60, -a.sin_q60, b.sin_q60, sum.cos_q60),
            "cosine of %" PRId32 " + %" PRId32, x, y);
    }
}

/* --- the library --- */

static int near_q60(int32_t got_q30, int64_t want_q60)
{
    const int64_t off = (int64_t)got_q30 * ONE_Q30 - want_q60;
    return off <= BOUND_Q60 && off >= -BOUND_Q60;
}

static void angle_case(int32_t x)
{
    const struct turn want = turn_of(x);
    struct exh_sincos y;
    exh_sincos(x, &y);
    CHECK(near_q60(y.sin_q30, want.sin_q60) && near_q60(y.cos_q30, want.cos_q60),
        "%" PRId32 ": sine %" PRId32 ", cosine %" PRId32, x, y.sin_q30, y.cos_q30);
    CHECK(y.sin_q30 <= ONE_Q30 && y.sin_q30 >= -ONE_Q30 && y.cos_q30 <= ONE_Q30 &&
              y.cos_q30 >= -ONE_Q30,
        "%" PRId32 ": beyond 1", x);
}

/* 2^20 angles, one in each 4096, and both sides of every eighth of the turn. */
TEST(every_angle_is_within_its_bound)
{
    for (uint32_t i = 0; i < UINT32_C(1) << 20; i++) {
        const uint32_t within = i * UINT32_C(2654435769) >> 20;
        angle_case(exh_from_u32(i << 12 | within));
    }
    for (uint32_t eighth = 0; eighth < 8; eighth++) {
        for (uint32_t i = 0; i < 2048; i++) { angle_case(exh_from_u32((eighth << 29) + i - 1024)); }
    }
    while (check_case(1)) { angle_case(check_i32()); }
}

/* What lets one eighth of the turn speak for all: reflections and quarter turns are exact. */
TEST(symmetries_are_exact)
{
    while (check_case(1)) {
        const uint32_t x = (uint32_t)check_i32();
        struct exh_sincos y, minus, quarter;
        exh_sincos(exh_from_u32(x), &y);
        exh_sincos(exh_from_u32(0u - x), &minus);
        exh_sincos(exh_from_u32(x + (1u << 30)), &quarter);
        CHECK(minus.sin_q30 == -y.sin_q30 && minus.cos_q30 == y.cos_q30, "-%" PRIu32, x);
        CHECK(quarter.sin_q30 == y.cos_q30 && quarter.cos_q30 == -y.sin_q30,
            "%" PRIu32 " and a quarter", x);
    }
}

TEST_MAIN(
    "prop/angle", oracle_is_sine_and_cosine, every_angle_is_within_its_bound, symmetries_are_exact);
