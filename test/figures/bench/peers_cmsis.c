/* SPDX-License-Identifier: MIT */
/* CMSIS-DSP's biquads and sines by its plain C paths, as its functions are called. */
#include "peers.h"

#include "dsp/controller_functions.h"
#include "dsp/fast_math_functions.h"
#include "dsp/filtering_functions.h"

#include <math.h>
#include <string.h>

static union {
    q31_t q31[5];
    q15_t q15[6];
    float f32[5];
    double f64[5];
} coeff[CHANNELS];

static long double native_q31(long double x) { return peer_round(x, 31); }

static long double native_q15(long double x) { return peer_round(x, 15); }

/* Coefficients of 30 fraction bits (postShift 1), the signs of a turned. adjusted: b1 taken
 * so that the gain at 0 Hz is 1 in spite of the rounding, as a careful user would. */
static void q31_coeff(const struct butterworth *f, int adjusted)
{
    for (uint32_t k = 0; k < CHANNELS; k++) {
        q31_t *c = coeff[k].q31;
        c[0] = (q31_t)lrintl(f->b0 * (1 << 30));
        c[1] = (q31_t)lrintl(f->b1 * (1 << 30));
        c[2] = (q31_t)lrintl(f->b2 * (1 << 30));
        c[3] = (q31_t)lrintl(-f->a1 * (1 << 30));
        c[4] = (q31_t)lrintl(-f->a2 * (1 << 30));
        if (adjusted) { c[1] = (1 << 30) - c[3] - c[4] - c[0] - c[2]; }
    }
}

static q31_t out_q31[BLOCK];

