/* SPDX-License-Identifier: MIT */
/* Pairs of position and monitored force: pooled, sorted, averaged. */
#ifndef BASE_PAIRS_H
#define BASE_PAIRS_H

#include "falls/fall.h"

/* All pairs of the contacts, in log order. The monitor answers the command of the previous tick. So
 * lag 1 pairs it with the position of that command. Both samples lie in the same contact. Its first
 * `lag` forces answer earlier commands, and its last `lag` positions are answered later, so these
 * have no partner. A contact of n samples gives n - lag pairs. The caller may thin out `contacts`
 * before, for instance to the first of each fall. */
enum fall_status fall_pool(const struct fall_log *log, const struct fall_contacts *contacts,
    size_t lag, struct fall_pairs *out);

/* Keeps lo <= F <= hi and sorts by rising force; ties keep their order. */
enum fall_status fall_band(
    const struct fall_pairs *in, double lo_N, double hi_N, struct fall_pairs *out);

/* Trailing windows of ten over `sorted`: n - 9 pairs (none below ten), pair i from
 * sorted pairs i .. i + 9. No window reaches over an end, none is shortened. */
enum fall_status fall_average(
    const struct fall_pairs *sorted, enum fall_force force, struct fall_pairs *out);
void fall_pairs_free(struct fall_pairs *pairs);

/* An empty list with room for cap pairs; averages into a list that has room for as many pairs as
 * `sorted` holds. */
enum fall_status fall_pairs_alloc(struct fall_pairs *p, size_t cap);
void fall_average_into(
    const struct fall_pairs *sorted, enum fall_force force, struct fall_pairs *out);

#endif
