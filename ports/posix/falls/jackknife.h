/* SPDX-License-Identifier: MIT */
/* How sure the line is: one fall left out after the other. */
#ifndef BASE_JACKKNIFE_H
#define BASE_JACKKNIFE_H

#include "falls/fall.h"

/* 95 %, N/m. UNBOUNDED: hi is 0 and there is no upper end (lo is 0 where it has none
 * either); any other status but OK: both are 0. */
struct fall_interval {
    enum fall_status status;
    double lo_Npm, hi_Npm;
    size_t falls; /* that have pairs in the band */
};

/* Leaves out one fall after another and repeats average and fit. The interval is the estimate +- t
 * times the jackknife's standard error; t has one degree of freedom less than falls. `sorted` is
 * the output of fall_band(). Falls are independent of each other, pairs are not.
 *
 * The interval of B is computed from its slope (m/N) and then inverted: a slope that scatters
 * through zero would make B jump from +inf to -inf. The interval covers the mean of the estimator,
 * which is not k. `make coverage` shows both. It also shows that percentiles of a bootstrap over
 * ten falls do not cover it. */
enum fall_status fall_jackknife(const struct fall_pairs *sorted, size_t falls,
    enum fall_force force, struct fall_interval *a, struct fall_interval *b);

/* 97.5 % of Student's t, of 1 degree of freedom or more. */
double fall_t(size_t degrees);

#endif
