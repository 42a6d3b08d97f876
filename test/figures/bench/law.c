/* SPDX-License-Identifier: MIT */
#include "law.h"

double law_double(const struct law_double *p, double q_m, double v_mps)
{
    double f = v_mps < 0 ? p->f0_N : 0;
    if (q_m >= p->lim_m) { f += p->k_Npm * (q_m - p->lim_m) + p->b_Nspm * v_mps; }
    return f < 0 ? 0 : f > p->f_max_N ? p->f_max_N : f;
}

float law_float(const struct law_float *p, float q_m, float v_mps)
{
    float f = v_mps < 0 ? p->f0_N : 0;
    if (q_m >= p->lim_m) { f += p->k_Npm * (q_m - p->lim_m) + p->b_Nspm * v_mps; }
    return f < 0 ? 0 : f > p->f_max_N ? p->f_max_N : f;
}
