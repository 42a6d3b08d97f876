/* SPDX-License-Identifier: MIT */
/* What looking ahead costs: a plane, a sphere of 40 mm and a box below a hand whose fingers are
 * bent at random, at rest or closing. Run under callgrind by look.sh, which counts the instructions
 * of ahead_look(). Prints how many looks found what. */
#include "world/ahead.h"
#include "world/rpy.h"

#include "exhand/error.h"

#include "sim/random.h"

#include <stdio.h>
#include <stdlib.h>

#define OPS 4000

void exh_assert_failed(const char *file, int line)
{
    fprintf(stderr, "look: %s:%d: the library's assertion\n", file, line);
    abort();
}

static double in(struct sim_random *r, double lo, double hi)
{
    return lo + (hi - lo) * sim_random_unit(r);
}

int main(int argc, char **argv)
{
    const int moves = argc > 1 && argv[1][0] == 'm', cull = argc < 3 || argv[2][0] != '0';
    const struct v3 some = {0.3, 0.2, 0.5};
    const struct shape plane = {SHAPE_PLANE, {0, 0, 0}, 0, ENDLESS, NULL};
    const struct shape ball = {SHAPE_SPHERE, {0, 0, 0}, 0.04, 0.04, NULL};
    const struct shape box = {SHAPE_BOX, {0.03, 0.02, 0.025}, 0, 0.0439, NULL};
    struct pose at = {rpy_turn(v3(0, -1.5707963267948966, 0)), {0.12, 0, 0.1}};
    struct sim_random rng = {1};
    struct ahead_stats s = {0, 0};
    struct hand h;
    struct body b[3];
    int found[4] = {0, 0, 0, 0};
    body_set(&b[0], &plane, &at, 0);
    at.turn = rpy_turn(some);
    at.at = v3(0.08, 0.035, 0.17);
    body_set(&b[1], &ball, &at, 1);
    at.at = v3(0.095, -0.03, 0.17);
    body_set(&b[2], &box, &at, 2);
    hand_hit2(&h);
    for (int i = 0; i < OPS * FINGERS; i++) {
        int32_t q[3];
        double ps[3];
        const struct ahead a = {.body = b,
            .bodies = 3,
            .cull = cull,
            .hand = &h,
            .finger = (unsigned)(i % FINGERS),
            .joint_turn_q32 = q,
            .turn_q32ps = moves ? ps : NULL,
            .look_m = 0.1,
            .graze = 0.34};
        struct ahead_patch to;
        for (int k = 0; k < 3; k++) {
            q[k] = (int32_t)(in(&rng, finger_lo_rad[k], (k ? 0.4 : 1) * finger_hi_rad[k]) /
                             RAD_PER_TURN_Q32);
            ps[k] = in(&rng, k ? 0.5 : -0.1, k ? 5 : 0.1) / RAD_PER_TURN_Q32;
        }
        ahead_look(&a, &to, &s);
        found[to.body + 1]++;
    }
    printf(
        "%d looks: %d %% find the plane, %d %% the sphere, %d %% the box; %.1f bodies asked a look",
        OPS * FINGERS, found[1] / (OPS / 20), found[2] / (OPS / 20), found[3] / (OPS / 20),
        (double)s.tested / (OPS * FINGERS));
    return 0;
}
