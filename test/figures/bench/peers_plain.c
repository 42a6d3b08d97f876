/* SPDX-License-Identifier: MIT */
/* Ours, and what anybody would write in floating point. */
#include "peers.h"

#include "exhand/exhand.h"

#include <math.h>

static long double native_q31(long double x) { return peer_round(x, 31); }

/* --- ours --- */

static struct exh_filter_cfg cfg;
static struct exh_filter state[CHANNELS];
static int32_t y_q31[BLOCK];

static void ours_setup(const struct butterworth *f)
{
    const struct exh_filter_par par = {2, (int32_t)(f->fc << 16)};
    const int32_t zero[CHANNELS] = {0};
    EXH_ASSERT(exh_filter_setup(&cfg, &par, (struct exh_period){1, f->fs}) == 0);
    exh_filter_reset(state, zero, CHANNELS);
}

static long double ours_step(long double x)
{
    const int32_t in = (int32_t)(x * 2147483648.0L);
    int32_t y;
    exh_filter_step(state, &cfg, &in, &y, 1);
    return y / 2147483648.0L;
}

static void ours_tick(uint32_t i) { exh_filter_step(state, &cfg, &peer_x_q31[i], y_q31, CHANNELS); }

static void ours_block(uint32_t i)
{
    for (uint32_t k = 0; k < BLOCK; k++) {
        exh_filter_step(state, &cfg, &peer_x_q31[i + k], &y_q31[k], 1);
    }
}

static struct exh_filter_cheap_cfg cheap_cfg;
static struct exh_filter_cheap cheap[CHANNELS];

static void cheap_setup(const struct butterworth *f)
{
    const struct exh_filter_par par = {2, (int32_t)(f->fc << 16)};
    const int32_t zero[CHANNELS] = {0};
    EXH_ASSERT(exh_filter_cheap_setup(&cheap_cfg, &par, (struct exh_period){1, f->fs}) == 0);
    exh_filter_cheap_reset(cheap, &cheap_cfg, zero, CHANNELS);
}

static long double cheap_step(long double x)
{
    const int32_t in = (int32_t)(x * 2147483648.0L);
    int32_t y;
    exh_filter_cheap_step(cheap, &cheap_cfg, &in, &y, 1);
    return y / 2147483648.0L;
}

static void cheap_tick(uint32_t i)
{
    exh_filter_cheap_step(cheap, &cheap_cfg, &peer_x_q31[i], y_q31, CHANNELS);
}

static void cheap_block(uint32_t i)
{
    for (uint32_t k = 0; k < BLOCK; k++) {
        exh_filter_cheap_step(cheap, &cheap_cfg, &peer_x_q31[i + k], &y_q31[k], 1);
    }
}

static void ours_sine(uint32_t turn_q32, long double *sine, long double *cosine)
{
    struct exh_sincos y;
    exh_sincos(exh_from_u32(turn_q32), &y);
    *sine = bench_q(y.sin_q30, 30);
    *cosine = bench_q(y.cos_q30, 30);
}

static void ours_sine_op(uint32_t i)
{
    struct exh_sincos y;
    exh_sincos(peer_x_q31[i] * 2, &y);
    bench_sink = y.sin_q30 + (int64_t)y.cos_q30;
}

/* The C library's, in radians; both of one angle, which the compiler makes one call. */
static void double_sine(uint32_t turn_q32, long double *sine, long double *cosine)
{
    const double a = turn_q32 * (6.28318530717958647692 / 4294967296.0);
    *sine = sin(a);
    *cosine = cos(a);
}

static void float_sine(uint32_t turn_q32, long double *sine, long double *cosine)
{
    const float a = (float)(exh_from_u32(turn_q32) * (6.28318530717958647692 / 4294967296.0));
    *sine = sinf(a);
    *cosine = cosf(a);
}

static volatile double sink_double;
static volatile float sink_float;

static void double_sine_op(uint32_t i)
{
    const double a = peer_x_f64[i] * 3.14159265358979;
    sink_double = sin(a) + cos(a);
}

static void float_sine_op(uint32_t i)
{
    const float a = peer_x_f32[i] * 3.14159265f;
    sink_float = sinf(a) + cosf(a);
}

/* --- plain --- */

#define PLAIN(type, in) \
    static struct { \
        type b0, b1, b2, a1, a2, s1, s2; \
    } type##_biquad[CHANNELS]; \
    static type type##_out[BLOCK]; \
    static inline type type##_one(uint32_t k, type x) \
    { \
        const type y = type##_biquad[k].b0 * x + type##_biquad[k].s1; \
        type##_biquad[k].s1 = \
            type##_biquad[k].b1 * x - type##_biquad[k].a1 * y + type##_biquad[k].s2; \
        type##_biquad[k].s2 = type##_biquad[k].b2 * x - type##_biquad[k].a2 * y; \
        return y; \
    } \
    static void type##_setup(const struct butterworth *f) \
    { \
        for (uint32_t k = 0; k < CHANNELS; k++) { \
            type##_biquad[k].b0 = (type)f->b0; \
            type##_biquad[k].b1 = (type)f->b1; \
            type##_biquad[k].b2 = (type)f->b2; \
            type##_biquad[k].a1 = (type)f->a1; \
            type##_biquad[k].a2 = (type)f->a2; \
            type##_biquad[k].s1 = type##_biquad[k].s2 = 0; \
        } \
    } \
    static long double type##_native(long double x) { return (type)x; } \
    static long double type##_step(long double x) { return type##_one(0, (type)x); } \
    static void type##_tick(uint32_t i) \
    { \
        for (uint32_t k = 0; k < CHANNELS; k++) { type##_out[k] = type##_one(k, in[i + k]); } \
    } \
    static void type##_block(uint32_t i) \
    { \
        for (uint32_t k = 0; k < BLOCK; k++) { type##_out[k] = type##_one(0, in[i + k]); } \
    }

PLAIN(float, peer_x_f32)
PLAIN(double, peer_x_f64)

static const struct filter_peer filters[] = {
    {"exhand", ours_setup, native_q31, ours_step, ours_tick, ours_block, sizeof state[0], 0},
    {"exhand-cheap", cheap_setup, native_q31, cheap_step, cheap_tick, cheap_block, sizeof cheap[0],
        0},
    {"plain double DF2T", double_setup, double_native, double_step, double_tick, double_block,
        sizeof double_biquad[0], 0},
    {"plain float DF2T", float_setup, float_native, float_step, float_tick, float_block,
        sizeof float_biquad[0], 0},
};
static const struct sine_peer sines[] = {{"exhand sincos", ours_sine, ours_sine_op, 0},
    {"libm double sin + cos", double_sine, double_sine_op, 0},
    {"libm float sinf + cosf", float_sine, float_sine_op, 0}};

const struct peer_group plain_peers = {
    filters, sizeof filters / sizeof filters[0], sines, sizeof sines / sizeof sines[0]};
