/* SPDX-License-Identifier: MIT */
/* Logistic: from counts of falls that rest along a ray of rising gains to the gain at which half of
 * them do, with its interval.
 *
 *   P(rest) = e + (1 - 2 e) / (1 + exp((x - m) / s)),   x the gain in octaves, e = 0.5 %
 *
 * by maximum likelihood; the interval of m is where the likelihood, at its best s for each m, is
 * not too far below its maximum (chi square of one degree, times how far the counts scatter beyond
 * binomial where they do). e keeps one odd fall far from the border from moving it. Both hang
 * little on how close the gains lie or how many falls each has: these make the interval wide or
 * narrow. */
#ifndef LAB_DROP_LOGISTIC_H
#define LAB_DROP_LOGISTIC_H

struct logistic_node {
    double x; /* octaves, rising */
    int rest, falls;
};

enum logistic_status {
    LOGISTIC_OK,
    LOGISTIC_OPEN, /* most falls rest at the last node: the border lies beyond */
    LOGISTIC_NONE  /* at no node do half of the falls rest */
};

struct logistic {
    enum logistic_status status;
    double at, low, high; /* octaves: half of the falls rest, 95 % interval; open: the last node */
};

/* What lies below the first node at which half of the falls rest is left out: a wall too weak to
 * stop the mass in time is another matter than one too stiff. */
struct logistic logistic_fit(const struct logistic_node *node, int n);

#endif
