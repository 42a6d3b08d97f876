/* SPDX-License-Identifier: MIT */
/* Rays against bodies, beside a walk along the ray in small steps that knows no more of a body
 * than whether a point is inside. */
#include "check.h"

#include "world/mesh.h"
#include "world/rpy.h"
#include "world/shape.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define STEP 1e-3

static struct hit one_ray(
    const struct body *b, int n, const struct ray *r, int cull, struct cast_stats *s)
{
    struct hit h;
    cast(b, n, r, 1, cull, &h, s);
    return h;
}

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

/* The entry that counts: of the stretch that holds the origin, else of the first one ahead. NAN:
 * none. */
static double walked(const struct body *b, const struct ray *r)
{
    const int in = inside(b, r->from);
    double lo, hi;
    if (in) {
        for (lo = 0; lo >= -r->back - STEP && inside(b, v3_along(r->from, lo, r->along));
             lo -= STEP) {}
        hi = lo + STEP;
    } else {
        for (hi = 0; hi <= r->len + STEP && !inside(b, v3_along(r->from, hi, r->along));
             hi += STEP) {}
        lo = hi - STEP;
    }
    if (inside(b, v3_along(r->from, lo, r->along)) || !inside(b, v3_along(r->from, hi, r->along))) {
        return (double)NAN;
    }
    for (int i = 0; i < 60; i++) {
        const double mid = (lo + hi) / 2;
        if (inside(b, v3_along(r->from, mid, r->along))) {
            hi = mid;
        } else {
            lo = mid;
        }
    }
    return hi >= -r->back && hi <= r->len ? hi : (double)NAN;
}

static void random_body(struct body *b, enum shape_kind kind)
{
    struct shape is = {.kind = kind, .radius_m = real_in(0.01, 0.06)};
    struct pose at;
    at.turn = rpy_turn(vec_in(3));
    at.at = vec_in(0.08);
    is.half_m = v3(real_in(0.005, 0.06), real_in(0.005, 0.06), real_in(0.005, 0.06));
    is.bound_m = kind == SHAPE_BOX       ? v3_len(is.half_m)
                 : kind == SHAPE_CAPSULE ? is.half_m.z + is.radius_m
                                         : is.radius_m;
    body_set(b, &is, &at, 0);
}

static void random_ray(struct ray *r)
{
    r->from = vec_in(0.1);
    do {
        r->along = vec_in(1);
    } while (v3_len(r->along) < 0.1);
    r->along = v3_unit(r->along);
    if ((check_u64() & 7) == 0) { r->along = v3(0, 0, check_u64() & 1 ? 1 : -1); }
    r->len = 0.2;
    r->back = 0.05;
}

static void against_walk(enum shape_kind kind)
{
    int hits = 0, cases = 0;
    while (check_case(2000)) {
        struct body b;
        struct ray r;
        struct cast_stats s = {0, 0};
        struct hit h;
        double t;
        random_body(&b, kind);
        random_ray(&r);
        h = one_ray(&b, 1, &r, (int)(check_u64() & 1), &s);
        t = walked(&b, &r);
        cases++;
        if (isnan(t)) {
            /* the walk steps over chords shorter than a step */
            CHECK(h.body < 0 || !inside(&b, v3_along(r.from, h.t + STEP, r.along)) ||
                      h.t > r.len - STEP || h.t < -r.back + STEP,
                "entry at %g that is none", h.t);
            continue;
        }
        hits++;
        CHECK(h.body == 0 || t > r.len - STEP || t < -r.back + STEP, "entry at %g not found", t);
        if (h.body == 0) { CHECK(fabs(h.t - t) < 1e-9, "entry at %.12g, not at %.12g", h.t, t); }
    }
    CHECK(cases < 20 || hits > cases / 20, "%d hits of %d: tells nothing", hits, cases);
}

TEST(a_ray_enters_a_plane_where_a_walk_does) { against_walk(SHAPE_PLANE); }

TEST(a_ray_enters_a_sphere_where_a_walk_does) { against_walk(SHAPE_SPHERE); }

TEST(a_ray_enters_a_box_where_a_walk_does) { against_walk(SHAPE_BOX); }

TEST(a_ray_enters_a_capsule_where_a_walk_does) { against_walk(SHAPE_CAPSULE); }

/* The plane touches the body where the ray enters: unit normal, against the ray, and a little out
 * along it is outside, a little in is inside. */
TEST(the_plane_lies_on_the_surface)
{
    while (check_case(1000)) {
        struct body b;
        struct ray r;
        struct cast_stats s = {0, 0};
        struct hit h;
        struct v3 n, p;
        double offset;
        random_body(&b, (enum shape_kind)(check_u64() % SHAPE_MESH));
        random_ray(&r);
        h = one_ray(&b, 1, &r, 1, &s);
        if (h.body < 0) { continue; }
        n = hit_normal(&b, &r, &h, &offset);
        p = v3_along(r.from, h.t, r.along);
        CHECK(fabs(v3_len(n) - 1) < 1e-12, "length %.15g", v3_len(n));
        CHECK(v3_dot(n, r.along) <= 1e-9, "with the ray: %g", v3_dot(n, r.along));
        CHECK(fabs(v3_dot(n, p) - offset) < 1e-12, "P_C is %g off", v3_dot(n, p) - offset);
        CHECK(!inside(&b, v3_along(p, 1e-6, n)), "outside is inside");
        CHECK(inside(&b, v3_along(p, -1e-6, n)), "inside is outside");
    }
}

#define MANY 40

