/* SPDX-License-Identifier: MIT */
/* Many runs of one row of Table II, each with the wall at another place between two encoder counts:
 * what they say together. */
#ifndef BOX_TABLE2_RUNS_H
#define BOX_TABLE2_RUNS_H

#include "box/table2.h"

#define TABLE2_RUNS_MAX 1000

/* The gates of the simulated device, on shares of falls. */
#define TABLE2_REST_MIN  0.95 /* come to rest at the paper's gains */
#define TABLE2_SWING_MIN 0.75 /* oscillate at 1.5 times both */

struct table2_runs {
    double rate_Hz, k_Npm, b_Nspm;
    int runs;        /* done */
    int lines;       /* of these, with a stiffness */
    int places;      /* 1: each run has its own place of the wall */
    double phase;    /* of the first run, which is written and drawn, */
    double q_lim_m;  /* and its wall */
    unsigned faults; /* of all runs, enum exh_fault; and */
    int incomplete;  /* falls not seen to their end: if any, all values below are void */
    /* Over the runs that gave a line, if more than half did; 0: none. */
    double b_Npm, a_Npm, r2;      /* medians */
    double low_Npm, high_Npm;     /* 95 % interval of the median of B; one run: its jackknife's */
    double low_5_Npm, high_5_Npm; /* 5 % and 95 % of the runs */
    double resting;               /* median share of pairs logged when the motor had stopped; < 0 */
    int falls, oscillating;
    double rest;           /* share of falls that come to rest; < 0: none seen to its end */
    double swing;          /* share of falls that oscillate at 1.5 times both gains; < 0: not run */
    enum fall_status line; /* why the first run without a stiffness has none */
};

/* at_15 NULL: not run. */
struct table2_runs table2_runs(
    const struct table2_result *at_1, const struct table2_result *at_15, int runs);

/* The order statistic of n, from 1, at the low end of the 95 % interval of the median. The one at
 * the high end is n + 1 less it. It follows from the binomial distribution; no distribution of the
 * values is assumed. 0: n is too small. */
int table2_median_rank(int n);

#endif
