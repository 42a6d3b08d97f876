/* SPDX-License-Identifier: MIT */
/* What a scene has beside its tick: scene_full.c parameters, records, registers, a link;
 * scene_rom.c none of them. */
#ifndef STM32F405_SCENE_H
#define STM32F405_SCENE_H

#include "exhand/run/scene.h"

void stm_scene_ready(const struct exh_scene *sc);
void stm_scene_start(const struct exh_scene *sc, struct exh_scene_board board);
void stm_scene_before(uint32_t tick, struct exh_scene_in *in);
void stm_scene_after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out);
void stm_scene_end(const struct exh_scene *sc);

#endif
