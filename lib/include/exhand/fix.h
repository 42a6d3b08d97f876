/* SPDX-License-Identifier: MIT */
/* Fixed-point arithmetic: everything that can lose a bit or clip, in one place.
 *
 * Formats are written into names: x_m_q30 is x in metres times 2^30. 32-bit
 * storage, 64-bit inside, one rounding (half up) and one saturation, at the end.
 * docs/NUMERICS.md owns the table of formats, units.h its constants.
 */
#ifndef EXHAND_FIX_H
#define EXHAND_FIX_H

#include "exhand/error.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Audit: a test build counts every saturation; elsewhere the hook is nothing. */
#ifdef EXH_FIX_AUDIT
void exh_fix_saturated(const char *file, int line);
#define EXH_SATURATED() exh_fix_saturated(__FILE__, __LINE__)
#else
#define EXH_SATURATED() ((void)0)
#endif

/* C99 leaves >> of a negative number to the compiler; we need the floor. */
EXH_STATIC_ASSERT(needs_arithmetic_shift, ((-3) >> 1) == -2);

/* int may have 16 bits: a constant or product that needs more says so (INT32_C(1) << 30, one factor
 * cast). */

/* The value of a 32-bit pattern read as two's complement, by arithmetic alone. */
static inline int32_t exh_from_u32(uint32_t u)
{
    return u <= INT32_MAX ? (int32_t)u : -(int32_t)(UINT32_MAX - u) - 1;
}

/* v limited to int32_t; the sign is always kept. */
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

/* v limited to lo..hi, lo <= hi. A limit that acts by design: not audited. */
static inline int32_t exh_clamp(int64_t v, int32_t lo, int32_t hi)
{
    return v < lo ? lo : v > hi ? hi : (int32_t)v;
}

/* The same of 32 bits, in which a small CPU needs a third of the work. */
static inline int32_t exh_clamp32(int32_t v, int32_t lo, int32_t hi)
{
    return v < lo ? lo : v > hi ? hi : v;
}

/* v limited to -most .. most of 64 bits, most >= 0. */
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

/* The high word of a product, floor(a*b / 2^32): the cheapest product there is. */
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

/* The value of a 64-bit pattern likewise. */
static inline int64_t exh_from_u64(uint64_t u)
{
    return u <= INT64_MAX ? (int64_t)u : -(int64_t)(UINT64_MAX - u) - 1;
}

/* now - before across any wrap of a 32-bit counter: the one place that wraps. */
static inline int32_t exh_wrap_diff(int32_t now, int32_t before)
{
    return exh_from_u32((uint32_t)now - (uint32_t)before);
}

/* a + b modulo 2^32, for counters only. */
static inline int32_t exh_wrap_add(int32_t a, int32_t b)
{
    return exh_from_u32((uint32_t)a + (uint32_t)b);
}

/* a - b limited to int32_t. Branch-free: with a conditional, gcc widens the products that follow to
 * 64 bits. */
static inline int32_t exh_diff_sat32(int32_t a, int32_t b)
{
    const int32_t d = exh_wrap_diff(a, b);
    const int32_t over = ((a ^ b) & (a ^ d)) >> 31;
    if (over) { EXH_SATURATED(); }
    return (d & ~over) | ((INT32_MAX ^ a >> 31) & over);
}

/* a + b modulo 2^64, where only damaged values can leave 64 bits. */
static inline int64_t exh_wrap_add64(int64_t a, int64_t b)
{
    return exh_from_u64((uint64_t)a + (uint64_t)b);
}

/* a - b modulo 2^64, likewise. */
static inline int64_t exh_wrap_diff64(int64_t a, int64_t b)
{
    return exh_from_u64((uint64_t)a - (uint64_t)b);
}

/* A positive factor mant * 2^-shift with 31 significant bits: what a division
 * at set-up leaves behind for the tick. */
struct exh_gain {
    int32_t mant;  /* 2^30 .. 2^31-1, or 0 */
    uint8_t shift; /* 0 .. 62 */
};

/* x times the gain, rounded half up. Relative error of the gain <= 2^-31 (and
 * half an LSB of the result); never overflows, the caller saturates. The mask: a gain whose memory
 * was damaged is a wrong one, and no more. */
static inline int64_t exh_gain_mul(struct exh_gain g, int32_t x)
{
    const int64_t v = (int64_t)x * g.mant;
    /* Shifts 2v, so that rounding needs one variable 64-bit shift instead of two. Wraps only if the
     * gain is corrupt. */
    return exh_wrap_add64(exh_wrap_add64(v, v) >> (g.shift & 63u), 1) >> 1;
}

/* x times the gain, rounded down. */
static inline int64_t exh_gain_floor(struct exh_gain g, int32_t x)
{
    return (int64_t)x * g.mant >> (g.shift & 63u);
}

/* 1/x without a division, x within 1/8 .. 8, both q24: within 2^-25 + 2^-28/x of exact.
 * Three Newton steps, y += y (1 - m y), from the line that is nearest to 1/m in 1/2 .. 1. They go
 * on with z = y - 1, below 1: products of 32 bits are a third of the work of longer ones. */
static inline int32_t exh_recip_q24(int32_t x)
{
    int32_t m_q31 = x * 8; /* brought to 2^30 .. 2^31-1 */
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

/* Sets *g to num/den. 0, or -EXH_E_RANGE when den is 0 or >= 2^63, or when the
 * quotient rounds to 2^31 or more, or is > 0 and < 2^-32. Set-up only (long division). */
int exh_gain_set(struct exh_gain *g, uint64_t num, uint64_t den);

/* floor(num/den), den > 0, without the compiler's division helpers; the
 * remainder goes to *rem unless NULL. Set-up only: 64 steps. */
uint64_t exh_udiv64(uint64_t num, uint64_t den, uint64_t *rem);

/* 1 if T is within 50 us .. 1 s, but for the 1000 ppm by which a timer may miss it, else 0: what
 * every set-up, the loop and a replay ask before they start. */
int exh_period_ok(struct exh_period T);

/* Whole ticks in ms >= 0, of a period that exh_period_ok(). Set-up only; at 20 kHz a day fits. */
uint32_t exh_ticks_in(int32_t ms, struct exh_period T);

#ifdef __cplusplus
}
#endif
#endif
