/* SPDX-License-Identifier: MIT */
/* The other end of a scene's link, for whoever counts its instructions: it answers every state by
 * planes that stand where the fingertips once were, in the same tick. */
#ifndef SIZE_WORLD_H
#define SIZE_WORLD_H

#include "exhand/run/scene.h"

/* Before a tick: the packets that the one before has written are read, and the answers put where
 * the loop puts what came. */
void world_answer(const struct exh_scene_link *link);

/* Planes where the fingertips of the newest state are, each along the axis that it has moved along
 * most since the first. */
void world_place(void);

#endif
