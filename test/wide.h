/* SPDX-License-Identifier: MIT */
/* Wide: exact 128-bit signed integers from two 64-bit words, for oracles.
 *
 * 32-bit compilers have no __int128, and an oracle must be wider than the code
 * it judges. Two's complement; sums and products wrap only beyond 2^127, which
 * no oracle comes near. test/module/unit/wide_test.c checks it against the compiler's.
 */
#ifndef TEST_WIDE_H
#define TEST_WIDE_H

#include <stdint.h>

struct wide {
    uint64_t hi, lo;
};

static inline struct wide wide_of(int64_t v)
{
    const struct wide w = {v < 0 ? UINT64_MAX : 0, (uint64_t)v};
    return w;
}

static inline struct wide wide_add(struct wide a, struct wide b)
{
    const uint64_t lo = a.lo + b.lo;
    const struct wide w = {a.hi + b.hi + (lo < a.lo), lo};
    return w;
}

static inline struct wide wide_neg(struct wide a)
{
    const struct wide w = {~a.hi + (a.lo == 0), (uint64_t)0 - a.lo};
    return w;
}

static inline struct wide wide_sub(struct wide a, struct wide b)
{
    return wide_add(a, wide_neg(b));
}

static inline int wide_negative(struct wide a) { return (int)(a.hi >> 63); }

static inline struct wide wide_abs(struct wide a) { return wide_negative(a) ? wide_neg(a) : a; }

static inline struct wide wide_mulu(uint64_t a, uint64_t b)
{
    const uint64_t al = a & UINT32_MAX, ah = a >> 32, bl = b & UINT32_MAX, bh = b >> 32;
    const uint64_t ll = al * bl, lh = al * bh, hl = ah * bl;
    const uint64_t mid = (ll >> 32) + (lh & UINT32_MAX) + (hl & UINT32_MAX);
    const struct wide w = {
        ah * bh + (lh >> 32) + (hl >> 32) + (mid >> 32), mid << 32 | (ll & UINT32_MAX)};
    return w;
}

static inline struct wide wide_mul(int64_t a, int64_t b)
{
    const uint64_t ua = a < 0 ? (uint64_t)0 - (uint64_t)a : (uint64_t)a;
    const uint64_t ub = b < 0 ? (uint64_t)0 - (uint64_t)b : (uint64_t)b;
    const struct wide w = wide_mulu(ua, ub);
    return (a < 0) != (b < 0) ? wide_neg(w) : w;
}

/* -1, 0, 1 as a is below, equal to, above b. */
static inline int wide_cmp(struct wide a, struct wide b)
{
    const uint64_t top = UINT64_C(1) << 63; /* signed order by flipping the sign bit */
    if (a.hi != b.hi) { return (a.hi ^ top) < (b.hi ^ top) ? -1 : 1; }
    return a.lo < b.lo ? -1 : a.lo > b.lo;
}

/* a * 2^n, 0 <= n <= 127. */
static inline struct wide wide_shl(struct wide a, unsigned n)
{
    struct wide w = {n >= 64 ? a.lo << (n - 64) : a.hi, n >= 64 ? 0 : a.lo};
    if (n > 0 && n < 64) {
        w.hi = a.hi << n | a.lo >> (64 - n);
        w.lo = a.lo << n;
    }
    return w;
}

/* floor(a / 2^n), 0 <= n <= 127. */
static inline struct wide wide_shr_floor(struct wide a, unsigned n)
{
    const uint64_t fill = wide_negative(a) ? UINT64_MAX : 0;
    struct wide w = a;
    if (n >= 64) {
        w.lo = a.hi;
        w.hi = fill;
        n -= 64;
    }
    if (n > 0) {
        w.lo = w.lo >> n | w.hi << (64 - n);
        w.hi = w.hi >> n | fill << (64 - n);
    }
    return w;
}

/* floor(a / 2^n + 1/2), 0 <= n <= 127. */
static inline struct wide wide_shr_half_up(struct wide a, unsigned n)
{
    const struct wide one = {0, 1};
    return n == 0 ? a : wide_shr_floor(wide_add(a, wide_shl(one, n - 1)), n);
}

/* a limited to int64_t or int32_t, the sign kept. */
static inline int64_t wide_sat64(struct wide a)
{
    if (wide_cmp(a, wide_of(INT64_MAX)) > 0) { return INT64_MAX; }
    if (wide_cmp(a, wide_of(INT64_MIN)) < 0) { return INT64_MIN; }
    return wide_negative(a) ? -(int64_t)(UINT64_MAX - a.lo) - 1 : (int64_t)a.lo;
}

static inline int32_t wide_sat32(struct wide a)
{
    const int64_t v = wide_sat64(a);
    return (int32_t)(v > INT32_MAX ? INT32_MAX : v < INT32_MIN ? INT32_MIN : v);
}

/* |a| <= b. */
static inline int wide_within(struct wide a, struct wide b)
{
    return wide_cmp(wide_abs(a), b) <= 0;
}

#endif
