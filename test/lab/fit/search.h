/* SPDX-License-Identifier: MIT */
/* Search: one population a reading, every plant offered to all of them.
 *
 * A round makes one plant from each population, runs them, and offers each to every
 * population: whatever is evaluated, all readings see it, so that none is searched less
 * than another. Half of the children are made by differential evolution (current to one
 * of the best), half by moving one of the best a little in some directions. All start
 * from the same plants. After `first` evaluations the best of each are judged again with
 * the dearer plan, and only these go on.
 */
#ifndef FIT_SEARCH_H
#define FIT_SEARCH_H

#include "lab/fit/score.h"

#include "sim/random.h"

#define SEARCH_MEMBERS 24  /* of a population */
#define SEARCH_KEPT    8   /* of these, when the plan gets dearer */
#define SEARCH_STARTS  192 /* plants before the first round */
#define SEARCH_BATCH   (READINGS * SEARCH_KEPT)

struct search_member {
    struct plant_point p;
    struct score s;
    double cost;
};

struct search_population {
    struct search_member member[SEARCH_MEMBERS];
    int members;
};

struct search {
    struct search_population of[READINGS];
    int used[READINGS];     /* populations that make children */
    int pinned[SPACE_ROWS]; /* rows that keep the start's value */
    struct plant_point start;
    struct sim_random rng;
    int fixed_wall;
    int kept; /* members a population may have */
};

void search_init(struct search *s, uint64_t seed);

/* The i-th of the plants all start from; 0 is `start`. */
struct plant_point search_first(struct search *s, int i);

/* One child of each used population; returns how many. */
int search_round(struct search *s, struct plant_point child[READINGS]);

/* A plant's unrest above this cannot enter any used population. */
double search_bound(const struct search *s);

void search_offer(struct search *s, const struct plant_point *p, const struct score *score);

/* Empties the populations; returns the plants that go on, without repetition. */
int search_cull(struct search *s, struct plant_point kept[SEARCH_BATCH]);

const struct search_member *search_best(const struct search *s, int reading);

#endif
