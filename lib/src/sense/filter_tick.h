/* SPDX-License-Identifier: MIT */
/* The low-pass of each kind, one sample of n channels. Files of their own, since compiled
 * into one function they take each other's registers. Not part of the library's interface. */
#ifndef EXH_FILTER_TICK_H
#define EXH_FILTER_TICK_H

#include "exhand/filter.h"

/* Fraction bits: pos of the low kinds, vel of LOW2, both of the high kinds. */
#define EXH_FILTER_POS_Q  31
#define EXH_FILTER_VEL_Q  32
#define EXH_FILTER_HIGH_Q 26

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
