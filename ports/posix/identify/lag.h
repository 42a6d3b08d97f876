/* SPDX-License-Identifier: MIT */
/* Separates the delay into a wait and a lag of the drive. The motion gives only their sum. The
 * monitor of the current separates them by the shape of its steps: command -> wait -> the drive's
 * next sample, by its own clock -> lag -> current -> lag -> monitor. From outside both lags look
 * the same. The delay of the motion includes the drive's lag, not the monitor's. */
#ifndef IDENTIFY_LAG_H
#define IDENTIFY_LAG_H

#include "identify/data.h"

struct lag {
    double wait_s;    /* before the drive may look; half its period more, in the mean of all runs */
    double run_s;     /* the same with the mean of this run until it looked */
    double drive_s;   /* of the current behind the command */
    double monitor_s; /* of the monitor behind the current */
    /* Standard errors of both lags. A short one looks like a wait: so much of either may be one. */
    double drive_error_s, monitor_error_s;
};

/* delay_s: estimate from the motion. Scale and zero of the monitor do not matter. 0; 1: no
 * information; -1: out of memory. */
int lag_tell(struct lag *lag, const struct identify_data *d, double delay_s);

void lag_swap(struct lag *lag);
/* Which of both lags is the drive's: with it this run's delay is the motion's. */
void lag_order(struct lag *lag, double delay_s);

#endif
