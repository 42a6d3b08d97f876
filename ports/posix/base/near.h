/* SPDX-License-Identifier: MIT */
/* "Did you mean": the word of a list that is nearest to what was typed. */
#ifndef BASE_NEAR_H
#define BASE_NEAR_H

#include <stddef.h>

struct near {
    const char *word;
    size_t len;
    const char *best; /* NULL: none is near enough */
    size_t off;       /* letters to change, or neighbours to swap, up to best */
};

struct near near_to(const char *word, size_t len);

/* `may` is one word of the list. */
void near_try(struct near *n, const char *may);

#define NEAR_B 64

/* ": did you mean LEAD and the word?", or nothing. */
const char *near_text(char text[NEAR_B], const struct near *n, const char *lead);

#endif
