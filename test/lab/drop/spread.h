/* SPDX-License-Identifier: MIT */
/* Many runs of one row of Table II: medians, and in every reading of the analysis. */
#ifndef LAB_DROP_SPREAD_H
#define LAB_DROP_SPREAD_H

#include "box/table2.h"

#include <stdio.h>

/* Many runs of one row, at its gains and at 1.5 times both. Medians are of the runs
 * that gave a line; 0 unless more than half did. */
struct table2_spread {
    int runs, lines, lines_same;         /* done at the gains; of these, with a line */
    double b_Npm, b_low_Npm, b_high_Npm; /* median, 5 % and 95 % */
    double a_Npm, b_same_Npm, a_same_Npm;
    double rest;       /* share of falls that come to rest; < 0: no fall */
    double oscillates; /* share of falls that do not, at 1.5 times both gains */
};
struct table2_spread table2_spread(
    const struct table2_result *at_1, const struct table2_result *at_15, int runs);

/* spread.csv: header and a line; empty fields where there is none. For people: a table. */
void table2_spread_csv_header(FILE *f);
void table2_spread_csv_line(FILE *f, const struct table2_result *r, const struct table2_spread *s);
void table2_spread_print(
    FILE *f, const struct table2_result *r, const struct table2_spread *s, int rows);

/* Every reading of the analysis: the median of `runs` runs of each row, those of row i
 * from r[first + i * stride] on. The CSV has a line a row and reading. */
struct table2_readings {
    const struct table2_result *r;
    int rows, first, stride, runs;
};
void table2_readings_print(FILE *f, const struct table2_readings *t);
void table2_readings_csv(FILE *f, const struct table2_readings *t);

/* A table2_judge: the stiffness in every way of reading.h. */
void readings_judge(
    const struct fall_log *log, const struct sim_device *d, struct table2_result *r);

#endif
