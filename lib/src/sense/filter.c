/* SPDX-License-Identifier: MIT */
/* Set-up, reset and step of the low-pass filters. The kinds: filter_low.c, filter_high.c. */
#include "exhand/filter.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include "filter_setup.h"
#include "filter_tick.h"
#include "../num/real.h"

#define POS_Q  EXH_FILTER_POS_Q
#define VEL_Q  EXH_FILTER_VEL_Q
#define FC_MIN EXH_Q(1, 100, 16)
#define FC_MAX EXH_Q(10000, 1, 16)

const struct exh_signal exh_filter_rows[EXH_FILTER_ROWS] = {
    {0x0701, 0, EXH_WHEN_SETUP, 1, 2, 2, "order", "", "order of the low-pass"},
    {0x0702, 16, EXH_WHEN_SETUP, FC_MIN, FC_MAX, EXH_Q(20, 1, 16), "fc", "hz",
        "cut-off of the low-pass, -3 dB"},
};

/* --- set-up --- */

/* Nearest value of v * 2^n, at most 2^bits - 1. */
static int32_t coefficient(struct exh_real v, int32_t n, unsigned bits)
{
    const uint64_t most = (UINT64_C(1) << bits) - 1;
    const uint64_t r = exh_real_round(exh_real_scale(v, n));
    return (int32_t)(r > most ? most : r);
}

/* The n that scales v to 2^(bits-1) .. 2^bits. */
static int32_t places(struct exh_real v, int32_t bits) { return bits - 63 - v.e; }

/* In the functions below, g = tan(pi fc T) and damped = g (g + sqrt 2); see NUMERICS.md. */
static void low2(struct exh_filter_cfg *cfg, struct exh_real g, struct exh_real damped)
{
    const struct exh_real more = exh_real_add(exh_real_of(1), damped);
    const struct exh_real b = exh_real_div(damped, more);
    struct exh_real a = exh_real_div(exh_real_mul(g, g), more);
    int32_t n;
    cfg->c = coefficient(exh_real_mul(g, exh_real_scale(exh_real_of(23), -4)), POS_Q, 31);
    a = exh_real_scale(exh_real_div(a, exh_real_of((uint64_t)cfg->c)), POS_Q);
    n = places(b, 31); /* 2a also fits: b is (g + sqrt 2) 23/16 a, more than 2a */
    cfg->a = coefficient(a, n, 30);
    cfg->b = coefficient(b, n, 31);
    cfg->shift = (uint8_t)(n - VEL_Q);
}

static void high2(struct exh_filter_cfg *cfg, struct exh_real g, struct exh_real damped)
{
    const struct exh_real one = exh_real_of(1);
    const struct exh_real inv = exh_real_div(one, exh_real_add(one, damped));
    cfg->a = coefficient(exh_real_mul(exh_real_mul(g, g), inv), 31, 31);
    cfg->b = coefficient(inv, 31, 31);
}

static void low1(struct exh_filter_cfg *cfg, struct exh_real g)
{
    const struct exh_real a = exh_real_div(g, exh_real_add(exh_real_of(1), g));
    const int32_t n = places(a, 30); /* 2a must also fit */
    cfg->a = coefficient(a, n, 30);
    cfg->shift = (uint8_t)(n - POS_Q);
}

static void high1(struct exh_filter_cfg *cfg, struct exh_real g)
{
    cfg->a = coefficient(exh_real_div(g, exh_real_add(exh_real_of(1), g)), 31, 31);
}

int exh_filter_ratio(
    uint64_t *fc, uint64_t *rate, const struct exh_filter_par *par, struct exh_period T)
{
    const uint64_t num = par->fc_Hz_q16 > 0 ? (uint64_t)par->fc_Hz_q16 * T.num : 0;
    const uint64_t den = (uint64_t)T.den << 16;
    *fc = num;
    *rate = den;
    /* A glove may have a lower rate than any loop. */
    if (T.num == 0 || T.den == 0) { return -EXH_E_RATE; }
    if (num == 0 || par->order < 1 || par->order > 2) { return -EXH_E_RANGE; }
    if (num >= den / 2) { return -EXH_E_CUTOFF; }
    return num < den >> 21 ? -EXH_E_RANGE : 0;
}

