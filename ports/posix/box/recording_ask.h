/* SPDX-License-Identifier: MIT */
/* --columns and --scale of a recording: where the sensors are, and what makes codes of them. */
#ifndef BOX_RECORDING_ASK_H
#define BOX_RECORDING_ASK_H

#include "exhand/glove.h"

#define RECORDING_NAME_B 64

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
    const char *columns; /* of the 22 sensors: "3-24", "8-14,16-30", names; NULL: the first 22 */
    const char *scale;   /* "A" or "A,B": codes are A times the number and B; NULL: the numbers */
};

/* Whether columns and scale can be read at all: 0, or 2 after a line on stderr. */
int recording_check(const struct recording_ask *ask);

struct recording_sensors {
    int given;                                      /* 0: the first columns */
    int column[EXH_GLOVE_SENSORS];                  /* of each sensor, from 1; 0: by name */
    char name[EXH_GLOVE_SENSORS][RECORDING_NAME_B]; /* to be found in the header */
    int scaled;
    double gain, offset; /* a code is gain times the number and offset; 1 and 0 where not scaled */
};

/* 0, or 2 after a line on stderr. */
int recording_sensors_of(struct recording_sensors *to, const struct recording_ask *ask);

#endif
