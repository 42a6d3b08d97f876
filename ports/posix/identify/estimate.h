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

/* Estimates the lag from the monitor; later fits keep it. 0; 1: no information; -1: out of
 * memory. */
int estimate_lag(struct fit *f, struct lag *lag, const struct identify_data *d);
/* Behind the fit: lag and delay of the device. */
void estimate_lag_end(struct fit *f, struct lag *lag, const struct identify_data *d);

/* A lag that is not held becomes that of a start, within the delay. */
void estimate_lag_anew(struct fit *f);

/* Number of repeated identifications of the estimated device on the simulated bench. */
#define RESAMPLES 8

/* Values corrected by the bias of the estimate, and their intervals. Both come from RESAMPLES such
 * devices, each with another random run and another start of the fit, and Student's t. 0; -1: out
 * of memory; 130: interrupted. */
int identify_resample(struct estimate_of *e, const struct identify_data *d, int jobs);

/* 0; -1: out of memory; 1: the run has too little to fit. */
int identify_estimate(struct estimate_of *e, const struct identify_data *d);

#endif
