/* SPDX-License-Identifier: MIT */
/* Velocity estimators on a quantised position, at 2 kHz: noise at constant speed, lag
 * under constant acceleration, error on a sine. One CSV line an estimator and encoder;
 * the figures of theory come with it where there are any. bench.sh adds instructions.
 */
#include "estimators.h"
#include "estimators_plain.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define RATE_HZ 2000
#define SETTLE  400   /* ticks before anything is judged */
#define TICKS   40000 /* 20 s */
#define SPEEDS  4
#define PHASES  16 /* of the encoder's grid: a sine of 5 Hz repeats every 400 ticks */

static const double speed_mps[SPEEDS] = {0.001, 0.01, 0.1, 1};
static const struct exh_period period = {1, RATE_HZ};

struct figures {
    double rms_mmps[SPEEDS], max_mmps[SPEEDS], lag_ms, sine_mmps;
};

/* --- the estimators, and what is expected of them --- */

struct estimator {
    const char *name;
    const char *kernel; /* whose instructions it has */
    int (*start)(struct exh_velocity_scale s, int arg);
    int32_t (*step)(int32_t cnt);
    int arg;
    int has_theory;
    struct figures theory; /* simulated apart from this library, D = 15.7 um, floats */
};

/* pole_100: the pole of exp(-2 pi 100 Hz T); pole_91: of 3/4. track_0.9: theta = 0.9. */
static const struct estimator estimators[] = {
    {"difference", "velocity_window_1", window_start, window_step, 0, 1,
        {{5.5, 14.6, 12.2, 11.3}, {30, 21, 26, 27}, 0.25, 13.1}},
    {"window_2", "velocity_window_2", window_start, window_step, 1, 0, {{0}, {0}, 0, 0}},
    {"window_4", "velocity_window_2", window_start, window_step, 2, 1,
        {{2.6, 3.5, 3.5, 3.8}, {6.9, 5.7, 5.8, 4.8}, 1.00, 7.7}},
    {"window_16", "velocity_window_16", window_start, window_step, 4, 1,
        {{1.0, 0.58, 0.41, 0.98}, {1.0, 1.8, 1.9, 1.1}, 4.00, 27.9}},
    {"pole_100", "velocity_pole", pole_start, pole_step, 1354, 1,
        {{2.0, 2.7, 2.8, 2.7}, {7.5, 4.6, 4.9, 5.1}, 1.61, 11.5}},
    {"foaw_16", "velocity_foaw_16", foaw_start, foaw_step, 16, 1,
        {{1.1, 0.38, 0.28, 0.21}, {1.8, 0.62, 0.72, 0.49}, 1.97, 11.7}},
    {"track_0.9", "velocity_track", track_start, track_step, 4500, 1,
        {{0.33, 0.11, 0.10, 0.11}, {0.59, 0.25, 0.23, 0.27}, 9.25, 63}},
    {"bare_difference", "bare difference", bare_pole_start, bare_pole_step, 0, 0, {{0}, {0}, 0, 0}},
    {"bare_pole_91", "bare pole", bare_pole_start, bare_pole_step, 2, 0, {{0}, {0}, 0, 0}},
    {"bare_track_0.9", "bare track", bare_track_start, bare_track_step, 4500, 0, {{0}, {0}, 0, 0}},
    {"double_window_4", "plain double window", double_window_start, double_window_step, 4, 0,
        {{0}, {0}, 0, 0}},
    {"float_window_4", "plain float window", float_window_start, float_window_step, 4, 0,
        {{0}, {0}, 0, 0}},
    {"double_pole_100", "plain double pole", double_pole_start, double_pole_step, 1354, 0,
        {{0}, {0}, 0, 0}},
    {"float_pole_100", "plain float pole", float_pole_start, float_pole_step, 1354, 0,
        {{0}, {0}, 0, 0}},
    {"double_foaw_16", "plain double foaw", double_foaw_start, double_foaw_step, 16, 0,
        {{0}, {0}, 0, 0}},
    {"float_foaw_16", "plain float foaw", float_foaw_start, float_foaw_step, 16, 0,
        {{0}, {0}, 0, 0}},
};

