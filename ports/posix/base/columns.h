/* SPDX-License-Identifier: MIT */
/* Which values of a scene's signals a table of numbers holds, and what its columns are called. */
#ifndef CLI_COLUMNS_H
#define CLI_COLUMNS_H

#include "exhand/run/scene.h"

#include <stdio.h>

#define COLUMNS_MAX    512
#define COLUMNS_IN_USE (-1) /* for a finger: those that the scene has in use */

struct columns {
    const struct exh_signal_table *table;
    uint16_t at[COLUMNS_MAX]; /* indices of values, rising */
    uint32_t n;
    int alone;   /* of one finger: its columns have the bare names */
    int fingers; /* several instances are fingers, not anything else */
};

/* The paper's signals, or all. Of finger (0 the thumb), or of those in use by params, an image of
 * the scene's parameters; of all signals COLUMNS_IN_USE has every finger. 0, or 2 after a line on
 * stderr that begins with path: this finger is not in use, or there are none. */
int columns_choose(struct columns *c, const struct exh_scene *sc, const uint8_t *params,
    size_t len_B, int all, int finger, const char *path);

/* NAME_UNIT, with _FINGER or _INDEX for several instances; a comma before each. */
void columns_names(FILE *to, const struct columns *c);
/* Only a comma for a missing value (none.h). */
void columns_values(FILE *to, const struct columns *c, const int32_t *v);

#endif
