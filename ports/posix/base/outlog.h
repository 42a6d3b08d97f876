/* SPDX-License-Identifier: MIT */
/* Logs on their way to a file (outfile.h). */
#ifndef CLI_OUTLOG_H
#define CLI_OUTLOG_H

#include <stdio.h>

/* It has ended. Whole is one with a header and a frame: else nothing of it is left. 0, or 1 after a
 * line on stderr: it could not be written. */
int outlog_close(FILE *f);

#endif
