/* SPDX-License-Identifier: MIT */
/* How far a long run is, for who waits at a terminal. */
#ifndef CLI_PROGRESS_H
#define CLI_PROGRESS_H

/* Shows "LABEL: DONE/N" on stderr over the last text, or "LABEL: DONE" if N = 0, unknown; over:
 * ends the line. Nothing if stderr is no terminal or label is NULL. */
void progress_show(const char *label, int done, int n, int over);

#endif
