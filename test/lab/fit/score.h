/* SPDX-License-Identifier: MIT */
/* Score: falls of a plant at the paper's six points and at 1.5 times both gains. Places of the
 * wall, counts and clocks are spread evenly (sim/settle.h). */
#ifndef FIT_SCORE_H
#define FIT_SCORE_H

#include "lab/fit/space.h"

#include "box/table2_runs.h"

struct score_plan {
    int falls, falls_at_15; /* of each row */
    int first;              /* case of the sequence */
};

struct score {
    int done;                 /* 0: given up, its cost was above the bound */
    float cost;               /* 0: all that is wanted; below 0 never */
    float rest[TABLE2_ROWS];  /* share of falls that come to rest */
    float swing[TABLE2_ROWS]; /* share that does not at 1.5x */
};

/* The cost is the sum of the squares of each row's distance below 99.5 % and 95 %, in parts of the
 * room between gate and 100 %. These are above the gates, so that the best point is inside of them.
 * Stops when the cost must be above bound. */
struct score score_plant(const struct plant_point *p, enum estimate_kind kind,
    const struct score_plan *plan, double bound);

/* How far inside both gates the worst row is: 1 all falls do as wanted, 0 on a gate, < 0 outside.
 */
double score_margin(const struct score *s);

/* Share of the falls at k and b of a row's rate that come to rest. */
double score_rest(const struct plant_point *p, enum estimate_kind kind, int row, double k_Npm,
    double b_Nspm, const struct score_plan *plan);

#endif
