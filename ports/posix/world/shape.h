/* SPDX-License-Identifier: MIT */
/* Shapes, and how far a point is from them. All are solid; all are convex but the mesh. */
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

/* A shape with its pose, in the frame of the points. */
struct body {
    struct pose at;
    struct shape is;
    double offset;   /* PLANE: of it along z from the frame's origin */
    unsigned object; /* whose shape it is, for the caller */
};

void body_set(struct body *b, const struct shape *is, const struct pose *at, unsigned object);

/* The distance of p from the surface, m; below 0 inside. Exact where it is below `most`; else any
 * value from `most` on may come instead. */
double body_away_m(const struct body *b, struct v3 p, double most);

/* The plane that touches the body where it is nearest to p: its outward normal (length 1), and how
 * far it is from the frame's origin along it. Nearest to a flat face, both are of the body's pose
 * alone: the same bits for every such p. Beside an edge or a corner the normal points to p. */
struct v3 body_plane(const struct body *b, struct v3 p, double *offset_m);

#endif