#define Q31_PEER(name, inst, words, start, run) \
    static inst name[CHANNELS]; \
    static words name##_state[CHANNELS][4]; \
    static void name##_start(void) \
    { \
        for (uint32_t k = 0; k < CHANNELS; k++) { \
            start(&name[k], 1, coeff[k].q31, name##_state[k], 1); \
        } \
    } \
    static void name##_setup(const struct butterworth *f) \
    { \
        q31_coeff(f, 0); \
        name##_start(); \
    } \
    static void name##_adjusted(const struct butterworth *f) \
    { \
        q31_coeff(f, 1); \
        name##_start(); \
    } \
    static long double name##_step(long double x) \
    { \
        q31_t in = (q31_t)(x * 2147483648.0L), y; \
        run(&name[0], &in, &y, 1); \
        return y / 2147483648.0L; \
    } \
    static void name##_tick(uint32_t i) \
    { \
        for (uint32_t k = 0; k < CHANNELS; k++) { \
            run(&name[k], &peer_x_q31[i + k], &out_q31[k], 1); \
        } \
    } \
    static void name##_block(uint32_t i) { run(&name[0], &peer_x_q31[i], out_q31, BLOCK); }

Q31_PEER(df1, arm_biquad_casd_df1_inst_q31, q31_t, arm_biquad_cascade_df1_init_q31,
    arm_biquad_cascade_df1_q31)
Q31_PEER(fast, arm_biquad_casd_df1_inst_q31, q31_t, arm_biquad_cascade_df1_init_q31,
    arm_biquad_cascade_df1_fast_q31)
Q31_PEER(wide, arm_biquad_cas_df1_32x64_ins_q31, q63_t, arm_biquad_cas_df1_32x64_init_q31,
    arm_biquad_cas_df1_32x64_q31)

/* The manual asks for two bits of headroom in q31. */
static long double quarter_step(long double x) { return 4 * df1_step(native_q31(x / 4)); }

static void quarter_tick(uint32_t i)
{
    for (uint32_t k = 0; k < CHANNELS; k++) {
        const q31_t in = peer_x_q31[i + k] >> 2;
        arm_biquad_cascade_df1_q31(&df1[k], &in, &out_q31[k], 1);
        out_q31[k] *= 4;
    }
}

static void quarter_block(uint32_t i)
{
    q31_t in[BLOCK];
    for (uint32_t k = 0; k < BLOCK; k++) { in[k] = peer_x_q31[i + k] >> 2; }
    arm_biquad_cascade_df1_q31(&df1[0], in, out_q31, BLOCK);
    for (uint32_t k = 0; k < BLOCK; k++) { out_q31[k] *= 4; }
}

static arm_biquad_casd_df1_inst_q15 q15[CHANNELS];
static q15_t q15_state[CHANNELS][4], out_q15[BLOCK];

static void q15_setup(const struct butterworth *f)
{
    for (uint32_t k = 0; k < CHANNELS; k++) {
        q15_t *c = coeff[k].q15;
        c[0] = (q15_t)lrintl(f->b0 * (1 << 14));
        c[1] = 0;
        c[2] = (q15_t)lrintl(f->b1 * (1 << 14));
        c[3] = (q15_t)lrintl(f->b2 * (1 << 14));
        c[4] = (q15_t)lrintl(-f->a1 * (1 << 14));
        c[5] = (q15_t)lrintl(-f->a2 * (1 << 14));
        arm_biquad_cascade_df1_init_q15(&q15[k], 1, c, q15_state[k], 1);
    }
}

static long double q15_step(long double x)
{
    q15_t in = (q15_t)(x * 32768), y;
    arm_biquad_cascade_df1_q15(&q15[0], &in, &y, 1);
    return y / 32768.0L;
}

static void q15_tick(uint32_t i)
{
    for (uint32_t k = 0; k < CHANNELS; k++) {
        arm_biquad_cascade_df1_q15(&q15[k], &peer_x_q15[i + k], &out_q15[k], 1);
    }
}

static void q15_block(uint32_t i)
{
    arm_biquad_cascade_df1_q15(&q15[0], &peer_x_q15[i], out_q15, BLOCK);
}

#define FLOAT_PEER(name, type, bits, inst, start, run) \
    static inst name[CHANNELS]; \
    static type name##_state[CHANNELS][2], name##_out[BLOCK]; \
    static void name##_setup(const struct butterworth *f) \
    { \
        for (uint32_t k = 0; k < CHANNELS; k++) { \
            type *c = coeff[k].bits; \
            c[0] = (type)f->b0; \
            c[1] = (type)f->b1; \
            c[2] = (type)f->b2; \
            c[3] = (type)-f->a1; \
            c[4] = (type)-f->a2; \
            start(&name[k], 1, c, name##_state[k]); \
        } \
    } \
    static long double name##_native(long double x) { return (type)x; } \
    static long double name##_step(long double x) \
    { \
        type in = (type)x, y; \
        run(&name[0], &in, &y, 1); \
        return y; \
    } \
    static void name##_tick(uint32_t i) \
    { \
        for (uint32_t k = 0; k < CHANNELS; k++) { \
            run(&name[k], &peer_x_##bits[i + k], &name##_out[k], 1); \
        } \
    } \
    static void name##_block(uint32_t i) { run(&name[0], &peer_x_##bits[i], name##_out, BLOCK); }

FLOAT_PEER(f32, float, f32, arm_biquad_cascade_df2T_instance_f32, arm_biquad_cascade_df2T_init_f32,
    arm_biquad_cascade_df2T_f32)
FLOAT_PEER(f64, double, f64, arm_biquad_cascade_df2T_instance_f64, arm_biquad_cascade_df2T_init_f64,
    arm_biquad_cascade_df2T_f64)

static const struct filter_peer filters[] = {
    {"CMSIS df1_q31", df1_setup, native_q31, df1_step, df1_tick, df1_block,
        sizeof df1[0] + sizeof df1_state[0] + 5 * sizeof(q31_t), 0},
    {"CMSIS df1_q31 b1 adj.", df1_adjusted, native_q31, df1_step, df1_tick, df1_block,
        sizeof df1[0] + sizeof df1_state[0] + 5 * sizeof(q31_t), 0},
    {"CMSIS df1_q31 x/4", df1_adjusted, native_q31, quarter_step, quarter_tick, quarter_block,
        sizeof df1[0] + sizeof df1_state[0] + 5 * sizeof(q31_t), 0},
    {"CMSIS df1_fast_q31", fast_setup, native_q31, fast_step, fast_tick, fast_block,
        sizeof fast[0] + sizeof fast_state[0] + 5 * sizeof(q31_t), 0},
    {"CMSIS fast b1 adj.", fast_adjusted, native_q31, fast_step, fast_tick, fast_block,
        sizeof fast[0] + sizeof fast_state[0] + 5 * sizeof(q31_t), 0},
    {"CMSIS df1_32x64_q31", wide_setup, native_q31, wide_step, wide_tick, wide_block,
        sizeof wide[0] + sizeof wide_state[0] + 5 * sizeof(q31_t), 0},
    {"CMSIS 32x64 b1 adj.", wide_adjusted, native_q31, wide_step, wide_tick, wide_block,
        sizeof wide[0] + sizeof wide_state[0] + 5 * sizeof(q31_t), 0},
    {"CMSIS df1_q15", q15_setup, native_q15, q15_step, q15_tick, q15_block,
        sizeof q15[0] + sizeof q15_state[0] + 6 * sizeof(q15_t), 0},
    {"CMSIS df2T_f32", f32_setup, f32_native, f32_step, f32_tick, f32_block,
        sizeof f32[0] + sizeof f32_state[0] + 5 * sizeof(float), 0},
    {"CMSIS df2T_f64", f64_setup, f64_native, f64_step, f64_tick, f64_block,
        sizeof f64[0] + sizeof f64_state[0] + 5 * sizeof(double), 0},
};

/* --- sines: arm_sin_q31 takes 0 .. 1 as a turn, arm_sin_cos_q31 -1 .. 1 as half turns --- */

static void single(uint32_t turn_q32, long double *sine, long double *cosine)
{
    const q31_t turn = (q31_t)(turn_q32 >> 1);
    *sine = bench_q(arm_sin_q31(turn), 31);
    *cosine = bench_q(arm_cos_q31(turn), 31);
}

static void single_op(uint32_t i)
{
    const q31_t turn = peer_x_q31[i] & INT32_MAX;
    bench_sink = arm_sin_q31(turn) + (int64_t)arm_cos_q31(turn);
}

static void pair(uint32_t turn_q32, long double *sine, long double *cosine)
{
    q31_t s, c;
    arm_sin_cos_q31((q31_t)turn_q32, &s, &c);
    *sine = bench_q(s, 31);
    *cosine = bench_q(c, 31);
}

static void pair_op(uint32_t i)
{
    q31_t s, c;
    arm_sin_cos_q31(peer_x_q31[i] * 2, &s, &c);
    bench_sink = s + (int64_t)c;
}

static const struct sine_peer sines[] = {
    {"CMSIS sin_q31 + cos_q31", single, single_op, 513 * 4},
    {"CMSIS sin_cos_q31", pair, pair_op, 513 * 4},
};

const struct peer_group cmsis_peers = {
    filters, sizeof filters / sizeof filters[0], sines, sizeof sines / sizeof sines[0]};
