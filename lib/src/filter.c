#include "exhand/filter.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#include "real.h"

#define POS_Q  26 /* fraction bits of pos, and of vel of the high kinds */
#define VEL_Q  32 /* fraction bits of vel of the low kinds              */
#define HALF   (INT64_C(1) << (POS_Q - 1))
#define FC_MIN EXH_Q(1, 100, 16)
#define FC_MAX EXH_Q(10000, 1, 16)

const struct exh_signal exh_filter_rows[EXH_FILTER_ROWS] = {
    {0x0701, 0, EXH_WHEN_SETUP, 1, 2, 2, "order", "", "order of the low-pass"},
    {0x0702, 16, EXH_WHEN_SETUP, FC_MIN, FC_MAX, EXH_Q(20, 1, 16), "fc", "hz",
     "cut-off of the low-pass, -3 dB"},
};

/* --- set-up --- */

/* Nearest value of v * 2^n, no larger than an int32_t. */
static int32_t coefficient(struct exh_real v, int32_t n)
{
    const uint64_t r = exh_real_round(exh_real_scale(v, n));
    return r > INT32_MAX ? INT32_MAX : (int32_t)r;
}

/* The n that brings v to 2^(bits-1) .. 2^bits. */
static int32_t places(struct exh_real v, int32_t bits)
{
    return bits - 63 - v.e;
}

/* From here on g = tan(pi fc T), damp = g + sqrt 2, den = 1 + g damp; see NUMERICS.md. */
static void low2(struct exh_filter_cfg *cfg, struct exh_real g, struct exh_real damp,
                 struct exh_real den)
{
    const struct exh_real b = exh_real_div(exh_real_mul(g, damp), den);
    const struct exh_real a = exh_real_div(exh_real_mul(g, g), den);
    const struct exh_real nine_eighths = exh_real_scale(exh_real_of(9), -3);
    const int32_t n = places(b, 31);
    cfg->b = coefficient(b, n);
    cfg->c = coefficient(exh_real_mul(g, nine_eighths), POS_Q);
    cfg->a = coefficient(exh_real_div(a, exh_real_of((uint64_t)cfg->c)), n + POS_Q);
    cfg->shift = (uint8_t)(n - VEL_Q);
}

static void high2(struct exh_filter_cfg *cfg, struct exh_real g, struct exh_real den)
{
    const struct exh_real inv = exh_real_div(exh_real_of(1), den);
    const struct exh_real mid = exh_real_mul(g, inv);
    const struct exh_real nine = exh_real_of(9);
    cfg->a = coefficient(inv, 31);
    cfg->b = coefficient(exh_real_div(mid, nine), 31 + 3);
    cfg->c = coefficient(exh_real_mul(mid, nine), 31 - 3);
    cfg->d = coefficient(exh_real_mul(g, mid), 31);
}

static void first(struct exh_filter_cfg *cfg, struct exh_real g)
{
    const struct exh_real a = exh_real_div(g, exh_real_add(exh_real_of(1), g));
    const int32_t n = cfg->kind == EXH_FILTER_LOW1 ? places(a, 30) : 31;
    cfg->a = coefficient(a, n);
    cfg->shift = (uint8_t)(n - POS_Q);
}

int exh_filter_setup(struct exh_filter_cfg *cfg, const struct exh_filter_par *par,
                     struct exh_period T)
{
    /* fc T = num / den */
    const uint64_t num = par->fc_Hz_q16 > 0 ? (uint64_t)par->fc_Hz_q16 * T.num : 0;
    const uint64_t den = (uint64_t)T.den << 16;
    struct exh_real g, damp;

    if (num == 0 || den == 0 || par->order < 1 || par->order > 2) { return -EXH_E_RANGE; }
    if (num >= den - num || num >= den) { return -EXH_E_CUTOFF; }
    if (num < den >> 21) { return -EXH_E_RANGE; }
    g = exh_real_tan_pi(num, den);
    damp = exh_real_add(g, EXH_REAL_SQRT2);
    *cfg = (struct exh_filter_cfg){0, 0, 0, 0, 0, 0};
    const int high = exh_real_round(exh_real_scale(g, 32)) > UINT64_C(3) << 29; /* g > 3/8 */
    if (par->order == 1) {
        cfg->kind = high ? EXH_FILTER_HIGH1 : EXH_FILTER_LOW1;
        first(cfg, g);
        return 0;
    }
    const struct exh_real one_more = exh_real_add(exh_real_of(1), exh_real_mul(g, damp));
    cfg->kind = high ? EXH_FILTER_HIGH2 : EXH_FILTER_LOW2;
    if (high) {
        high2(cfg, g, one_more);
    } else {
        low2(cfg, g, damp, one_more);
    }
    return 0;
}

/* --- the tick --- */

/* No input moves a low kind's state this far; only damaged bytes do. */
#define BEYOND (INT64_C(5) << (31 - 2 + POS_Q)) /* 5/4 of full scale */

/* The output where it does not fit. A state that no input can cause starts anew there. */
static int32_t clipped(struct exh_filter *s, int64_t low)
{
    const int32_t y = low < 0 ? INT32_MIN : INT32_MAX;
    EXH_SATURATED();
    if (low > BEYOND || low < -BEYOND) { exh_filter_reset(s, &y, 1); }
    return y;
}

static inline int32_t output(struct exh_filter *s, int64_t low)
{
    const int64_t y = low >> POS_Q;
    return y >= INT32_MIN && y <= INT32_MAX ? (int32_t)y : clipped(s, low);
}

