/* SPDX-License-Identifier: MIT */
/* The oracle's own arithmetic, against the compiler's 128 bits where there are
 * any, and against identities that hold everywhere. */
#include "wide.h"

#include "check.h"

static const int64_t corner[] = {INT64_MIN, INT64_MIN + 1, -4294967296, -4294967295, -2147483648,
    -65536, -1, 0, 1, 65535, 2147483647, 4294967295, 4294967296, INT64_MAX - 1, INT64_MAX};
#define CORNERS (sizeof corner / sizeof corner[0])

TEST(known_products)
{
    static const struct {
        int64_t a, b;
        uint64_t hi, lo;
    } row[] = {
        {0, INT64_MIN, 0, 0},
        {-1, -1, 0, 1},
        {-1, 1, UINT64_MAX, UINT64_MAX},
        {INT64_MIN, INT64_MIN, UINT64_C(0x4000000000000000), 0},
        {INT64_MAX, INT64_MAX, UINT64_C(0x3FFFFFFFFFFFFFFF), 1},
        {INT64_MIN, INT64_MAX, UINT64_C(0xC000000000000000), UINT64_C(0x8000000000000000)},
        {INT64_C(1) << 40, -(INT64_C(1) << 40), UINT64_C(0xFFFFFFFFFFFF0000), 0},
    };
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        const struct wide w = wide_mul(row[i].a, row[i].b);
        CHECK(w.hi == row[i].hi && w.lo == row[i].lo, "row %zu: %016" PRIx64 " %016" PRIx64, i,
            w.hi, w.lo);
    }
}

TEST(known_shifts)
{
    static const struct {
        int64_t v;
        unsigned n;
        int64_t floor, half_up;
    } row[] = {
        {5, 1, 2, 3},
        {-5, 1, -3, -2},
        {-1, 127, -1, 0},
        {1, 127, 0, 0},
        {6, 2, 1, 2},
        {-6, 2, -2, -1},
        {INT64_MIN, 63, -1, -1},
        {INT64_MAX, 63, 0, 1},
        {INT64_MIN, 64, -1, 0},
        {INT64_MAX, 64, 0, 0},
        {-3, 65, -1, 0},
    };
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        CHECK_EQ_I64(wide_sat64(wide_shr_floor(wide_of(row[i].v), row[i].n)), row[i].floor);
        CHECK_EQ_I64(wide_sat64(wide_shr_half_up(wide_of(row[i].v), row[i].n)), row[i].half_up);
    }
}

TEST(identities_hold_everywhere)
{
    while (check_case(10)) {
        const int64_t a = check_i64(), b = check_i64(), c = check_i64() >> 2, d = check_i64() >> 2;
        const unsigned n = (unsigned)(check_u64() % 64);
        const struct wide left = wide_mul(a, wide_sat64(wide_add(wide_of(c), wide_of(d))));
        const struct wide right = wide_add(wide_mul(a, c), wide_mul(a, d));
        const struct wide up = wide_shl(wide_of(a), n);
        CHECK(wide_cmp(left, right) == 0, "a %" PRId64 " c %" PRId64 " d %" PRId64, a, c, d);
        CHECK(wide_sat64(wide_shr_floor(up, n)) == a, "a %" PRId64 " n %u", a, n);
        CHECK(wide_cmp(wide_sub(wide_of(a), wide_of(b)), wide_of(0)) == (a > b) - (a < b),
            "a %" PRId64 " b %" PRId64, a, b);
    }
}

TEST(saturates_with_the_right_sign)
{
    const struct wide big = wide_shl(wide_of(1), 100);
    CHECK_EQ_I64(wide_sat64(big), INT64_MAX);
    CHECK_EQ_I64(wide_sat64(wide_neg(big)), INT64_MIN);
    CHECK_EQ_I64(wide_sat32(wide_of(INT64_C(1) << 31)), INT32_MAX);
    CHECK_EQ_I64(wide_sat32(wide_of(-(INT64_C(1) << 31) - 1)), INT32_MIN);
    CHECK_EQ_I64(wide_sat32(wide_of(-7)), -7);
    for (size_t i = 0; i < CORNERS; i++) {
        CHECK_EQ_I64(wide_sat64(wide_of(corner[i])), corner[i]);
    }
}

#ifdef __SIZEOF_INT128__
__extension__ typedef __int128 i128;
__extension__ typedef unsigned __int128 u128;

static int same(struct wide w, i128 v)
{
    return w.hi == (uint64_t)((u128)v >> 64) && w.lo == (uint64_t)(u128)v;
}

static void against_compiler(int64_t a, int64_t b, int64_t c, unsigned n)
{
    const struct wide p = wide_mul(a, b);
    const i128 q = (i128)a * b;
    const i128 half = q >> 1; /* head room for the sums */
    const struct wide h = wide_shr_floor(p, 1);
    CHECK(same(p, q), "%" PRId64 " * %" PRId64, a, b);
    CHECK(same(h, half), "%" PRId64 " * %" PRId64 " >> 1", a, b);
    CHECK(same(wide_add(h, wide_of(c)), half + c), "%" PRId64 " * %" PRId64 " + %" PRId64, a, b, c);
    CHECK(same(wide_sub(h, wide_of(c)), half - c), "%" PRId64 " * %" PRId64 " - %" PRId64, a, b, c);
    CHECK(same(wide_shr_floor(p, n), q >> n), "%" PRId64 " * %" PRId64 " >> %u", a, b, n);
    CHECK(same(wide_shl(p, n), (i128)((u128)q << n)), "%" PRId64 " * %" PRId64 " << %u", a, b, n);
    CHECK(same(wide_abs(h), half < 0 ? -half : half), "|%" PRId64 " * %" PRId64 "|", a, b);
    if (n > 0 && n < 127) {
        CHECK(same(wide_shr_half_up(h, n), (half + ((i128)1 << (n - 1))) >> n),
            "%" PRId64 " * %" PRId64 " / 2^%u rounded", a, b, n);
    }
    CHECK(wide_cmp(p, wide_of(c)) == (q > c) - (q < c), "%" PRId64 " * %" PRId64 " ? %" PRId64, a,
        b, c);
}

TEST(agrees_with_the_compiler)
{
    for (size_t i = 0; i < CORNERS * CORNERS * 128; i++) {
        const size_t a = i / 128 / CORNERS, b = i / 128 % CORNERS;
        against_compiler(corner[a], corner[b], corner[(a + b + i) % CORNERS], (unsigned)(i % 128));
    }
    while (check_case(1)) {
        const unsigned n = (unsigned)(check_u64() % 128);
        const int64_t a = check_i64(), b = check_i64(), c = check_i64();
        against_compiler(a, b, c, n);
    }
}
#else
TEST(agrees_with_the_compiler)
{
    check_note("no 128-bit integers in this compiler: identities only");
    CHECK_EQ_I64(wide_sat64(wide_shr_floor(wide_mul(INT64_MIN, INT64_MIN), 64)), INT64_C(1) << 62);
}
#endif

TEST_MAIN("unit/wide", known_products, known_shifts, identities_hold_everywhere,
    saturates_with_the_right_sign, agrees_with_the_compiler);
