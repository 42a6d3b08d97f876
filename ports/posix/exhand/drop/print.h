/* SPDX-License-Identifier: MIT */
/* Table II as it is printed and written. */
#ifndef DROP_PRINT_H
#define DROP_PRINT_H

#include "box/table2_runs.h"

#include <stdio.h>

/* table2.csv, a line a rate, and runs.csv, a line a run; empty fields where there is no value. */
void table2_csv_header(FILE *f);
void table2_csv_line(FILE *f, const struct table2_runs *r);
void table2_runs_csv_header(FILE *f);
void table2_runs_csv_line(FILE *f, const struct table2_result *r);

/* For people: the rows, then what the paper has otherwise. */
void table2_print_runs(FILE *f, const struct table2_runs *r, int rows);
void table2_print_paper(FILE *f, const struct table2_runs *r, int rows);

/* Both gates over the rows: a line each. How many rows fail one. */
int table2_print_gates(FILE *f, const struct table2_runs *r, int rows);

#endif
