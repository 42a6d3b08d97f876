/* SPDX-License-Identifier: MIT */
/* Distances from bodies and the planes that touch them, against a search that only knows whether a
 * point is inside a body. What a finger touches first, against a walk in steps of 50 um. */
#include "check.h"

#include "world/ahead.h"
#include "world/mesh.h"
#include "world/rpy.h"
#include "world/shape.h"

#include <stdio.h>
#include <stdlib.h>

static double real_in(double lo, double hi)
{
    return lo + (hi - lo) * (double)(check_u64() >> 11) * 0x1p-53;
}

static struct v3 vec_in(double most)
{
    const double x = real_in(-most, most), y = real_in(-most, most);
    return v3(x, y, real_in(-most, most));
}

static int inside(const struct body *b, struct v3 p)
{
    const struct v3 l = pose_back(&b->at, p);
    const double z = fmin(fmax(l.z, -b->is.half_m.z), b->is.half_m.z);
    switch (b->is.kind) {
    case SHAPE_PLANE: return l.z <= 0;
    case SHAPE_SPHERE: return v3_len(l) <= b->is.radius_m;
    case SHAPE_BOX:
        return fabs(l.x) <= b->is.half_m.x && fabs(l.y) <= b->is.half_m.y &&
               fabs(l.z) <= b->is.half_m.z;
    case SHAPE_CAPSULE: return v3_len(v3(l.x, l.y, l.z - z)) <= b->is.radius_m;
    case SHAPE_MESH: break;
    }
    return 0;
}

static void random_body(struct body *b, enum shape_kind kind)
{
    struct shape is = {.kind = kind, .radius_m = real_in(0.01, 0.06)};
    struct pose at;
    at.turn = rpy_turn(vec_in(3));
    at.at = vec_in(0.08);
    is.half_m = v3(real_in(0.005, 0.06), real_in(0.005, 0.06), real_in(0.005, 0.06));
    is.bound_m = kind == SHAPE_PLANE     ? ENDLESS
                 : kind == SHAPE_BOX     ? v3_len(is.half_m)
                 : kind == SHAPE_CAPSULE ? is.half_m.z + is.radius_m
                                         : is.radius_m;
    body_set(b, &is, &at, 0);
}

/* A ball around p that is all on one side of the surface, and one a little larger that is not. */
static int other_side_within(const struct body *b, struct v3 p, double r, struct v3 toward)
{
    const int in = inside(b, p);
    if (inside(b, v3_along(p, r, toward)) != in) { return 1; }
    for (int i = 0; i < 200; i++) {
        const struct v3 u = v3_unit(vec_in(1));
        if (inside(b, v3_along(p, r, u)) != in) { return 1; }
    }
    return 0;
}

static void body_of(enum shape_kind kind)
{
    while (check_case(2000)) {
        struct body b;
        const struct v3 p = vec_in(0.15);
        double away, offset;
        struct v3 n, on;
        random_body(&b, kind);
        away = body_away_m(&b, p, ENDLESS);
        n = body_plane(&b, p, &offset);
        on = v3_along(p, offset - v3_dot(n, p), n);
        CHECK(fabs(v3_len(n) - 1) < 1e-12, "normal of length %g", v3_len(n));
        CHECK((away <= 0) == inside(&b, p), "%g m away, but inside %d", away, inside(&b, p));
        CHECK(
            !other_side_within(&b, p, fabs(away) * (1 - 1e-9), n), "%g m: nearer than told", away);
        CHECK(other_side_within(&b, p, fabs(away) + 1e-9, v3_times(n, away > 0 ? -1 : 1)),
            "%g m: not along the normal", away);
        CHECK(fabs(v3_dot(n, p) - offset - away) < 1e-12, "plane %g m away, body %g",
            v3_dot(n, p) - offset, away);
        CHECK(inside(&b, v3_along(on, -1e-9, n)) && !inside(&b, v3_along(on, 1e-9, n)),
            "the plane's point is not on the surface");
        CHECK(
            body_away_m(&b, p, 0.01) == away || (away >= 0.01 && body_away_m(&b, p, 0.01) >= 0.01),
            "%g with a limit of 10 mm, %g without", body_away_m(&b, p, 0.01), away);
    }
}

TEST(a_plane_is_as_far_as_it_is) { body_of(SHAPE_PLANE); }

TEST(a_sphere_is_as_far_as_it_is) { body_of(SHAPE_SPHERE); }

