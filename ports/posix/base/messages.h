/* SPDX-License-Identifier: MIT */
/* Lines on stderr while a box runs. A separate thread writes them, so that no tick waits for a
 * stopped terminal or a full pipe. Before words_begin() and after words_end() they are written
 * directly. */
#ifndef CLI_WORDS_H
#define CLI_WORDS_H

#include <stdint.h>

#define WORDS_LINE_B 1024

/* If paced, a line that finds no room is lost and counted. Otherwise it waits for room, 2 s at
 * most. Error messages (option.h) take this way, too. Without a thread, lines are written
 * immediately. */
void words_begin(int paced);
void words_end(void); /* waits 1 s at most for what was said before; repeatable */

/* A whole line, its end not with it. Any thread's. */
void words_say(const char *line);

/* The line of status, over the one before; one that is shorter than WORDS_LINE_B - 8. Lost without
 * a word where half the room is taken: lines that were said have the other half. */
void words_show(const char *line);

/* Lines said and lost since words_begin(). */
uint32_t words_lost(void);

#endif
