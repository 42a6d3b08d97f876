/* SPDX-License-Identifier: MIT */
#include "scene_part.h"

#include "mesh.h"
#include "rpy.h"

#include <stdio.h>
#include <string.h>

static int add_object(struct reading *r, struct scene_object *o, const char *material)
{
    struct scene *s = r->s;
    o->material = scene_material_of(s, material);
    if (o->material < 0) {
        return tokens_complain(&r->w,
            "%s %s: material %.30s: not defined so far: add `material %.30s` "
            "above",
            r->w.word[0], o->name, material, material);
    }
    if (strcmp(o->name, "hand") == 0 || scene_object_of(s, o->name)) {
        return tokens_complain(
            &r->w, "%s %s: the name is taken: use another one", r->w.word[0], o->name);
    }
    if (s->objects == SCENE_OBJECTS_MAX) {
        return tokens_complain(&r->w, "%s %s: more than %d objects: leave some out", r->w.word[0],
            o->name, SCENE_OBJECTS_MAX);
    }
    s->object = scene_room(s->object, s->objects, sizeof *o);
    if (s->object == NULL) { return tokens_complain(&r->w, "no memory"); }
    s->object[s->objects++] = *o;
    return 0;
}

int scene_take_plane(struct reading *r)
{
    struct scene_object o = {.shape.kind = SHAPE_PLANE, .draw_m = 0.25};
    double at[3], normal[3] = {0, 0, 1};
    const char *material;
    struct pair p[] = {{"at", 3, at, -SCENE_FAR_M, SCENE_FAR_M, 1, 0},
        {"material", 0, &material, 0, 0, 1, 0}, {"normal", 3, normal, -1e3, 1e3, 0, 0},
        {"draw", 1, &o.draw_m, 0.001, SCENE_FAR_M, 0, 0}};
    struct v3 n;
    if (scene_named(r, o.name) || tokens_pairs(&r->w, 2, p, 4)) { return 1; }
    to_v3(&o.stand.at, at);
    to_v3(&n, normal);
    if (frame_from_z(&o.stand.turn, n, fabs(n.x) < 0.9 * v3_len(n) ? v3(1, 0, 0) : v3(0, 1, 0))) {
        return tokens_complain(
            &r->w, "plane %s: normal has no length: let it point out of the solid", o.name);
    }
    o.shape.bound_m = ENDLESS;
    return add_object(r, &o, material);
}

/* What spheres, boxes, capsules and meshes have in common, and n pairs of their own. */
static int take_body(
    struct reading *r, struct scene_object *o, const struct pair *own, int n, const char **material)
{
    double at[3], rpy[3] = {0, 0, 0};
    struct v3 turn;
    struct pair p[8] = {{"at", 3, at, -SCENE_FAR_M, SCENE_FAR_M, 1, 0},
        {"material", 0, material, 0, 0, 1, 0}, {"rpy", 3, rpy, -360, 360, 0, 0}};
    memcpy(p + 3, own, (size_t)n * sizeof *own);
    if (scene_named(r, o->name) || tokens_pairs(&r->w, 2, p, 3 + n)) { return 1; }
    to_v3(&o->stand.at, at);
    to_v3(&turn, rpy);
    o->stand.turn = rpy_turn(v3_times(turn, RAD_PER_DEG));
    return 0;
}

int scene_take_sphere(struct reading *r)
{
    struct scene_object o = {.shape.kind = SHAPE_SPHERE};
    const char *material;
    const struct pair p[] = {{"radius", 1, &o.shape.radius_m, 1e-4, 10, 1, 0}};
    if (take_body(r, &o, p, 1, &material)) { return 1; }
    o.shape.bound_m = o.shape.radius_m;
    return add_object(r, &o, material);
}

int scene_take_box(struct reading *r)
{
    struct scene_object o = {.shape.kind = SHAPE_BOX};
    double size[3];
    const char *material;
    const struct pair p[] = {{"size", 3, size, 1e-4, 20, 1, 0}};
    if (take_body(r, &o, p, 1, &material)) { return 1; }
    o.shape.half_m = v3(size[0] / 2, size[1] / 2, size[2] / 2);
    o.shape.bound_m = v3_len(o.shape.half_m);
    return add_object(r, &o, material);
}

int scene_take_capsule(struct reading *r)
{
    struct scene_object o = {.shape.kind = SHAPE_CAPSULE};
    const char *material;
    const struct pair p[] = {{"radius", 1, &o.shape.radius_m, 1e-4, 10, 1, 0},
        {"length", 1, &o.shape.half_m.z, 1e-4, 20, 1, 0}};
    if (take_body(r, &o, p, 2, &material)) { return 1; }
    o.shape.half_m.z /= 2;
    o.shape.bound_m = o.shape.half_m.z + o.shape.radius_m;
    return add_object(r, &o, material);
}

/* A file beside the scene. */
static void beside(char *to, size_t to_B, const char *scene, const char *file)
{
    const char *slash = strrchr(scene, '/');
    const int dir = file[0] == '/' || slash == NULL ? 0 : (int)(slash - scene) + 1;
    snprintf(to, to_B, "%.*s%s", dir, scene, file);
}

int scene_take_mesh(struct reading *r)
{
    struct scene *s = r->s;
    struct scene_object o = {.shape.kind = SHAPE_MESH};
    double scale = 1;
    const char *material, *file;
    char path[1024], why[400];
    struct mesh *m;
    const struct pair p[] = {{"file", 0, &file, 0, 0, 1, 0}, {"scale", 1, &scale, 1e-6, 1e3, 0, 0}};
    if (take_body(r, &o, p, 2, &material)) { return 1; }
    beside(path, sizeof path, r->w.file, file);
    m = mesh_read(path, scale, why, sizeof why);
    if (m == NULL) { return tokens_complain(&r->w, "mesh %s: %s", o.name, why); }
    s->mesh = scene_room(s->mesh, s->meshes, sizeof *s->mesh);
    if (s->mesh == NULL) { return tokens_complain(&r->w, "no memory"); }
    s->mesh[s->meshes++] = m;
    if (mesh_ready(m, why, sizeof why)) {
        return tokens_complain(&r->w, "mesh %s: %s", o.name, why);
    }
    o.shape.mesh = m;
    o.shape.bound_m = m->bound_m * (1 + 1e-6); /* Embree's corners are floats */
    return add_object(r, &o, material);
}
