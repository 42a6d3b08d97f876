/* SPDX-License-Identifier: MIT */
/* exhand-lab drop --sweep: the stability border in the k-b plane, at each rate.
 *
 * First octaves: k and b are doubled until a whole column and a whole row of cells is
 * unstable; k begins the lower the slower the rate. Then a grid over what that spans, then
 * bisection between the last stable cell and the next: along k on each row, along b on
 * each column. A line that is stable to its end is open: it has no border. What is to be run
 * follows from the cells known, so a file of cells is all that a resumed sweep needs. */
#ifndef CLI_SWEEP_H
#define CLI_SWEEP_H

#include "lab/drop/study.h"

/* Runs what DIR/stability.csv, and shards' files beside it, lack; writes the file,
 * border.csv and rho.csv for the picture, and says what it found on stdout. The exit
 * status. */
int sweep_run(const struct sweep_opt *o);

#endif
