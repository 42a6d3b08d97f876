/* SPDX-License-Identifier: MIT */
/* Logistic: the gain at which half of the falls come to rest, with its interval, from counts of
 * falls that rest along a ray of rising gains.
 *
 *   P(rest) = e + (1 - 2 e) / (1 + exp((x - m) / s)),   x the gain in octaves, e = 0.5 %
 *
 * m and s are those of maximum likelihood. The interval of m has every m whose likelihood, at its
 * best s, is near enough to the maximum, by chi square of one degree. If the counts scatter more
 * than binomial, the limit grows by that factor. e prevents that one odd fall far from the border
 * moves it. The result depends little on the distance of the gains and the number of falls. These
 * make the interval wide or narrow. */
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

/* Nodes below the first one at which half of the falls rest are left out. There the wall is too
 * weak to stop the mass in time, which is not the border of stability. */
struct logistic logistic_fit(const struct logistic_node *node, int n);

#endif
