/* SPDX-License-Identifier: MIT */
/* The positive reals of set-ups (lib/src/num/real.h): where they end. What they come to is in
 * unit/filter and golden. */
#include "../../../lib/src/num/real.h"

#include "check.h"
#include "wide.h"

static int same(struct exh_real a, uint64_t m, int32_t e) { return a.m == m && a.e == e; }

static int64_t rounded(struct exh_real a) { return (int64_t)exh_real_round(a); }

#define TOP (UINT64_C(1) << 62)

TEST(none_is_none)
{
    const struct exh_real none = exh_real_of(0), one = exh_real_of(1);
    CHECK(same(none, 0, 0), "0 * 2^0");
    CHECK(same(one, TOP, -62), "1");
    CHECK(same(exh_real_scale(none, 7), 0, 0), "0 * 2^7");
    CHECK(same(exh_real_mul(none, one), 0, 0), "0 * 1");
    CHECK(same(exh_real_div(none, one), 0, 0), "0 / 1");
    CHECK(same(exh_real_add(none, none), 0, 0), "0 + 0");
    CHECK(same(exh_real_add(one, none), TOP, -62), "1 + 0");
    CHECK(same(exh_real_add(none, one), TOP, -62), "0 + 1");
    CHECK(same(exh_real_sub(one, none), TOP, -62), "1 - 0");
    CHECK(same(exh_real_sub(one, one), 0, 0), "1 - 1");
    CHECK_EQ_I64(rounded(none), 0);
}

/* With 0 the exponents say nothing of which is larger. */
TEST(none_and_very_small)
{
    const struct exh_real none = exh_real_of(0), small = exh_real_scale(exh_real_of(3), -200);
    CHECK(same(exh_real_add(none, small), small.m, small.e), "0 + 3/2^200");
    CHECK(same(exh_real_add(small, none), small.m, small.e), "3/2^200 + 0");
    CHECK(same(exh_real_sub(small, none), small.m, small.e), "3/2^200 - 0");
}

TEST(what_is_too_small_to_matter)
{
    for (int32_t n = 60; n < 70; n++) {
        const struct exh_real one = exh_real_of(1), small = exh_real_scale(one, -n);
        const uint64_t left = n <= 62 ? UINT64_C(1) << (62 - n) : 0;
        CHECK(same(exh_real_add(one, small), TOP + left, -62), "1 + 2^-%" PRId32, n);
        CHECK(same(exh_real_add(small, one), TOP + left, -62), "2^-%" PRId32 " + 1", n);
        CHECK(same(exh_real_sub(one, small), left ? 2 * (TOP - left) : TOP, left ? -63 : -62),
            "1 - 2^-%" PRId32, n);
    }
}

TEST(sums_in_either_order)
{
    const struct exh_real a = exh_real_of(5), b = exh_real_of(7000000);
    const struct exh_real c = exh_real_of(7000005);
    CHECK(same(exh_real_add(a, b), c.m, c.e), "5 + 7000000");
    CHECK(same(exh_real_add(b, a), c.m, c.e), "7000000 + 5");
    CHECK(same(exh_real_sub(c, b), a.m, a.e), "7000005 - 7000000");
    CHECK(same(exh_real_of(UINT64_MAX), UINT64_C(0x7FFFFFFFFFFFFFFF), 1), "63 bits of 64");
}

TEST(rounds_half_up_once)
{
    CHECK_EQ_I64(rounded(exh_real_scale(exh_real_of(1), -1)), 1);
    CHECK_EQ_I64(rounded(exh_real_scale(exh_real_of(3), -1)), 2);
    CHECK_EQ_I64(rounded(exh_real_scale(exh_real_of(3), -3)), 0);
    CHECK_EQ_I64(rounded(exh_real_scale(exh_real_of(1), -2)), 0);
    CHECK_EQ_I64(rounded(exh_real_scale(exh_real_of(1), -300)), 0);
    CHECK_EQ_I64(rounded(exh_real_scale(exh_real_of(1), 61)), INT64_C(1) << 61);
}

/* The upper half of the product, to its last bit. */
TEST(products_are_exact_in_64_bits)
{
    for (uint32_t i = 0; i < 1000; i++) {
        const struct exh_real a = {
            TOP | (UINT64_C(0x9E3779B97F4A7C15) * (i + 1) >> 2), (int32_t)i - 500};
        const struct exh_real b = {
            TOP | (i == 0 ? TOP - 1 : UINT64_C(0xD1342543DE82EF95) * (i + 7) >> 2), 3};
        uint64_t m = wide_mulu(a.m, b.m).hi;
        int32_t e = a.e + b.e + 64;
        for (; m < TOP; m <<= 1) { e--; }
        CHECK(same(exh_real_mul(a, b), m, e), "case %" PRIu32, i);
        CHECK(same(exh_real_mul(b, a), m, e), "case %" PRIu32 ", turned", i);
    }
}

/* Quotients that come out even do, and the others are the last below. */
TEST(quotients_to_the_last_bit)
{
    for (uint64_t i = 1; i < 200; i++) {
        for (uint64_t k = 1; k < 200; k++) {
            const struct exh_real a = exh_real_of(i), b = exh_real_of(k),
                                  q = exh_real_div(exh_real_of(i * k), b);
            CHECK(same(q, a.m, a.e), "%" PRIu64 " times %" PRIu64, i, k);
        }
    }
    CHECK(same(exh_real_div(exh_real_of(1), exh_real_of(3)), UINT64_C(0x5555555555555555), -64),
        "1/3");
    CHECK(same(exh_real_div(exh_real_of(2), exh_real_of(3)), UINT64_C(0x5555555555555555), -63),
        "2/3");
}

/* Of 80 digits, beside a flat and a right angle too: within 2^-56. */
TEST(tangents_near_both_ends)
{
    static const struct {
        uint64_t num, den, m;
        int32_t e;
    } row[] = {
        {1, UINT64_C(1) << 40, UINT64_C(0x6487ED5110B4611A), -101},
        {1, UINT64_C(1) << 30, UINT64_C(0x6487ED5110B4612F), -91},
        {1, 8, UINT64_C(0x6A09E667F3BCC909), -64},
        {1, 5, UINT64_C(0x5CFF587677D50B85), -63},
        {1, 3, UINT64_C(0x6ED9EBA16132A9CF), -62},
        {3, 8, UINT64_C(0x4D413CCCFE779921), -61},
        {(UINT64_C(1) << 29) - 1, UINT64_C(1) << 30, UINT64_C(0x517CC1B727220A84), -34},
        {(UINT64_C(1) << 45) - 1, UINT64_C(1) << 46, UINT64_C(0x517CC1B727220A95), -18},
    };
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        const struct exh_real t = exh_real_tan_pi(row[i].num, row[i].den);
        const uint64_t off = t.m > row[i].m ? t.m - row[i].m : row[i].m - t.m;
        CHECK(t.e == row[i].e && off < 64, "row %zu: off by %" PRIu64, i, off);
    }
}

TEST_MAIN("unit/real", none_is_none, none_and_very_small, what_is_too_small_to_matter,
    sums_in_either_order, rounds_half_up_once, products_are_exact_in_64_bits,
    quotients_to_the_last_bit, tangents_near_both_ends);
