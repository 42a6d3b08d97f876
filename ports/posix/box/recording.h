/* SPDX-License-Identifier: MIT */
/* Recording: a glove's rows from a text file.
 *
 * A row is a line: 22 numbers in the order of the glove's sensors, with commas, semicolons,
 * blanks or tabs between, and a label behind them if you like. Lines end in LF, CR LF or CR;
 * empty ones are no rows; those between rows are counted and said. The first may be a header. If
 * the header begins with t_s, as that of our own CSVs does, the first column is time, whatever
 * follows the 22 is ignored, and a unit at the end of a name (_rad, _deg, _turn) is believed.
 * Columns that were asked for are the sensors; all others may hold anything.
 * Whole numbers all of them, some beyond pi: A/D codes; else angles in radians.
 * What is not a number there (nan, inf, nothing) is NAN in its row, counted and said.
 */
#ifndef CLI_RECORDING_H
#define CLI_RECORDING_H

#include "box/recording_ask.h"

/* "codes", "rad", ... in this order, from 1; RECORDING_GUESS for another. */
enum recording_unit recording_unit_of(const char *name);

struct recording {
    double (*row)[EXH_GLOVE_SENSORS]; /* codes, or rad; NAN: there was no number */
    long rows;
    int codes; /* 1: codes, not always whole */
};

/* "-" is standard input. 0, or 2 or 3 after a line on stderr that names file, line and column. */
int recording_read(struct recording *r, const char *path, const struct recording_ask *ask);
/* For whoever moves a hand by it: what was no number stays as it was; 0, if it never was one. */
void recording_hold(struct recording *r);
void recording_free(struct recording *r);

#endif
