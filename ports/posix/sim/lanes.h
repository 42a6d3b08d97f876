/* SPDX-License-Identifier: MIT */
/* Lanes: plants side by side. Each has the bits of the same plant alone, except for the monitor's
 * current, which lanes do not have. A plant alone waits in every line for its last result. With
 * lanes, vector registers compute some plants in parallel, and the others fill the wait. */
#ifndef SIM_LANES_H
#define SIM_LANES_H

#include "plant.h"

#define SIM_LANES 8

/* Lane k of each array is plant k's: as struct plant, sim_device and plant_piece. */
struct sim_lanes {
    double x_m[SIM_LANES], v_mps[SIM_LANES], q_m[SIM_LANES], w_mps[SIM_LANES], cur_A[SIM_LANES];
    double mass_kg[SIM_LANES], cable_npm[SIM_LANES], cable_nspm[SIM_LANES];
    double mu_motor[SIM_LANES];
    double coulomb_n[SIM_LANES], viscous_nspm[SIM_LANES], kf_npa[SIM_LANES];
};
struct sim_lane_pieces {
    double n[SIM_LANES]; /* sub-steps, whole; 0: the plant stays */
    double half_s[SIM_LANES], keep_cur[SIM_LANES], mean_cur[SIM_LANES];
    double h_mass[SIM_LANES], h_rotor[SIM_LANES], damp_mass[SIM_LANES], damp_rotor[SIM_LANES];
    double half_mass[SIM_LANES], half_rotor[SIM_LANES], rub_mass[SIM_LANES], rub_half[SIM_LANES];
};

void sim_lanes_set(struct sim_lanes *l, int k, const struct plant *p, const struct sim_device *d);
void sim_lane_pieces_set(struct sim_lane_pieces *s, int k, const struct plant_piece *piece);

/* Each of the first lanes over its own piece with its own reference. What one alone reads and
 * writes is lane 0; else the arrays, ref_A too, are read whole. */
void sim_lanes_advance(
    struct sim_lanes *l, const struct sim_lane_pieces *s, const double *ref_A, int lanes);

#endif
