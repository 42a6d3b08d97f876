/* SPDX-License-Identifier: MIT */
/* The fit: Levenberg and Marquardt over the model's parameters, by differences. */
#ifndef IDENTIFY_FIT_H
#define IDENTIFY_FIT_H

#include "identify/model.h"
#include "identify/observe.h"

struct fit {
    struct model at;
    unsigned held;                            /* bits of enum model_par that no fit moves */
    double cost;                              /* mean of weight residual^2 */
    int steps;                                /* taken */
    int good;                                 /* it came to its end */
    double low[MODEL_PARS], high[MODEL_PARS]; /* 95 % */
    double mu_low, mu_high;                   /* of model_mu(), 95 % */
};

#define FIT_ALL   ((1u << MODEL_PARS) - 1u)
#define FIT_ROTOR 15u /* determined by the free rotor: the first four, as ratios */
#define FIT_MASS  (FIT_ALL & ~FIT_ROTOR & ~(1u << MODEL_LAG))

struct fit_how {
    unsigned free;  /* bits of enum model_par */
    double floor_m; /* no observation counts as better than this */
    int steps;      /* at most */
    int bold;       /* 1: takes its steps though the cost does not fall; 2: their mean, too */
    double enough;  /* a step that lowers the cost by a smaller share is the last */
    int one_sided;  /* differences at half the price, for far away */
};

/* From f->at. 0, or -1: out of memory. */
int fit_run(
    struct fit *f, const struct identify_data *d, const struct observations *o, struct fit_how how);
/* The shares of observations become those that this model can foretell. 0, or -1: out of memory. */
int fit_weigh(const struct model *m, const struct identify_data *d, struct observations *o);
/* Of models as they are; infinite: out of memory. */
void fit_costs(const struct model *m, int models, const struct identify_data *d,
    const struct observations *o, double floor_m, double *cost);
/* Moves what is not held by chance, about as far as a start is that came near. */
struct sim_random;
void fit_shake(struct fit *f, struct sim_random *chance);

/* Where to begin, from currents and times of the run. */
struct model fit_start(const struct identify_data *d);

#endif
