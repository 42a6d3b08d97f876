/* SPDX-License-Identifier: MIT */
#include "view.h"

#include "sim/lag.h"

void view_start(struct view *v, const struct scene *s)
{
    const struct v3 centre = pose_by(&s->hand, v3(0.02, 0, 0.12));
    const struct v3 eye = s->eye_set ? s->eye : v3_add(centre, v3(-0.32, -0.30, 0.24));
    struct v3 way;
    v->look = s->eye_set ? s->look : centre;
    way = v3_sub(eye, v->look);
    v->away_m = v3_len(way);
    v->turn_rad = atan2(way.y, way.x);
    v->tilt_rad = asin(way.z / v->away_m);
    view_turn(v, 0, 0);
}

void view_turn(struct view *v, double turn_rad, double tilt_rad)
{
    v->turn_rad += turn_rad;
    v->tilt_rad = fmin(fmax(v->tilt_rad + tilt_rad, -1.5), 1.5);
}

void view_nearer(struct view *v, double steps)
{
    v->away_m = fmin(fmax(v->away_m * pow(0.9, steps), 0.05), 5);
}

struct v3 view_eye(const struct view *v)
{
    const double flat = v->away_m * sim_cos(v->tilt_rad);
    return v3_add(v->look, v3(flat * sim_cos(v->turn_rad), flat * sim_sin(v->turn_rad),
                               v->away_m * sim_sin(v->tilt_rad)));
}
