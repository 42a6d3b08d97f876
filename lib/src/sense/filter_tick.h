/* SPDX-License-Identifier: MIT */
/* The low-pass of each kind, one sample of n channels. Files of their own, since compiled
 * into one function they take each other's registers. Not part of the library's interface. */
#ifndef EXH_FILTER_TICK_H
#define EXH_FILTER_TICK_H

#include "exhand/filter.h"
#include "exhand/fix.h"

/* Fraction bits: pos of the low kinds, vel of LOW2, both of the high kinds. */
#define EXH_FILTER_POS_Q  31
#define EXH_FILTER_VEL_Q  32
#define EXH_FILTER_HIGH_Q 22

/* What a channel's step reads of cfg where it uses it. A 32-bit compiler that does not see a mask
 * there shifts 64 bits by way of a test and two moves; one that widens a coefficient ahead of the
 * loop multiplies 64 bits by 64 in it. */
#if UINTPTR_MAX > UINT32_MAX
#define EXH_FILTER_WORD const
#else
#define EXH_FILTER_WORD const volatile
#endif

/* A 32-bit compiler takes a shift alone for a word of 64 bits, and multiplies by it as such. */
static inline int32_t high_word(int64_t v) { return exh_from_u32((uint32_t)((uint64_t)v >> 32)); }

/* Settled at x. */
static inline void exh_filter_rest(struct exh_filter *s, int32_t x)
{
    s->pos = (int64_t)x * (INT64_C(1) << EXH_FILTER_POS_Q) + (INT64_C(1) << (EXH_FILTER_POS_Q - 1));
    s->vel = 0;
    s->wide = 0;
}

#define EXH_FILTER_STEP(name) \
    void name(struct exh_filter *s, const struct exh_filter_cfg *cfg, const int32_t *x, \
        int32_t *y, unsigned n)

EXH_FILTER_STEP(exh_filter_low1);
EXH_FILTER_STEP(exh_filter_low2);
EXH_FILTER_STEP(exh_filter_high1);
EXH_FILTER_STEP(exh_filter_high2);

#endif
