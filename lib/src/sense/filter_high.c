/* SPDX-License-Identifier: MIT */
/* The high kinds: cut-off up to half the rate. Fractions of 31 bits times 64-bit states. */
#include "filter_tick.h"

#include "exhand/fix.h"

#define Q    EXH_FILTER_HIGH_Q
#define HALF (INT64_C(1) << (Q - 1))

/* States swing up to 32 times the input where that swings at half the rate. There they
 * stop, which takes energy and so cannot start an oscillation. */
static int64_t bounded(int64_t v) { return exh_clamp64(v, INT64_C(1) << (31 + 5 + Q)); }

/* What a reset, or a low kind before, left: into our format. A low kind that is settled stands
 * anywhere within an LSB of pos, and of vel, of which it sees the integer part alone; so do we. */
static void widen(struct exh_filter *s)
{
    if (!s->wide) {
        s->pos >>= EXH_FILTER_POS_Q - Q;
        s->vel = (s->vel >> EXH_FILTER_VEL_Q) * (INT32_C(1) << Q);
        s->wide = 1;
    }
}

/* Coefficients of damaged memory may wrap here. */
EXH_FILTER_STEP(exh_filter_high2)
{
    for (; n > 0; n--, s++, x++, y++) {
        int64_t pos, vel, e, mid, move, low;
        widen(s);
        pos = bounded(s->pos);
        vel = bounded(s->vel);
        e = (int64_t)*x * (INT32_C(1) << Q) + HALF - pos;
        mid = exh_wrap_add64(exh_mul64_q31(vel, cfg->a), exh_mul64_q31(e, cfg->b));
        move = exh_wrap_add64(exh_mul64_q31(vel, cfg->c), exh_mul64_q31(e, cfg->d));
        low = exh_wrap_add64(pos, move);
        s->vel = exh_wrap_diff64(exh_wrap_add64(mid, mid), vel);
        s->pos = exh_wrap_add64(low, move);
        *y = exh_sat32(low >> Q);
    }
}

EXH_FILTER_STEP(exh_filter_high1)
{
    for (; n > 0; n--, s++, x++, y++) {
        int64_t pos, move, low;
        widen(s);
        pos = bounded(s->pos);
        move = exh_mul64_q31((int64_t)*x * (INT32_C(1) << Q) + HALF - pos, cfg->a);
        low = exh_wrap_add64(pos, move);
        s->pos = exh_wrap_add64(low, move);
        *y = exh_sat32(low >> Q);
    }
}
