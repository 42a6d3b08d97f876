/* SPDX-License-Identifier: MIT */
#include "shape.h"

#include "mesh.h"

void body_set(struct body *b, const struct shape *is, const struct pose *at, unsigned object)
{
    b->at = *at;
    b->is = *is;
    b->offset = v3_dot(at->turn.z, at->at);
    b->object = object;
}

static double within(double v, double most) { return v > most ? most : v < -most ? -most : v; }

/* From the point of a capsule's axis that is nearest to p. */
static struct v3 from_axis(const struct body *b, struct v3 p)
{
    const struct v3 o = v3_sub(p, b->at.at);
    const double at = within(v3_dot(o, b->at.turn.z), b->is.half_m.z);
    return v3_along(o, -at, b->at.turn.z);
}

/* How far l, in the box's frame, is beyond its faces; below 0: within them. */
static struct v3 beyond(const struct body *b, struct v3 l)
{
    const struct v3 h = b->is.half_m;
    return v3(fabs(l.x) - h.x, fabs(l.y) - h.y, fabs(l.z) - h.z);
}

static double box_away_m(const struct body *b, struct v3 p)
{
    const struct v3 q = beyond(b, pose_back(&b->at, p));
    const double most = fmax(q.x, fmax(q.y, q.z));
    return most <= 0 ? most : v3_len(v3(fmax(q.x, 0), fmax(q.y, 0), fmax(q.z, 0)));
}

double body_away_m(const struct body *b, struct v3 p, double most)
{
    const double ball = v3_len(v3_sub(p, b->at.at)) - b->is.bound_m;
    if (b->is.kind == SHAPE_PLANE) { return v3_dot(b->at.turn.z, p) - b->offset; }
    if (b->is.kind == SHAPE_SPHERE || ball >= most) { return ball; }
    if (b->is.kind == SHAPE_BOX) { return box_away_m(b, p); }
    return b->is.kind == SHAPE_CAPSULE ? v3_len(from_axis(b, p)) - b->is.radius_m
                                       : mesh_away_m(b->is.mesh, pose_back(&b->at, p), most);
}

/* Of the face that l is beyond, or least within, if it is one; else of the edge or corner. */
static struct v3 box_plane(const struct body *b, struct v3 p, double *offset_m)
{
    const struct v3 l = pose_back(&b->at, p), q = beyond(b, l), h = b->is.half_m;
    const int face = q.x >= q.y && q.x >= q.z ? 0 : q.y >= q.z ? 1 : 2;
    const struct v3 axis = face == 0 ? b->at.turn.x : face == 1 ? b->at.turn.y : b->at.turn.z;
    const double at = face == 0 ? l.x : face == 1 ? l.y : l.z;
    struct v3 n = at < 0 ? v3_times(axis, -1) : axis;
    *offset_m = v3_dot(n, b->at.at) + (face == 0 ? h.x : face == 1 ? h.y : h.z);
    if ((q.x > 0) + (q.y > 0) + (q.z > 0) > 1) {
        const struct v3 edge = v3(within(l.x, h.x), within(l.y, h.y), within(l.z, h.z));
        n = m3_by(&b->at.turn, v3_unit(v3_sub(l, edge)));
        *offset_m = v3_dot(n, pose_by(&b->at, edge));
    }
    return n;
}

static struct v3 mesh_plane(const struct body *b, struct v3 p, double *offset_m)
{
    struct v3 n, on;
    mesh_tangent(b->is.mesh, pose_back(&b->at, p), &n, &on);
    n = m3_by(&b->at.turn, n);
    *offset_m = v3_dot(n, pose_by(&b->at, on));
    return n;
}

struct v3 body_plane(const struct body *b, struct v3 p, double *offset_m)
{
    struct v3 n = b->at.turn.z, centre;
    switch (b->is.kind) {
    case SHAPE_PLANE: *offset_m = b->offset; return n;
    case SHAPE_BOX: return box_plane(b, p, offset_m);
    case SHAPE_MESH: return mesh_plane(b, p, offset_m);
    case SHAPE_SPHERE: n = v3_sub(p, b->at.at); break;
    case SHAPE_CAPSULE: n = from_axis(b, p); break;
    }
    centre = v3_sub(p, n);
    n = v3_len(n) > 0 ? v3_unit(n) : b->at.turn.x; /* in the middle: any will do */
    *offset_m = v3_dot(n, centre) + b->is.radius_m;
    return n;
}
