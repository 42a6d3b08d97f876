/* SPDX-License-Identifier: MIT */
/* The contact law as one would write it with a floating-point unit: contact test, F0,
 * clamp. No dead band, no hysteresis, no ledger, no slew. To have a ratio in one run. */
#ifndef BENCH_LAW_H
#define BENCH_LAW_H

struct law_double {
    double k_Npm, b_Nspm, f0_N, lim_m, f_max_N;
};
double law_double(const struct law_double *p, double q_m, double v_mps);

struct law_float {
    float k_Npm, b_Nspm, f0_N, lim_m, f_max_N;
};
float law_float(const struct law_float *p, float q_m, float v_mps);

#endif
