/* SPDX-License-Identifier: MIT */
/* Values that mean "none", such as the distance to a plane not received yet. Outputs leave them
 * out. */
#ifndef CLI_NONE_H
#define CLI_NONE_H

#include "exhand/signal.h"

#include <stdio.h>

int none_is(const struct exh_signal *row, int32_t raw);

/* raw * 2^-frac; not a number for "none". */
double none_or(const struct exh_signal *row, int32_t raw);

/* A comma and nine digits, or only a comma for "none". */
void none_or_cell(FILE *to, const struct exh_signal *row, int32_t raw);

#endif
