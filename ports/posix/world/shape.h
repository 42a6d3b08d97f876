/* SPDX-License-Identifier: MIT */
/* Shapes and the ray: where does a ray enter one of many bodies?
 *
 * All bodies are convex but the mesh. A ray enters a body where it passes its surface inwards,
 * ahead of its origin (up to `len`), or behind it (up to `back`) if it starts inside: then the
 * finger is in the body already, and the plane it came through goes on being the answer. */
#ifndef WORLD_SHAPE_H
#define WORLD_SHAPE_H

#include "vec.h"

enum shape_kind {
    SHAPE_PLANE, /* everything below z = 0 of its frame */
    SHAPE_SPHERE,
    SHAPE_BOX,
    SHAPE_CAPSULE, /* along z of its frame */
    SHAPE_MESH
};

struct mesh;

struct shape {
    enum shape_kind kind;
    struct v3 half_m; /* BOX: half its edges; CAPSULE: z half the length between the centres of
                         its ends */
    double radius_m;  /* SPHERE, CAPSULE */
    double bound_m;   /* of the ball around its origin that holds it; PLANE: infinite */
    const struct mesh *mesh;
};

/* A shape where it stands: in the frame of the rays. */
struct body {
    struct pose at;
    struct shape is;
    double radius2;  /* is.radius_m squared */
    double offset;   /* PLANE: of it along z from the frame's origin */
    double bound2;   /* is.bound_m squared */
    unsigned object; /* whose shape it is, for the caller */
};

void body_set(struct body *b, const struct shape *is, const struct pose *at, unsigned object);

struct ray {
    struct v3 from, along; /* along has length 1 */
    double len, back;
};

struct hit {
    double t; /* the ray enters at from + t along */
    int body; /* of the array, -1: none */
    int face; /* MESH: triangle */
};

struct cast_stats {
    unsigned long tested, culled; /* bodies looked at; of these put aside by their ball */
};

#define CAST_MAX 6

/* The first entry of each of up to CAST_MAX rays into any of n bodies: h[i] is that of r[i]. All
 * have the len and back of the first. Two rays go at a time, lane by lane with the bits that each
 * alone would give. With cull 0 no ball is asked. */
void cast(const struct body *b, int n, const struct ray *r, int rays, int cull, struct hit *h,
    struct cast_stats *s);

/* The outward normal (length 1) where r enters, and how far the tangent plane there is from the
 * origin of the frame, along it. Of a flat face both are of the body's pose alone and so the same
 * bits wherever the ray comes from. */
struct v3 hit_normal(
    const struct body *b, const struct ray *r, const struct hit *h, double *offset);

#endif
