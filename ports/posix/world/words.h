/* SPDX-License-Identifier: MIT */
/* A line of a scene as words, and its "key value" pairs by a table, with errors that say where,
 * what, and what to do. */
#ifndef WORLD_WORDS_H
#define WORLD_WORDS_H

#include <stddef.h>

#define WORDS_MAX 64

struct words {
    const char *file;
    int line, n;
    char *word[WORDS_MAX];
    char *error; /* "" until something is wrong; the first fault stays */
    size_t error_B;
};

struct pair {
    const char *key;
    int numbers;   /* how many follow; 0: one word */
    void *to;      /* double[numbers], or const char * */
    double lo, hi; /* of each number */
    int must, seen;
};

/* Parts text, up to a # if there is one. 0, or 1: too many words. */
int words_part(struct words *w, char *text);

/* Says file:line: and this; always 1. */
#ifdef __GNUC__
__attribute__((format(printf, 2, 3)))
#endif
int words_complain(struct words *w, const char *format, ...);

/* Reads the pairs from word[from] on into the table; 0 or 1. */
int words_pairs(struct words *w, int from, struct pair *p, int n);

#endif
