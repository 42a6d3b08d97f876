/* SPDX-License-Identifier: MIT */
/* What passivity does in a run of scene guarded: what it takes away, and what a contact gave out.
 */
#ifndef CLI_GUARD_H
#define CLI_GUARD_H

#include "guarded/guarded.h"

#include <stdint.h>
#include <stdio.h>

struct guard {
    double bound_J;        /* one tick's work at the speed limit, or two's */
    double out_J;          /* most that a contact had given out, as coded: > 0 */
    double force_Ns;       /* what law and limits would have given in contact, sum */
    double taken_Ns;       /* of it taken away */
    uint64_t ticks, acted; /* of contact; in which something was taken */
    double T_s, top_N;
};

/* Before the first tick, and behind each. */
void guard_start(struct guard *g, struct exh_scene_board board);
void guard_after(struct guard *g);

/* A run beside the same one with passivity only observing. */
struct guard_row {
    double rate_Hz, k_Npm, b_Nspm;
    struct guard on, off;
    double on_Npm, off_Npm; /* stiffness; 0: none */
    int falls, on_oscillating, off_oscillating;
};
void guard_print(FILE *f, const struct guard_row *row, int rows);

#endif
