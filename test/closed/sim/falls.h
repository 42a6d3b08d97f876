/* SPDX-License-Identifier: MIT */
/* Synthetic logs of falls, for the tests of the analysis. */
#ifndef TEST_SIM_FALLS_H
#define TEST_SIM_FALLS_H

#include "check.h"

#include "falls/analysis.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MAX_FALLS 64

struct log_builder {
    struct fall_sample *sample;
    size_t n, cap;
    size_t start[MAX_FALLS];
    size_t falls;
    double t_s;
};

static inline void begin_fall(struct log_builder *b) { b->start[b->falls++] = b->n; }

static inline void add(struct log_builder *b, double tick_s, double q_m, double f_N, int c)
{
    if (b->n == b->cap) {
        b->cap = b->cap ? 2 * b->cap : 1024;
        b->sample = realloc(b->sample, b->cap * sizeof *b->sample);
        if (!b->sample) { abort(); }
    }
    b->sample[b->n++] = (struct fall_sample){.t_s = b->t_s, .q_m = q_m, .f_mon_N = f_N, .c = c};
    b->t_s += tick_s;
}

static inline struct fall_log built(const struct log_builder *b)
{
    return (struct fall_log){b->sample, b->n, b->start, b->falls};
}

static inline void drop(struct log_builder *b)
{
    free(b->sample);
    memset(b, 0, sizeof *b);
    b->sample = NULL;
}

static inline double uniform(uint64_t *rng)
{
    uint64_t z = (*rng += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

static inline double normal(uint64_t *rng)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) { sum += uniform(rng); }
    return sum;
}

static inline int near(double got, double want, double relative)
{
    return fabs(got - want) <= relative * fabs(want);
}

/* Three falls onto a line without noise. */
static inline void ramp(struct log_builder *b, double k_Npm, size_t lag)
{
    for (int fall = 0; fall < 3; fall++) {
        double last[3] = {0.0, 0.0, 0.0};
        begin_fall(b);
        for (int i = 0; i < 5; i++) { add(b, 1e-3, 0.07, 2.0, 0); }
        for (int i = 0; i < 300; i++) {
            const double q_m = 0.07 + 6.0 / k_Npm * i / 300.0 + 1e-3 / k_Npm * fall;
            memmove(last + 1, last, 2 * sizeof last[0]);
            last[0] = q_m;
            add(b, 1e-3, q_m, k_Npm * (last[lag] - 0.07), 1);
        }
        add(b, 1e-3, 0.07, 2.0, 0);
    }
}

/* One sample per character: # contact, . none, | a fall begins here. */
static inline void draw_log(struct log_builder *b, const char *picture)
{
    for (; *picture; picture++) {
        if (*picture == '|') {
            begin_fall(b);
        } else {
            add(b, 1e-3, (double)b->n, 100.0 + (double)b->n, *picture == '#');
        }
    }
}

#define SLOPE_NPM 8000.0

/* Falls whose compliance scatters by 10 % around 1/k, some noise on each position. */
static inline void scattered_falls(
    struct log_builder *b, size_t falls, size_t pairs, double noise_m, uint64_t *rng)
{
    for (size_t fall = 0; fall < falls; fall++) {
        const double slope_mpN = (1.0 + 0.1 * normal(rng)) / SLOPE_NPM;
        begin_fall(b);
        for (size_t i = 0; i < pairs; i++) {
            const double f_N = 0.5 + 4.5 * uniform(rng);
            add(b, 1e-3, f_N * slope_mpN + noise_m * normal(rng), f_N, 1);
        }
    }
}

#endif
