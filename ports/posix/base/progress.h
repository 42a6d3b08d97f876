/* SPDX-License-Identifier: MIT */
/* How far a long run is, for who waits at a terminal. */
#ifndef CLI_PROGRESS_H
#define CLI_PROGRESS_H

/* "LABEL: DONE/N", or "LABEL: DONE" where nobody knows of how many, N = 0, over what stood there on
 * standard error; over: the line ends. Nothing where that is no terminal, or label is NULL. */
void progress_show(const char *label, int done, int n, int over);

#endif
