/* SPDX-License-Identifier: MIT */
/* The other end of a scene's link, for a count of its instructions. It answers every state in the
 * same tick, by planes at the earlier places of the fingertips. */
#ifndef SIZE_WORLD_H
#define SIZE_WORLD_H

#include "exhand/run/scene.h"

/* Before a tick: reads the packets of the tick before, and writes the answers to the loop's receive
 * buffer. */
void world_answer(const struct exh_scene_link *link);

/* Planes where the fingertips of the newest state are, each along the axis that it has moved along
 * most since the first. */
void world_place(void);

#endif
