/* SPDX-License-Identifier: MIT */
/* Samples of the lines of an encoder, out of bytes or CSV, a chunk at a time. */
#ifndef CLI_SAMPLES_H
#define CLI_SAMPLES_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define SAMPLES_CHUNK 4096

/* Which of the samples, and where in one the lines are. */
struct samples_opt {
    const char *csv;     /* path, "-" standard input, NULL: bytes from there */
    double rate_Hz;      /* 0: CSV has a column of time */
    int64_t a, b, index; /* bits of a byte; index < 0: none */
    int64_t every;       /* one in so many is kept, the first being one */
};

struct samples {
    const struct samples_opt *opt;
    FILE *from;
    const char *name;
    uint64_t seen;        /* samples read */
    uint64_t line;        /* of CSV */
    int named;            /* its columns have been */
    uint64_t skip;        /* before the next one kept */
    int64_t t_ns;         /* the last one's, of CSV with time */
    uint8_t of_byte[256]; /* index<<2 | A<<1 | B */
};

struct samples_chunk {
    size_t n;
    uint8_t line[SAMPLES_CHUNK]; /* index<<2 | A<<1 | B */
    int64_t at[SAMPLES_CHUNK];   /* sample number, or ns of CSV with time */
};

/* Status: 0, or 2 or 3 after a line on stderr. */
int samples_open(struct samples *s, const struct samples_opt *opt);
/* The next that are kept; c->n is 0 at the end only. */
int samples_next(struct samples *s, struct samples_chunk *c);
void samples_close(struct samples *s);

/* Microseconds between two samples. */
double samples_us(const struct samples *s, int64_t gap);

#endif
