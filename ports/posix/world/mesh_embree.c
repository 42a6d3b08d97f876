/* SPDX-License-Identifier: MIT */
/* Rays into meshes by Embree 3 or 4. Its library has 44 MB: it is loaded when the first mesh is.
 *
 * Embree answers in floats which triangle is hit; where, is then computed from the triangle in
 * doubles, so that no rounding of Embree's is in a plane. */
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
    F(rtcSetNewGeometryBuffer) F(rtcAttachGeometry) F(rtcIntersect1)
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
        snprintf(error, error_B, "no memory for its rays: use a smaller mesh");
        return 1;
    }
    embree.rtcCommitGeometry(g);
    embree.rtcAttachGeometry(s, g);
    embree.rtcReleaseGeometry(g);
    embree.rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
    embree.rtcCommitScene(s);
    m->rays = s;
    return 0;
}

void mesh_unready(struct mesh *m)
{
    if (m->rays) { embree.rtcReleaseScene(m->rays); }
    m->rays = NULL;
}

/* The first triangle on the way, or -1. */
static int first(const struct mesh *m, struct v3 from, struct v3 along, double len)
{
    struct RTCRayHit r;
    memset(&r, 0, sizeof r);
    r.ray.org_x = (float)from.x;
    r.ray.org_y = (float)from.y;
    r.ray.org_z = (float)from.z;
    r.ray.dir_x = (float)along.x;
    r.ray.dir_y = (float)along.y;
    r.ray.dir_z = (float)along.z;
    r.ray.tfar = (float)len;
    r.ray.mask = ~0u;
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if WORLD_EMBREE == 4
    embree.rtcIntersect1(m->rays, &r, NULL);
#else
    struct RTCIntersectContext c;
    rtcInitIntersectContext(&c);
    embree.rtcIntersect1(m->rays, &c, &r);
#endif
    return r.hit.geomID == RTC_INVALID_GEOMETRY_ID ? -1 : (int)r.hit.primID;
}

int mesh_cast(const struct mesh *m, const struct ray *r, double *t, int *triangle)
{
    struct v3 on, n;
    int hit = first(m, r->from, r->along, r->len);
    if (hit < 0) { return 0; }
    n = mesh_normal(m, hit, &on);
    if (v3_dot(n, r->along) >= 0) { /* from behind: it starts inside, look back */
        hit = first(m, r->from, v3_times(r->along, -1), r->back);
        if (hit < 0) { return 0; }
        n = mesh_normal(m, hit, &on);
        if (v3_dot(n, r->along) >= 0) { return 0; }
    }
    *t = v3_dot(n, v3_sub(on, r->from)) / v3_dot(n, r->along);
    *triangle = hit;
    return 1;
}
