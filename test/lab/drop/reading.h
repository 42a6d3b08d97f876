/* SPDX-License-Identifier: MIT */
/* Readings of the paper's analysis: what its text leaves open, as options.
 *
 * The text gives the steps, but leaves three choices. "The stiffness as ratio of force over
 * position" can be either of two regressions. The monitor can be paired with the position of its
 * own tick or of the tick that it answers. A "contact situation" can include different samples.
 * One table names every combination.
 */
#ifndef CLI_READING_H
#define CLI_READING_H

#include "falls/analysis.h"

struct reading {
    const char *name; /* direction-pairs-scope */
    enum fall_direction direction;
    size_t lag; /* 0 same tick, 1 the position the monitor answers */
    enum fall_scope scope;
};

#define READINGS 16
extern const struct reading reading_table[READINGS];

/* That of the gates and of Table II, b-aligned-all: its place in the table. */
#define READING_DEFAULT 12

/* Its place in the table, or -1. */
int reading_find(const char *name);

/* The stiffness of a log by every reading, N/m; 0 where there is none. */
enum fall_status reading_all(
    const struct fall_log *log, double step_m, double stiffness_Npm[READINGS]);

#endif
