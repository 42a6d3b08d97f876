/* SPDX-License-Identifier: MIT */
/* Exo: the fingers in use, and the glove that moves with them. An absent finger has no
 * plant, no path and no piece of glove: it costs nothing. */
#ifndef SIM_EXO_H
#define SIM_EXO_H

#include "finger.h"
#include "glove.h"

#define SIM_FINGERS    5
#define SIM_EXO_POINTS 2048 /* 22 channels 1 ms apart, at two points a tick of 20 kHz */

struct sim_exo_par {
    unsigned fingers; /* bit i: finger i (thumb, index, middle, ring, little) */
    double apart_s;   /* each finger in use begins so much later than the one before */
    struct sim_finger_par finger[SIM_FINGERS];
    struct sim_path_par path[SIM_FINGERS];
    struct sim_path_record record[SIM_FINGERS]; /* rows 0: approaches */
};

/* No finger in use; all have the same parameters. */
struct sim_exo_par sim_exo_default(void);

struct sim_exo {
    unsigned fingers, used;        /* in use, and how many */
    unsigned char at[SIM_FINGERS]; /* which */
    uint32_t knuckles, seen;       /* sensors of their knuckles, and all that see those */
    struct sim_finger finger[SIM_FINGERS];
    int gloved;
    struct sim_exo_point {
        double t_s, x_m[SIM_FINGERS];
    } point[SIM_EXO_POINTS]; /* where the fingers were, oldest first in the ring */
    unsigned first, points;
    double newest_s;      /* of the last point */
    struct sim_decay way; /* what the glove's low-pass leaves from point to point */
    int torn;             /* points were overwritten before a glove had read them */
};

/* 0, or -1: more fingers than there are. gloved: the way is kept for a glove. */
int sim_exo_start(struct sim_exo *e, const struct sim_exo_par *p, const struct sim_device *d,
    uint64_t seed, int gloved);

/* To until_s, all of them. */
void sim_exo_advance(struct sim_exo *e, double until_s);

/* 1: all fingers in use are through with their scripts. */
int sim_exo_done(const struct sim_exo *e);

/* Every D/A output changes at at_s, as sim_finger_latch() says. */
void sim_exo_latch(struct sim_exo *e, double at_s, const double ref_A[SIM_FINGERS]);

/* The glove on this hand: what does not bend with the fingers in use rests as in rest_rad. */
void sim_exo_glove(struct sim_exo *e, struct sim_glove *g, const struct sim_glove_par *p,
    uint64_t seed, const double rest_rad[SIM_GLOVE_SENSORS]);

/* The frame of the tick that now is, every channel held in its time; in the order of ticks,
 * a scan apart. */
void sim_exo_frame(
    struct sim_exo *e, struct sim_glove *g, double tick_s, int16_t raw[SIM_GLOVE_SENSORS]);

#endif
