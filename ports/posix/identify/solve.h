/* SPDX-License-Identifier: MIT */
/* The step of Levenberg and Marquardt: a small symmetric system, its diagonal raised. */
#ifndef IDENTIFY_SOLVE_H
#define IDENTIFY_SOLVE_H

#define SOLVE_MAX 16

/* x of A x = g, by Cholesky; A is n x n, n <= SOLVE_MAX, its diagonal raised by that share.
 * 0; -1: not definite. */
int solve_raised(int n, const double *a, double raise, const double *g, double *x);

#endif
