/* SPDX-License-Identifier: MIT */
/* Fixed-point arithmetic: every operation that can lose a bit or saturate.
 *
 * The name of a value contains its format: x_m_q30 is x in metres times 2^30. Storage has 32 bits,
 * intermediate results have 64. Each result is rounded once (half up) and saturated once, at the
 * end. docs/NUMERICS.md lists the formats, units.h defines their constants. */
#ifndef EXHAND_FIX_H
#define EXHAND_FIX_H

#include "exhand/error.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Audit: a test build counts every saturation. Other builds compile the hook to nothing. */
#ifdef EXH_FIX_AUDIT
void exh_fix_saturated(const char *file, int line);
#define EXH_SATURATED() exh_fix_saturated(__FILE__, __LINE__)
#else
#define EXH_SATURATED() ((void)0)
#endif

/* C99 leaves >> of a negative number to the compiler. This library needs the floor. */
EXH_STATIC_ASSERT(needs_arithmetic_shift, ((-3) >> 1) == -2);

/* int may have 16 bits. Larger constants and products get a type: INT32_C(1) << 30, or a cast. */

/* The value of a 32-bit pattern read as two's complement. Portable: uses arithmetic alone. */
static inline int32_t exh_from_u32(uint32_t u)
{
    return u <= INT32_MAX ? (int32_t)u : -(int32_t)(UINT32_MAX - u) - 1;
}

/* v saturated to int32_t. The sign never changes. */
static inline int32_t exh_sat32(int64_t v)
{
    if (v > INT32_MAX) {
        EXH_SATURATED();
        return INT32_MAX;
    }
    if (v < INT32_MIN) {
        EXH_SATURATED();
        return INT32_MIN;
    }
    return (int32_t)v;
}

/* v limited to lo .. hi; requires lo <= hi. The audit does not count these limits. */
static inline int32_t exh_clamp(int64_t v, int32_t lo, int32_t hi)
{
    return v < lo ? lo : v > hi ? hi : (int32_t)v;
}

/* exh_clamp() for 32-bit values. A small CPU needs a third of the work. */
static inline int32_t exh_clamp32(int32_t v, int32_t lo, int32_t hi)
{
    return v < lo ? lo : v > hi ? hi : v;
}

/* v limited to -most .. most; requires most >= 0. */
static inline int64_t exh_clamp64(int64_t v, int64_t most)
{
    return v > most ? most : v < -most ? -most : v;
}

/* 1 if lo <= v <= hi. */
static inline int exh_inside(int32_t v, int32_t lo, int32_t hi) { return v >= lo && v <= hi; }

/* floor(v / 2^n + 1/2), 1 <= n <= 63; exact for every v. */
static inline int64_t exh_shr_round(int64_t v, unsigned n)
{
    return (v >> n) + ((v >> (n - 1)) & 1);
}

/* a*b / 2^n rounded half up, 1 <= n <= 62; exact for every a and b. */
static inline int64_t exh_mul_shr(int32_t a, int32_t b, unsigned n)
{
    return ((int64_t)a * b + (INT64_C(1) << (n - 1))) >> n;
}

/* The high word of a product: floor(a*b / 2^32). This is the cheapest product. */
static inline int32_t exh_mul_hi(int32_t a, int32_t b) { return (int32_t)((int64_t)a * b >> 32); }
static inline uint32_t exh_umul_hi(uint32_t a, uint32_t b)
{
    return (uint32_t)((uint64_t)a * b >> 32);
}

/* a*b / 2^31 rounded half up, b >= 0; exact for every a. */
static inline int64_t exh_mul64_q31(int64_t a, int32_t b)
{
    const int64_t hi = (a >> 32) * b;
    const int64_t lo = (int64_t)(uint32_t)((uint64_t)a & UINT32_MAX) * b;
    return 2 * hi + ((lo + (INT64_C(1) << 30)) >> 31);
}

/* The value of a 64-bit pattern read as two's complement. */
static inline int64_t exh_from_u64(uint64_t u)
{
    return u <= INT64_MAX ? (int64_t)u : -(int64_t)(UINT64_MAX - u) - 1;
}

/* now - before, modulo 2^32: the distance of two readings of a 32-bit counter that wraps. */
static inline int32_t exh_wrap_diff(int32_t now, int32_t before)
{
    return exh_from_u32((uint32_t)now - (uint32_t)before);
}

/* a + b modulo 2^32. For counters only. */
static inline int32_t exh_wrap_add(int32_t a, int32_t b)
{
    return exh_from_u32((uint32_t)a + (uint32_t)b);
}

/* a - b saturated to int32_t. Branch-free: with a conditional, gcc widens the products that follow
 * to 64 bits. */
