/* SPDX-License-Identifier: MIT */
/* exhand-lab faults: what its parts share. */
#ifndef CLI_FAULTS_PART_H
#define CLI_FAULTS_PART_H

#include "lab/faults/faults.h"

struct faults_count {
    int32_t n, seen, bad; /* branches that begin with it, of these */
    int32_t seen_ticks;   /* the latest */
};

/* One that was wrong. */
struct faults_wrong {
    uint32_t run, tick; /* of the branch */
    struct faults_what what[2];
    uint8_t eager, cards;
    uint32_t bad;
    int32_t seen_ticks[2], state[2];
};
#define FAULTS_WRONGS 4 /* kept of each run */

/* Of the random times of one rate and scene, or of one run. */
struct faults_random {
    uint32_t rate_Hz;
    uint8_t scene;
    int32_t err, n, open, released; /* branches; from an open gate; that released a force */
    int32_t bad, late;              /* some rule broken; a cause not seen in time */
    int32_t zero_ticks;             /* the tick that saw it is 1 */
    double zero_s;                  /* from the tick that saw it to no current in the motor */
    double slope, force_N;          /* worst over the law's; most held */
    double back_mps, jerk_mps3, cut_back_mps, cut_jerk_mps3;
    struct faults_wrong wrong[FAULTS_WRONGS]; /* the first that were */
    int32_t kinds[FAULTS_BADS];               /* of the bad: what */
    struct faults_count by[FAULTS_SOURCES];
};

/* Exit status. run < 0: all of them. */
int faults_random(FILE *f, int total, uint64_t seed, int run, int parallel);
int faults_print_random(FILE *f, const struct faults_random *r, int n);
void faults_print_wrong(FILE *f, const struct faults_random *r, int n);
int faults_matrix(FILE *f, uint32_t at_Hz, int parallel); /* at_Hz 0: at three rates */
int faults_refusals(FILE *f, uint32_t at_Hz, int parallel);
int faults_pictures(const char *dir);
int faults_states(FILE *f); /* of the box, and every name */

#endif
