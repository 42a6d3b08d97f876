/* SPDX-License-Identifier: MIT */
/* Scene minimal once with its own set-up and once for each rate it was frozen for: what a test sees
 * of either. */
#ifndef TEST_FROZEN_SIDE_H
#define TEST_FROZEN_SIDE_H

#include "exhand/run/scene.h"

#include "exhand/exhand.h"

struct side_cfg {
    struct exh_quad_cfg quad;
    struct exh_velocity_window_cfg vel;
    struct exh_drive_cfg drive;
    struct exh_tracking_cfg track;
    struct exh_safety_cfg safety;
    struct exh_knot knot[2];
};

struct side {
    const struct exh_scene *scene;
    void (*cfg)(struct side_cfg *cfg); /* without what points; its padding is zero */
    int (*points)(void);               /* what points does where it must: 1, or 0 */
    void (*state)(struct exh_bytes *c);
};
extern const struct side side_live, side_90, side_1000, side_20000, side_1193_1193182;

#endif
