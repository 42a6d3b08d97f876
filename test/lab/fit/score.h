/* SPDX-License-Identifier: MIT */
/* Score: a plant is run at the paper's six points and at 1.5 times both gains, and read
 * in every way at once. */
#ifndef FIT_SCORE_H
#define FIT_SCORE_H

#include "lab/fit/space.h"

#include "lab/drop/reading.h"
#include "box/table2.h"

struct score_plan {
    int runs;                         /* of ten falls a row, at the gains */
    int falls_at_15;                  /* one run of so many at 1.5 times both */
    double observe_s, observe_slow_s; /* the latter at 100 Hz and below */
    uint64_t seed;
    int fixed_wall; /* 0: the wall lies anywhere between two encoder counts,
                       elsewhere in each run; 1: where q_lim and step put it */
};

struct score {
    int done;                 /* 0: given up, its unrest alone was above the bound */
    float unrest;             /* 0 if all six rest and all six at 1.5x oscillate */
    float rest[TABLE2_ROWS];  /* share of falls that come to rest */
    float swing[TABLE2_ROWS]; /* share that oscillates at 1.5x */
    /* mean of ln(stiffness / k) over the runs; SCORE_NONE: no line in some run */
    float ln_k[TABLE2_ROWS][READINGS];
};
#define SCORE_NONE 99.0f

/* Gives up once the unrest is above bound. */
struct score score_plant(const struct plant_point *p, const struct score_plan *plan, double bound);

/* What the search makes small: unrest plus the sum of squares of ln(ours / paper). */
double score_cost(const struct score *s, int reading);

/* One run. 0, or -1: it failed. r is freed by run_free(). */
struct score_gains {
    int row; /* whose rate */
    double k_Npm, b_Nspm;
    int falls;
    uint64_t seed;
};
int score_run(const struct plant_point *p, const struct score_plan *plan, struct score_gains at,
    struct run *r);
double score_step_m(const struct plant_point *p);

/* Falls of the run that oscillate; *soft is their sum judged by how far. */
int score_oscillating(
    const struct run *r, double step_m, double observe_s, int wanted, double *soft);

#endif
