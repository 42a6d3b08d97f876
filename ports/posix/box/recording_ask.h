/* SPDX-License-Identifier: MIT */
/* --columns, --scale and --unit of a recording. */
#ifndef BOX_RECORDING_ASK_H
#define BOX_RECORDING_ASK_H

enum recording_unit {
    RECORDING_GUESS,
    RECORDING_CODES,
    RECORDING_RAD,
    RECORDING_DEG,
    RECORDING_TURN
};

/* How a file is to be read; all zeros: as recording.h says. */
struct recording_ask {
    enum recording_unit unit;
    const char *columns; /* recording_columns.h; NULL: the first 22 */
    const char *scale;   /* "A" or "A,B": codes are A times the number and B; NULL: the numbers */
};

struct recording_scale {
    int given;
    double gain, offset; /* a code is gain times the number and offset; 1 and 0 where not given */
};

/* "codes", "rad", ... in this order, from 1; RECORDING_GUESS for another. */
enum recording_unit recording_unit_of(const char *name);

/* 0, or 2 after a line on stderr. */
int recording_scale_of(struct recording_scale *to, const char *text);

#endif
