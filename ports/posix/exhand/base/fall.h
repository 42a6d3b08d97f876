/* SPDX-License-Identifier: MIT */
/* Part: what the files of the analysis share among themselves (analysis.h). */
#ifndef CLI_PART_H
#define CLI_PART_H

#include "base/analysis.h"

/* Physical values lie far below; the square of this is far from overflow. */
#define VALUE_MAX 1e9

/* False for NaN too: a NaN compares false with everything. */
static inline int sane(double x)
{
    return x > -VALUE_MAX && x < VALUE_MAX;
}

/* Never a null pointer for an empty list; calloc refuses a product that wraps. */
void *part_alloc(size_t n, size_t size_B);

/* dissect.c: the sample behind the last of a fall, and whether a log can be used. */
size_t part_fall_end(const struct fall_log *log, size_t fall);
enum fall_status part_check_log(const struct fall_log *log);

/* pairs.c: an empty list with room for cap pairs; averages into a list that has room
 * for as many pairs as `sorted` holds. */
enum fall_status part_pairs_alloc(struct fall_pairs *p, size_t cap);
void part_average_into(const struct fall_pairs *sorted, enum fall_force force,
                       struct fall_pairs *out);

#endif
