/* SPDX-License-Identifier: MIT */
/* The triangle nearest to a point by Embree 3 or 4. Its library has 44 MB, so it is loaded with the
 * first mesh. Embree selects the candidate triangles in floats. Each is then checked in doubles, so
 * that no plane contains Embree's rounding. */
#include "mesh.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if WORLD_EMBREE == 4
#include <embree4/rtcore.h>
#define LIBRARY "libembree4.so.4"
#else
#include <embree3/rtcore.h>
#define LIBRARY "libembree3.so.3"
#endif

/* clang-format off */
#define EACH(F) \
    F(rtcNewDevice) F(rtcReleaseDevice) F(rtcNewScene) F(rtcReleaseScene) F(rtcSetSceneFlags) \
    F(rtcCommitScene) F(rtcNewGeometry) F(rtcReleaseGeometry) F(rtcCommitGeometry) \
    F(rtcSetNewGeometryBuffer) F(rtcAttachGeometry) F(rtcPointQuery)
/* clang-format on */

static struct {
#define POINTER(f) __typeof__(f) *f;
    EACH(POINTER)
    RTCDevice device;
} embree;

/* 0, or 1 with the reason. */
static int load(char *error, size_t error_B)
{
    void *library, *f;
    if (embree.device) { return 0; }
    library = dlopen(LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        snprintf(error, error_B,
            "a mesh needs " LIBRARY ", which can't be loaded: install it (Debian: "
            "libembree-dev)");
        return 1;
    }
#define LOOK_UP(name) \
    f = dlsym(library, #name); \
    memcpy(&embree.name, &f, sizeof f); \
    if (f == NULL) { \
        snprintf(error, error_B, LIBRARY " has no " #name ": install another libembree-dev"); \
        return 1; \
    }
    EACH(LOOK_UP)
    embree.device = embree.rtcNewDevice("threads=1");
    if (embree.device == NULL) { snprintf(error, error_B, LIBRARY ": can't start on this CPU"); }
    return embree.device == NULL;
}

static int fill(RTCGeometry g, const struct mesh *m)
{
    float *point = embree.rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof *point, (size_t)m->points);
    unsigned *corner = embree.rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof *corner, (size_t)m->triangles);
    if (point == NULL || corner == NULL) { return 1; }
    for (int i = 0; i < m->points; i++) {
        point[3 * i] = (float)m->point[i].x;
        point[3 * i + 1] = (float)m->point[i].y;
        point[3 * i + 2] = (float)m->point[i].z;
    }
    for (int i = 0; i < 3 * m->triangles; i++) {
        corner[i] = (unsigned)m->triangle[i / 3].corner[i % 3];
    }
    return 0;
}

int mesh_ready(struct mesh *m, char *error, size_t error_B)
{
    RTCScene s;
    RTCGeometry g;
    if (load(error, error_B)) { return 1; }
    s = embree.rtcNewScene(embree.device);
    g = embree.rtcNewGeometry(embree.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (s == NULL || g == NULL || fill(g, m)) {
        snprintf(error, error_B, "no memory for its tree: use a smaller mesh");
        return 1;
    }
    embree.rtcCommitGeometry(g);
    embree.rtcAttachGeometry(s, g);
    embree.rtcReleaseGeometry(g);
    embree.rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
    embree.rtcCommitScene(s);
    m->tree = s;
    return 0;
}

void mesh_unready(struct mesh *m)
{
    if (m->tree) { embree.rtcReleaseScene(m->tree); }
    m->tree = NULL;
}

/* What of a triangle is nearest to p. */
static struct v3 nearest(const struct mesh *m, const int *corner, struct v3 p, int *inside)
{
    const struct v3 a = m->point[corner[0]], ab = v3_sub(m->point[corner[1]], a),
                    ac = v3_sub(m->point[corner[2]], a), n = v3_cross(ab, ac), to = v3_sub(p, a);
    const double nn = v3_dot(n, n), w = v3_dot(v3_cross(ab, to), n) / nn,
                 v = v3_dot(v3_cross(to, ac), n) / nn;
    struct v3 best = a;
    double least = ENDLESS;
    *inside = v > 0 && w > 0 && v + w < 1;
    if (*inside) { return v3_along(v3_along(a, v, ab), w, ac); }
    for (int k = 0; k < 3; k++) { /* else of one of its edges */
        const struct v3 from = m->point[corner[k]],
                        edge = v3_sub(m->point[corner[(k + 1) % 3]], from);
        const double at = v3_dot(v3_sub(p, from), edge) / v3_dot(edge, edge);
        const struct v3 on = v3_along(from, at < 0 ? 0 : at > 1 ? 1 : at, edge);
        const double far = v3_len(v3_sub(p, on));
        if (far < least) { least = far, best = on; }
    }
    return best;
}

/* The nearest triangle so far. Of two at one distance, which share an edge, the one that p is more
 * in front of or behind says on which side p is. */
struct search {
    const struct mesh *m;
    struct v3 p, on, n;
    double far_m, aside;
    int found, inside;
};

#define SAME_M 1e-9

static bool look(struct RTCPointQueryFunctionArguments *q)
{
    struct search *s = q->userPtr;
    const int *corner = s->m->triangle[q->primID].corner;
    int inside;
    const struct v3 on = nearest(s->m, corner, s->p, &inside), to = v3_sub(s->p, on);
    const double far_m = v3_len(to);
    struct v3 a;
    const struct v3 n = mesh_normal(s->m, (int)q->primID, &a);
    const double aside = v3_dot(n, to);
    if (far_m > s->far_m + SAME_M) { return false; }
    if (s->found && far_m > s->far_m - SAME_M && fabs(aside) <= fabs(s->aside)) { return false; }
    s->found = 1;
    s->far_m = far_m;
    s->aside = aside;
    s->on = inside ? a : on;
    s->n = inside || far_m <= 0 ? n : v3_times(to, (aside < 0 ? -1 : 1) / far_m);
    s->inside = aside < 0;
    q->query->radius = (float)(far_m * (1 + 1e-6) + 1e-6);
    return true;
}

static void seek(struct search *s, const struct mesh *m, struct v3 p, double most)
{
    struct RTCPointQuery q = {
        (float)p.x, (float)p.y, (float)p.z, 0, (float)(most * (1 + 1e-6) + 1e-6)};
    struct RTCPointQueryContext context;
    *s = (struct search){.m = m, .p = p, .n = v3(0, 0, 1), .on = p, .far_m = most};
    rtcInitPointQueryContext(&context);
    (void)embree.rtcPointQuery(m->tree, &q, &context, look, s);
}

double mesh_away_m(const struct mesh *m, struct v3 p, double most)
{
    struct search s;
    seek(&s, m, p, most);
    return s.found && s.inside ? -s.far_m : s.far_m;
}

void mesh_tangent(const struct mesh *m, struct v3 p, struct v3 *n, struct v3 *on)
{
    struct search s;
    seek(&s, m, p, 1e3);
    *n = s.n;
    *on = s.on;
}
