/* SPDX-License-Identifier: MIT */
/* The poses that a glove is calibrated from: what to do, what is known of each, and the
 * codes that were taken in it, live or recorded. */
#ifndef CLI_GLOVE_POSES_H
#define CLI_GLOVE_POSES_H

#include "sim/glove.h"

#include "exhand/calibrate.h"
#include "exhand/glove.h"

#include <stdint.h>
#include <stdio.h>

#define GLOVE_POSES 15

/* What was taken in each pose; frames 0: nothing. */
struct glove_taken {
    struct glove_codes {
        struct exh_mean mean_raw_q16;
        double low, high;
    } code[GLOVE_POSES][EXH_GLOVE_SENSORS];
    uint32_t frames[GLOVE_POSES];
};

/* A live glove on a live hand, both simulated. */
struct glove_bench {
    struct sim_glove_par par;
    unsigned char fault[EXH_GLOVE_SENSORS]; /* enum sim_glove_fault */
    double miss_deg;                        /* by how much the person misses each angle, at most */
    double rate_Hz;
    int64_t frames; /* of each pose */
    int64_t seed;
};

/* "flat", ... */
const char *glove_pose_name(unsigned pose);

/* What to do, one pose after the other. */
void glove_poses_print(FILE *f);

/* Its number by that name; -1: none has it. */
int glove_pose_find(const char *name);

/* What a pose says of a sensor. 1: *deg; 0: nothing. */
int glove_pose_says(unsigned pose, unsigned sensor, int *deg);

/* Takes all poses in order; instructions to the person go to `progress`. */
void glove_poses_take(struct glove_taken *t, const struct glove_bench *b, FILE *progress);

/* CSV: pose and 22 codes a line, one or more lines a pose, in any order; lines end in LF, CR
 * or both. "-" is standard input. 0, or 2 or 3 after a line on stderr. */
int glove_poses_read(struct glove_taken *t, const char *path);

/* A recording in other columns (recording_columns.h), whose label is a pose's name or number, and
 * other codes (recording_ask.h; scale may be NULL). A row with a value that is no number is left
 * out and counted. */
int glove_poses_read_columns(
    struct glove_taken *t, const char *path, const char *columns, const char *scale);

/* For the fit: those that were taken. Their number; which[] says which they are. */
unsigned glove_poses_fit(
    struct exh_glove_pose *pose, uint8_t which[GLOVE_POSES], const struct glove_taken *t);

/* A frame as glove_poses_read() reads it. */
void glove_poses_row(FILE *f, const char *pose, const int16_t raw[EXH_GLOVE_SENSORS]);

/* As glove_poses_read() reads it, one line a pose: its means. */
void glove_poses_csv(FILE *f, const struct glove_taken *t);

#endif
