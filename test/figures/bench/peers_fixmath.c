/* SPDX-License-Identifier: MIT */
/* libfixmath's products in a biquad of direct form I, and its sines. Full scale is 2^13, so that
 * the format's integer bits hold signal, too: coefficients have 16 fraction bits, samples 29. */
#include "peers.h"
#include "peers_fixmath.h"

#define FULL_BITS 29

static struct {
    fix16_t b0, b1, b2, a1, a2, x1, x2, y1, y2;
} biquad[CHANNELS];
static fix16_t in[BENCH_OPS + BLOCK], out[BLOCK];

static long double native(long double x) { return peer_round(x, FULL_BITS); }

static void setup(const struct butterworth *f)
{
    for (uint32_t k = 0; k < CHANNELS; k++) {
        biquad[k].b0 = fixmath_of(f->b0);
        biquad[k].b1 = fixmath_of(f->b1);
        biquad[k].b2 = fixmath_of(f->b2);
        biquad[k].a1 = fixmath_of(f->a1);
        biquad[k].a2 = fixmath_of(f->a2);
        biquad[k].x1 = biquad[k].x2 = biquad[k].y1 = biquad[k].y2 = 0;
    }
    for (uint32_t i = 0; i < BENCH_OPS + BLOCK; i++) { in[i] = peer_x_q31[i] >> (31 - FULL_BITS); }
}

/* b1 taken so that the gain at 0 Hz is 1, as a careful user would. */
static void adjusted(const struct butterworth *f)
{
    setup(f);
    for (uint32_t k = 0; k < CHANNELS; k++) {
        biquad[k].b1 = fix16_one + biquad[k].a1 + biquad[k].a2 - biquad[k].b0 - biquad[k].b2;
    }
}

static inline fix16_t one(uint32_t k, fix16_t x)
{
    const fix16_t y = fix16_mul(biquad[k].b0, x) + fix16_mul(biquad[k].b1, biquad[k].x1) +
                      fix16_mul(biquad[k].b2, biquad[k].x2) -
                      fix16_mul(biquad[k].a1, biquad[k].y1) - fix16_mul(biquad[k].a2, biquad[k].y2);
    biquad[k].x2 = biquad[k].x1;
    biquad[k].x1 = x;
    biquad[k].y2 = biquad[k].y1;
    biquad[k].y1 = y;
    return y;
}

static long double step(long double x)
{
    return one(0, (fix16_t)(x * (1 << FULL_BITS))) / (long double)(1 << FULL_BITS);
}

static void tick(uint32_t i)
{
    for (uint32_t k = 0; k < CHANNELS; k++) { out[k] = one(k, in[i + k]); }
}

static void block(uint32_t i)
{
    for (uint32_t k = 0; k < BLOCK; k++) { out[k] = one(0, in[i + k]); }
}

/* --- sines --- */

/* By parabola: half a turn either way is all it takes. */
static fix16_t parabola_cos(fix16_t rad)
{
    const fix16_t a = rad + (fix16_pi >> 1);
    return fix16_sin_parabola(a > fix16_pi ? a - 2 * fix16_pi : a);
}

#define SINE(name, sine_of, cosine_of) \
    static void name(uint32_t turn_q32, long double *sine, long double *cosine) \
    { \
        const fix16_t a = fixmath_rad((int32_t)turn_q32); \
        *sine = sine_of(a) / 65536.0L; \
        *cosine = cosine_of(a) / 65536.0L; \
    } \
    static void name##_op(uint32_t i) \
    { \
        const fix16_t a = fixmath_rad(peer_x_q31[i] * 2); \
        bench_sink = sine_of(a) + (int64_t)cosine_of(a); \
    }
SINE(series, fix16_sin, fix16_cos)
SINE(parabola, fix16_sin_parabola, parabola_cos)
SINE(table, fixmath_lut_sin, fixmath_lut_cos)

static const struct filter_peer filters[] = {
    {"libfixmath fix16 DF1", setup, native, step, tick, block, sizeof biquad[0], 0},
    {"libfixmath b1 adj.", adjusted, native, step, tick, block, sizeof biquad[0], 0},
};
static const struct sine_peer sines[] = {
    {"libfixmath sin + cos", series, series_op, 0},
    {"libfixmath parabola", parabola, parabola_op, 0},
    {"libfixmath 205 KB table", table, table_op, FIXMATH_LUT_B},
};

const struct peer_group fixmath_peers = {
    filters, sizeof filters / sizeof filters[0], sines, sizeof sines / sizeof sines[0]};
