/* SPDX-License-Identifier: MIT */
/* What a ray costs: the performance sheet's scene, a plane, a sphere of 40 mm and a box, five rays
 * an operation from a hand whose fingers are bent at random: above them, so that nearly every ray
 * hits, or beside sphere and box. Run under callgrind by rays.sh, which counts the instructions of
 * cast(), and of plain() beside it. Prints rays and hits. */
#include "world/rpy.h"
#include "world/shape.h"
#include "world/finger.h"

#include "exhand/error.h"

#include "sim/random.h"

#include <stdio.h>
#include <stdlib.h>

#define OPS 10000

void exh_assert_failed(const char *file, int line)
{
    fprintf(stderr, "rays: %s:%d: the library's assertion\n", file, line);
    abort();
}

static double in(struct sim_random *r, double lo, double hi)
{
    return lo + (hi - lo) * sim_random_unit(r);
}

/* The same by hand, for this scene alone, one ray: what a program would do that knows no other. */
__attribute__((noinline)) double plain(const struct ray *r, const struct body *b, struct v3 *n);
double plain(const struct ray *r, const struct body *b, struct v3 *n)
{
    const struct v3 up = b[0].at.turn.z, o = v3_sub(r->from, b[1].at.at),
                    p = v3_sub(r->from, b[2].at.at);
    const double down = v3_dot(up, r->along), to = v3_dot(o, r->along);
    const double d = to * to - v3_dot(o, o) + b[1].radius2;
    const double kx = 1 / (r->along.x + 1e-300), ky = 1 / (r->along.y + 1e-300),
                 kz = 1 / (r->along.z + 1e-300);
    const double x = b[2].is.half_m.x * fabs(kx), y = b[2].is.half_m.y * fabs(ky),
                 z = b[2].is.half_m.z * fabs(kz);
    double best = r->len, in, out, t;
    if (down < 0) {
        t = (b[0].offset - v3_dot(up, r->from)) / down;
        if (t < best && t > 0) { best = t, *n = up; }
    }
    if (d >= 0) {
        t = -to - sqrt(d);
        if (t < best && t > 0) { best = t, *n = v3_unit(v3_along(o, t, r->along)); }
    }
    in = fmax(fmax(-p.x * kx - x, -p.y * ky - y), -p.z * kz - z);
    out = fmin(fmin(-p.x * kx + x, -p.y * ky + y), -p.z * kz + z);
    if (in <= out && in < best && in > 0) {
        best = in;
        *n = in == -p.x * kx - x ? v3(-1, 0, 0) : in == -p.y * ky - y ? v3(0, -1, 0) : v3(0, 0, -1);
    }
    return best;
}

int main(int argc, char **argv)
{
    const int turned = argc > 1 && argv[1][0] == 't', near = argc < 3 || argv[2][0] == 'n';
    const int cull = argc < 4 || argv[3][0] != '0';
    const struct v3 none = {0, 0, 0}, some = {0.3, 0.2, 0.5};
    const struct shape plane = {SHAPE_PLANE, {0, 0, 0}, 0, ENDLESS, NULL};
    const struct shape ball = {SHAPE_SPHERE, {0, 0, 0}, 0.04, 0.04, NULL};
    const struct shape box = {SHAPE_BOX, {0.03, 0.02, 0.025}, 0, 0.0439, NULL};
    struct pose at = {rpy_turn(v3(0, -1.5707963267948966, 0)), {near ? 0.12 : 0.09, 0, 0.1}};
    struct sim_random rng = {1};
    struct cast_stats s = {0, 0};
    struct hand h;
    struct body b[3];
    int hits[4] = {0, 0, 0, 0};
    double sum = 0;
    body_set(&b[0], &plane, &at, 0);
    at.turn = rpy_turn(turned ? some : none);
    at.at = near ? v3(0.08, 0.035, 0.17) : v3(0.07, 0.1, 0.2);
    body_set(&b[1], &ball, &at, 1);
    at.at = near ? v3(0.095, -0.03, 0.17) : v3(0.07, -0.1, 0.2);
    body_set(&b[2], &box, &at, 2);
    hand_hit2(&h);
    for (int i = 0; i < OPS; i++) {
        struct ray r[FINGERS];
        struct hit hit[FINGERS];
        for (unsigned f = 0; f < FINGERS; f++) {
            int32_t q[3];
            struct finger tip;
            for (int k = 0; k < 3; k++) {
                q[k] =
                    (int32_t)(in(&rng, finger_lo_rad[k], (k && near ? 0.4 : 1) * finger_hi_rad[k]) /
                              RAD_PER_TURN_Q32);
            }
            finger_at(&tip, &h, f, q);
            r[f].from = tip.tip;
            r[f].along = tip.pad;
            r[f].len = 0.1;
            r[f].back = 0.05;
        }
        cast(b, 3, r, FINGERS, cull, hit, &s);
        for (int f = 0; f < FINGERS; f++) {
            struct v3 n = none;
            sum += plain(&r[f], b, &n) * n.z;
            hits[hit[f].body + 1]++;
        }
    }
    printf("%d rays: %d%% hit the plane, %d%% the sphere, %d%% the box", 5 * OPS,
        hits[1] / (OPS / 20), hits[2] / (OPS / 20), hits[3] / (OPS / 20));
    return sum > 1e300; /* never; but so it is needed */
}
