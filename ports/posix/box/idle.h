/* SPDX-License-Identifier: MIT */
/* Idle: the rest of a fall that has come to rest is known, and need not be run.
 *
 * Once the device stands still to the last bit (sim/still.h) and a tick has left the controller's
 * state as it was, every further tick of the fall is that one again, but for the noise of the
 * monitor. What that noise reaches, the tracking of the current, must be out of its reach. So
 * nothing is guessed and no digit hangs on it. Scene drop alone, with nobody watching its ticks. */
#ifndef CLI_IDLE_H
#define CLI_IDLE_H

#include "drop/drop.h"

struct idle {
    struct drop was; /* the state a tick ago, */
    int there;       /* if it was still then */
};

/* Behind a tick: is every further one of this fall the same? */
int idle_step(struct idle *i);

/* So many have passed: what counts ticks has counted them. */
void idle_passed(uint32_t ticks);

/* Force by the monitor, N, q20, as the scene has it. */
int32_t idle_monitor_N_q20(int16_t mon_raw);

#endif
