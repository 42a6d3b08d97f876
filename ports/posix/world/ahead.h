/* SPDX-License-Identifier: MIT */
/* What a fingertip will touch first: its pad's sphere goes along the way that the finger is on,
 * by steps no longer than the distance to the nearest body, so that it jumps over none. */
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
    unsigned long tested, culled; /* bodies asked for their distance; of these by their ball */
};

/* What is told of the finger. */
struct ahead_patch {
    int body; /* -1: there is nothing */
    struct v3 normal, point;
    double offset_m; /* of the tangent plane from the origin, along the normal */
};

/* Of the first of these that holds:
 *   - the finger touches something: the patch nearest to its pad;
 *   - it is on its way, and touches something on it: the patch that it touches first;
 *   - it would touch something if it closed: the patch that it would touch first;
 *   - it rests: the patch nearest to it, within look_m.
 * Where the way meets a far patch flatter than graze, the patch of that body that is nearest now:
 * the plane of the far one would pass near the finger long before its surface does. */
void ahead_look(const struct ahead *a, struct ahead_patch *to, struct ahead_stats *s);

#endif
