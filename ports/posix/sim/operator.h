/* SPDX-License-Identifier: MIT */
/* Operator: the hand in the simulated glove. It rests in a pose, goes to one when asked,
 * goes through all of them, waves, or does what a recording says. */
#ifndef SIM_OPERATOR_H
#define SIM_OPERATOR_H

#include "glove.h"

/* Poses for a person to take, angles in degrees in the glove's order, each within its sensor's
 * nominal range. Together they move every sensor to both of its ends. */
struct sim_pose {
    const char *name, *say; /* "fist", "make a fist, thumb beside it" */
    double deg[SIM_GLOVE_SENSORS];
};
extern const struct sim_pose sim_pose[];
extern const int sim_poses;

/* Its number, or -1. */
int sim_pose_find(const char *name);

enum sim_operator_does {
    SIM_REST,  /* in a pose; goes to another by sim_operator_go() */
    SIM_POSES, /* from pose to pose, a rest in each, for ever */
    SIM_GRASP, /* from flat to fist and back without a rest */
    SIM_WAVE,  /* every joint a sine between flat and fist, a finger later than
                  the one before it */
    SIM_RECORD /* what was recorded, a straight line from row to row; it rests
                  in the last */
};

struct sim_operator_par {
    enum sim_operator_does does;
    int pose;      /* it begins in this one */
    double move_s; /* a movement, minimum jerk */
    double rest_s; /* a rest */
    double wave_hz;
    double off_rad; /* each joint stops short of its pose, or beyond, by up to this */
    const double (*row_rad)[SIM_GLOVE_SENSORS]; /* SIM_RECORD: the caller's */
    long rows;
    double row_hz;
};

/* Rests in "flat"; a movement takes 0.5 s, a rest 0.5 s, a wave 1 s. */
struct sim_operator_par sim_operator_default(void);

struct sim_operator {
    struct sim_operator_par par;
    struct sim_random rng;
    double at_rad[SIM_GLOVE_SENSORS]; /* where the last movement ends */
    int to;                           /* the pose it goes to or rests in */
    double begin_s, end_s;            /* of the last movement or row */
    long step;                        /* movements or rows so far */
    int asked;                        /* the pose that sim_operator_go() requested, -1: none */
};

/* Puts the hand into the glove and starts both, at 0 s. */
void sim_operator_start(struct sim_operator *o, const struct sim_operator_par *p,
    struct sim_glove *g, const struct sim_glove_par *gp, uint64_t seed);

/* Does all that begins at or before t_s. Call it before the glove is read at t_s. */
void sim_operator_advance(struct sim_operator *o, struct sim_glove *g, double t_s);

/* SIM_REST: go to this pose now; there once it is at rest. */
void sim_operator_go(struct sim_operator *o, int pose);
int sim_operator_at_rest(const struct sim_operator *o, double t_s);

/* The frame of this tick: moves the hand, converts all 22 channels, each in its time. */
void sim_operator_frame(
    struct sim_operator *o, struct sim_glove *g, double tick_s, int16_t raw[SIM_GLOVE_SENSORS]);

#endif
