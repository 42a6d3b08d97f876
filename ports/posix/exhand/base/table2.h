/* SPDX-License-Identifier: MIT */
/* The paper's Table II: its six points, and how ours are judged and printed. */
#ifndef CLI_TABLE2_H
#define CLI_TABLE2_H

#include "lab/drop/reading.h"
#include "base/run.h"

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

/* One run judged. B fits position over force and inverts, A fits force over
 * position; aligned pairs F_mon(n) with q(n-1), same with q(n). */
struct table2_result {
    int done;  /* run to its end and judged: else the values below are void */
    int error; /* it or a file of it failed, said on stderr */
    double rate_Hz, k_Npm, b_Nspm;
    enum fall_status line; /* aligned: OK, or why there is no stiffness */
    double b_Npm, a_Npm, r2, ci_low_Npm, ci_high_Npm; /* aligned; 0: none */
    double b_same_Npm, a_same_Npm;                    /* 0: none */
    int ci_bounded;
    double reading_Npm[READINGS]; /* if asked for; 0: none */
    int falls, oscillating, buzzing, incomplete;
    unsigned faults;
    unsigned long lost;
    struct guard guard; /* of scene guarded */
};

#define TABLE2_PATH_B 1024 /* a path with its zero */

/* What of a run is asked for, each with all before it: the longer the log, the more of the time is
 * judging. */
enum table2_ask {
    TABLE2_REST,    /* falls, and which came to rest */
    TABLE2_LINE,    /* the stiffness, aligned */
    TABLE2_SAME,    /* and at the same tick */
    TABLE2_READINGS /* and in every way of reading.h */
};

/* Runs and judges; with a plot prefix also writes what the force-over-position picture needs. */
struct table2_result table2_measure(const struct run_cfg *c, const char *plot_prefix,
                                    enum table2_ask ask);

/* Many runs of one row, at its gains and at 1.5 times both. Medians are of the runs
 * that gave a line; 0 unless more than half did. */
struct table2_spread {
    int runs, lines, lines_same;         /* done at the gains; of these, with a line */
    double b_Npm, b_low_Npm, b_high_Npm; /* median, 5 % and 95 % */
    double a_Npm, b_same_Npm, a_same_Npm;
    double rest;       /* share of falls that come to rest; < 0: no fall */
    double oscillates; /* share of falls that do not, at 1.5 times both gains */
};
struct table2_spread table2_spread(const struct table2_result *at_1,
                                   const struct table2_result *at_15, int runs);

/* table2.csv and spread.csv: header and a line; empty fields where there is none. */
void table2_csv_header(FILE *f);
void table2_csv_line(FILE *f, const struct table2_result *r);
void table2_spread_csv_header(FILE *f);
void table2_spread_csv_line(FILE *f, const struct table2_result *r, const struct table2_spread *s);

/* Every reading of the analysis: the median of `runs` runs of each row, those of row i
 * from r[first + i * stride] on. The CSV has a line a row and reading. */
struct table2_readings {
    const struct table2_result *r;
    int rows, first, stride, runs;
};
void table2_readings_print(FILE *f, const struct table2_readings *t);
void table2_readings_csv(FILE *f, const struct table2_readings *t);

/* For people. spread may be NULL. */
void table2_print(FILE *f, const struct table2_result *r, const struct table2_spread *s, int rows);

#endif