static inline int32_t exh_diff_sat32(int32_t a, int32_t b)
{
    const int32_t d = exh_wrap_diff(a, b);
    const int32_t over = ((a ^ b) & (a ^ d)) >> 31;
    if (over) { EXH_SATURATED(); }
    return (d & ~over) | ((INT32_MAX ^ a >> 31) & over);
}

/* a + b modulo 2^64. For sums that only damaged values can bring out of 64 bits. */
static inline int64_t exh_wrap_add64(int64_t a, int64_t b)
{
    return exh_from_u64((uint64_t)a + (uint64_t)b);
}

/* a - b modulo 2^64. For differences that only damaged values can bring out of 64 bits. */
static inline int64_t exh_wrap_diff64(int64_t a, int64_t b)
{
    return exh_from_u64((uint64_t)a - (uint64_t)b);
}

/* A positive factor mant * 2^-shift with 31 significant bits. Set-up divides once and stores the
 * quotient here; the tick only multiplies. */
struct exh_gain {
    int32_t mant;  /* 2^30 .. 2^31-1, or 0 */
    uint8_t shift; /* 0 .. 62 */
};

/* x times the gain, rounded half up. The gain has a relative error of at most 2^-31, the result
 * half an LSB more. The product never overflows 64 bits; the caller saturates it. The mask on the
 * shift keeps a damaged gain defined: the result is wrong, the program is not. */
static inline int64_t exh_gain_mul(struct exh_gain g, int32_t x)
{
    const int64_t v = (int64_t)x * g.mant;
    /* Shifts 2v, so that rounding needs one variable 64-bit shift instead of two. Corrupt gains
     * wrap. */
    return exh_wrap_add64(exh_wrap_add64(v, v) >> (g.shift & 63u), 1) >> 1;
}

/* x times the gain, rounded down. */
static inline int64_t exh_gain_floor(struct exh_gain g, int32_t x)
{
    return (int64_t)x * g.mant >> (g.shift & 63u);
}

/* 1/x without a division, for x within 1/8 .. 8; argument and result are q24. The error is at most
 * 2^-25 + 2^-28/x. Method: three Newton steps y += y (1 - m y), started on the straight line
 * nearest to 1/m within 1/2 .. 1. The steps use z = y - 1 < 1: 32-bit products suffice. */
static inline int32_t exh_recip_q24(int32_t x)
{
    int32_t m_q31 = x * 8; /* normalised to 2^30 .. 2^31-1 */
    int32_t z_q30;
    int64_t rest_q61; /* 1 - m */
    unsigned shift = 3;
    for (unsigned n = 4; n > 0; n >>= 1) {
        const unsigned up = m_q31 >> (31 - n) ? 0 : n;
        m_q31 <<= up;
        shift += up;
    }
    rest_q61 = (INT64_C(1) << 61) - (int64_t)m_q31 * (INT32_C(1) << 30);
    z_q30 = 1957999797 - (int32_t)((int64_t)m_q31 * 2021161080 >> 31);
    for (int i = 0; i < 3; i++) {
        const int32_t off_q30 = (int32_t)((rest_q61 - (int64_t)m_q31 * z_q30) >> 31);
        z_q30 += off_q30 + (int32_t)((int64_t)z_q30 * off_q30 >> 30);
    }
    return ((((INT32_C(1) << 30) + z_q30) >> (12 - shift)) + 1) >> 1;
}

/* Sets *g to num/den and returns 0. Returns -EXH_E_RANGE if den is 0 or >= 2^63, or if the quotient
 * is above 0 and below 2^-32 or rounds to 2^31 or more. Set-up only: a long division.
 *
 *   struct exh_gain g;
 *   int err = exh_gain_set(&g, 1, 3);
 *   int32_t third = exh_sat32(exh_gain_mul(g, x)); */
int exh_gain_set(struct exh_gain *g, uint64_t num, uint64_t den);

/* floor(num/den) without the compiler's division helpers; requires den > 0. Stores the remainder in
 * *rem unless rem is NULL. Set-up only: 64 steps. */
uint64_t exh_udiv64(uint64_t num, uint64_t den, uint64_t *rem);

/* 1 if the period T is within 50 us .. 1 s, else 0. The limits allow the 1000 ppm by which a timer
 * may miss the period. Every set-up, the loop and a replay check T with this function. */
int exh_period_ok(struct exh_period T);

/* The number of whole ticks in ms >= 0; requires exh_period_ok(T). Set-up only. Holds a day. */
uint32_t exh_ticks_in(int32_t ms, struct exh_period T);

#ifdef __cplusplus
}
#endif
#endif
