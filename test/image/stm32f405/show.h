/* SPDX-License-Identifier: MIT */
/* A run for a person, on stdout. */
#ifndef SHOW_H
#define SHOW_H

#include <stdint.h>

/* What the image has said before its loop. */
void show_words(const char *image);
/* How it did; bad: it computed otherwise, or ended early. */
void show_run(int bad, uint32_t most_of_99);

#endif