TEST(of_many_the_first_whatever_their_order_and_culling)
{
    while (check_case(2000)) {
        struct body b[MANY], turned[MANY];
        struct ray r;
        struct cast_stats s = {0, 0};
        struct hit one = {1, -1, 0}, h, t;
        random_ray(&r);
        for (int i = 0; i < MANY; i++) {
            random_body(&b[i], (enum shape_kind)(SHAPE_SPHERE + check_u64() % 3));
            b[i].object = (unsigned)i;
            b[i].at.at = v3_times(b[i].at.at, 3);
            turned[MANY - 1 - i] = b[i];
            h = one_ray(&b[i], 1, &r, 0, &s);
            if (h.body == 0 && (one.body < 0 || h.t < one.t)) { one.t = h.t, one.body = i; }
        }
        h = one_ray(b, MANY, &r, 1, &s);
        t = one_ray(turned, MANY, &r, 0, &s);
        CHECK(h.body == one.body && (h.body < 0 || h.t == one.t), "body %d, not %d", h.body,
            one.body);
        CHECK(t.body < 0 ? h.body < 0 : MANY - 1 - t.body == h.body, "another order, another body");
    }
}

TEST(rays_together_find_what_each_finds_alone)
{
    while (check_case(1000)) {
        struct body b[MANY];
        struct ray r[CAST_MAX];
        struct hit h[CAST_MAX];
        struct cast_stats together = {0, 0}, alone = {0, 0};
        const int rays = 1 + (int)(check_u64() % CAST_MAX), cull = (int)(check_u64() & 1);
        for (int i = 0; i < MANY; i++) {
            random_body(&b[i], (enum shape_kind)(check_u64() % SHAPE_MESH));
        }
        for (int i = 0; i < rays; i++) { random_ray(&r[i]); }
        cast(b, MANY, r, rays, cull, h, &together);
        for (int i = 0; i < rays; i++) {
            const struct hit a = one_ray(b, MANY, &r[i], cull, &alone);
            CHECK(a.body == h[i].body && a.t == h[i].t && a.face == h[i].face, "ray %d of %d", i,
                rays);
        }
        CHECK(alone.tested == together.tested && alone.culled == together.culled,
            "counted otherwise");
    }
}

TEST(two_at_one_place_are_told_apart_by_number)
{
    struct shape is = {.kind = SHAPE_SPHERE, .radius_m = 0.02, .bound_m = 0.02};
    struct pose at = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
    const struct ray r = {{0, 0, 0.05}, {0, 0, -1}, 0.1, 0.05};
    struct cast_stats s = {0, 0};
    struct body b[2];
    body_set(&b[0], &is, &at, 7);
    body_set(&b[1], &is, &at, 3);
    CHECK(one_ray(b, 2, &r, 1, &s).body == 1, "not the lower number");
    body_set(&b[0], &is, &at, 2);
    CHECK(one_ray(b, 2, &r, 1, &s).body == 0, "not the lower number");
}

/* --- meshes --- */

/* Every triangle by itself, in doubles. */
static int brute(const struct mesh *m, const struct ray *r, double *t)
{
    int found = -1;
    *t = r->len;
    for (int i = 0; i < m->triangles; i++) {
        const int *c = m->triangle[i].corner;
        struct v3 on;
        const struct v3 n = mesh_normal(m, i, &on);
        const double down = v3_dot(n, r->along), at = v3_dot(n, v3_sub(on, r->from)) / down;
        const struct v3 p = v3_along(r->from, at, r->along);
        int in = 0;
        for (int k = 0; k < 3; k++) {
            const struct v3 a = m->point[c[k]], b = m->point[c[(k + 1) % 3]];
            in += v3_dot(n, v3_cross(v3_sub(b, a), v3_sub(p, a))) >= 0;
        }
        if (in == 3 && down < 0 && at >= 0 && at < *t) { *t = at, found = i; }
    }
    return found;
}

TEST(a_mesh_is_hit_where_its_triangles_are)
{
    char why[400];
    struct mesh *m = mesh_read("ports/posix/world/scenes/gem.obj", 0.05, why, sizeof why);
    int hits = 0;
    CHECK(m != NULL, "%s", why);
    if (m == NULL) { return; }
    CHECK_EQ_I64(m->triangles, 80);
    if (mesh_ready(m, why, sizeof why)) {
        check_note("rays into meshes: not tested: %s", why);
        mesh_free(m);
        return;
    }
    while (check_case(500)) {
        struct ray r;
        double t = 0, want;
        int face = 0;
        const int there =
            (random_ray(&r), r.from = v3_times(v3_unit(r.from), 0.1), brute(m, &r, &want));
        const int hit = mesh_cast(m, &r, &t, &face);
        hits += hit;
        CHECK(hit == (there >= 0), "hit %d, not %d", hit, there);
        if (hit && there >= 0) { CHECK(fabs(t - want) < 1e-6, "at %.9g, not %.9g", t, want); }
        if (hit && face == there) { CHECK(fabs(t - want) < 1e-12, "at %.15g, not %.15g", t, want); }
        r.back = 0.12; /* the middle is inside: in through the face behind */
        r.from = v3(0, 0, 0);
        CHECK(mesh_cast(m, &r, &t, &face) && t < -0.04 && t > -0.0501, "from inside at %g", t);
    }
    CHECK(hits > 0, "no hit: tells nothing");
    mesh_free(m);
}

TEST_MAIN("world: rays", a_ray_enters_a_plane_where_a_walk_does,
    a_ray_enters_a_sphere_where_a_walk_does, a_ray_enters_a_box_where_a_walk_does,
    a_ray_enters_a_capsule_where_a_walk_does, the_plane_lies_on_the_surface,
    of_many_the_first_whatever_their_order_and_culling, rays_together_find_what_each_finds_alone,
    two_at_one_place_are_told_apart_by_number, a_mesh_is_hit_where_its_triangles_are);
