/* SPDX-License-Identifier: MIT */
/* 64-bit division, milliseconds to ticks, and the set-up of a gain. */
#include "exhand/fix.h"

#include "exhand/error.h"

#include <stddef.h>

uint64_t exh_udiv64(uint64_t num, uint64_t den, uint64_t *rem)
{
    uint64_t quot = 0;
    uint64_t r = 0;
    EXH_ASSERT(den != 0);
    for (int i = 0; i < 64; i++) {
        r = r << 1 | num >> 63; /* at most as much of num as went out */
        num <<= 1;
        quot <<= 1;
        if (r >= den) {
            r -= den;
            quot |= 1;
        }
    }
    if (rem != NULL) { *rem = r; }
    return quot;
}

int exh_period_ok(struct exh_period T)
{
    return T.num > 0 && UINT64_C(1000) * T.num <= UINT64_C(1001) * T.den &&
           T.den <= UINT64_C(20020) * T.num;
}

uint32_t exh_ticks_in(int32_t ms, struct exh_period T)
{
    return (uint32_t)exh_udiv64((uint64_t)(uint32_t)ms * T.den, UINT64_C(1000) * T.num, NULL);
}

int exh_gain_set(struct exh_gain *g, uint64_t num, uint64_t den)
{
    uint64_t rem;
    uint64_t mant;
    unsigned shift = 0;

    g->mant = 0;
    g->shift = 1;
    if (den == 0 || den >> 63) { return -EXH_E_RANGE; }
    if (num == 0) { return 0; }
    mant = exh_udiv64(num, den, &rem);
    if (mant > INT32_MAX) { return -EXH_E_RANGE; }
    while (mant < UINT64_C(1) << 30) { /* adds one quotient bit per step */
        rem <<= 1;
        mant <<= 1;
        if (rem >= den) {
            rem -= den;
            mant |= 1;
        }
        shift++;
        if (shift > 62) { return -EXH_E_RANGE; }
    }
    if (rem >= den - rem) { mant++; } /* half up */
    if (mant > INT32_MAX) {           /* rounded up to 2^31 */
        if (shift == 0) { return -EXH_E_RANGE; }
        mant >>= 1;
        shift--;
    }
    g->mant = (int32_t)mant;
    g->shift = (uint8_t)shift;
    return 0;
}
