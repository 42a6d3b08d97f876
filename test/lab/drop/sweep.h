/* SPDX-License-Identifier: MIT */
/* exhand-lab drop --sweep: the stability border in the k-b plane, at each rate.
 *
 * Rays from k alone towards b alone, whose nodes rise in equal ratios (ray.h); the border of each
 * is where half of the falls rest. A coarse map has some of the rays and some of the nodes of a
 * fine one. A file of cells is all that a resumed sweep needs. */
#ifndef CLI_SWEEP_H
#define CLI_SWEEP_H

#include "lab/drop/study.h"

/* Runs what DIR/stability.csv, and shards' files beside it, lack; writes the file,
 * border.csv and rho.csv for the picture, and says what it found on stdout. The exit
 * status. */
int sweep_run(const struct sweep_opt *o);

#endif
