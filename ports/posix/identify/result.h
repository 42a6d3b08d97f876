/* SPDX-License-Identifier: MIT */
/* A device's parameters as a text: `exhand identify` writes it, `exhand advise gains --device`
 * reads it.
 *
 *   exhand identify 2
 *   # any remark
 *   rate = 2000 hz
 *   known_mass = 0.5 kg
 *   residual = 0.33
 *   monitor_lag = 0.00032 s               at least; 0: unknown
 *   rotor = 0.0464 0.0461 0.0467 kg       value, low, high, unit: one line of each of model_row[],
 *   mu_both = 0.271 0.27 0.273            and of mu_motor + mu_mass
 */
#ifndef IDENTIFY_RESULT_H
#define IDENTIFY_RESULT_H

#include "identify/model.h"

#include <stdio.h>

#define RESULT_LINE_B 200

struct result_file {
    double rate_Hz, mass_kg;
    double residual;      /* mean square over what edges of counts allow */
    double monitor_lag_s; /* of the current's monitor, at least: what a rest is judged by */
    struct model value, low, high;
    double mu_low, mu_high; /* of model_mu() of the value */
};

/* With a residual above this the model does not fit, and the file must not be used for advice. */
#define RESULT_RESIDUAL_MAX 1.6

/* An estimate, of a run so sampled, with a known mass. */
struct estimate_of;
void result_take(struct result_file *r, const struct estimate_of *e, double T_s, double mass_kg);

void result_write(FILE *f, const struct result_file *r);

/* 0; 2 after a line on stderr with file, line and the valid input. */
int result_read(struct result_file *r, const char *path);
/* The same from an open file; name: for messages. */
int result_parse(struct result_file *r, FILE *f, const char *name);

#endif
