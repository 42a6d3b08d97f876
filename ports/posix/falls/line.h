/* SPDX-License-Identifier: MIT */
/* The straight line through averaged pairs. */
#ifndef BASE_LINE_H
#define BASE_LINE_H

#include "falls/fall.h"

/* Least squares in both directions. A minimises the error in force, B that in
 * position; a/b = r2, so B is the larger. Everything is finite whatever the
 * status; what the status denies is 0 (TOO_FEW, FLAT: a, b and r2; NO_RISE: b). */
struct fall_fit {
    enum fall_status status;
    size_t n;     /* averaged pairs */
    double a_Npm; /* slope of F over mean q */
    double b_Npm; /* inverse slope of mean q over F */
    double r2;
    double q_mean_m, f_mean_N; /* both lines pass here */
    double q_min_m, q_max_m, f_min_N, f_max_N;
};

void fall_fit_line(const struct fall_pairs *averaged, struct fall_fit *out);

#endif
