/* SPDX-License-Identifier: MIT */
/* Settle: does a mass that falls onto the wall come to rest? One fall, without random numbers. The
 * model of the stability advisor: rotor, string, mass and friction as in plant.h, the wall in
 * doubles (no codes, noise or I2t). Random quantities of the device are parameters of a case. These
 * are the place of the wall between two counts, the height of the fall, and the phases of encoder,
 * tick and the drive's clock. + - x / only: the same result on every machine. */
#ifndef SIM_SETTLE_H
#define SIM_SETTLE_H

#include "device.h"
#include "estimate.h"

struct settle_wall {
    double T_s, k_Npm, b_Nspm;
    double f0_N, f0_band_m; /* pull-back force and what reverses it */
    double f_max_N, slew_Nps;
    struct estimate_par velocity;
};

/* All in 0..1: place of the wall and phase of the encoder in counts, the first tick in ticks. The
 * drive's first sample in its periods, and the height between its least and its largest. */
struct settle_case {
    double wall, grid, tick, servo, height;
};

enum settle_end {
    SETTLE_REST,
    SETTLE_MOVES, /* or the force does, by what is no rest */
    SETTLE_ASTRAY /* no contact, or left the measured range */
};

/* The i-th case, i >= 0. Each block of 32 cases fills all five quantities evenly (a Latin
 * hypercube). No two are coupled: height and tick make the place of the first tick in the wall. */
struct settle_case settle_case_at(int i);

/* Watches the device for its observe_s from the first contact. A device that sticks earlier is at
 * rest then. */
enum settle_end settle_run(
    const struct sim_device *d, const struct settle_wall *w, struct settle_case c);

#endif
