/* SPDX-License-Identifier: MIT */
/* Eigen: how large the largest eigenvalue of a small matrix is. */
#ifndef SIM_EIGEN_H
#define SIM_EIGEN_H

#define EIGEN_MAX 64

struct matrix {
    int n;
    double m[EIGEN_MAX][EIGEN_MAX];
};

/* The spectral radius, by balancing, reduction to Hessenberg form and QR steps with
 * complex shifts. < 0: an eigenvalue did not settle (no matrix that did so is known).
 * + - x / and square roots only. */
double eigen_radius(const struct matrix *M);

/* Square root from + - x /, for v >= 0; correct to the last digit or the one before. */
double sim_sqrt(double v);

#endif
