/* SPDX-License-Identifier: MIT */
#include "shape.h"

#include "mesh.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

void body_set(struct body *b, const struct shape *is, const struct pose *at, unsigned object)
{
    b->at = *at;
    b->is = *is;
    b->offset = v3_dot(at->turn.z, at->at);
    b->bound2 = is->bound_m * is->bound_m;
    b->radius2 = is->radius_m * is->radius_m;
    b->object = object;
}

/* Each: where the ray enters, NAN for nowhere. An entry behind the origin counts only if the origin
 * is inside; whether it is the first, and not too far back, is for the caller. */

static double within(double v, double most) { return v > most ? most : v < -most ? -most : v; }

/* The long cylinder first; an entry beyond an end is one through the ball there, if any. */
static double capsule_enter(const struct body *b, const struct ray *r, struct v3 to)
{
    const struct v3 axis = b->at.turn.z, o = v3_times(to, -1);
    const double h = b->is.half_m.z;
    const double along = v3_dot(r->along, axis), at = v3_dot(o, axis);
    const double aa = 1 - along * along, bb = v3_dot(o, r->along) - at * along;
    const double cc = v3_dot(o, o) - at * at - b->radius2, d = bb * bb - aa * cc;
    const struct v3 near = v3_along(o, -within(at, h), axis);
    double t, end;
    if (d < 0 || (aa < 1e-12 && cc > 0)) { return (double)NAN; }
    if (aa < 1e-12) { /* along the axis: in through the end it comes from */
        t = 0;
        end = along > 0 ? -2 * h : 2 * h;
    } else {
        t = (-bb - sqrt(d)) / aa;
        end = at + t * along;
    }
    if (fabs(end) > h) {
        const struct v3 e = v3_along(o, -within(end, h), axis);
        const double b2 = v3_dot(e, r->along), d2 = b2 * b2 - (v3_dot(e, e) - b->radius2);
        if (d2 < 0) { return (double)NAN; }
        t = -b2 - sqrt(d2);
    }
    return t >= 0 || v3_dot(near, near) <= b->radius2 ? t : (double)NAN; /* starts inside */
}

static double mesh_enter(const struct body *b, const struct ray *r, struct v3 to, int *face)
{
    struct ray local = *r;
    double t;
    local.from = m3_back(&b->at.turn, v3_times(to, -1));
    local.along = m3_back(&b->at.turn, r->along);
    return mesh_cast(b->is.mesh, &local, &t, face) ? t : (double)NAN;
}

static double other_enter(const struct body *b, const struct ray *r, struct v3 to, int *face)
{
    return b->is.kind == SHAPE_CAPSULE ? capsule_enter(b, r, to) : mesh_enter(b, r, to, face);
}

/* --- two rays at a time --- */

typedef double d2 __attribute__((vector_size(16)));

#ifdef __SSE2__
/* Bit j: lane j is below 0. */
static inline unsigned negative(d2 v) { return (unsigned)_mm_movemask_pd(v); }

static inline d2 greater(d2 a, d2 b) { return _mm_max_pd(a, b); }

static inline d2 less(d2 a, d2 b) { return _mm_min_pd(a, b); }

static inline d2 root(d2 v) { return _mm_sqrt_pd(v); }

static inline d2 size(d2 v) { return _mm_andnot_pd((d2){-0.0, -0.0}, v); }
#else
static inline unsigned negative(d2 v)
{
    return (signbit(v[0]) ? 1u : 0u) | (signbit(v[1]) ? 2u : 0u);
}

static inline d2 greater(d2 a, d2 b)
{
    return (d2){a[0] > b[0] ? a[0] : b[0], a[1] > b[1] ? a[1] : b[1]};
}

static inline d2 less(d2 a, d2 b)
{
    return (d2){a[0] < b[0] ? a[0] : b[0], a[1] < b[1] ? a[1] : b[1]};
}

static inline d2 root(d2 v) { return (d2){sqrt(v[0]), sqrt(v[1])}; }

static inline d2 size(d2 v) { return (d2){fabs(v[0]), fabs(v[1])}; }
#endif

#define PAIRS (CAST_MAX / 2)

