/* SPDX-License-Identifier: MIT */
/* The eye, turned about a point. */
#ifndef WORLD_VIEW_H
#define WORLD_VIEW_H

#include "scene_text.h"

struct view {
    struct v3 look;
    double turn_rad, tilt_rad, away_m;
};

/* As the scene has it, or else a little above and before the hand. */
void view_start(struct view *v, const struct scene *s);
void view_turn(struct view *v, double turn_rad, double tilt_rad);
void view_nearer(struct view *v, double steps);
struct v3 view_eye(const struct view *v);

#endif
