/* SPDX-License-Identifier: MIT */
/* Predicts what a fingertip touches first. The sphere of its pad moves along the finger's path, in
 * steps no longer than the distance to the nearest body, so that it cannot skip one. */
#ifndef WORLD_AHEAD_H
#define WORLD_AHEAD_H

#include "finger.h"
#include "motion.h"
#include "shape.h"

#include <stdint.h>

/* The finger and what is around it, in {R}. */
struct ahead {
    const struct body *body;
    int bodies;
    int cull; /* 0: no body is put aside by its ball */
    const struct hand *hand;
    unsigned finger;
    const int32_t *joint_turn_q32; /* 3 */
    const double *turn_q32ps;      /* of these, a second; NULL: they rest */
    const double *pull_turn_q32ps; /* the same while the finger closes; NULL or 0: q1
                                      and q2 alike */
    /* The hand's own way in {W}, which goes on; NULL: it rests. */
    struct pose (*hand_at)(const void *ctx, double later_s);
    const void *ctx;
    double hand_mps; /* of a fingertip by it, at most */
    double look_m;   /* how far around a finger that rests, and twice how far the
                        hand's own way is followed */
    double graze;    /* least sine between way and surface */
};

struct ahead_stats {
    unsigned long tested, culled; /* bodies; of these, bodies that their ball excluded */
};

/* The reported result of a finger. */
struct ahead_patch {
    int body; /* -1: there is nothing */
    struct v3 normal, point;
    double offset_m; /* of the tangent plane from the origin, along the normal */
};

/* Selects the first that applies:
 * - The finger touches something: the patch nearest to its pad.
 * - It moves and its path touches something: the patch it touches first.
 * - It would touch something if it closed: the patch it would touch first.
 * - It rests: the patch nearest to it, within look_m.
 *
 * Where the path meets a far patch at an angle below graze, the nearest patch of that body is used.
 * The plane of the far one would pass near the finger long before its surface does. */
void ahead_look(const struct ahead *a, struct ahead_patch *to, struct ahead_stats *s);

#endif