int exh_filter_setup(
    struct exh_filter_cfg *cfg, const struct exh_filter_par *par, struct exh_period T)
{
    uint64_t num, den;
    struct exh_real g, damped;
    const int err = exh_filter_ratio(&num, &den, par, T);
    int high;
    if (err != 0) { return err; }

    g = exh_real_tan_pi(num, den);
    /* g > 11/32. Above a quarter of the rate, g > 1 and unbounded. */
    high = num > den / 4 || exh_real_round(exh_real_scale(g, 32)) > UINT64_C(11) << 27;
    damped = exh_real_mul(g, exh_real_add(g, EXH_REAL_SQRT2));
    *cfg = (struct exh_filter_cfg){0, 0, 0, 0, 0};
    if (par->order == 1 && high) {
        cfg->kind = EXH_FILTER_HIGH1;
        high1(cfg, g);
    } else if (par->order == 1) {
        cfg->kind = EXH_FILTER_LOW1;
        low1(cfg, g);
    } else if (high) {
        cfg->kind = EXH_FILTER_HIGH2;
        high2(cfg, g, damped);
    } else {
        cfg->kind = EXH_FILTER_LOW2;
        low2(cfg, g, damped);
    }
    return 0;
}

/* --- the tick, reset and retuning --- */

void exh_filter_step(struct exh_filter *s, const struct exh_filter_cfg *cfg, const int32_t *x,
    int32_t *y, unsigned n)
{
    switch ((enum exh_filter_kind)cfg->kind) {
    case EXH_FILTER_LOW1: exh_filter_low1(s, cfg, x, y, n); break;
    case EXH_FILTER_LOW2: exh_filter_low2(s, cfg, x, y, n); break;
    case EXH_FILTER_HIGH1: exh_filter_high1(s, cfg, x, y, n); break;
    case EXH_FILTER_HIGH2: exh_filter_high2(s, cfg, x, y, n); break;
    default: EXH_ASSERT(0);
    }
}

void exh_filter_reset(struct exh_filter *s, const int32_t *x, unsigned n)
{
    for (unsigned i = 0; i < n; i++) { exh_filter_rest(&s[i], x[i]); }
}

/* Speeds have the same unit, and the new filter can decelerate them. */
static int speed_stays(const struct exh_filter_cfg *from, const struct exh_filter_cfg *to)
{
    return from->kind == to->kind &&
           (to->kind == EXH_FILTER_LOW2 || (to->kind == EXH_FILTER_HIGH2 && to->a >= from->a));
}

/* The position keeps its meaning, so the output continues without a jump. High kinds convert it. */
void exh_filter_retune(struct exh_filter *s, const struct exh_filter_cfg *from,
    const struct exh_filter_cfg *to, unsigned n)
{
    const int to_low = to->kind == EXH_FILTER_LOW2 || to->kind == EXH_FILTER_LOW1;
    const unsigned more = POS_Q - EXH_FILTER_HIGH_Q;
    const int64_t full = INT64_C(1) << (62 - more);
    for (unsigned i = 0; i < n; i++) {
        if (!speed_stays(from, to)) { s[i].vel = 0; }
        if (to_low && s[i].wide) {
            s[i].pos = exh_clamp64(s[i].pos, full) * (INT64_C(1) << more);
            s[i].wide = 0;
        }
    }
}

void exh_filter_serialize(struct exh_bytes *c, struct exh_filter *s)
{
    exh_bytes_i64(c, &s->pos);
    exh_bytes_i64(c, &s->vel);
    exh_bytes_u8(c, &s->wide);
}
