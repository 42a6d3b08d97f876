/* SPDX-License-Identifier: MIT */
/* Observations from the counts of a run: each count that the string passes, in or out. For a count
 * at rest only its edges are known, and where the string turns only one edge. A count that is
 * passed is its middle, as mean over its ticks. */
#ifndef IDENTIFY_OBSERVE_H
#define IDENTIFY_OBSERVE_H

#include "identify/data.h"

struct observation {
    uint32_t from, ticks; /* samples */
    float cnt;            /* its middle */
    float weight;         /* 1 / (expected deviation)^2 */
    float share;          /* of the weight that counts, as fit_weigh() left it; at first 1 */
    uint32_t group;       /* part of a round: where it lies in all is not known */
    uint16_t round;
};

struct observations {
    struct observation *o;
    size_t n;
    double counted; /* of them, each by its share */
    unsigned groups, rounds;
    size_t last; /* samples that are needed of the rounds wanted */
};

/* No group is longer than group_s: what the drive took over sooner or later adds up. Of the first
 * `rounds` of these stages (bits); 0: of all. 0, or -1: out of memory. Free it in any case. */
int observe(struct observations *to, const struct identify_data *d, unsigned stages,
    unsigned rounds, double group_s);
/* The same without the square wave and the time after it until a slow pull. There the string may
 * have slackened and struck. */
int observe_calm(struct observations *to, const struct identify_data *d, unsigned stages,
    unsigned rounds, double group_s);
void observe_free(struct observations *o);

#endif
