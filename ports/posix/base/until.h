/* SPDX-License-Identifier: MIT */
/* Until somebody stops it: Ctrl-C and the time, for commands that wait for what others send. */
#ifndef CLI_UNTIL_H
#define CLI_UNTIL_H

/* From now on SIGINT and SIGTERM set until_stopped(), and poll() comes back. */
void until_catch(void);
int until_stopped(void);

/* Of the clock that never jumps, s. */
double until_now_s(void);

#endif
