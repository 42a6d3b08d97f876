/* SPDX-License-Identifier: MIT */
/* Ray: both gains raised together from weak to stiff, falls at each node, and where half of them no
 * longer rest. The one definition of a border: the map, its coarse form in the demo and the study
 * of friction have it from here. */
#ifndef LAB_DROP_RAY_H
#define LAB_DROP_RAY_H

#include "lab/drop/logistic.h"
#include "lab/drop/study.h"

#define RAY_NODES      320 /* at most: 13 octaves, from 0.1 to what the scene takes */
#define RAY_PER_OCTAVE 24

struct ray {
    double rate_Hz, k_Npm, b_Nspm; /* at gain 1 */
    double first;                  /* gain of the first node */
    int per_octave;                /* nodes */
};

/* What the falls at one gain did. 0, or else the climb ends with it. */
typedef int ray_at(void *ctx, const struct ray *r, double gain, int *rest, int *falls);

struct ray_border {
    enum logistic_status status;
    double gain, low, high; /* 95 % interval */
    int nodes, error;       /* error: what ray_at() returned, else 0 */
};

/* Nodes from the first gain on. The last one is where no fall has rested for an octave, or where
 * the scene takes no more k or b. If none has rested, it is eight times gain 1. */
struct ray_border ray_border(const struct ray *r, ray_at *at, void *ctx);

/* The gain of a node. */
double ray_gain(const struct ray *r, int node);

#endif
