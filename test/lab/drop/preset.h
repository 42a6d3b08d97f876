/* SPDX-License-Identifier: MIT */
/* Original: the system that the paper started from, beside this box: tables of a column each, and
 * their picture.
 *
 * The original, as far as it is known: a loop at 90 Hz, the paper's gains for it, and an 8-bit
 * glove whose frame is one late. */
#ifndef CLI_ORIGINAL_H
#define CLI_ORIGINAL_H

#include "falls/analysis.h"

#include <stddef.h>

#define ORIGINAL_NAME    "original" /* of --preset */
#define ORIGINAL_RATE_HZ 90
#define ORIGINAL_BOX_HZ  2000
#define ORIGINAL_COLUMNS 6

/* 0 if text is the preset's name; 2 after a line on stderr. */
int original_take(const char *text);

struct original_row {
    const char *what, *unit;
    int digits;
};

/* Values as value[row * columns + column]; below ORIGINAL_NONE: there is none. */
#define ORIGINAL_NONE -1e29
struct original_table {
    const struct original_row *row;
    int rows, columns;
    const char *const *column;
    const double *value;
};
void original_print(const struct original_table *t);

/* DIR/original.csv, and original.gp, which draws the n traces 0 .. that original_trace() has
 * written. 0, or 1 after a line on stderr. */
int original_out(const char *dir, const struct original_table *t, const char *const *trace, int n);

/* DIR/original_N.csv: a contact from 10 ms before its first sample on: seconds since, metres past
 * wall_m, newtons. */
int original_trace(const char *dir, int n_th, const struct fall_sample *s, size_t n, size_t contact,
    double wall_m);

/* What samples in contact say together. */
struct original_contact {
    double peak_N, deepest_m, err_N; /* F_mon; past the wall; rms of F_mon less F_des */
    double rms_N;                    /* of F_des */
    size_t ticks;
};
void original_add(struct original_contact *c, const struct fall_sample *s, double wall_m);
void original_end(struct original_contact *c);

#endif
