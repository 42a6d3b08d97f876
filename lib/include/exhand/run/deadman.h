/* SPDX-License-Identifier: MIT */
/* Who runs a firmware image: the dead-man switch. Taking hold of it gives one command: in FAULT it
 * clears, in OFF it runs; so after a fault it is let go and taken a second time. Letting go stops.
 * A switch that is closed at power-on, and so may be stuck, has to be let go first. Hooks for the
 * loop. */
#ifndef EXHAND_RUN_DEADMAN_H
#define EXHAND_RUN_DEADMAN_H

#include "exhand/run/scene.h"

void exh_deadman_start(const struct exh_scene *sc, struct exh_scene_board board);
/* Sets in->command. */
void exh_deadman_before(uint32_t tick, struct exh_scene_in *in);

#endif