TEST(a_box_is_as_far_as_it_is) { body_of(SHAPE_BOX); }

TEST(a_capsule_is_as_far_as_it_is) { body_of(SHAPE_CAPSULE); }

TEST(a_flat_face_has_the_same_bits_from_wherever_it_is_nearest)
{
    while (check_case(500)) {
        struct body b;
        double first, offset;
        struct v3 n, m;
        random_body(&b, SHAPE_BOX);
        n = body_plane(&b, pose_by(&b.at, v3(0, 0, b.is.half_m.z + 0.01)), &first);
        for (int i = 0; i < 20; i++) {
            const struct v3 l = v3(real_in(-1, 1) * b.is.half_m.x, real_in(-1, 1) * b.is.half_m.y,
                b.is.half_m.z + real_in(1e-6, 0.1));
            m = body_plane(&b, pose_by(&b.at, l), &offset);
            CHECK(memcmp(&m, &n, sizeof n) == 0 && offset == first, "other bits");
        }
    }
}

/* --- meshes --- */

/* Of one triangle by barycentric coordinates on a grid that closes in: no formula of ours. */
static double to_triangle(const struct mesh *m, int i, struct v3 p)
{
    const int *c = m->triangle[i].corner;
    const struct v3 a = m->point[c[0]], ab = v3_sub(m->point[c[1]], a),
                    ac = v3_sub(m->point[c[2]], a);
    double v0 = 0.5, w0 = 0.5, size = 0.5, best = ENDLESS;
    for (int round = 0; round < 40; round++, size *= 0.6) {
        double bv = v0, bw = w0;
        for (int k = 0; k < 49; k++) {
            const double v = v0 + (k % 7 - 3) / 3.0 * size, w = w0 + (k / 7 - 3) / 3.0 * size;
            const struct v3 q = v3_along(v3_along(a, v, ab), w, ac);
            const double far = v3_len(v3_sub(p, q));
            if (v >= 0 && w >= 0 && v + w <= 1 && far < best) { best = far, bv = v, bw = w; }
        }
        v0 = bv, w0 = bw;
    }
    return best;
}

TEST(a_mesh_is_as_far_as_its_nearest_triangle)
{
    char why[400];
    struct mesh *m = mesh_read("ports/posix/world/scenes/gem.obj", 0.05, why, sizeof why);
    CHECK(m != NULL, "%s", why);
    if (m == NULL) { return; }
    CHECK_EQ_I64(m->triangles, 80);
    if (mesh_ready(m, why, sizeof why)) {
        check_note("distances from meshes: not tested: %s", why);
        mesh_free(m);
        return;
    }
    while (check_case(60)) {
        const struct v3 p = v3_times(v3_unit(vec_in(1)), real_in(0, 0.12));
        const double away = mesh_away_m(m, p, 1);
        double least = ENDLESS;
        struct v3 n, on;
        for (int i = 0; i < m->triangles; i++) { least = fmin(least, to_triangle(m, i, p)); }
        mesh_tangent(m, p, &n, &on);
        CHECK(fabs(fabs(away) - least) < 1e-5, "%.9g m, not %.9g", away, least);
        CHECK(v3_len(p) < 0.04   ? away < 0
              : v3_len(p) > 0.05 ? away > 0
                                 : 1,
            "%g m at %g", away, v3_len(p));
        CHECK(fabs(v3_dot(n, v3_sub(p, on)) - away) < 1e-9, "plane %g m away, mesh %g",
            v3_dot(n, v3_sub(p, on)), away);
        CHECK(mesh_away_m(m, p, fabs(away) / 2) >= fabs(away) / 2 || away < 0, "nearer than asked");
    }
    mesh_free(m);
}

/* --- ahead --- */

static double nearest(const struct body *b, int n, struct v3 p)
{
    double least = ENDLESS;
    for (int i = 0; i < n; i++) { least = fmin(least, body_away_m(&b[i], p, ENDLESS)); }
    return least;
}

