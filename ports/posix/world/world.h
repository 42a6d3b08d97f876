/* SPDX-License-Identifier: MIT */
/* The core of the world simulator: no clock, socket or graphics. A frame answers the hand's
 * joints with the planes that its fingers are about to touch. It computes only what the scene
 * needs. A finger that is off costs nothing; an object out of reach sleeps until it could be in
 * reach, and costs nothing until then. The same scene, times and inputs give the same bits on
 * every machine. */
#ifndef WORLD_WORLD_H
#define WORLD_WORLD_H

#include "pace.h"
#include "scene_text.h"

#include "exhand/wire.h"

#include <stddef.h>

/* since world_load() or as the caller cleared them */
struct world_stats {
    unsigned long frames, looks, hits;
    unsigned long tests;  /* bodies whose distance was computed */
    unsigned long culled; /* of these, bodies that the ball around them excluded */
    unsigned long slept;  /* objects not looked at, summed over the frames */
    unsigned long moved;  /* objects whose place was computed */
};

struct world;

/* Loads a scene. NULL on failure, with "file:line: what: what to do" in error. name is the file
 * name for messages; meshes are searched in its folder. */
struct world *world_load(const char *name, const char *text, char *error, size_t error_B);
struct world *world_load_file(const char *path, char *error, size_t error_B);
void world_free(struct world *w);

const struct scene *world_scene(const struct world *w);
const struct hand *world_hand(const struct world *w);

/* 0: look at every object in every frame, for comparison. */
void world_cull(struct world *w, int on);

/* Carries the hand so far from where the scene has it at that time, in {W}. */
void world_carry(struct world *w, struct v3 by_m);

/* {R} in {W} at t_s. */
struct pose world_hand_at(const struct world *w, double t_s);

/* The planes of the fingers in use, in->fingers and the scene's; t_s, the scene's time, may also go
 * back. pace: how the joints turn; NULL: they rest. echo_* of out are left alone. stats may be
 * NULL. */
void world_frame(struct world *w, const struct exh_wire_state *in, const struct pace *pace,
    double t_s, struct exh_wire_planes *out, struct world_stats *stats);

/* How far the pad of a finger is from the nearest surface at t_s, m; below 0: inside; 1e3: nothing
 * is there. */
double world_gap_m(struct world *w, unsigned finger, const int32_t joint_turn_q32[3], double t_s);

#endif
