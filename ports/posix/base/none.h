/* SPDX-License-Identifier: MIT */
/* Values that say there is none, such as the distance to a plane that nobody has told of: whatever
 * shows them leaves them out. */
#ifndef CLI_NONE_H
#define CLI_NONE_H

#include "exhand/signal.h"

#include <stdio.h>

int none_is(const struct exh_signal *row, int32_t raw);

/* raw * 2^-frac; not a number if there is none. */
double none_or(const struct exh_signal *row, int32_t raw);

/* A comma and nine digits, or nothing behind it. */
void none_or_cell(FILE *to, const struct exh_signal *row, int32_t raw);

#endif
