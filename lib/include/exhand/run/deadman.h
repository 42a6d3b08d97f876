/* SPDX-License-Identifier: MIT */
/* Dead-man switch of a firmware image. Closing it gives one command: clear in FAULT, run in OFF. So
 * after a fault, release it and close it twice. Opening it stops. A switch that is closed at
 * power-on may be stuck; it must be opened first. Its functions are hooks of the loop. */
#ifndef EXHAND_RUN_DEADMAN_H
#define EXHAND_RUN_DEADMAN_H

#include "exhand/run/scene.h"

void exh_deadman_start(const struct exh_scene *sc, struct exh_scene_board board);
/* Sets in->command. */
void exh_deadman_before(uint32_t tick, struct exh_scene_in *in);

#endif
