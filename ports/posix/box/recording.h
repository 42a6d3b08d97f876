/* SPDX-License-Identifier: MIT */
/* Recording: a glove's rows from a text file.
 *
 * A row is a line: 22 numbers in the order of the glove's sensors, with commas, semicolons,
 * blanks or tabs between, and a label behind them if you like. Lines end in LF, CR LF or CR;
 * empty ones are no rows; those between rows are counted and said. The first may be a header. If
 * the header begins with t_s, as that of our own CSVs does, the first column is time, whatever
 * follows the 22 is ignored, and a unit at the end of a name (_rad, _deg, _turn) is believed.
 * Columns that were asked for (recording_columns.h) are the sensors, time and label; all others may
 * hold anything. Then every row has as many columns as the first line, and time goes on by no more
 * than ten seconds from row to row.
 * Whole numbers all of them, some beyond pi: A/D codes; else angles in radians.
 * What is not a number there (nan, inf, nothing) is NAN in its row, counted and said.
 */
#ifndef CLI_RECORDING_H
#define CLI_RECORDING_H

#include "box/recording_ask.h"

#include "exhand/glove.h"

#define RECORDING_LABEL_B 32

struct recording {
    double (*row)[EXH_GLOVE_SENSORS]; /* codes, or rad; NAN: there was no number */
    double *t_s;                      /* of each row, from the first on; NULL: not asked for */
    char (*label)[RECORDING_LABEL_B]; /* of each row; NULL: not asked for */
    long rows;
    int codes; /* 1: codes, not always whole */
};

/* "-" is standard input. 0, or 2 or 3 after a line on stderr that names file, line and column. */
int recording_read(struct recording *r, const char *path, const struct recording_ask *ask);
/* For whoever moves a hand by it: what was no number stays as it was; 0, if it never was one. */
void recording_hold(struct recording *r);

/* Rows a second in the mean by t_s; 0 if that is not known. */
double recording_row_hz(const struct recording *r);
/* How many steps of t_s are longer than one and a half of the mean. */
long recording_gaps(const struct recording *r);
void recording_free(struct recording *r);

#endif
