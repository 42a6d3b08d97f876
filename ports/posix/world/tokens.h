/* SPDX-License-Identifier: MIT */
/* The tokeniser of scenes: a line as words, its "key value" pairs by a table, errors that say
 * where, what, and what to do. */
#ifndef WORLD_TOKENS_H
#define WORLD_TOKENS_H

#include <stddef.h>

#define TOKENS_MAX 64

struct tokens {
    const char *file;
    int line, n;
    char *word[TOKENS_MAX];
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
int tokens_part(struct tokens *w, char *text);

/* Says file:line: and this; always 1. */
#ifdef __GNUC__
__attribute__((format(printf, 2, 3)))
#endif
int tokens_complain(struct tokens *w, const char *format, ...);

/* Reads the pairs from word[from] on into the table; 0 or 1. */
int tokens_pairs(struct tokens *w, int from, struct pair *p, int n);

#endif
