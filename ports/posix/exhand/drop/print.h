/* SPDX-License-Identifier: MIT */
/* Table II as it is printed and written. */
#ifndef DROP_PRINT_H
#define DROP_PRINT_H

#include "box/table2.h"

#include <stdio.h>

/* table2.csv: header and a line; empty fields where there is none. */
void table2_csv_header(FILE *f);
void table2_csv_line(FILE *f, const struct table2_result *r);

/* For people: the runs, then what the paper has otherwise. */
void table2_print_runs(FILE *f, const struct table2_result *r, int rows);
void table2_print_paper(FILE *f, const struct table2_result *r, int rows);

#endif
