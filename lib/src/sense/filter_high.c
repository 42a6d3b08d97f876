/* SPDX-License-Identifier: MIT */
/* The high kinds: cut-off up to half the rate. 31-bit fractions times 64-bit states, as products of
 * at most 32 by 32 bits. */
#include "filter_tick.h"

#include "exhand/fix.h"

#define Q    EXH_FILTER_HIGH_Q
#define HALF (UINT64_C(1) << (Q - 1))

/* Twice 4 times full scale: no input causes such an output. */
#define FAR (INT64_C(8) << (31 + Q))

/* Converts a state after a reset or from a low kind to our format. Both have zero speed. */
static void widen(struct exh_filter *s)
{
    s->pos >>= EXH_FILTER_POS_Q - Q;
    s->wide = 1;
}

/* The output where it saturates. A state that no input can cause is reset there. */
static int32_t at_rail(struct exh_filter *s, int64_t twice)
{
    const int32_t y = twice < 0 ? INT32_MIN : INT32_MAX;
    EXH_SATURATED();
    if (twice > FAR || twice < -FAR) { exh_filter_rest(s, y); }
    return y;
}

/* The mean of the previous and present state. Tests the limit on the high word only. */
static inline int32_t mean(struct exh_filter *s, uint64_t before)
{
    const uint64_t twice = before + (uint64_t)s->pos, full = UINT64_C(1) << (32 + Q);
    if (twice + full >= 2 * full) { return at_rail(s, exh_from_u64(twice)); }
    return exh_from_u32((uint32_t)(twice >> (Q + 1) & UINT32_MAX));
}

static inline uint32_t low_word(int64_t v) { return (uint32_t)((uint64_t)v & UINT32_MAX); }

/* Modulo 2^64: words of damaged coefficients may wrap. */
static inline uint64_t times(int32_t word, int32_t c) { return (uint64_t)((int64_t)word * c); }

/* floor((e a + v b) / 2^32). Of the four products of words, the low ones are added before
 * truncation. */
static inline uint64_t sum(
    int64_t e, EXH_FILTER_WORD int32_t *a, int64_t v, EXH_FILTER_WORD int32_t *b)
{
    const int32_t of_e = *a, of_v = *b;
    const uint64_t below =
        (uint64_t)low_word(e) * (uint32_t)of_e + (uint64_t)low_word(v) * (uint32_t)of_v;
    return times(high_word(e), of_e) + (uint32_t)(below >> 32) + times(high_word(v), of_v);
}

/* The same for one product. */
static inline uint64_t share(int64_t e, EXH_FILTER_WORD int32_t *a)
{
    const int32_t of_e = *a;
    const uint64_t below = (uint64_t)low_word(e) * (uint32_t)of_e;
    return times(high_word(e), of_e) + (uint32_t)(below >> 32);
}

static inline int64_t error_of(const struct exh_filter *s, int32_t x)
{
    const uint64_t at = (uint64_t)(int64_t)x << Q | HALF;
    return exh_from_u64(at - (uint64_t)s->pos);
}

/* Modulo 2^64: a damaged state may wrap here. */
EXH_FILTER_STEP(exh_filter_high2)
{
    EXH_FILTER_WORD int32_t a = cfg->a, b = cfg->b;
    for (; n > 0; n--, s++, x++, y++) {
        if (s->wide == 0) { widen(s); }
        const uint64_t before = (uint64_t)s->pos;
        const uint64_t move = 4 * sum(error_of(s, *x), &a, s->vel, &b);
        s->pos = exh_from_u64(before + move);
        s->vel = exh_from_u64(move - (uint64_t)s->vel);
        *y = mean(s, before);
    }
}

EXH_FILTER_STEP(exh_filter_high1)
{
    EXH_FILTER_WORD int32_t a = cfg->a;
    for (; n > 0; n--, s++, x++, y++) {
        if (s->wide == 0) { widen(s); }
        const uint64_t before = (uint64_t)s->pos;
        s->pos = exh_from_u64(before + 4 * share(error_of(s, *x), &a));
        *y = mean(s, before);
    }
}
