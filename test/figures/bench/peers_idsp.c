/* SPDX-License-Identifier: MIT */
/* The crate idsp's filters and sine (peers_rust/), built by cargo with its own optimisation; where
 * it is not, its filters' twins in C. */
#include "idsp_twin.h"
#include "peers.h"

#include <math.h>

#ifdef PEERS_RUST
#define IDSP(name) idsp_##name
IDSP_FILTER(idsp_df1)
IDSP_FILTER(idsp_wide)
IDSP_FILTER(idsp_dither)
IDSP_FILTER(idsp_lowpass)
void idsp_sine(int32_t turn, int32_t *cosine, int32_t *sine);
#else
#define IDSP(name) twin_##name
#endif

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
        IDSP(name##_start)(ba); \
    }
BIQUAD(df1)
BIQUAD(wide)
BIQUAD(dither)

/* Gains whose poles are those of the bilinear transform: the recurrence's matrix has the required
 * trace and determinant. */
static void gains(const struct butterworth *f, int32_t k[2])
{
    k[0] = (int32_t)lrintl((1 + f->a1 + f->a2) / 4 * 4294967296.0L);
    k[1] = (int32_t)lrintl((f->a2 - f->a1 - 3) / 4 * 4294967296.0L);
}

static void lowpass_setup(const struct butterworth *f)
{
    int32_t k[2];
    gains(f, k);
    IDSP(lowpass_start)(k);
}

#define CALLS(name) \
    static long double name##_step(long double x) \
    { \
        return IDSP(name##_step)((int32_t)(x * 2147483648.0L)) / 2147483648.0L; \
    } \
    static void name##_tick(uint32_t i) { IDSP(name##_tick)(&peer_x_q31[i], out); } \
    static void name##_block(uint32_t i) \
    { \
        for (uint32_t k = 0; k < BLOCK; k++) { out[k] = IDSP(name##_step)(peer_x_q31[i + k]); } \
    }
CALLS(df1)
CALLS(wide)
CALLS(dither)
CALLS(lowpass)

/* With two bits of headroom, so that nothing wraps. */
static long double quarter_step(long double x) { return 4 * dither_step(native_q31(x / 4)); }

static void quarter_tick(uint32_t i)
{
    int32_t in[CHANNELS];
    for (uint32_t k = 0; k < CHANNELS; k++) { in[k] = peer_x_q31[i + k] >> 2; }
    IDSP(dither_tick)(in, out);
    for (uint32_t k = 0; k < CHANNELS; k++) { out[k] *= 4; }
}

static void quarter_block(uint32_t i)
{
    for (uint32_t k = 0; k < BLOCK; k++) { out[k] = 4 * IDSP(dither_step)(peer_x_q31[i + k] >> 2); }
}

static const struct filter_peer filters[] = {
    {"idsp DF1", df1_setup, native_q31, df1_step, df1_tick, df1_block, 36, 0},
    {"idsp DF1Wide", wide_setup, native_q31, wide_step, wide_tick, wide_block, 48, 0},
    {"idsp DF1Dither", dither_setup, native_q31, dither_step, dither_tick, dither_block, 40, 0},
    {"idsp DF1Dither x/4", dither_setup, native_q31, quarter_step, quarter_tick, quarter_block, 40,
        0},
    {"idsp Lowpass<2>", lowpass_setup, native_q31, lowpass_step, lowpass_tick, lowpass_block, 24,
        0.15L},
};

#ifdef PEERS_RUST
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

static const struct sine_peer sines[] = {{"idsp cossin", both, both_op, 512}};

/* A million samples at every cut-off, noise of full scale and the crate's own wraps among them. */
#define SAME(name) \
    static int name##_same(const int32_t *k) \
    { \
        idsp_##name##_start(k); \
        twin_##name##_start(k); \
        for (uint32_t i = 0; i < 1000000; i++) { \
            const int32_t x = i / 1000 % 2 ? bench_i32() : INT32_MAX; \
            if (idsp_##name##_step(x) != twin_##name##_step(x)) { return 0; } \
        } \
        return 1; \
    }
SAME(df1)
SAME(wide)
SAME(dither)
SAME(lowpass)

int idsp_twins_same(const struct butterworth *f)
{
    int32_t ba[5], k[2];
    biquad(f, ba);
    gains(f, k);
    return df1_same(ba) && wide_same(ba) && dither_same(ba) && lowpass_same(k);
}

const struct peer_group idsp_peers = {
    filters, sizeof filters / sizeof filters[0], sines, sizeof sines / sizeof sines[0]};
#else
const struct peer_group idsp_peers = {filters, sizeof filters / sizeof filters[0], NULL, 0};
#endif
