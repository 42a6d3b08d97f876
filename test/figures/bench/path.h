/* SPDX-License-Identifier: MIT */
/* The input of the force path and the ticks: the drop scene's configuration at 2 kHz, with gains
 * that are no powers of two, and a movement through its wall. */
#ifndef BENCH_PATH_H
#define BENCH_PATH_H

#include "bench.h"

#include "drop/drop.h"

#define PATH_HEALTHY \
    (EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS | EXH_DIN_DRIVE0)

extern struct drop_par path_par;
extern struct drop_cfg path_cfg;

/* Sets both, and seeds the generator. */
void path_setup(void);

/* Counts of a throw: 70 mm out and back in 1024 ticks, i any. */
int32_t path_cnt(uint32_t i);
/* The same as inputs of the law, the velocity exact and rounded to its format. */
struct exh_contact_in path_in(uint32_t i);

/* What a scene does from count to D/A code, in SI. Velocity: window of two ticks. */
struct exact {
    long double step_m, T_s, k_Npm, b_Nspm, lim_m, f_max_N, slew_Nps, A_per_N, peak_A;
    long double code_per_A, code_zero;
    long double force_N; /* last */
    int32_t cnt[2];      /* of the last two ticks, newest first */
};

/* Of the minimal scene, whose table has to be set up. */
#define MINIMAL_RATE_HZ 1000
struct exact minimal_exact(void);
extern const struct exh_scene exh_scene_minimal;

#endif
