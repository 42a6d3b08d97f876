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

#include "lab/drop/cells.h"
#include "box/run.h"

struct sweep_opt {
    const double *rate_Hz;
    int rates;
    int columns, rows; /* of the grid: k and b */
    int shard, shards; /* 1/1: all of it */
    int jobs;
    struct run_cfg base; /* device, settings of the scene, seed, falls */
    const char *dir;
};

/* "2/3". 0, or 2 after a line on stderr. */
int sweep_take_shard(const char *text, int *shard, int *shards);

/* Falls at one cell, judged. *error: 0, 1 after a line on stderr, -1 interrupted. */
struct cell sweep_cell(const struct run_cfg *base, double rate_Hz, double k_Npm, double b_Nspm,
                       int *error);

/* Ticks of the scene's velocity window under these settings. */
int sweep_window(const struct run_cfg *base);

/* Makes the directory if need be. 0, or 2 after a line on stderr that names the option. */
int sweep_open_dir(const char *dir, const char *option);

/* Runs what DIR/stability.csv, and shards' files beside it, lack; writes the file,
 * border.csv and rho.csv for the picture, and says what it found on stdout. The exit
 * status. */
int sweep_run(const struct sweep_opt *o);

#endif
