/* SPDX-License-Identifier: MIT */
/* Recording columns: which columns of a text are sensors, time and label.
 *
 * A list with commas: numbers from 1, names of the header, and ranges A-B of either are the
 * 22 sensors in the order of the glove. time=C, time_ms=C or time_us=C is time that rises,
 * clock=A-C are hour, minute and second of a day, label=C is a label.
 */
#ifndef CLI_RECORDING_COLUMNS_H
#define CLI_RECORDING_COLUMNS_H

#include "box/recording_line.h"

#include "exhand/glove.h"

enum recording_use {
    RECORDING_NOTHING,
    RECORDING_SENSOR, /* and 21 more */
    RECORDING_TIME = RECORDING_SENSOR + EXH_GLOVE_SENSORS,
    RECORDING_MINUTE, /* of a clock: RECORDING_TIME is its hour */
    RECORDING_SECOND,
    RECORDING_LABEL,
    RECORDING_USES
};

struct recording_columns {
    unsigned char use[RECORDING_COLUMNS]; /* of column 1 first: enum recording_use */
    int last;                             /* the last one in use, from 1 */
    double time_s;                        /* one of the time column; 0: a clock, or no time */
    int named;                            /* by names of a header */
};

/* The 22 sensors from column `first` on. */
void recording_columns_plain(struct recording_columns *c, int first);

/* text is the list; head is the first line, which may be a header. 0, or 2 after a line on stderr
 * that begins with path. */
int recording_columns_read(struct recording_columns *c, const char *text,
    const struct recording_line *head, const char *path);

/* Whether a column is used as that. */
int recording_columns_has(const struct recording_columns *c, enum recording_use use);

#endif
