/* SPDX-License-Identifier: MIT */
/* NAME=VALUE, as --set and --device take it. */
#ifndef CLI_ASSIGN_H
#define CLI_ASSIGN_H

#include "sim/device.h"

#include <stddef.h>

#define ASSIGN_NAME_B   32
#define ASSIGN_GRID_MAX 200 /* columns, rows */

/* Name and value apart. 0, or 2 after a line on stderr. */
int assign_split(const char *option, const char *text, char name[ASSIGN_NAME_B], double *value);

/* What sim_device_set() or sim_glove_set() refused, row being what it left there: says so, and
 * which command lists what there is. 2. */
int assign_refused(
    const char *command, const char *name, double value, const struct sim_device_row *row);

/* NAME=VALUE into the device of this command: 0, or 2 after a line on stderr. */
int assign_device(struct sim_device *d, const char *command, const char *text);

/* That the device is integrated in steps that are short enough (plant.h), hand_npm being the
 * stiffness of a hand, 0 without. The table's own step is shortened to one that will do; another is
 * refused: 0, or 2 after a line on stderr with the step that would do. */
int assign_step(struct sim_device *d, double hand_npm, double hand_nspm);

/* "12x9". 0, or 2 after a line on stderr. */
int assign_grid(const char *text, int *columns, int *rows);

/* For cli_hint (option.h). */
const char *assign_hint(const char *name, size_t len);

#endif
