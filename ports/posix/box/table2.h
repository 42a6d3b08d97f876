/* SPDX-License-Identifier: MIT */
/* The paper's Table II: its six points, and how ours are judged and printed. */
#ifndef BASE_TABLE2_H
#define BASE_TABLE2_H

#include "box/run.h"

#include <stdio.h>

struct table2_row {
    double rate_Hz, k_Npm, b_Nspm, stiffness_Npm;
};
#define TABLE2_ROWS 6
extern const struct table2_row table2_paper[TABLE2_ROWS];

/* The paper's row at this rate to 1000 ppm (what a timer may miss it by), or NULL. */
const struct table2_row *table2_at(double rate_Hz);
/* The gains to start from at any rate: that row's, else the row's below it. */
const struct table2_row *table2_gains(double rate_Hz);

#define TABLE2_MORE 16 /* further values of a run */

/* One run judged. B fits position over force and inverts, A fits force over
 * position; aligned pairs F_mon(n) with q(n-1), same with q(n). */
struct table2_result {
    int done;  /* run to its end and judged: else the values below are void */
    int error; /* it or a file of it failed, said on stderr */
    double rate_Hz, k_Npm, b_Nspm;
    uint64_t seed;
    double phase, q_lim_m; /* the wall's place between two counts, and the wall */
    enum fall_status line; /* aligned: OK, or why there is no stiffness */
    double b_Npm, a_Npm, r2, ci_low_Npm, ci_high_Npm; /* aligned; 0: none */
    double b_same_Npm, a_same_Npm;                    /* 0: none */
    int ci_bounded;
    double resting; /* share of the band's pairs from after the motor's last movement; < 0: none */
    double reading_Npm[TABLE2_MORE]; /* additional reading for the judgement; 0: none */
    int falls, oscillating, buzzing, incomplete;
    unsigned faults;
    unsigned long lost;
    int dumps;          /* of the black box */
    struct guard guard; /* of scene guarded */
};

#define TABLE2_PATH_B 1024 /* a path with its zero */

/* How much of a run is judged; each includes those before it. Judging takes longer for longer logs.
 */
enum table2_ask {
    TABLE2_REST, /* falls, and which came to rest */
    TABLE2_LINE, /* the stiffness, aligned */
    TABLE2_SAME  /* and at the same tick */
};

/* Runs and judges; with a plot prefix also writes what the force-over-position picture needs. */
struct table2_result table2_measure(
    const struct run_cfg *c, const char *plot_prefix, enum table2_ask ask);

/* Another judge of a run. Its result goes to reading_Npm. */
typedef void table2_judge(
    const struct fall_log *log, const struct sim_device *d, struct table2_result *r);
struct table2_result table2_measure_more(
    const struct run_cfg *c, const char *plot_prefix, enum table2_ask ask, table2_judge *more);

/* The result is void: said on stderr. */
void table2_failed(struct table2_result *r, const char *what, const char *why);

#endif
