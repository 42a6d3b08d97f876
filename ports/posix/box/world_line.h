/* SPDX-License-Identifier: MIT */
/* World line: whether there is a world at the other end of --udp. A change is printed on stderr,
 * with the option and its value. The box goes on. */
#ifndef BOX_WORLD_LINE_H
#define BOX_WORLD_LINE_H

#include "posix.h"

#include <stdio.h>

struct bilateral_box;

/* What --udp gives: HOST:PORT, a name or numbers. The board's line leads there, from any port of
 * ours, with the key in the file that --key gives (NULL: none). Without --udp none goes with it. 0,
 * or 2 after a line on stderr. */
int world_line_use(const char *given, const char *key, struct posix_line *line);

/* The device is simulated, so a tick that another program delayed is made up for: both ends are to
 * be tried, not this machine. */
#define WORLD_LINE_SLACK_S 1.0

/* A run begins; a tick of it has ended. */
void world_line_start(void);
void world_line_after(const struct bilateral_box *box);

/* During a run: whether a world's packet has come; its present problem, "" if none; and a summary
 * line. */
int world_line_heard(void);
const char *world_line_word(void);
void world_line_print(FILE *f, const struct bilateral_box *box);

#endif
