/* SPDX-License-Identifier: MIT */
/* The files that a command leaves in the directory of its --out. */
#ifndef CLI_OUTFILE_H
#define CLI_OUTFILE_H

#include <stdio.h>

/* Makes the directory if need be; name is the longest of what will be in it. 0, or 2 after
 * a line on stderr. */
int outfile_dir(const char *dir, const char *name);

/* DIR/NAME by a function that writes it. 0, or 1 after a line on stderr: nothing is ever
 * written elsewhere. */
int outfile_write(
    const char *dir, const char *name, void (*write)(FILE *f, const void *ctx), const void *ctx);

/* An image of at most cap bytes that an option names: its length, or -status after a line on
 * stderr that says what file was expected. */
long outfile_read(
    const char *option, const char *path, const char *expected, void *to, size_t cap_B);

#endif
