/* SPDX-License-Identifier: MIT */
/* The results of set-up here, which ../freeze.c writes. */
#include "minimal.c"

#include "../freeze.h"

const struct exh_scene *const freeze_scene = &exh_scene_minimal;
const struct freeze freeze_list[] = {{&freeze_knot, "knot", knot, 2, {0}},
    {&freeze_quad, "quad_cfg", &quad_cfg, 1, {"&quad_par"}},
    {&freeze_velocity_window, "vel_cfg", &vel_cfg, 1, {0}},
    {&freeze_drive, "drive_cfg", &drive_cfg, 1, {"&drive_par", "{knot, 2}", "{0, 0}"}},
    {&freeze_track, "track_cfg", &track_cfg, 1, {0}},
    {&freeze_safety, "safety_cfg", &safety_cfg, 1, {0}}, {0, 0, 0, 0, {0}}};
