/* SPDX-License-Identifier: MIT */
/* The scene with its parts in sight: SIDE names the copy. */
#define JOIN(a, b)        a##b
#define NAMED(a, b)       JOIN(a, b)
#define exh_scene_minimal NAMED(SIDE, _scene)
#include "minimal/minimal.c"

#include "side.h"

#include <string.h>

static void cfg(struct side_cfg *c)
{
    memset(c, 0, sizeof *c);
    memcpy(&c->quad, &quad_cfg, sizeof quad_cfg);
    memcpy(&c->vel, &vel_cfg, sizeof vel_cfg);
    memcpy(&c->drive, &drive_cfg, sizeof drive_cfg);
    memcpy(&c->track, &track_cfg, sizeof track_cfg);
    memcpy(&c->safety, &safety_cfg, sizeof safety_cfg);
    memcpy(c->knot, knot, sizeof knot);
    memset(&c->quad.par, 0, sizeof c->quad.par);
    memset(&c->drive.par, 0, sizeof c->drive.par);
    memset(&c->drive.force_to_cur, 0, sizeof c->drive.force_to_cur);
    memset(&c->drive.cur_to_force, 0, sizeof c->drive.cur_to_force);
}

static int points(void)
{
    return quad_cfg.par == &quad_par && drive_cfg.par == &drive_par &&
           drive_cfg.force_to_cur.knot == knot && drive_cfg.force_to_cur.n == 2 &&
           drive_cfg.cur_to_force.knot == 0 && drive_cfg.cur_to_force.n == 0;
}

static void state(struct exh_bytes *c)
{
    exh_quad_serialize(c, &s.quad);
    exh_velocity_window_serialize(c, &s.vel);
    exh_drive_serialize(c, &s.drive);
    exh_tracking_serialize(c, &s.track);
    exh_safety_serialize(c, &s.safety);
}

const struct side SIDE = {&exh_scene_minimal, cfg, points, state};
