/* SPDX-License-Identifier: MIT */
/* Motion of an object: an offset (m) and a rotation about its own origin (roll, pitch, yaw)
 * relative to its rest pose, as functions of time only. */
#ifndef WORLD_MOTION_H
#define WORLD_MOTION_H

#include "vec.h"

enum motion_kind { MOTION_NONE, MOTION_LINEAR, MOTION_SINE, MOTION_KEYS };

struct motion_key {
    double t_s;
    struct v3 move_m, turn_rad;
};

struct motion {
    enum motion_kind kind;
    struct v3 move, turn; /* LINEAR: per second; SINE: amplitude */
    double hz, phase_rad; /* SINE */
    int loop;             /* KEYS: from the last on again with the first */
    int keys;
    struct motion_key *key; /* at rising times; malloc */
};

/* The pose at t_s of an object with the rest pose `stand`. */
struct pose motion_at(const struct motion *m, const struct pose *stand, double t_s);

/* What its origin never exceeds, m/s; and its turning, rad/s. */
double motion_speed(const struct motion *m);
double motion_turning(const struct motion *m);

#endif
