/* SPDX-License-Identifier: MIT */
/* The glove's 22 channels: low-passes and quantizer. */
#include "bench.h"

#include "exhand/exhand.h"

#include <math.h>

#define CHANNELS 22u
#define PI       3.141592653589793238462643383279502884L

static struct exh_filter_cfg cfg;
static struct exh_filter state[CHANNELS];
static struct exh_filter_cheap_cfg cheap_cfg;
static struct exh_filter_cheap cheap[CHANNELS];
static struct exh_quantizer_cfg code_cfg;
static struct exh_quantizer code[CHANNELS];
static int32_t x[BENCH_OPS + CHANNELS], y[CHANNELS];

/* fc is 1/ticks of the rate, times tenths/10. */
static void tune(int32_t order, uint32_t ticks, int32_t tenths)
{
    const struct exh_filter_par par = {order, (int32_t)((INT64_C(65536) * tenths) / 10)};
    EXH_ASSERT(exh_filter_setup(&cfg, &par, (struct exh_period){1, ticks}) == 0);
    if (order == 2) {
        EXH_ASSERT(exh_filter_cheap_setup(&cheap_cfg, &par, (struct exh_period){1, ticks}) == 0);
    }
}

static void inputs(void)
{
    const int32_t zero[CHANNELS] = {0};
    bench_seed();
    for (uint32_t i = 0; i < BENCH_OPS + CHANNELS; i++) { x[i] = bench_in(-794568949, 794568949); }
    exh_filter_reset(state, zero, CHANNELS);
    exh_filter_cheap_reset(cheap, &cheap_cfg, zero, CHANNELS);
}

static void second_setup(void)
{
    tune(2, 100, 10);
    inputs();
}

static void first_setup(void)
{
    tune(1, 100, 10);
    inputs();
}

static void high_setup(void)
{
    tune(2, 10, 25);
    inputs();
}

static void filter_op(uint32_t i) { exh_filter_step(state, &cfg, &x[i], y, CHANNELS); }

static void cheap_op(uint32_t i) { exh_filter_cheap_step(cheap, &cheap_cfg, &x[i], y, CHANNELS); }

static void quantizer_setup(void)
{
    const struct exh_quantizer_par par = {14, 1 << 18};
    EXH_ASSERT(exh_quantizer_setup(&code_cfg, &par) == 0);
    inputs();
}

static void quantizer_op(uint32_t i)
{
    for (uint32_t k = 0; k < CHANNELS; k++) {
        y[k] = exh_quantizer_step(&code[k], &code_cfg, x[i + k]);
    }
}

/* The same filters in long double, input and output in LSB. */
static struct {
    long double g, d, s1, s2;
    int32_t order;
} ref;

static long double ref_step(long double in)
{
    long double low;
    if (ref.order == 1) {
        const long double move = (in - ref.s2) * ref.g / (1 + ref.g);
        low = ref.s2 + move;
    } else {
        const long double band = (ref.s1 + ref.g * (in - ref.s2)) / ref.d;
        low = ref.s2 + ref.g * band;
        ref.s1 = 2 * band - ref.s1;
    }
    ref.s2 = 2 * low - ref.s2;
    return low;
}

static int32_t exact_step(int32_t in)
{
    int32_t out;
    exh_filter_step(state, &cfg, &in, &out, 1);
    return out;
}

static int32_t cheap_step(int32_t in)
{
    int32_t out;
    exh_filter_cheap_step(cheap, &cheap_cfg, &in, &out, 1);
    return out;
}

/* A step of 0.37, a sine at fc, and noise of full scale times noise, which at 1 clips. */
static void step_error(struct error *e, int32_t (*step)(int32_t in), long double noise,
    int32_t order, uint32_t ticks, int32_t tenths)
{
    const int32_t n = (int32_t)(30 * ticks * 10 / (uint32_t)tenths);
    const long double r = tenths / (10.0L * ticks);
    for (int kind = 0; kind < 3; kind++) {
        tune(order, ticks, tenths);
        inputs();
        ref.g = tanl(PI * r);
        ref.d = 1 + ref.g * (ref.g + sqrtl(2));
        ref.s1 = ref.s2 = 0;
        ref.order = order;
        for (int32_t t = 0; t < n; t++) {
            const int32_t in = kind == 0   ? 794568949
                               : kind == 1 ? (int32_t)lrintl(794568949 * sinl(2 * PI * r * t))
                                           : (int32_t)lrintl(noise * bench_i32());
            error_add(e, step(in) - bench_clamp(ref_step(in), INT32_MIN, INT32_MAX));
        }
    }
}

