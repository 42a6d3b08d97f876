/* SPDX-License-Identifier: MIT */
/* The high kinds: cut-off up to half the rate. Fractions of 31 bits times 64-bit states. */
#include "filter_tick.h"

#include "exhand/fix.h"

#define Q    EXH_FILTER_HIGH_Q
#define HALF (INT64_C(1) << (Q - 1))

/* States swing up to 32 times the input where that swings at half the rate. There they
 * stop, which takes energy and so cannot start an oscillation. */
#define MOST (INT64_C(1) << (31 + 5 + Q))

/* The high word alone says that a state is within. */
static inline int64_t bounded(int64_t v)
{
    const uint32_t high = (uint32_t)((uint64_t)v >> 32), most = (uint32_t)(MOST >> 32);
    return high + most < 2 * most ? v : exh_clamp64(v, MOST);
}

/* exh_mul64_q31() of a coefficient, which is never below 0: its low product needs no sign. One of
 * damaged memory may wrap. */
static inline int64_t share(int64_t a, int32_t b)
{
    const uint64_t high = (uint64_t)((int64_t)high_word(a) * b);
    const uint64_t low = (uint64_t)(uint32_t)((uint64_t)a & UINT32_MAX) * (uint32_t)b;
    return exh_from_u64(2 * high + ((low + (UINT32_C(1) << 30)) >> 31));
}

/* The limit is seen in the high word; within it the low one is all there is. */
static inline int32_t within(int64_t low)
{
    const uint32_t high = (uint32_t)((uint64_t)low >> 32), half = UINT32_C(1) << (31 + Q - 32);
    if (high + half >= 2 * half) { return exh_sat32(low >> Q); }
    return exh_from_u32((uint32_t)((uint64_t)low >> Q & UINT32_MAX));
}

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
    EXH_FILTER_WORD int32_t a = cfg->a, b = cfg->b, c = cfg->c, d = cfg->d;
    for (; n > 0; n--, s++, x++, y++) {
        int64_t pos, vel, e, mid, move, low;
        widen(s);
        pos = bounded(s->pos);
        vel = bounded(s->vel);
        e = exh_wrap_diff64((int64_t)*x * (INT32_C(1) << Q) + HALF, pos);
        mid = exh_wrap_add64(share(vel, a), share(e, b));
        move = exh_wrap_add64(share(vel, c), share(e, d));
        low = exh_wrap_add64(pos, move);
        s->vel = exh_wrap_diff64(exh_wrap_add64(mid, mid), vel);
        s->pos = exh_wrap_add64(low, move);
        *y = within(low);
    }
}

EXH_FILTER_STEP(exh_filter_high1)
{
    EXH_FILTER_WORD int32_t a = cfg->a;
    for (; n > 0; n--, s++, x++, y++) {
        int64_t pos, move, low;
        widen(s);
        pos = bounded(s->pos);
        move = share(exh_wrap_diff64((int64_t)*x * (INT32_C(1) << Q) + HALF, pos), a);
        low = exh_wrap_add64(pos, move);
        s->pos = exh_wrap_add64(low, move);
        *y = within(low);
    }
}
