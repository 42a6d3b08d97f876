/* SPDX-License-Identifier: MIT */
/* Positive real numbers for set-ups: 63 significant bits and an exponent, in integers. Slow (a
 * division takes 63 steps), so never called in a tick. Not part of the library's interface. */
#ifndef EXH_REAL_H
#define EXH_REAL_H

#include <stdint.h>

/* m * 2^e with m within 2^62 .. 2^63-1, or 0 * 2^0. Each operation has a relative error below 2^-61
 * and rounds towards zero. */
struct exh_real {
    uint64_t m;
    int32_t e;
};

#define EXH_REAL_SQRT2 ((struct exh_real){UINT64_C(0x5A827999FCEF3242), -62})
#define EXH_REAL_PI    ((struct exh_real){UINT64_C(0x6487ED5110B4611A), -61})

struct exh_real exh_real_of(uint64_t v);
struct exh_real exh_real_mul(struct exh_real a, struct exh_real b);
struct exh_real exh_real_div(struct exh_real a, struct exh_real b); /* b > 0 */
struct exh_real exh_real_add(struct exh_real a, struct exh_real b);
struct exh_real exh_real_sub(struct exh_real a, struct exh_real b); /* a >= b */

/* a * 2^n. */
static inline struct exh_real exh_real_scale(struct exh_real a, int32_t n)
{
    a.e += a.m == 0 ? 0 : n;
    return a;
}

/* The nearest integer, half up, at most 2^62. */
uint64_t exh_real_round(struct exh_real a);

/* tan(pi num/den), 0 < num/den < 1/2, num < 2^62, den < 2^62. The relative error is below 2^-56,
 * except near a quarter turn, where the cotangent limits it. */
struct exh_real exh_real_tan_pi(uint64_t num, uint64_t den);

#endif
