/* SPDX-License-Identifier: MIT */
/* What studies of the k-b plane share: options, a cell, a directory. */
#ifndef LAB_DROP_STUDY_H
#define LAB_DROP_STUDY_H

#include "lab/drop/cells.h"
#include "box/run.h"

struct sweep_opt {
    const double *rate_Hz;
    int rates;
    int rays, per_octave; /* of the map: directions in the plane, nodes of each */
    int columns, rows;    /* of the check of the border: k and b */
    int shard, shards;    /* 1/1: all of it */
    int jobs;
    struct run_cfg base; /* device, settings of the scene, seed, falls */
    const char *dir;
};

/* "2/3". 0, or 2 after a line on stderr. */
int sweep_take_shard(const char *text, int *shard, int *shards);

/* Runs base->board.falls falls at one pair of gains, each a separate run, and returns how many
 * rest. Seed, rate, gains and number give the chance of a run, its place of the wall too. -1 after
 * a line on stderr, -2 interrupted. */
int study_rest(const struct run_cfg *base, double rate_Hz, double k_Npm, double b_Nspm);

/* The chance of a run that is one of many: the same wherever it is run. */
uint64_t study_seed(uint64_t seed, double rate_Hz, double k_Npm, double b_Nspm, int number);

/* Ticks of the scene's velocity window under these settings. */
int sweep_window(const struct run_cfg *base);

/* Makes the directory if need be. 0, or 2 after a line on stderr that names the option. */
int sweep_open_dir(const char *dir, const char *option);

#endif