/* The middle of the pad where it first touches on this way, in steps of 50 um; 0: nowhere. */
static int walked(const struct ahead *a, const double *turn_q32ps, double seconds, struct v3 *p)
{
    for (double s = 0; s <= seconds; s += 5e-5) {
        int32_t q[3];
        struct finger f;
        for (int j = 0; j < 3; j++) {
            const double v = a->joint_turn_q32[j] + s * turn_q32ps[j];
            q[j] = (int32_t)fmin(
                fmax(v, finger_lo_rad[j] / RAD_PER_TURN_Q32), finger_hi_rad[j] / RAD_PER_TURN_Q32);
        }
        finger_at(&f, a->hand, a->finger, q);
        *p = f.tip;
        if (nearest(a->body, a->bodies, f.tip) <= FINGER_PAD_M) { return 1; }
    }
    return 0;
}

TEST(what_is_told_is_what_the_pad_touches_first_on_its_way)
{
    struct hand h;
    int touched = 0, passed = 0;
    hand_hit2(&h);
    while (check_case(300)) {
        struct body b[3];
        int32_t q[3];
        double ps[3];
        const struct ahead a = {.body = b,
            .bodies = 3,
            .cull = (int)(check_u64() & 1),
            .hand = &h,
            .finger = 2,
            .joint_turn_q32 = q,
            .turn_q32ps = ps,
            .look_m = 0.1,
            .graze = 0};
        struct ahead_stats s = {0, 0};
        struct ahead_patch to;
        struct finger f;
        struct v3 p;
        for (int i = 0; i < 3; i++) {
            random_body(&b[i], i == 0 ? SHAPE_SPHERE : i == 1 ? SHAPE_BOX : SHAPE_CAPSULE);
            b[i].at.at = v3_add(b[i].at.at, v3(0.08, 0.01, 0.17));
            b[i].object = (unsigned)i;
        }
        for (int j = 0; j < 3; j++) {
            q[j] = (int32_t)(real_in(0, 0.2) / RAD_PER_TURN_Q32);
            ps[j] = real_in(j ? 0.5 : -0.1, j ? 2 : 0.1) / RAD_PER_TURN_Q32;
        }
        finger_at(&f, &h, 2, q);
        if (nearest(b, 3, f.tip) < FINGER_PAD_M + 0.001) { continue; }
        ahead_look(&a, &to, &s);
        if (!walked(&a, ps, 1.4, &p)) {
            passed++;
            continue;
        }
        touched++;
        CHECK(to.body >= 0, "nothing told, but it touches");
        if (to.body < 0) { continue; }
        { /* the plane touches that body, where it is nearest to where the pad will be */
            double offset;
            const struct v3 n = body_plane(&b[to.body], p, &offset);
            const double before = v3_dot(n, f.tip) - offset - FINGER_PAD_M;
            const double off = v3_len(v3_sub(to.point, v3_along(p, offset - v3_dot(n, p), n)));
            if (before <= 0) {
                continue;
            } /* it comes around a body: the patch that is nearest now */
            CHECK(off < 0.003 || fabs(nearest(b, 3, p) - FINGER_PAD_M) > 1e-4,
                "%.3f mm from where it touches", 1e3 * off);
        }
    }
    CHECK(touched == 0 || touched > 40, "%d touched, %d passed: tells nothing", touched, passed);
}

TEST(two_at_one_place_are_told_apart_by_number)
{
    struct shape is = {.kind = SHAPE_SPHERE, .radius_m = 0.02, .bound_m = 0.02};
    struct pose at = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0.1, 0.01, 0.2}};
    const int32_t q[3] = {0, 0, 0};
    struct hand h;
    struct body b[2];
    const struct ahead a = {.body = b,
        .bodies = 2,
        .hand = &h,
        .finger = 2,
        .joint_turn_q32 = q,
        .look_m = 0.2,
        .graze = 0};
    struct ahead_stats s = {0, 0};
    struct ahead_patch to;
    hand_hit2(&h);
    body_set(&b[0], &is, &at, 7);
    body_set(&b[1], &is, &at, 3);
    ahead_look(&a, &to, &s);
    CHECK(to.body == 1, "not the lower number");
    body_set(&b[0], &is, &at, 2);
    ahead_look(&a, &to, &s);
    CHECK(to.body == 0, "not the lower number");
}

TEST_MAIN("world: ahead", a_plane_is_as_far_as_it_is, a_sphere_is_as_far_as_it_is,
    a_box_is_as_far_as_it_is, a_capsule_is_as_far_as_it_is,
    a_flat_face_has_the_same_bits_from_wherever_it_is_nearest,
    a_mesh_is_as_far_as_its_nearest_triangle, what_is_told_is_what_the_pad_touches_first_on_its_way,
    two_at_one_place_are_told_apart_by_number);
