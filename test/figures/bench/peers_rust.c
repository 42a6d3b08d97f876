/* SPDX-License-Identifier: MIT */
/* The crate idsp's filters and sine (peers_rust/), built by cargo with its own optimisation. */
#include "peers.h"

#include <math.h>

void idsp_df1_start(const int32_t *ba);
int32_t idsp_df1_step(int32_t x);
void idsp_df1_tick(const int32_t *x, int32_t *y);
void idsp_wide_start(const int32_t *ba);
int32_t idsp_wide_step(int32_t x);
void idsp_wide_tick(const int32_t *x, int32_t *y);
void idsp_dither_start(const int32_t *ba);
int32_t idsp_dither_step(int32_t x);
void idsp_dither_tick(const int32_t *x, int32_t *y);
void idsp_lowpass_start(const int32_t *k);
int32_t idsp_lowpass_step(int32_t x);
void idsp_lowpass_tick(const int32_t *x, int32_t *y);
void idsp_sine(int32_t turn, int32_t *cosine, int32_t *sine);

static int32_t out[BLOCK];

static long double native_q31(long double x) { return peer_round(x, 31); }

/* Coefficients of 30 fraction bits, b1 taken so that the gain at 0 Hz is 1, as a careful user
 * would. */
static void biquad(const struct butterworth *f, int32_t ba[5])
{
    ba[0] = (int32_t)lrintl(f->b0 * (1 << 30));
    ba[2] = (int32_t)lrintl(f->b2 * (1 << 30));
    ba[3] = (int32_t)lrintl(-f->a1 * (1 << 30));
    ba[4] = (int32_t)lrintl(-f->a2 * (1 << 30));
    ba[1] = (1 << 30) - ba[3] - ba[4] - ba[0] - ba[2];
}

#define BIQUAD(name) \
    static void name##_setup(const struct butterworth *f) \
    { \
        int32_t ba[5]; \
        biquad(f, ba); \
        idsp_##name##_start(ba); \
    }
BIQUAD(df1)
BIQUAD(wide)
BIQUAD(dither)

/* Gains whose poles are those of the bilinear transform: the recurrence's matrix has the trace and
 * determinant asked for. */
static void lowpass_setup(const struct butterworth *f)
{
    const int32_t k[2] = {(int32_t)lrintl((1 + f->a1 + f->a2) / 4 * 4294967296.0L),
        (int32_t)lrintl((f->a2 - f->a1 - 3) / 4 * 4294967296.0L)};
    idsp_lowpass_start(k);
}

#define CALLS(name) \
    static long double name##_step(long double x) \
    { \
        return idsp_##name##_step((int32_t)(x * 2147483648.0L)) / 2147483648.0L; \
    } \
    static void name##_tick(uint32_t i) { idsp_##name##_tick(&peer_x_q31[i], out); } \
    static void name##_block(uint32_t i) \
    { \
        for (uint32_t k = 0; k < BLOCK; k++) { out[k] = idsp_##name##_step(peer_x_q31[i + k]); } \
    }
CALLS(df1)
CALLS(wide)
CALLS(dither)
CALLS(lowpass)

static void both(uint32_t turn_q32, long double *sine, long double *cosine)
{
    int32_t s, c;
    idsp_sine((int32_t)turn_q32, &c, &s);
    *sine = bench_q(s, 31);
    *cosine = bench_q(c, 31);
}

static void both_op(uint32_t i)
{
    int32_t s, c;
    idsp_sine(peer_x_q31[i] * 2, &c, &s);
    bench_sink = s + (int64_t)c;
}

static const struct filter_peer filters[] = {
    {"idsp Biquad<Q30> DF1", df1_setup, native_q31, df1_step, df1_tick, df1_block, 36},
    {"idsp DF1Wide", wide_setup, native_q31, wide_step, wide_tick, wide_block, 48},
    {"idsp DF1Dither", dither_setup, native_q31, dither_step, dither_tick, dither_block, 40},
    {"idsp Lowpass<2> poles matched", lowpass_setup, native_q31, lowpass_step, lowpass_tick,
        lowpass_block, 24},
};
static const struct sine_peer sines[] = {{"idsp cossin", both, both_op, 512}};

const struct peer_group rust_peers = {
    filters, sizeof filters / sizeof filters[0], sines, sizeof sines / sizeof sines[0]};
