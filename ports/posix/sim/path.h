/* SPDX-License-Identifier: MIT */
/* Path: the wanted position of a finger, as string length in m. Scripted approaches move from rest
 * to beyond the assumed place of the object with minimum jerk, and pass that place at a given
 * speed. Then the finger presses, withdraws, and repeats. Alternatively the rows of a glove's
 * recording are control points of a cubic B-spline: it passes near them, never beyond them, without
 * a step in acceleration. Row n is at (n + 1) / row_hz.
 *
 * A hand has learned the weight of the free device and pushes harder by that. The spring's end
 * leads the wanted place x by e, with K e + B e' = learned (m x'' + c x' + f). m, c and f include
 * all that moves and rubs when the string is drawn out, and the finger alone when it is let in. So
 * a free finger is near the script. With learned = 0 the spring's end is the script. All in closed
 * form (lag.h), without integration. */
#ifndef SIM_PATH_H
#define SIM_PATH_H

#include "device.h"
#include "lag.h"
#include "random.h"

#define SIM_SENSORS 22 /* of a glove's row */

/* Doubles only, in the order of the table in path.c. */
struct sim_path_par {
    double start_m, believed_m, push_m, speed_mps;
    double first_s, hold_s, back_s, rest_s, vary, approaches;
};
extern const struct sim_device_row sim_path_row[];
extern const int sim_path_rows;

struct sim_path_par sim_path_default(void);

/* Sets one by name, as sim_device_set() does. */
int sim_path_set(
    struct sim_path_par *p, const char *name, double value, const struct sim_device_row **row);

/* The paper's three speeds, m/s of string at the assumed place of the object: "slow", "natural",
 * "fast"; 0: no such name. */
double sim_path_speed(const char *name);

/* What is carried along: the load of free movement, and the spring it is carried by. */
struct sim_path_load {
    double out_kg, out_Nspm, out_N; /* times learned: string drawn out */
    double in_kg;                   /* let in */
    double k_Npm, b_Nspm;           /* of the hand */
};

/* A recording: string per row, the caller's. */
struct sim_path_record {
    const double *string_m;
    long rows;
    double row_hz;
    int again; /* 1: behind the last row comes the first, for ever */
};

enum sim_path_phase {
    SIM_PATH_REST, /* at the start, before an approach */
    SIM_PATH_APPROACH,
    SIM_PATH_HOLD,
    SIM_PATH_WITHDRAW,
    SIM_PATH_PLAY, /* a recording */
    SIM_PATH_DONE
};

struct sim_path {
    struct sim_path_par par;
    struct sim_path_load load;
    struct sim_path_record record;
    struct sim_random rng;
    enum sim_path_phase phase;
    long number;  /* of the approach, from 1; or of the recording's row */
    double end_s; /* of the phase or row */
    double at_m;  /* where it ends */
    struct sim_curve x;
    int terms; /* of x */
    struct sim_lag e;
};

/* At rest at its start, at 0 s. record: NULL or rows 0: approaches. */
void sim_path_start(struct sim_path *p, const struct sim_path_par *par,
    const struct sim_path_load *load, const struct sim_path_record *record, uint64_t seed);

/* Everything that begins at or before t_s; and when the next thing begins. */
void sim_path_advance(struct sim_path *p, double t_s);
double sim_path_next_s(const struct sim_path *p);

/* The spring's end, and the script itself; t_s from the phase's begin to its end. */
double sim_path_at(const struct sim_path *p, double t_s);
/* The same. left: what is left of e^-(t / p->e.tau_s) since p->e.x.start_s. */
double sim_path_left(const struct sim_path *p, double t_s, double left);
double sim_path_wanted(const struct sim_path *p, double t_s);

/* The 22 angles of a row (rad, in the glove's order), flexion of finger 0..4 counted up or, sign
 * -1, down, as string; a joint bent backwards draws none in. */
double sim_path_string(
    const double row_rad[SIM_SENSORS], unsigned finger, double sign, const double arm_m[3]);

/* 1 or -1: how the flexion of these rows is counted. */
double sim_path_sign(const double (*row_rad)[SIM_SENSORS], long rows);

#endif
