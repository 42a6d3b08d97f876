/* SPDX-License-Identifier: MIT */
/* The cheap low-pass: sums of 32 by 32 bit products, each one instruction on a small CPU. */
#include "exhand/filter_cheap.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include "filter_setup.h"
#include "../num/real.h"

/* Fraction bits of the high coefficients: the sum fits for any input. */
#define HIGH_Q 29
#define HALF   (UINT32_C(1) << (HIGH_Q - 1))
#define MIDDLE (INT32_C(3) << (HIGH_Q - 3)) /* value of a at 0.2 of the rate, and of -a at 0.3 */

/* --- set-up: g = tan(pi fc T), b0 = g^2 / (1 + K), K = g (g + sqrt 2); see NUMERICS.md --- */

/* Nearest value of v * 2^n; it must fit. */
static int32_t coefficient(struct exh_real v, int32_t n)
{
    return (int32_t)exh_real_round(exh_real_scale(v, n));
}

/* The speed is at most 1.907 g of full scale per tick, for any input. Its unit is 9/4 g / 2^32 of
 * full scale. c compensates the rounding of b, as it is five times as fine. */
static void low(struct exh_filter_cheap_cfg *cfg, struct exh_real g, struct exh_real inv)
{
    const struct exh_real b0 = exh_real_mul(exh_real_mul(g, g), inv);
    const struct exh_real damping = exh_real_mul(exh_real_mul(g, EXH_REAL_SQRT2), inv);
    const struct exh_real unit = exh_real_div(exh_real_of(4), exh_real_of(9));
    cfg->a = -coefficient(damping, 33);
    cfg->b = coefficient(exh_real_mul(exh_real_mul(g, inv), unit), 32);
    cfg->c = coefficient(exh_real_div(b0, exh_real_of((uint64_t)cfg->b)), 64);
}

static void high(struct exh_filter_cheap_cfg *cfg, struct exh_real g, struct exh_real inv)
{
    const struct exh_real square = exh_real_mul(g, g), one = exh_real_of(1);
    const int beyond = g.e >= -62; /* g >= 1, from a quarter of the rate */
    const struct exh_real off = beyond ? exh_real_sub(square, one) : exh_real_sub(one, square);
    const int32_t a = coefficient(exh_real_mul(off, inv), HIGH_Q + 1);
    cfg->a = beyond ? -a : a;
    cfg->b = coefficient(exh_real_mul(square, inv), HIGH_Q);
    /* Gain 1 at 0 Hz. c fits, although 4 b does not. */
    cfg->c = exh_from_u32((UINT32_C(1) << HIGH_Q) - 4 * (uint32_t)cfg->b - (uint32_t)cfg->a);
    cfg->high = 1;
}

int exh_filter_cheap_setup(
    struct exh_filter_cheap_cfg *cfg, const struct exh_filter_par *par, struct exh_period T)
{
    uint64_t num, den;
    struct exh_real g, inv;
    const int err = par->order == 1 ? -EXH_E_RANGE : exh_filter_ratio(&num, &den, par, T);
    if (err != 0) { return err; }

    g = exh_real_tan_pi(num, den);
    inv = exh_real_add(exh_real_of(1), exh_real_mul(g, exh_real_add(g, EXH_REAL_SQRT2)));
    inv = exh_real_div(exh_real_of(1), inv);
    *cfg = (struct exh_filter_cheap_cfg){0, 0, 0, 0};
    /* g > 7/32; g itself is unbounded. */
    if (num > den / 4 || exh_real_round(exh_real_scale(g, 32)) > UINT64_C(7) << 27) {
        high(cfg, g, inv);
    } else {
        low(cfg, g, inv);
    }
    return 0;
}

/* --- the tick and reset --- */

static inline int32_t word(int64_t v) { return exh_from_u32((uint32_t)((uint64_t)v >> 32)); }

static inline int64_t words(int32_t high, uint32_t low)
{
    return exh_from_u64((uint64_t)(uint32_t)high << 32 | low);
}

static inline uint64_t times(int32_t a, int32_t b) { return (uint64_t)((int64_t)a * b); }

/* Modulo 2^32, for damaged coefficients. */
static inline int32_t multiple(int32_t k, int32_t v)
{
    return exh_from_u32((uint32_t)k * (uint32_t)v);
}

/* b, 2 b and -4 b. */
struct factors {
    int32_t b, twice, back;
};

