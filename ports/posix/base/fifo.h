/* SPDX-License-Identifier: MIT */
/* Files that may be FIFOs: who waits for the other end of one says so. */
#ifndef CLI_FIFO_H
#define CLI_FIFO_H

#include <stdio.h>

/* As open(), for reading or writing. Reports once if a FIFO has no other end within a second, or
 * delivers nothing. A signal with a handler ends the wait: EINTR. */
int fifo_open(const char *path, int how);

/* As fopen(), to read. */
FILE *fifo_read(const char *path);

/* 1 if it is a FIFO. */
int fifo_is(const char *path);

#endif
