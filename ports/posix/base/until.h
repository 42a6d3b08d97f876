/* SPDX-License-Identifier: MIT */
/* Runs until it is stopped: Ctrl-C or a time limit. */
#ifndef CLI_UNTIL_H
#define CLI_UNTIL_H

/* From now on SIGINT and SIGTERM set posix_interrupted(). A call that waits then comes back, or
 * waits on. */
enum until_wait { UNTIL_COMES_BACK, UNTIL_RESTARTS };
void until_catch(enum until_wait wait);

/* Of the clock that never jumps, s. */
double until_now_s(void);

#endif
