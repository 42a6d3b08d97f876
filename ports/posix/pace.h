/* SPDX-License-Identifier: MIT */
/* The wall clock that a paced run follows: when a tick is due, and how many went by. */
#ifndef POSIX_PACE_H
#define POSIX_PACE_H

#include "exhand/units.h"

#include <signal.h>
#include <stdint.h>

/* Tick 0 is when it is first waited for. A tick that is at most slack_s late is made up for; 0:
 * every one that went by is missed. */
void pace_start(struct exh_period T, double slack_s);

/* Waits until this tick is due, or a signal comes and *end is set. Returns the number of later
 * ticks already due, which are missed, as on a board whose loop was late for an interrupt. 0 within
 * the slack. */
uint32_t pace_wait(uint64_t tick, const volatile sig_atomic_t *end);

#endif
