/* SPDX-License-Identifier: MIT */
/* Reports the progress of arming after a RUN command, from a scene's signals state, arm_step and
 * present. */
#ifndef CLI_ARMING_H
#define CLI_ARMING_H

#include <stdint.h>

enum arming { ARMING_GOES_ON, ARMING_RUNS, ARMING_REFUSED };

/* After a tick that is not the first before RUN was commanded. */
enum arming arming_is(int32_t state);

/* RUN or LIMIT: the gate is open, all of the force limit is there. */
int arming_runs(int32_t state);

/* A line on stderr: which step did not hold, and why. */
void arming_complain(int32_t arm_step, int32_t present);

#endif
