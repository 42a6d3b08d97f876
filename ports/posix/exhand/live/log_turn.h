/* SPDX-License-Identifier: MIT */
/* A log of many files: FILE is the newest, FILE.1 the one before, and so on. */
#ifndef CLI_LOG_TURN_H
#define CLI_LOG_TURN_H

#include <stdint.h>

#define LOG_TURN_LEAST_B (UINT64_C(64) << 10)
#define LOG_TURN_MOST_B  (UINT64_C(1) << 40)

/* --log-size: ctx is the uint64_t. */
int log_turn_take_size(void *ctx, const char *text);

/* turns: there are to be many, and what is there of a run before becomes an old one. keep: how many
 * old ones stay; < 0: all. An exit status, after a line on stderr. */
int log_turn_open(const char *path, int turns, int64_t keep);

/* The file behind fd has ended: it gets its name, the old ones' move on. errno, or 0. */
int log_turn(int fd);
/* The latter alone. */
int log_turn_shift(void);

/* So much was written in all: one word if the disk runs low. */
void log_turn_look(uint64_t all_B);
extern uint64_t (*log_turn_free_B)(const char *path); /* of its disk; tests have their own */

#endif
