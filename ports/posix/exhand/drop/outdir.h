/* SPDX-License-Identifier: MIT */
/* The directory that `exhand drop --out` leaves its files in. */
#ifndef DROP_OUTDIR_H
#define DROP_OUTDIR_H

#include "box/table2_runs.h"

/* Makes the directory if need be and sees whether files can be made. 0, or 2 after a line on
 * stderr. */
int outdir_open(const char *dir);

/* Pictures of an earlier run must not look as if they were of this one. */
void outdir_clear(const char *dir);

/* DIR/drop_RATEHz + suffix: what belongs to one rate. */
void outdir_path(char to[TABLE2_PATH_B], const char *dir, double rate_Hz, const char *suffix);

/* table2.csv of the rows, runs.csv of the results. 0, or 1 after a line on stderr. */
int outdir_table(const char *dir, const struct table2_runs *r, int rows);
int outdir_runs(const char *dir, const struct table2_result *r, int n);

/* pictures.gp: what gnuplot needs to draw the pictures of one run a rate, run inside the directory.
 * 0, or 1 after a line on stderr. rows > 0. */
int outdir_pictures(
    const char *dir, const struct sim_device *d, const struct table2_result *r, int rows);

#endif
