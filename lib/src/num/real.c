/* SPDX-License-Identifier: MIT */
/* Positive real numbers for set-ups, in integers. */
#include "real.h"

#include "exhand/error.h"

#define TOP (UINT64_C(1) << 62)

/* v * 2^e normalised to 63 bits. */
static struct exh_real norm(uint64_t v, int32_t e)
{
    struct exh_real r = {v, e};
    if (v == 0) {
        r.e = 0;
        return r;
    }
    while (r.m < TOP) {
        r.m <<= 1;
        r.e--;
    }
    if (r.m >> 63) {
        r.m >>= 1;
        r.e++;
    }
    return r;
}

struct exh_real exh_real_of(uint64_t v) { return norm(v, 0); }

struct exh_real exh_real_mul(struct exh_real a, struct exh_real b)
{
    const uint64_t ah = a.m >> 32, al = a.m & UINT32_MAX;
    const uint64_t bh = b.m >> 32, bl = b.m & UINT32_MAX;
    const uint64_t mid = ah * bl + (al * bl >> 32); /* below 2^63 + 2^32 */
    const uint64_t mid2 = al * bh + (mid & UINT32_MAX);
    return norm(ah * bh + (mid >> 32) + (mid2 >> 32), a.e + b.e + 64);
}

struct exh_real exh_real_div(struct exh_real a, struct exh_real b)
{
    uint64_t quot = 0;
    uint64_t rem = a.m;
    EXH_ASSERT(b.m != 0);
    for (int i = 0; i < 64; i++) { /* rem < 2 b: one bit per step */
        quot <<= 1;
        if (rem >= b.m) {
            rem -= b.m;
            quot |= 1;
        }
        rem <<= 1;
    }
    return norm(quot, a.e - b.e - 63);
}

struct exh_real exh_real_add(struct exh_real a, struct exh_real b)
{
    const int first = a.m != 0 && (b.m == 0 || a.e >= b.e);
    const struct exh_real big = first ? a : b, small = first ? b : a;
    const int32_t n = big.e - small.e;
    return norm(big.m + (small.m == 0 || n > 62 ? 0 : small.m >> n), big.e);
}

struct exh_real exh_real_sub(struct exh_real a, struct exh_real b)
{
    const int32_t n = a.e - b.e;
    return norm(a.m - (b.m == 0 || n > 62 ? 0 : b.m >> n), a.e);
}

uint64_t exh_real_round(struct exh_real a)
{
    if (a.m == 0 || a.e < -63) { return 0; }
    EXH_ASSERT(a.e < 0);
    return (a.m >> (-a.e - 1) >> 1) + (a.m >> (-a.e - 1) & 1);
}

/* Lambert's continued fraction, x/(1 - x^2/(3 - x^2/(5 - ...))). Eleven levels leave an error below
 * 2^-60 at x = pi/4. */
static struct exh_real tangent(struct exh_real x)
{
    const struct exh_real sq = exh_real_mul(x, x);
    struct exh_real t = exh_real_of(23);
    for (uint64_t k = 21; k < 22; k -= 2) { t = exh_real_sub(exh_real_of(k), exh_real_div(sq, t)); }
    return exh_real_div(x, t);
}

struct exh_real exh_real_tan_pi(uint64_t num, uint64_t den)
{
    const int steep = num > den / 4; /* beyond an eighth turn: the cotangent of the rest */
    const struct exh_real part =
        steep ? exh_real_div(exh_real_of(den - 2 * num), exh_real_of(2 * den))
              : exh_real_div(exh_real_of(num), exh_real_of(den));
    const struct exh_real t = tangent(exh_real_mul(EXH_REAL_PI, part));
    return steep ? exh_real_div(exh_real_of(1), t) : t;
}
