/* SPDX-License-Identifier: MIT */
/* The model that is fitted: rotor, string and mass as sim/plant.h has them, the commands of a run
 * put in, the string at the motor as it would have moved. */
#ifndef IDENTIFY_MODEL_H
#define IDENTIFY_MODEL_H

#include "identify/data.h"

#include "sim/device.h"
#include "sim/lanes.h"

/* What is fitted, in this order. */
enum model_par {
    MODEL_ROTOR,   /* kg, log */
    MODEL_COULOMB, /* N */
    MODEL_VISCOUS, /* Ns/m */
    MODEL_DELAY,   /* s: in all, from tick to current */
    MODEL_KF,      /* N/A, log */
    MODEL_STEP,    /* m per count, log */
    MODEL_CABLE_K, /* N/m, log */
    MODEL_CABLE_B, /* Ns/m */
    MODEL_MU_MOTOR,
    MODEL_MU_MASS,
    MODEL_LAG, /* s: of the delay, what is a lag and no waiting, log */
    MODEL_PARS
};

struct model_row {
    const char *name, *unit;
    double min, max;
    int in_log; /* its coordinate in the fit is a logarithm */
};
extern const struct model_row model_row[MODEL_PARS];

/* The drive's own loop, on which what waits hangs; its half period is part of the delay. */
#define MODEL_SERVO_HZ 4000

struct model {
    double value[MODEL_PARS];
};

/* Both dry frictions of the string. A run determines this sum better than its two parts. */
double model_mu(const struct model *m);

/* What the simulated device is in these terms, at a period of T_s. */
struct model model_of(const struct sim_device *d, double T_s);
/* Sum of both dry frictions of the string. A run determines it better than its two parts. */
struct sim_device model_device(const struct model *m, double T_s, double servo_Hz);

/* Models that run at a time. */
#define MODEL_LANES SIM_LANES
/* Runs of one model, of which each has another time. */
#define MODEL_CHANCES 4

/* Position of each of 1 .. MODEL_LANES models at each sample, counts, of the first n. */
void model_run(const struct model *m, int models, const struct identify_data *d, size_t n,
    float *const *q_cnt);

struct sim_random;
/* The same for MODEL_CHANCES runs of one model, which differ in the phase at which the drive takes
 * over each command. */
void model_chances(const struct model *m, const struct identify_data *d, size_t n,
    struct sim_random *chance, float *const *q_cnt);

#endif
