/* SPDX-License-Identifier: MIT */
/* Table II in every reading of the analysis. */
#ifndef LAB_DROP_READINGS_H
#define LAB_DROP_READINGS_H

#include "box/table2.h"

#include <stdio.h>

/* The median of `runs` runs of each row, those of row i from r[i * stride] on. The CSV has a line a
 * row and reading. */
struct table2_readings {
    const struct table2_result *r;
    int rows, stride, runs;
};
void table2_readings_print(FILE *f, const struct table2_readings *t);
void table2_readings_csv(FILE *f, const struct table2_readings *t);

/* A table2_judge: the stiffness in every way of reading.h. */
void readings_judge(
    const struct fall_log *log, const struct sim_device *d, struct table2_result *r);

#endif