/* The rays by component, and what they have found. */
struct beam {
    struct pair {
        d2 x, y, z, rx, ry, rz; /* origin and direction */
        d2 best;                /* where the first entry so far is */
        unsigned lanes;         /* bit j: lane j is a ray */
        struct hit *hit;        /* theirs */
    } pair[PAIRS];
    const struct ray *ray;
    double back;
    int pairs;
};

static void spread(struct beam *k, const struct ray *r, int rays, struct hit *h)
{
    k->ray = r;
    k->back = -r->back;
    k->pairs = (rays + 1) / 2;
    for (int i = 0; i < k->pairs; i++) {
        const struct ray *a = &r[2 * i], *b = 2 * i + 1 < rays ? a + 1 : a; /* the odd one twice */
        struct pair *p = &k->pair[i];
        p->x = (d2){a->from.x, b->from.x}, p->rx = (d2){a->along.x, b->along.x};
        p->y = (d2){a->from.y, b->from.y}, p->ry = (d2){a->along.y, b->along.y};
        p->z = (d2){a->from.z, b->from.z}, p->rz = (d2){a->along.z, b->along.z};
        p->best = (d2){r->len, r->len};
        p->lanes = 3;
        p->hit = &h[2 * i];
    }
    if (rays & 1) { k->pair[rays / 2].lanes = 1; }
}

/* The entries at t of the lanes `in`, where they are the first so far. Of two at one place the
 * lower object has it, so that the order of the bodies is of no consequence. */
static inline void keep(
    struct pair *p, double back, const struct body *all, int body, unsigned in, d2 t, int face)
{
    in &= ~(negative(p->best - t) | negative(t - back));
    for (; in; in &= in - 1) {
        const int j = !(in & 1);
        struct hit *h = &p->hit[j];
        if (h->body >= 0 && t[j] == p->best[j] && all[body].object > all[h->body].object) {
            continue;
        }
        p->best[j] = h->t = t[j];
        h->body = body;
        h->face = face;
    }
}

static void plane(struct beam *k, const struct body *all, int body)
{
    const struct body *b = &all[body];
    const struct v3 n = b->at.turn.z;
    for (int i = 0; i < k->pairs; i++) {
        struct pair *p = &k->pair[i];
        const d2 down = n.x * p->rx + n.y * p->ry + n.z * p->rz;
        const d2 t = (b->offset - (n.x * p->x + n.y * p->y + n.z * p->z)) / down;
        keep(p, k->back, all, body, negative(down) & p->lanes, t, 0);
    }
}

/* One pair of faces: narrows the stretch of the rays that is inside. o: from the origins to the
 * middle. */
static inline void slab(
    struct v3 axis, double half, const struct pair *p, const d2 o[3], d2 *in, d2 *out)
{
    /* 1e-300 makes a ray along the faces finite and changes no other */
    const d2 k = 1 / (axis.x * p->rx + axis.y * p->ry + axis.z * p->rz + 1e-300);
    const d2 mid = (axis.x * o[0] + axis.y * o[1] + axis.z * o[2]) * k, w = half * size(k);
    *in = greater(mid - w, *in);
    *out = less(mid + w, *out);
}

static inline unsigned box(const struct body *b, const struct pair *p, const d2 o[3], d2 *in)
{
    const struct m3 *m = &b->at.turn;
    d2 out = {ENDLESS, ENDLESS};
    *in = -out;
    slab(m->x, b->is.half_m.x, p, o, in, &out);
    slab(m->y, b->is.half_m.y, p, o, in, &out);
    slab(m->z, b->is.half_m.z, p, o, in, &out);
    return ~(negative(out - *in) | negative(out));
}

/* Capsules and meshes: ray by ray. Not inlined: it would take ball() its registers. */
__attribute__((noinline)) static void others(struct pair *p, const struct ray *two, double back,
    const struct body *all, int body, unsigned in)
{
    for (; in; in &= in - 1) {
        const int j = !(in & 1);
        const struct ray *r = &two[j];
        const struct v3 o = v3_sub(all[body].at.at, r->from);
        int face = 0;
        const double t = other_enter(&all[body], r, o, &face);
        if (!isnan(t)) { keep(p, back, all, body, 1u << j, (d2){t, t}, face); }
    }
}

static inline unsigned ones(unsigned in) { return (in & 1) + (in >> 1); }

/* First the ball around the body, which of a sphere is the sphere: `to` its middle along the ray,
 * `inside` is above 0 if the ray's origin is, `d` what is under the root. Put aside is a ray that
 * passes by or has the ball behind, or has found something before it. */
