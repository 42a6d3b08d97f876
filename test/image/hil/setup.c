/* SPDX-License-Identifier: MIT */
#include "setup.h"

#include "bilateral/bilateral.h"
#include "drop/drop.h"
#include "guarded/guarded.h"

#include "box/hand.h"

#include <string.h>

#define HELD_S 0.1 /* the dead-man switch must have been open for 50 ms */

static void set(struct ref_cfg *c, const char *name, double value)
{
    if (c->settings < REF_SETTINGS) {
        c->setting[c->settings++] = (struct ref_setting){name, value};
    }
}

/* What a calibration finds of the device. */
static void set_device(struct ref_cfg *c)
{
    const struct sim_device *d = &c->board.device;
    set(c, "step", d->step_m / d->decode);
    set(c, "kf", d->kf_npa);
    set(c, "dac_scale", d->dac_perA);
    set(c, "dac_zero", d->dac_zero);
    set(c, "mon_scale", d->mon_apc);
    set(c, "uncalibrated", 1);
}

/* The paper's first experiment, falls without end; guarded or not. */
static void drop(struct ref_cfg *c, const struct exh_scene *scene)
{
    c->scene = scene;
    c->board.falls = 1000000000;
    set_device(c);
    set(c, "q_lim", c->board.device.height_m);
    set(c, "k", 2000);
    set(c, "b", 10);
}

/* --- the full box --- */

#define WALL_M  0.030 /* string drawn out where a fingertip meets its wall */
#define FRAME_S (1.0 / 400)

static struct peer peer;
static struct peer_world walls;
static struct sim_glove_par glove;

/* The glove as it is, perfectly calibrated. */
static int calibrate(void)
{
    struct exh_glove_cal cal;
    bilateral_cal_of(&cal, &glove);
    return bilateral_stage_cal(&cal, NULL);
}

/* A wall in front of each finger, at the other end of the link. */
static void put_up(struct ref_cfg *c)
{
    const struct peer_cfg cfg = {.world = &walls, .until_s = 1e30};
    memset(&walls, 0, sizeof walls);
    for (unsigned i = 0; i < BILATERAL_FINGERS; i++) {
        const struct bilateral_finger_is w = {i, c->board.exo.finger[i].arm_m, c->board.hand.pose};
        walls.wall.fingers = (uint8_t)(walls.wall.fingers | 1u << i);
        bilateral_wall(&walls.wall.plane[i], &w, WALL_M);
        c->board.exo.path[i].believed_m = bilateral_string_m(&walls, &w, 0, 0);
    }
    peer_start(&peer, &cfg, 1);
    c->board.line.on = 1;
    c->board.line.frame = peer_frame;
    c->board.line.ctx = &peer;
    c->board.line.frame_s = FRAME_S;
}

/* Five fingers in exoskeleton and glove. */
static void bilateral(struct ref_cfg *c)
{
    c->scene = &exh_scene_bilateral;
    c->board.glove = 1;
    c->board.exo.fingers = (1u << BILATERAL_FINGERS) - 1;
    for (unsigned i = 0; i < BILATERAL_FINGERS; i++) { c->board.exo.path[i].approaches = 1e6; }
    glove = c->board.glove_par;
    c->prepare = calibrate;
    put_up(c);
    set_device(c);
    set(c, "mat_k", 20000);
    set(c, "mat_b", 60);
    set(c, "fingers", (1u << BILATERAL_FINGERS) - 1);
    set(c, "session", 1);
}

int setup_for(struct ref_cfg *c, const char *symbol, uint64_t seed, uint32_t ticks)
{
    memset(c, 0, sizeof *c);
    c->board = posix_config_default();
    c->board.seed = seed;
    c->board.max_ticks = ticks;
    c->held_s = HELD_S;
    if (strcmp(symbol, "exh_scene_drop") == 0) {
        drop(c, &exh_scene_drop);
    } else if (strcmp(symbol, "exh_scene_guarded") == 0) {
        drop(c, &exh_scene_guarded);
    } else if (strcmp(symbol, "exh_scene_bilateral") == 0) {
        bilateral(c);
    } else {
        return -1;
    }
    return 0;
}
