/* SPDX-License-Identifier: MIT */
/* Medians and other quantiles of many runs, of which some gave no value. */
#ifndef CLI_QUANTILE_H
#define CLI_QUANTILE_H

/* The value below which `share` (0..1) of the n values lie, between two of them in
 * proportion; sorts v. 0 unless more than half of the runs gave a value: the median of
 * a few would pass the exception for the rule. */
double quantile(double *v, int n, int runs, double share);

#endif
