/* SPDX-License-Identifier: MIT */
/* Logs on their way to a file (outfile.h). */
#ifndef CLI_OUTLOG_H
#define CLI_OUTLOG_H

#include <stdint.h>
#include <stdio.h>

/* 1: it has a header and a frame, or is no regular file and cannot be read again. */
int outlog_has_frame(FILE *f);

/* It has ended. Whole is one with a header and a frame: else nothing of it is left. 0, or 1 after a
 * line on stderr: it could not be written. */
int outlog_close(FILE *f);

/* Call it when a write failed. Cuts the file after its last whole record, and appends a record with
 * the number of missing ones: of `taken` those that are not in the file, and `lost`. Returns 0, and
 * outlog_close() may follow; or -1: nothing can be kept. */
int outlog_mend(FILE *f, uint32_t taken, uint32_t lost);

#endif
