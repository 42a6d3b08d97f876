/* SPDX-License-Identifier: MIT */
/* From a run to the device: estimates, intervals, and whether the model fits. */
#ifndef IDENTIFY_ESTIMATE_H
#define IDENTIFY_ESTIMATE_H

#include "identify/fit.h"
#include "identify/lag.h"

struct estimate_of {
    struct fit fit;
    struct lag lag;
    int lag_told;
    unsigned rounds;
    size_t counts;  /* observations, */
    double counted; /* and how many of them a model can foretell */
};

/* Down to a fit, from where f is. 0; -1: out of memory. */
int estimate_finish(struct fit *f, const struct identify_data *d, const struct observations *o);

/* What the monitor tells of this run: a fit holds it from then on. 0; 1: nothing; -1: out of
 * memory. */
int estimate_lag(struct fit *f, struct lag *lag, const struct identify_data *d);
/* Behind the fit: lag and delay of the device. */
void estimate_lag_end(struct fit *f, struct lag *lag, const struct identify_data *d);

/* A lag that is not held becomes that of a start, within the delay. */
void estimate_lag_anew(struct fit *f);

/* So often the device that was found is told apart again, on the simulated bench. */
#define RESAMPLES 8

/* Values without what the estimate itself is off by, and their intervals: how far the estimates of
 * RESAMPLES such devices, each a run with other chance and a fit from another start, are off and
 * apart. Student's t for as many. 0; -1: out of memory; 130: interrupted. */
int identify_resample(struct estimate_of *e, const struct identify_data *d, int jobs);

/* 0; -1: out of memory; 1: the run has too little to fit. */
int identify_estimate(struct estimate_of *e, const struct identify_data *d);

#endif
