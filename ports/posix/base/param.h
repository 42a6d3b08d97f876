/* SPDX-License-Identifier: MIT */
/* A scene's parameters by name and in SI, for options and printing. */
#ifndef CLI_PARAM_H
#define CLI_PARAM_H

#include "exhand/params.h"
#include "exhand/signal.h"

#include <stdio.h>

/* raw * 2^-frac. */
double cli_signal_value(const struct exh_signal *row, int32_t raw);

/* In a word or two, when it may change. */
const char *cli_signal_when(const struct exh_signal *row);

/* The row called name (its index to *index unless NULL), or NULL. */
const struct exh_signal *cli_signal_find(
    const struct exh_signal_table *t, const char *name, uint32_t *index);

/* Stages name = value, to the nearest raw value. 0, or -EXH_E… after a line on
 * stderr that names the parameter, its range and what to do. */
int cli_param_set(struct exh_params *p, const char *name, double value);

/* The same; the line begins with the option that it came by: "--set: ". */
int cli_param_set_by(struct exh_params *p, const char *by, const char *name, double value);

/* Why set-up refused these parameters at this rate, on stderr: of a cut-off, which one, and one
 * that would do. */
void cli_setup_complain(const struct exh_params *p, double rate_Hz, int err);

/* Name, unit, value (of the first instance; raw NULL: the row's own start), range, help: one row a
 * line. */
void cli_signal_print(FILE *f, const struct exh_signal_table *t, const int32_t *raw);

#endif
