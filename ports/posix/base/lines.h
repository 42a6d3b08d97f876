/* SPDX-License-Identifier: MIT */
/* Lines of a text, however they end. */
#ifndef CLI_LINES_H
#define CLI_LINES_H

#include <stddef.h>
#include <stdio.h>

/* The next line without its end: LF, CR or CR LF. A NUL becomes '?', so that the rest is not lost.
 * Returns 1, 0 after the last line, -1 if it does not fit. */
int lines_next(FILE *f, char *to, size_t cap_B);

/* As a terminal shows it and does not obey it: control characters, and bytes that are no UTF-8,
 * become \xHH. What does not fit is cut off. */
void lines_plain(char *to, size_t cap_B, const char *from);

/* Whether it is a terminal that can move its cursor: TERM=dumb can't. */
int lines_terminal(int fd);

#endif
