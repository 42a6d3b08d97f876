/* SPDX-License-Identifier: MIT */
/* Hand record: what a glove recorded, as string for simulated fingers.
 *
 * Two kinds of text: rows of 22 angles in the glove's order, as recording.h reads them, equally far
 * apart; and rows of 30 numbers, a date (year, month, day, hour, minute, second), a flag and 23
 * angles in radians, which have a clock that jitters: they are put on an even 60 Hz grid, on
 * straight lines between rows. What is flexion counts as in hand.h; whether up or down is
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

/* row_hz: of rows without a clock. Arms: of the fingers of exo. 0, or after a line on stderr 2, 3
 * if it is not there. */
int hand_record_read(
    struct hand_record *h, const char *path, double row_hz, const struct sim_exo_par *exo);
void hand_record_free(struct hand_record *h);

/* It is played again and again: behind its last row a way of a second leads back to its first. 0,
 * or 2 after a line on stderr. */
int hand_record_again(struct hand_record *h);

/* The fingers of exo do what was recorded; h must outlive the run. */
void hand_record_use(const struct hand_record *h, struct sim_exo_par *exo);

#endif
