/* SPDX-License-Identifier: MIT */
/* Vectors, rotations and poses of the world simulator: doubles, + - x / and square roots only,
 * so that a world gives the same bits on every machine. */
#ifndef WORLD_VEC_H
#define WORLD_VEC_H

#include <math.h>

#define ENDLESS ((double)INFINITY)

struct v3 {
    double x, y, z;
};

static inline struct v3 v3(double x, double y, double z)
{
    const struct v3 v = {x, y, z};
    return v;
}

static inline struct v3 v3_add(struct v3 a, struct v3 b)
{
    return v3(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline struct v3 v3_sub(struct v3 a, struct v3 b)
{
    return v3(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline struct v3 v3_times(struct v3 a, double s) { return v3(a.x * s, a.y * s, a.z * s); }

/* a + s b */
static inline struct v3 v3_along(struct v3 a, double s, struct v3 b)
{
    return v3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

static inline double v3_dot(struct v3 a, struct v3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

static inline struct v3 v3_cross(struct v3 a, struct v3 b)
{
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline double v3_len(struct v3 a) { return sqrt(v3_dot(a, a)); }

/* a at length 1; a itself if it has none. */
static inline struct v3 v3_unit(struct v3 a)
{
    const double l = v3_len(a);
    return l > 0 ? v3_times(a, 1 / l) : a;
}

/* A rotation by its columns: the axes of the turned frame. */
struct m3 {
    struct v3 x, y, z;
};

static inline struct v3 m3_by(const struct m3 *m, struct v3 v)
{
    return v3_along(v3_along(v3_times(m->x, v.x), v.y, m->y), v.z, m->z);
}

/* By the transpose, which is the inverse. */
static inline struct v3 m3_back(const struct m3 *m, struct v3 v)
{
    return v3(v3_dot(m->x, v), v3_dot(m->y, v), v3_dot(m->z, v));
}

static inline struct m3 m3_times(const struct m3 *a, const struct m3 *b)
{
    const struct m3 m = {m3_by(a, b->x), m3_by(a, b->y), m3_by(a, b->z)};
    return m;
}

/* A frame in another one. */
struct pose {
    struct m3 turn;
    struct v3 at;
};

static inline struct v3 pose_by(const struct pose *p, struct v3 v)
{
    return v3_add(p->at, m3_by(&p->turn, v));
}

static inline struct v3 pose_back(const struct pose *p, struct v3 v)
{
    return m3_back(&p->turn, v3_sub(v, p->at));
}

/* What is b in the frame of a, both given in one third frame. */
static inline struct pose pose_in(const struct pose *a, const struct pose *b)
{
    struct pose p;
    p.at = pose_back(a, b->at);
    p.turn.x = m3_back(&a->turn, b->turn.x);
    p.turn.y = m3_back(&a->turn, b->turn.y);
    p.turn.z = m3_back(&a->turn, b->turn.z);
    return p;
}

#endif