static void one_error(struct error *e, int32_t order, uint32_t ticks, int32_t tenths)
{
    step_error(e, exact_step, 1, order, ticks, tenths);
}

static void second_error(struct error *e)
{
    for (uint32_t ticks = 10; ticks <= 10000; ticks *= 10) { one_error(e, 2, ticks, 10); }
}

static void first_error(struct error *e)
{
    for (uint32_t ticks = 10; ticks <= 10000; ticks *= 10) { one_error(e, 1, ticks, 10); }
}

static void high_error(struct error *e)
{
    one_error(e, 2, 1000, 1200);
    one_error(e, 2, 1000, 2500);
    one_error(e, 2, 1000, 4000);
    one_error(e, 2, 1000, 4500);
}

static void cheap_error(struct error *e)
{
    for (uint32_t ticks = 10; ticks <= 10000; ticks *= 10) {
        step_error(e, cheap_step, 0.8L, 2, ticks, 10);
    }
}

static void cheap_high_error(struct error *e)
{
    step_error(e, cheap_step, 0.8L, 2, 1000, 690);
    step_error(e, cheap_step, 0.7L, 2, 1000, 2500);
    step_error(e, cheap_step, 0.48L, 2, 1000, 4000);
    step_error(e, cheap_step, 0.48L, 2, 1000, 4500);
}

static void quantizer_error(struct error *e)
{
    const struct exh_quantizer_par par = {14, 1 << 18};
    struct exh_quantizer s = {0, 0};
    (void)exh_quantizer_setup(&code_cfg, &par);
    bench_seed();
    for (int i = 0; i < 1000000; i++) {
        const int32_t in = bench_i32();
        error_add(e, (exh_quantizer_step(&s, &code_cfg, in) - (long double)in) / (1 << 18));
    }
}

#define IDSP \
    "idsp Lowpass<2>, 0.011 to 156 ppm, latches, private harness, rustc 1.95; i686 1564 by a C " \
    "twin"

static const struct kernel kernels[] = {
    {"filter_2_x22", "FS", 1 / 2147483648.0, 2.5, 1, second_setup, filter_op, second_error,
        "half an LSB of input and output, states' words; steps, sines and noise at fc/fs 0.1, "
        "0.01, "
        "0.001, 0.0001",
        708, IDSP},
    {"filter_1_x22", "FS", 1 / 2147483648.0, 2.5, 1, first_setup, filter_op, first_error,
        "as above", 0, NULL},
    {"filter_2_high_x22", "FS", 1 / 2147483648.0, 6, 1, high_setup, filter_op, high_error,
        "coefficients rounded at 2^-32; as above at fc/fs 0.12, 0.25, 0.4, 0.45", 0, NULL},
    {"filter_cheap_x22", "FS", 1 / 2147483648.0, 633, 1, second_setup, cheap_op, cheap_error,
        "b, c rounded at 10^-4: 8 LSB + rate/(16 fc) LSB; as above, noise at 0.8 of full scale", 0,
        NULL},
    {"filter_cheap_high_x22", "FS", 1 / 2147483648.0, 80, 1, high_setup, cheap_op, cheap_high_error,
        "coefficients rounded at 2^-30; as above at fc/fs 0.069, 0.25, 0.4, 0.45, noise that "
        "does not clip",
        0, NULL},
    {"quantizer_x22", "code", 1, 1, 1, quantizer_setup, quantizer_op, quantizer_error,
        "half a code and half the hysteresis of one code; 14 bits", 0, NULL},
};
const struct kernel_group filter_group = {kernels, sizeof kernels / sizeof kernels[0]};
