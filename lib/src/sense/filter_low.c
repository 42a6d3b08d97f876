/* SPDX-License-Identifier: MIT */
/* The low kinds: cut-off well below the sample rate, where the state changes slowly and the cost
 * matters. A 32-bit CPU multiplies only 32 by 32 bits and shifts once. */
#include "filter_tick.h"

#include "exhand/fix.h"

#define POS_Q EXH_FILTER_POS_Q

/* No input moves the state this far; only damaged bytes do. */
#define BEYOND (INT64_C(5) << (31 - 2 + POS_Q)) /* 5/4 of full scale */

/* The output where it saturates. A state that no input can cause is reset there. */
static int32_t clipped(struct exh_filter *s, int64_t low)
{
    const int32_t y = low < 0 ? INT32_MIN : INT32_MAX;
    EXH_SATURATED();
    if (low > BEYOND || low < -BEYOND) { exh_filter_rest(s, y); }
    return y;
}

/* Tests the limit on the high word only. */
static inline int32_t output(struct exh_filter *s, int64_t low)
{
    const uint64_t half = UINT64_C(1) << (31 + POS_Q);
    if ((uint64_t)low + half >= 2 * half) { return clipped(s, low); }
    return exh_from_u32((uint32_t)((uint64_t)low >> POS_Q & UINT32_MAX));
}

/* (x - floor(pos)) * a modulo 2^64, in the form with the shorter code for the CPU. Both have the
 * same bits. 2a fits. */
static inline uint64_t drive(int64_t pos, int32_t x, int32_t a)
{
#if UINTPTR_MAX > UINT32_MAX
    return (uint64_t)(x - (pos >> POS_Q)) * (uint64_t)a;
#else
    const int32_t below = exh_from_u32((uint32_t)((uint64_t)pos & UINT32_MAX));
    const int64_t odd = (uint32_t)a & (uint32_t)(below >> 31);
    return (
        uint64_t)((int64_t)x * a - (int64_t)high_word(pos) * exh_from_u32(2 * (uint32_t)a) - odd);
#endif
}

/* Only damaged bytes wrap here; clipped() detects them. */
EXH_FILTER_STEP(exh_filter_low2)
{
    const int32_t a = cfg->a, b = cfg->b, c = cfg->c;
    EXH_FILTER_WORD unsigned shift = cfg->shift;
    for (; n > 0; n--, s++, x++, y++) {
        const uint64_t friction = (uint64_t)((int64_t)high_word(s->vel) * b);
        const int64_t acc = exh_from_u64(drive(s->pos, *x, a) - friction);
        const int64_t v = acc >> (shift & 31);
        const int64_t p = exh_wrap_add64(s->vel, v);
        s->vel = exh_wrap_add64(p, v);
        const int64_t move = (int64_t)high_word(p) * c;
        const int64_t low = exh_wrap_add64(s->pos, move);
        s->pos = exh_wrap_add64(low, move);
        *y = output(s, low);
    }
}

EXH_FILTER_STEP(exh_filter_low1)
{
    const int32_t a = cfg->a;
    EXH_FILTER_WORD unsigned shift = cfg->shift;
    for (; n > 0; n--, s++, x++, y++) {
        const int64_t acc = exh_from_u64(drive(s->pos, *x, a));
        const int64_t move = acc >> (shift & 31);
        const int64_t low = exh_wrap_add64(s->pos, move);
        s->pos = exh_wrap_add64(low, move);
        *y = output(s, low);
    }
}
