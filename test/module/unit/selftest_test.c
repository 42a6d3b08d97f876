/* SPDX-License-Identifier: MIT */
/* The known answers of guard.h's self-test: each wrong answer alone is reported, by its group.
 * lib/src/safe/selftest.c is compiled once more with macros that spoil the functions. */
#include "exhand/angle.h"
#include "exhand/bytes.h"
#include "exhand/filter.h"
#include "exhand/fix.h"
#include "exhand/integrity.h"

#include "check.h"

static int calls, wrong; /* how many results there were, which of them is spoiled */

static int64_t spoiled(int64_t v) { return v + (++calls == wrong); }

static int64_t bad_shr_round(int64_t v, unsigned n) { return spoiled(exh_shr_round(v, n)); }

static int32_t bad_sat32(int64_t v)
{
    return v > 0 ? (int32_t)-spoiled(-(int64_t)exh_sat32(v)) : (int32_t)spoiled(exh_sat32(v));
}

static int32_t bad_clamp(int64_t v, int32_t lo, int32_t hi)
{
    return (int32_t)spoiled(exh_clamp(v, lo, hi));
}

static int32_t bad_wrap_diff(int32_t now, int32_t before)
{
    return (int32_t)spoiled(exh_wrap_diff(now, before));
}

static int64_t bad_mul_shr(int32_t x, int32_t y, unsigned n)
{
    return spoiled(exh_mul_shr(x, y, n));
}

static int32_t bad_mul_hi(int32_t x, int32_t y) { return (int32_t)spoiled(exh_mul_hi(x, y)); }

static int64_t bad_mul64_q31(int64_t x, int32_t y) { return spoiled(exh_mul64_q31(x, y)); }

static uint64_t bad_udiv64(uint64_t n, uint64_t d, uint64_t *rem)
{
    const uint64_t quot = exh_udiv64(n, d, rem);
    *rem += ++calls == wrong;
    return (uint64_t)spoiled((int64_t)quot);
}

static int bad_gain_set(struct exh_gain *g, uint64_t n, uint64_t d)
{
    const int err = exh_gain_set(g, n, d);
    g->mant += ++calls == wrong;
    g->shift = (uint8_t)(g->shift + (++calls == wrong));
    return (int)spoiled(err);
}

static int64_t bad_gain_mul(struct exh_gain g, int32_t x) { return spoiled(exh_gain_mul(g, x)); }

static int64_t bad_gain_floor(struct exh_gain g, int32_t x)
{
    return spoiled(exh_gain_floor(g, x));
}

static uint32_t bad_crc32(uint32_t crc, const void *p, size_t n)
{
    return (uint32_t)spoiled(exh_crc32(crc, p, n));
}

static void bad_sincos(int32_t angle_turn_q32, struct exh_sincos *y)
{
    exh_sincos(angle_turn_q32, y);
    y->sin_q30 = (int32_t)spoiled(y->sin_q30);
    y->cos_q30 = (int32_t)spoiled(y->cos_q30);
}

static int bad_filter_setup(
    struct exh_filter_cfg *cfg, const struct exh_filter_par *par, struct exh_period T)
{
    return (int)(exh_filter_setup(cfg, par, T) - (++calls == wrong));
}

static void bad_filter_step(struct exh_filter *s, const struct exh_filter_cfg *cfg,
    const int32_t *x, int32_t *y, unsigned n)
{
    exh_filter_step(s, cfg, x, y, n);
    *y = (int32_t)spoiled(*y);
}

int bad_selftest(void);
int bad_selftest_glove(void);

#define exh_shr_round      bad_shr_round
#define exh_sat32          bad_sat32
#define exh_clamp          bad_clamp
#define exh_wrap_diff      bad_wrap_diff
#define exh_mul_shr        bad_mul_shr
#define exh_mul_hi         bad_mul_hi
#define exh_mul64_q31      bad_mul64_q31
#define exh_udiv64         bad_udiv64
#define exh_gain_set       bad_gain_set
#define exh_gain_mul       bad_gain_mul
#define exh_gain_floor     bad_gain_floor
#define exh_crc32          bad_crc32
#define exh_sincos(a, y)   bad_sincos(a, y)
#define exh_filter_setup   bad_filter_setup
#define exh_filter_step    bad_filter_step
#define exh_selftest       bad_selftest
#define exh_selftest_glove bad_selftest_glove
#define INPUT              static volatile
#include "../../../lib/src/safe/selftest.c"

/* Results in the order in which they are looked at: up to each of these they are its group's. */
#define SHIFTS    6
#define PRODUCTS  (SHIFTS + 3)
#define DIVISIONS (PRODUCTS + 7)
#define CRCS      (DIVISIONS + 1)
#define SINES     (CRCS + 2)
#define FILTERS   (SINES + 9)

static int group_of(int k)
{
    return k <= SHIFTS      ? EXH_SELFTEST_SHIFT
           : k <= PRODUCTS  ? EXH_SELFTEST_PRODUCT
           : k <= DIVISIONS ? EXH_SELFTEST_DIVISION
           : k <= CRCS      ? EXH_SELFTEST_CRC
           : k <= SINES     ? EXH_SELFTEST_SINE
           : k <= FILTERS   ? EXH_SELFTEST_FILTER
                            : EXH_SELFTEST_OK;
}

TEST(every_wrong_answer_is_told)
{
    for (wrong = 0; wrong <= FILTERS + 1; wrong++) {
        const int want = wrong == 0 ? EXH_SELFTEST_OK : group_of(wrong);
        int got;
        calls = 0;
        got = bad_selftest();
        CHECK(got == (wrong <= CRCS ? want : EXH_SELFTEST_OK), "answer %d: %d", wrong, got);
        calls = 0;
        got = bad_selftest_glove();
        CHECK(got == want, "glove, answer %d: %d, want %d", wrong, got, want);
    }
    CHECK_EQ_I64(calls, FILTERS);
}

/* A CPU whose shift of a negative number is none: not an answer of a function. */
TEST(a_shift_that_brings_zeros_is_told)
{
    const int64_t was = odd;
    odd = INT64_C(0x123456789ABCDEF);
    wrong = calls = 0;
    CHECK_EQ_I64(bad_selftest(), EXH_SELFTEST_SHIFT);
    CHECK_EQ_I64(calls, 0);
    odd = was;
    CHECK_EQ_I64(bad_selftest(), EXH_SELFTEST_OK);
}

TEST_MAIN("unit/selftest", every_wrong_answer_is_told, a_shift_that_brings_zeros_is_told);