static struct factors factors_of(int32_t b)
{
    return (struct factors){b, multiple(2, b), multiple(-4, b)};
}

/* sum + b (x + 2 in1 + in2 - 4 at); then shifts the inputs. Uses one 64-bit product where the CPU
 * has one, else one per word. */
static inline uint64_t driven(
    uint64_t sum, struct exh_filter_cheap *s, int32_t x, int32_t at, const struct factors *k)
{
#if UINTPTR_MAX > UINT32_MAX
    const int64_t off = x + 2 * (int64_t)s->in1 + s->in2 - 4 * (int64_t)at;
    sum += (uint64_t)off * (uint64_t)k->b;
#else
    sum += times(s->in1, k->twice) + times(s->in2, k->b) + times(at, k->back);
    sum += times(x, k->b);
#endif
    s->in2 = s->in1;
    s->in1 = x;
    return sum;
}

static void rest(struct exh_filter_cheap *s, int32_t at)
{
    s->pos = words(at, UINT32_C(1) << 31);
    s->vel = 0;
}

/* Sums are modulo 2^64; only damaged bytes wrap them. */
static void step_low(struct exh_filter_cheap *s, const struct exh_filter_cheap_cfg *cfg,
    const int32_t *x, int32_t *y, unsigned n)
{
    const int32_t a = cfg->a, c = cfg->c;
    const struct factors k = factors_of(cfg->b);
    for (; n > 0; n--, s++, x++, y++) {
        const int32_t at = word(s->pos);
        const uint64_t sum = (uint64_t)s->vel + times(word(s->vel), a);
        int32_t v, to;
        s->vel = exh_from_u64(driven(sum, s, *x, at, &k));
        v = word(s->vel);
        s->pos = exh_from_u64((uint64_t)s->pos + times(v, c));
        to = word(s->pos);
        if (((to ^ v) & (to ^ at)) < 0) { /* beyond the rail in the direction of motion */
            EXH_SATURATED();
            to = at < 0 ? INT32_MIN : INT32_MAX;
            rest(s, to);
        }
        *y = to;
    }
}

/* The rounding remainder enters the next sum. Added, it cancels at 0 Hz. Inverted, it cancels at
 * half the rate, where the recursion would turn it into a limit cycle. Near the middle frequency
 * either would cause one, so sums are only rounded there. */
static void step_high(struct exh_filter_cheap *s, const struct exh_filter_cheap_cfg *cfg,
    const int32_t *x, int32_t *y, unsigned n)
{
    const int32_t a = cfg->a, c = cfg->c;
    const struct factors k = factors_of(cfg->b);
    const uint32_t mask = (UINT32_C(1) << HIGH_Q) - 1;
    const uint32_t kept = a > MIDDLE || a < -MIDDLE ? mask : 0;
    const uint32_t turn = a > MIDDLE ? 0 : a < -MIDDLE ? mask : HALF;
    for (; n > 0; n--, s++, x++, y++) {
        const int32_t before = word(s->pos);
        uint64_t sum = ((uint32_t)((uint64_t)s->pos & kept) ^ turn) + times(before, a);
        uint32_t left;
        sum = driven(sum + times(word(s->vel), c), s, *x, 0, &k);
        left = (uint32_t)(sum & mask);
        *y = exh_sat32(exh_from_u64(sum) >> HIGH_Q);
        s->vel = words(before, 0);
        s->pos = words(*y, left);
    }
}

void exh_filter_cheap_step(struct exh_filter_cheap *s, const struct exh_filter_cheap_cfg *cfg,
    const int32_t *x, int32_t *y, unsigned n)
{
    if (cfg->high) {
        step_high(s, cfg, x, y, n);
    } else {
        step_low(s, cfg, x, y, n);
    }
}

void exh_filter_cheap_reset(struct exh_filter_cheap *s, const struct exh_filter_cheap_cfg *cfg,
    const int32_t *x, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        rest(&s[i], x[i]);
        if (cfg->high) { /* plus half an LSB in the high kind */
            s[i].pos = words(x[i], HALF);
            s[i].vel = words(x[i], 0);
        }
        s[i].in1 = s[i].in2 = x[i];
    }
}

void exh_filter_cheap_serialize(struct exh_bytes *c, struct exh_filter_cheap *s)
{
    exh_bytes_i64(c, &s->pos);
    exh_bytes_i64(c, &s->vel);
    exh_bytes_i32(c, &s->in1);
    exh_bytes_i32(c, &s->in2);
}
