/* SPDX-License-Identifier: MIT */
/* Search: a population a velocity estimator, all with equal effort.
 *
 * A round makes some plants from each population and offers each to its own. Half of the children
 * are made by differential evolution (current to one of the best), half by moving one of the best a
 * little in some directions. All start from the same plants. Twice the best of each go on alone, to
 * be judged by more falls. */
#ifndef FIT_SEARCH_H
#define FIT_SEARCH_H

#include "lab/fit/score.h"

#include "sim/random.h"

#define SEARCH_MEMBERS 24  /* of a population */
#define SEARCH_KEPT    8   /* of these, when the plan gets dearer */
#define SEARCH_STARTS  192 /* plants of each before the first round */
#define SEARCH_BROOD   6   /* children of a population in a round */
#define SEARCH_BATCH   (ESTIMATES * SEARCH_STARTS)

struct search_member {
    struct plant_point p;
    struct score s;
};

struct search_population {
    struct search_member member[SEARCH_MEMBERS];
    int members;
};

/* A plant to be run, with the estimator that its population has. */
struct search_child {
    struct plant_point p;
    enum estimate_kind kind;
};

struct search {
    struct search_population of[ESTIMATES];
    int used[ESTIMATES];    /* populations that make children */
    int pinned[SPACE_ROWS]; /* rows that keep the start's value */
    struct plant_point start;
    struct sim_random rng;
    int kept; /* members a population may have */
};

void search_init(struct search *s, uint64_t seed);

/* Plants to run, into room for SEARCH_BATCH; how many. First the starts, the same for all; then
 * rounds of children; search_cull() empties the populations and gives their best to run again. */
int search_first(struct search *s, struct search_child *child);
int search_round(struct search *s, struct search_child *child);
int search_cull(struct search *s, struct search_child *child);

/* A plant's cost above this cannot enter the population. */
double search_bound(const struct search *s, enum estimate_kind kind);

void search_offer(struct search *s, const struct search_child *c, const struct score *score);

#endif