static unsigned ball(struct beam *k, const struct body *all, int body, int cull)
{
    const struct body *b = &all[body];
    const struct v3 at = b->at.at;
    const double bound2 = cull ? b->bound2 : ENDLESS;
    unsigned asked = 0;
    for (int i = 0; i < k->pairs; i++) {
        struct pair *p = &k->pair[i];
        const d2 o[3] = {at.x - p->x, at.y - p->y, at.z - p->z};
        const d2 to = o[0] * p->rx + o[1] * p->ry + o[2] * p->rz;
        const d2 inside = bound2 - (o[0] * o[0] + o[1] * o[1] + o[2] * o[2]), d = to * to + inside;
        unsigned in = ~negative(less(d, greater(to, inside))) & p->lanes;
        d2 t;
        if (in == 0) { continue; }
        if (b->is.kind == SHAPE_SPHERE) {
            asked += ones(in);
            keep(p, k->back, all, body, in, to - root(d), 0);
            continue;
        }
        if (cull) { /* begins where something was found before */
            const d2 before = to - p->best;
            in &= negative(before) | ~negative(inside) | ~negative(d - before * before);
        }
        asked += ones(in);
        if (in == 0) { continue; }
        if (b->is.kind == SHAPE_BOX) {
            in &= box(b, p, o, &t);
            keep(p, k->back, all, body, in, t, 0);
        } else {
            others(p, &k->ray[2 * i], k->back, all, body, in);
        }
    }
    return asked;
}

void cast(const struct body *b, int n, const struct ray *r, int rays, int cull, struct hit *h,
    struct cast_stats *s)
{
    struct beam k;
    unsigned asked = 0;
    spread(&k, r, rays, h);
    for (int i = 0; i < rays; i++) { h[i] = (struct hit){r->len, -1, 0}; }
    for (int i = 0; i < n; i++) {
        if (b[i].is.kind == SHAPE_PLANE) {
            plane(&k, b, i);
            asked += (unsigned)rays;
        } else {
            asked += ball(&k, b, i, cull || b[i].is.kind == SHAPE_SPHERE);
        }
    }
    s->tested += (unsigned long)n * (unsigned long)rays;
    s->culled += (unsigned long)n * (unsigned long)rays - asked;
}

static struct v3 capsule_normal(const struct body *b, struct v3 p)
{
    const struct v3 o = v3_sub(p, b->at.at);
    const double at = within(v3_dot(o, b->at.turn.z), b->is.half_m.z);
    return v3_unit(v3_along(o, -at, b->at.turn.z));
}

/* Of the face that p is on: the one it is least within. */
static struct v3 box_normal(const struct body *b, const struct ray *r, struct v3 p, double *half)
{
    const struct v3 l = pose_back(&b->at, p), h = b->is.half_m;
    const double x = fabs(l.x) - h.x, y = fabs(l.y) - h.y, z = fabs(l.z) - h.z;
    const int face = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const struct v3 axis = face == 0 ? b->at.turn.x : face == 1 ? b->at.turn.y : b->at.turn.z;
    *half = face == 0 ? h.x : face == 1 ? h.y : h.z;
    return v3_dot(axis, r->along) > 0 ? v3_times(axis, -1) : axis;
}

struct v3 hit_normal(const struct body *b, const struct ray *r, const struct hit *h, double *offset)
{
    const struct v3 p = v3_along(r->from, h->t, r->along);
    struct v3 n = b->at.turn.z, on;
    double half;
    switch (b->is.kind) {
    case SHAPE_PLANE: *offset = v3_dot(n, b->at.at); return n;
    case SHAPE_BOX:
        n = box_normal(b, r, p, &half);
        *offset = v3_dot(n, b->at.at) + half;
        return n;
    case SHAPE_MESH:
        n = m3_by(&b->at.turn, mesh_normal(b->is.mesh, h->face, &on));
        *offset = v3_dot(n, pose_by(&b->at, on));
        return n;
    case SHAPE_SPHERE: n = v3_unit(v3_sub(p, b->at.at)); break;
    case SHAPE_CAPSULE: n = capsule_normal(b, p); break;
    }
    *offset = v3_dot(n, p);
    return n;
}
