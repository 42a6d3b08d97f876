/* SPDX-License-Identifier: MIT */
/* A scene of constants. */
#include "scene.h"

void stm_scene_ready(const struct exh_scene *sc) { (void)sc; }

void stm_scene_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    (void)board;
}

void stm_scene_before(uint32_t tick, struct exh_scene_in *in)
{
    (void)tick;
    (void)in;
}

void stm_scene_after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    (void)tick;
    (void)in;
    (void)out;
}

void stm_scene_end(const struct exh_scene *sc) { (void)sc; }
