/* SPDX-License-Identifier: MIT */
/* Hand record: what a glove recorded, as string for simulated fingers.
 *
 * Rows have 22 angles as recording.h reads them. They are equally spaced in time, or have a time
 * that jitters. Then linear interpolation puts them on an even 60 Hz grid. Rows of 30 numbers are
 * known without columns: a date (year, month, day, hour, minute, second), a flag and 23 angles in
 * radians. What is flexion counts as in hand.h; whether up or down is
 * seen from the rows.
 */
#ifndef CLI_HAND_RECORD_H
#define CLI_HAND_RECORD_H

#include "sim/exo.h"

struct hand_record {
    double *string_m[SIM_FINGERS]; /* rows each */
    long rows;
    double row_hz;
    int again;
};

/* columns: recording_columns.h, or NULL. row_hz: of rows without time. Arms: of the fingers of exo.
 * 0, or after a line on stderr 2, 3 if it is not there. */
int hand_record_read(struct hand_record *h, const char *path, const char *columns, double row_hz,
    const struct sim_exo_par *exo);
void hand_record_free(struct hand_record *h);

/* It is played again and again: behind its last row a way of a second leads back to its first. 0,
 * or 2 after a line on stderr. */
int hand_record_again(struct hand_record *h);

/* The fingers of exo do what was recorded; h must outlive the run. */
void hand_record_use(const struct hand_record *h, struct sim_exo_par *exo);

#endif
