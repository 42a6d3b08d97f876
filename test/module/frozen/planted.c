/* SPDX-License-Identifier: MIT */
/* Scene minimal as if a structure had one more field, where alignment left room, of which the
 * program has no row. */
#include "minimal/minimal.c"

#include "freeze.h"

#include <stddef.h>

static int planted(struct exh_scene_board board)
{
    const int err = setup(board);
    ((uint8_t *)&vel_cfg)[offsetof(struct exh_velocity_window_cfg, n) + 1] = 1;
    return err;
}

static const struct exh_scene scene = {.name = "minimal", .setup = planted};
const struct exh_scene *const freeze_scene = &scene;
const struct freeze freeze_list[] = {
    {&freeze_velocity_window, "vel_cfg", &vel_cfg, 1, {0}}, {0, 0, 0, 0, {0}}};
