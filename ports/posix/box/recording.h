/* SPDX-License-Identifier: MIT */
/* Recording: a glove's rows from a text file.
 *
 * A row is a line: 22 numbers in the order of the glove's sensors, with commas, semicolons,
 * blanks or tabs between, and a label behind them if you like. Lines end in LF, CR LF or CR;
 * empty ones are passed over. The first may be a header. If the header begins with t_s, as
 * that of our own CSVs does, the first column is time, whatever follows the 22 is ignored, and
 * a unit at the end of a name (_rad, _deg, _turn) is believed.
 * Whole numbers all of them, some beyond pi: A/D codes; else angles in radians.
 */
#ifndef CLI_RECORDING_H
#define CLI_RECORDING_H

#include "exhand/glove.h"

enum recording_unit {
    RECORDING_GUESS,
    RECORDING_CODES,
    RECORDING_RAD,
    RECORDING_DEG,
    RECORDING_TURN
};

/* "codes", "rad", ... in this order, from 1; RECORDING_GUESS for another. */
enum recording_unit recording_unit_of(const char *name);

struct recording {
    double (*row)[EXH_GLOVE_SENSORS]; /* codes, or rad */
    long rows;
    int codes; /* 1: codes */
};

/* "-" is standard input. 0, or 2 or 3 after a line on stderr that names file, line and column. */
int recording_read(struct recording *r, const char *path, enum recording_unit unit);
void recording_free(struct recording *r);

#endif
