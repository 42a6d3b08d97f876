/* SPDX-License-Identifier: MIT */
/* Faults of the chip and of what is wired to it, from random times of a run in closed loop. */
#ifndef FAULTS_H
#define FAULTS_H

#include "kinds.h"

/* `times` of a set in turn, drawn with this seed. A table on stdout. 0: each as its kind says. */
int stm_faults(struct machine *m, unsigned times, uint64_t seed, enum kind_set set);

/* The supply fails in so many operations of a save into flash, the first and the last among them. A
 * line on stdout. 0: each time the earlier parameters or the new ones are there, and the image says
 * the same. */
int stm_cuts(struct machine *m, const char *image, unsigned times);

/* A small program leaves memory, each way. A line on stdout. 0: each ends in its state. */
int stm_jumps(void);

#endif
