/* SPDX-License-Identifier: MIT */
/* Mass: the one axis of the paper's first experiment, a falling mass or a bench for calibration,
 * with drive, encoder and monitor. What sim/exo is for fingers. */
#ifndef SIM_MASS_H
#define SIM_MASS_H

#include "bench.h"
#include "fall.h"

#include <stdint.h>

struct sim_mass {
    struct sim_device device;
    struct sim_random rng;
    struct plant plant;
    struct plant_pieces pieces;
    struct fall fall;
    struct bench bench; /* instead of the fall, if benched */
    int benched;
    double now_s;
    double latched_A; /* D/A output */
    double ref_A;     /* what the servo last sampled */
    double servo_s;   /* its first sample; on a bench its next */
    double sample_s;  /* its next that changes ref_A; the others change nothing */
    double grid;      /* encoder phase, counts */
};

/* So many falls, watched by a controller of period T_s; at 0 s. */
void sim_mass_fall(
    struct sim_mass *m, const struct sim_device *d, uint64_t seed, int falls, double T_s);

/* A bench, with what is wrong with it (enum bench_wrong). */
void sim_mass_bench(struct sim_mass *m, const struct sim_device *d, uint64_t seed, unsigned wrong);

/* Mass and string somewhere else, before anything moved. */
void sim_mass_put(struct sim_mass *m, double x_m, double q_m);

/* Everything that happens up to and at until_s. */
void sim_mass_advance(struct sim_mass *m, double until_s);

/* The D/A output changes at at_s, now or later, but before it changes again. */
void sim_mass_latch(struct sim_mass *m, double at_s, double ref_A);

/* Sets the D/A to zero and disables the drive, without a delay. */
void sim_mass_safe(struct sim_mass *m);

/* Codes of encoder (jitter_cnt peak to peak on it) and monitor. */
void sim_mass_read(struct sim_mass *m, double jitter_cnt, uint32_t *enc_raw, int16_t *mon_raw);

#endif