/* Damaged bytes may wrap here, which clipped() finds. Nothing else comes near. */
static void step_low2(struct exh_filter *s, const struct exh_filter_cfg *cfg, const int32_t *x,
                      int32_t *y, unsigned n)
{
    const uint32_t a = (uint32_t)cfg->a;
    const int32_t b = cfg->b, c = cfg->c;
    const unsigned shift = cfg->shift & 31;
    for (unsigned i = 0; i < n; i++) {
        const int64_t e = x[i] - (s[i].pos >> POS_Q);
        const uint64_t drive = (uint64_t)e * a;
        const int64_t friction = (s[i].vel >> VEL_Q) * b;
        const int64_t v = exh_from_u64(drive - (uint64_t)friction) >> shift;
        const int64_t p = exh_wrap_add64(s[i].vel, v);
        const int64_t move = (p >> VEL_Q) * c;
        const int64_t low = exh_wrap_add64(s[i].pos, move);
        s[i].vel = exh_wrap_add64(p, v);
        s[i].pos = exh_wrap_add64(low, move);
        y[i] = output(&s[i], low);
    }
}

static void step_low1(struct exh_filter *s, const struct exh_filter_cfg *cfg, const int32_t *x,
                      int32_t *y, unsigned n)
{
    const uint32_t a = (uint32_t)cfg->a;
    const unsigned shift = cfg->shift & 31;
    for (unsigned i = 0; i < n; i++) {
        const int64_t e = x[i] - (s[i].pos >> POS_Q);
        const int64_t move = exh_from_u64((uint64_t)e * a) >> shift;
        const int64_t low = exh_wrap_add64(s[i].pos, move);
        s[i].pos = exh_wrap_add64(low, move);
        y[i] = output(&s[i], low);
    }
}

/* States of the high kinds swing up to 32 times the input where that swings at half the
 * rate. There they stop, which takes energy and so cannot start an oscillation. */
static int64_t bounded(int64_t v)
{
    const int64_t most = INT64_C(1) << (31 + 5 + POS_Q);
    return v > most ? most : v < -most ? -most : v;
}

static void step_high2(struct exh_filter *s, const struct exh_filter_cfg *cfg, const int32_t *x,
                       int32_t *y, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        const int64_t pos = bounded(s[i].pos), vel = bounded(s[i].vel);
        const int64_t e = (int64_t)x[i] * (1 << POS_Q) + HALF - pos;
        const int64_t mid = exh_mul64_q31(vel, cfg->a) + exh_mul64_q31(e, cfg->b);
        const int64_t move = exh_mul64_q31(vel, cfg->c) + exh_mul64_q31(e, cfg->d);
        const int64_t low = pos + move;
        s[i].vel = 2 * mid - vel;
        s[i].pos = low + move;
        y[i] = exh_sat32(low >> POS_Q);
    }
}

static void step_high1(struct exh_filter *s, const struct exh_filter_cfg *cfg, const int32_t *x,
                       int32_t *y, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        const int64_t pos = bounded(s[i].pos);
        const int64_t e = (int64_t)x[i] * (1 << POS_Q) + HALF - pos;
        const int64_t move = exh_mul64_q31(e, cfg->a);
        const int64_t low = pos + move;
        s[i].pos = low + move;
        y[i] = exh_sat32(low >> POS_Q);
    }
}

void exh_filter_step(struct exh_filter *s, const struct exh_filter_cfg *cfg, const int32_t *x,
                     int32_t *y, unsigned n)
{
    switch ((enum exh_filter_kind)cfg->kind) {
    case EXH_FILTER_LOW2: step_low2(s, cfg, x, y, n); break;
    case EXH_FILTER_LOW1: step_low1(s, cfg, x, y, n); break;
    case EXH_FILTER_HIGH2: step_high2(s, cfg, x, y, n); break;
    case EXH_FILTER_HIGH1: step_high1(s, cfg, x, y, n); break;
    default: EXH_ASSERT(0);
    }
}

/* --- around it --- */

void exh_filter_reset(struct exh_filter *s, const int32_t *x, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        s[i].pos = (int64_t)x[i] * (1 << POS_Q) + HALF;
        s[i].vel = 0;
    }
}

static int second_order(const struct exh_filter_cfg *cfg)
{
    return cfg->kind == EXH_FILTER_LOW2 || cfg->kind == EXH_FILTER_HIGH2;
}

void exh_filter_retune(struct exh_filter *s, unsigned n, const struct exh_filter_cfg *from,
                       const struct exh_filter_cfg *to)
{
    const int both = second_order(from) && second_order(to);
    const int64_t most = INT64_C(1) << 62;
    for (unsigned i = 0; i < n; i++) {
        if (!both) { s[i].vel = 0; }
        if (from->kind == EXH_FILTER_LOW2 && to->kind == EXH_FILTER_HIGH2) {
            s[i].vel >>= VEL_Q - POS_Q;
        }
        if (from->kind == EXH_FILTER_HIGH2 && to->kind == EXH_FILTER_LOW2) {
            const int64_t fits = most >> (VEL_Q - POS_Q);
            const int64_t vel = s[i].vel > fits ? fits : s[i].vel < -fits ? -fits : s[i].vel;
            s[i].vel = vel * (1 << (VEL_Q - POS_Q));
        }
        if (to->kind == EXH_FILTER_LOW2 || to->kind == EXH_FILTER_LOW1) {
            const int64_t fits = INT64_C(1) << (31 + POS_Q);
            s[i].pos = s[i].pos > fits ? fits : s[i].pos < -fits ? -fits : s[i].pos;
        }
    }
}

void exh_filter_bytes(struct exh_bytes *c, struct exh_filter *s)
{
    exh_bytes_i64(c, &s->pos);
    exh_bytes_i64(c, &s->vel);
}
