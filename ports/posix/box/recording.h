/* SPDX-License-Identifier: MIT */
/* Recording: a glove's rows from a text file. A row is a line of 22 numbers in the order of the
 * glove's sensors, with commas, semicolons, blanks or tabs between, and an optional label. Lines
 * end in LF, CR LF or CR. Empty lines are skipped; those between rows are counted and reported.
 *
 * The first line may be a header. If it begins with t_s, as in our own CSVs, the first column is
 * time and columns after the 22 are ignored. A unit at the end of a name (_rad, _deg, _turn) then
 * applies. With selected columns (recording_columns.h), these are the sensors, time and label;
 * others may contain anything. Then every row has as many columns as the first line, and time rises
 * by at most ten seconds per row.
 *
 * If all are integers and some exceed pi, they are A/D codes, else angles in radians. A value that
 * is not a number (nan, inf, empty) is NAN in its row, counted and reported. */
#ifndef CLI_RECORDING_H
#define CLI_RECORDING_H

#include "box/recording_ask.h"

#include "exhand/glove.h"

#define RECORDING_LABEL_B 32

struct recording {
    double (*row)[EXH_GLOVE_SENSORS]; /* codes, or rad; NAN: there was no number */
    double *t_s;                      /* of each row, from the first on; NULL: not wanted */
    char (*label)[RECORDING_LABEL_B]; /* of each row; NULL: not wanted */
    long rows;
    int codes; /* 1: codes, not always whole */
};

/* "-" is standard input. 0, or 2 or 3 after a line on stderr that names file, line and column. */
int recording_read(struct recording *r, const char *path, const struct recording_ask *ask);
/* For playback: a missing value keeps the last one, or 0 if there is none. */
void recording_hold(struct recording *r);

/* Rows a second in the mean by t_s; 0 if that is not known. */
double recording_row_hz(const struct recording *r);
/* How many steps of t_s are longer than one and a half of the mean. */
long recording_gaps(const struct recording *r);
void recording_free(struct recording *r);

#endif
