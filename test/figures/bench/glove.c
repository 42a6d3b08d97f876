/* SPDX-License-Identifier: MIT */
/* Glove: a frame of 22 codes to 22 angles. */
#include "bench.h"

#include "exhand/exhand.h"

#include <string.h>

#define FRAMES 20000

static struct exh_glove_in in[BENCH_OPS];
static struct exh_glove_cal cal;
static struct exh_glove_cfg cfg;
static struct exh_glove state;

/* The default calibration, its abductions pulled along by two knuckles each. */
static void set_up(const struct exh_glove_par *par)
{
    static const uint8_t knuckle[][3] = {{3, 0, 1}, {10, 4, 7}, {14, 7, 11}, {18, 11, 15}};
    cal = exh_glove_cal_default;
    for (size_t i = 0; i < sizeof knuckle / sizeof knuckle[0]; i++) {
        struct exh_glove_sensor *s = &cal.sensor[knuckle[i][0]];
        s->of[0] = knuckle[i][1];
        s->of[1] = knuckle[i][2];
        s->cross_q30[0] = -(INT32_C(1) << 26) + 12345;
        s->cross_q30[1] = -(INT32_C(1) << 25) - 54321;
    }
    memset(&state, 0, sizeof state);
    (void)exh_glove_setup(&cfg, par, &cal, (struct exh_period){1, 2000});
}

static struct exh_glove_par defaults(void)
{
    const struct exh_signal *r = exh_glove_rows;
    const struct exh_glove_par par = {r[0].dflt, r[1].dflt, r[2].dflt, r[3].dflt, r[4].dflt,
        r[5].dflt, r[6].dflt, r[7].dflt, r[8].dflt};
    return par;
}

/* Every sensor somewhere in its calibrated span. */
static void frame(struct exh_glove_in *to)
{
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        to->raw[i] = (int16_t)bench_in(
            exh_glove_cal_default.sensor[i].low_raw, exh_glove_cal_default.sensor[i].high_raw);
    }
}

static void frames(void)
{
    bench_seed();
    for (uint32_t i = 0; i < BENCH_OPS; i++) { frame(&in[i]); }
}

static void step_setup(void)
{
    const struct exh_glove_par par = defaults();
    frames();
    set_up(&par);
}

static void plain_setup(void)
{
    struct exh_glove_par par = defaults();
    par.order = 0;
    frames();
    set_up(&par);
}

static void step_op(uint32_t i)
{
    int32_t angle[EXH_GLOVE_SENSORS];
    (void)exh_glove_step(&state, &cfg, &in[i], angle);
    bench_sink = angle[0];
}

static long double own(unsigned i, int16_t raw)
{
    const struct exh_glove_sensor *s = &cal.sensor[i];
    return ((long double)raw * 32768 - s->zero_raw_q15) * s->gain_turnpraw_q38 / (1 << 21);
}

static void line_error(struct error *e)
{
    struct exh_glove_par par = defaults();
    par.order = 0;
    par.bits = 16;
    par.hyst_raw_q16 = 0;
    bench_seed();
    set_up(&par);
    for (int n = 0; n < FRAMES; n++) {
        int32_t angle[EXH_GLOVE_SENSORS];
        frame(&in[0]);
        (void)exh_glove_step(&state, &cfg, &in[0], angle);
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
            const struct exh_glove_sensor *s = &cal.sensor[i];
            long double want = own(i, in[0].raw[i]);
            for (unsigned k = 0; k < 2; k++) {
                if (s->of[k] == EXH_GLOVE_NONE) { continue; }
                want += own(s->of[k], in[0].raw[s->of[k]]) * s->cross_q30[k] / (1 << 30);
            }
            error_add(e, angle[i] - want);
        }
    }
}

#define TURN (1.0 / 4294967296.0)

static const struct kernel kernels[] = {
    {"glove_step", "turn", TURN, 1.75, 1, step_setup, step_op, line_error,
        "three roundings, two of them at a share: lines and cross terms of any codes in the span; "
        "22 channels with low-pass and quantizer",
        0, NULL},
    {"glove_step_plain", "turn", TURN, 1.75, 1, plain_setup, step_op, line_error,
        "the same without low-pass", 0, NULL},
};
const struct kernel_group glove_group = {kernels, sizeof kernels / sizeof kernels[0]};
