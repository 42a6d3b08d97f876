/* SPDX-License-Identifier: MIT */
/* Finds the objects within reach of the hand. An object out of reach sleeps until the earliest time
 * at which it could be in reach, at the highest speed of both. Sleepers form a heap ordered by that
 * time; a frame checks only its top. */
#ifndef WORLD_REACH_H
#define WORLD_REACH_H

#include "scene_text.h"

#include "exhand/wire.h"

struct sleeper {
    double wake_s;
    unsigned object;
};

struct reach {
    struct sleeper *asleep; /* heap */
    struct body *near;
    unsigned char *placed; /* of near[]: its pose is that of all times */
    int sleepers, nears;
    int all;          /* no object sleeps */
    struct v3 centre; /* in {R}: P_F stays within span_m of it, what is looked at within */
    double span_m, radius_m, speed; /* radius_m; speed of centre in {W}, at most */
    double t_s;                     /* of the last frame */
};

/* 0, or 1 for no memory. */
int reach_start(struct reach *r, const struct scene *s, const struct hand *h);
void reach_stop(struct reach *r);

/* All awake again: the hand was carried, or time went back. */
void reach_wake(struct reach *r, const struct scene *s);

/* Brings near[] to t_s, in {R}, which is `hand` in {W}. Returns how many places it computed. */
unsigned reach_update(struct reach *r, const struct scene *s, const struct pose *hand, double t_s);

#endif
