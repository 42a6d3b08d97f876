/* SPDX-License-Identifier: MIT */
/* The low-pass of each kind: one sample of n channels. The kinds are separate files, since compiled
 * into one function they compete for registers. Not part of the library's interface. */
#ifndef EXH_FILTER_TICK_H
#define EXH_FILTER_TICK_H

#include "exhand/filter.h"
#include "exhand/fix.h"

/* Fraction bits: pos of the low kinds, vel of LOW2, both of the high kinds. */
#define EXH_FILTER_POS_Q  31
#define EXH_FILTER_VEL_Q  32
#define EXH_FILTER_HIGH_Q 22

/* Access to coefficients in a channel's step. Without a visible mask, a 32-bit compiler shifts 64
 * bits by a test and two moves. If it widens a coefficient before the loop, it multiplies 64 by 64
 * bits in it. */
#if UINTPTR_MAX > UINT32_MAX
#define EXH_FILTER_WORD const
#else
#define EXH_FILTER_WORD const volatile
#endif

/* After a plain shift, a 32-bit compiler keeps a 64-bit word and multiplies it as such. */
static inline int32_t high_word(int64_t v) { return exh_from_u32((uint32_t)((uint64_t)v >> 32)); }

/* The state settled at x. */
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