/* --- the movements --- */

struct movement {
    double v_mps, a_mps2; /* constant speed and acceleration */
    double sine_m, sine_radps;
};

static double at_m(const struct movement *m, double t_s)
{
    return m->v_mps * t_s + m->a_mps2 * t_s * t_s / 2 + m->sine_m * sin(m->sine_radps * t_s);
}

static double at_mps(const struct movement *m, double t_s)
{
    return m->v_mps + m->a_mps2 * t_s + m->sine_m * m->sine_radps * cos(m->sine_radps * t_s);
}

struct moments {
    double mean, rms, max;
};

/* Error of the estimate, m/s. The encoder's grid lies anywhere: phase 0..1. */
static struct moments follow(
    const struct estimator *e, double step_m, double phase, const struct movement *m, int ticks)
{
    const struct exh_velocity_scale s = {(int32_t)(step_m * 4398046511104.0 + 0.5), period};
    double sum = 0, squares = 0, max = 0;
    if (e->start(s, e->arg) < 0) {
        fprintf(stderr, "%s: set-up refused\n", e->name);
        exit(1);
    }
    for (int i = 0; i < ticks; i++) {
        const double t_s = (double)i / RATE_HZ;
        const int32_t cnt = (int32_t)floor(at_m(m, t_s) / step_m + phase);
        const double v = e->step(cnt) / (double)(1 << EXH_Q_VEL), off = v - at_mps(m, t_s);
        if (i < SETTLE) { continue; }
        sum += off;
        squares += off * off;
        max = fabs(off) > max ? fabs(off) : max;
    }
    ticks -= SETTLE;
    return (struct moments){sum / ticks, sqrt(squares / ticks), max};
}

static struct figures judge(const struct estimator *e, double step_m)
{
    const struct movement fast = {0, 5, 0, 0}, sine = {0, 0, 0.01, 2 * 3.14159265358979 * 5};
    struct figures f;
    double squares = 0;
    for (int k = 0; k < SPEEDS; k++) {
        const struct movement even = {speed_mps[k], 0, 0, 0};
        const struct moments m = follow(e, step_m, 0.37, &even, TICKS);
        f.rms_mmps[k] = 1000 * m.rms;
        f.max_mmps[k] = 1000 * m.max;
    }
    f.lag_ms = -1000 * follow(e, step_m, 0.37, &fast, 2 * RATE_HZ).mean / fast.a_mps2;
    for (int k = 0; k < PHASES; k++) {
        const double rms = follow(e, step_m, (k + 0.37) / PHASES, &sine, RATE_HZ).rms;
        squares += rms * rms / PHASES;
    }
    f.sine_mmps = 1000 * sqrt(squares);
    return f;
}

static void print(
    const char *who, const struct estimator *e, double step_um, const struct figures *f)
{
    printf("%s,%s,%s,%.4g", who, e->name, e->kernel, step_um);
    for (int k = 0; k < SPEEDS; k++) { printf(",%.3g,%.3g", f->rms_mmps[k], f->max_mmps[k]); }
    printf(",%.3g,%.3g\n", f->lag_ms, f->sine_mmps);
}

/* 66.32 um: the device's encoder, x1. 15.7 um: the one theory was simulated with. */
int main(void)
{
    static const double step_um[] = {66.32, 15.7};
    printf("source,estimator,kernel,step_um,rms_1mmps,max_1mmps,rms_10mmps,max_10mmps,"
           "rms_100mmps,max_100mmps,rms_1mps,max_1mps,lag_ms,sine_rms_mmps\n");
    for (size_t d = 0; d < 2; d++) {
        for (size_t i = 0; i < sizeof estimators / sizeof estimators[0]; i++) {
            const struct figures f = judge(&estimators[i], step_um[d] * 1e-6);
            print("measured", &estimators[i], step_um[d], &f);
            if (d == 1 && estimators[i].has_theory) {
                print("theory", &estimators[i], step_um[d], &estimators[i].theory);
            }
        }
    }
    return 0;
}
