/* SPDX-License-Identifier: MIT */
/* Ln: the natural logarithm from + - * /, so that every machine prints the same digits. */
#ifndef SIM_LN_H
#define SIM_LN_H

/* x > 0; within 1e-15 of the whole. */
double sim_ln(double x);

#endif
