/* SPDX-License-Identifier: MIT */
/* Scenes of the world simulator in the full box: five fingers hold one ball; a mesh where there are
 * rays for it. */
#include "check.h"

#include "box/hand.h"

#include "world/world.h"

#include <string.h>

static struct bilateral_run_cfg hand_in(const char *path, char *why, size_t why_B)
{
    struct bilateral_run_cfg c;
    memset(&c, 0, sizeof c);
    c.scene = world_load_file(path, why, why_B);
    c.rate_Hz = 2000;
    c.board = posix_config_default();
    c.board.exo = sim_exo_default();
    c.board.exo.fingers = 31;
    c.board.hand.pose = sim_pose_find("thumb_out");
    c.k_Npm = c.b_Nspm = -1;
    c.fps = 400;
    c.until_s = 1e30;
    c.keep = 1;
    return c;
}

/* Ticks in which each of the five is in contact with that ball and feels it. */
static size_t held(const struct bilateral_run *r)
{
    size_t together = 0;
    for (size_t i = 0; i < r->finger[0].n; i++) {
        int n = 0;
        for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
            const struct bilateral_sample *s = &r->finger[f].at[i];
            n += s->raw.c && s->raw.f_des_N_q20 > 1 << 20;
        }
        together += n == BILATERAL_FINGERS;
    }
    return together;
}

TEST(five_fingers_hold_one_ball_at_once)
{
    static const double mps[] = {0.1, 0.3, 0.87};
    char why[700];
    for (int k = 0; k < 3; k++) {
        struct bilateral_run_cfg c =
            hand_in("ports/posix/world/scenes/grasp.world", why, sizeof why);
        struct bilateral_run r;
        CHECK(c.scene != NULL, "%s", why);
        for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
            c.board.exo.path[f].speed_mps = mps[k];
            c.board.exo.path[f].approaches = 2;
        }
        CHECK_EQ_I64(bilateral_run(&c, &r), 0);
        CHECK_EQ_I64(r.faults, 0);
        CHECK(held(&r) > 1000,
            "%g m/s: %zu ticks of half a millisecond with more than 1 N at each of five", mps[k],
            held(&r));
        for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
            CHECK(r.finger[f].unfrozen == 0, "finger %u: felt before its freeze", f);
        }
        bilateral_run_free(&r);
        world_free(c.scene);
    }
}

TEST(a_mesh_is_felt_where_there_are_rays_into_it_and_else_it_is_said_what_is_missing)
{
    char why[700] = "";
    int felt = 0;
    struct bilateral_run_cfg c = hand_in("ports/posix/world/scenes/gem.world", why, sizeof why);
    struct bilateral_run r;
    if (c.scene == NULL) {
        CHECK(strstr(why, "mesh") && strstr(why, "libembree-dev"), "%s", why);
        check_note("no Embree: %s", why);
        return;
    }
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        c.board.exo.path[f].speed_mps = 0.2;
        c.board.exo.path[f].approaches = 1;
    }
    CHECK_EQ_I64(bilateral_run(&c, &r), 0);
    CHECK_EQ_I64(r.faults, 0);
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        felt += r.finger[f].contacts > 0;
        CHECK(r.finger[f].unfrozen == 0, "finger %u: felt before its freeze", f);
    }
    CHECK(felt >= 3, "%d of five fingers felt it: it turns, and its faces may turn away", felt);
    bilateral_run_free(&r);
    world_free(c.scene);
}

TEST_MAIN("five fingers on one ball; a mesh", five_fingers_hold_one_ball_at_once,
    a_mesh_is_felt_where_there_are_rays_into_it_and_else_it_is_said_what_is_missing);
