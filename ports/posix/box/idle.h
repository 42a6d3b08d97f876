/* SPDX-License-Identifier: MIT */
/* Idle: skips the rest of a fall at rest, whose result is known. Condition: the device is at rest
 * to the last bit (sim/still.h), and a tick has left the controller's state unchanged. Every
 * further tick then repeats, except for the noise of the monitor. Only current tracking sees that
 * noise, and must be unable to react. So no digit of the results changes. For scene drop only,
 * without an observer of its ticks. */
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
