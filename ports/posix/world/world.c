/* SPDX-License-Identifier: MIT */
#include "world.h"

#include "reach.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GRAZE_FROM_M (3 * FINGER_PAD_M)

struct world {
    struct scene *scene;
    struct hand hand;
    struct reach reach;
    struct v3 carried_m;
    int cull;
};

struct world *world_load(const char *name, const char *text, char *error, size_t error_B)
{
    struct world *w = calloc(1, sizeof *w);
    if (w == NULL) {
        snprintf(error, error_B, "%s:1: no memory", name);
        return NULL;
    }
    w->cull = 1;
    hand_hit2(&w->hand);
    w->scene = scene_read(name, text, error, error_B);
    if (w->scene == NULL || reach_start(&w->reach, w->scene, &w->hand)) {
        if (w->scene) { snprintf(error, error_B, "%s:1: no memory: use fewer objects", name); }
        world_free(w);
        return NULL;
    }
    return w;
}

/* The whole file as one text, to be freed; NULL with the reason in error. */
static char *whole(const char *path, char *error, size_t error_B)
{
    FILE *f = fopen(path, "rb");
    char *text = NULL;
    size_t n = 0, room = 0;
    if (f == NULL) {
        snprintf(error, error_B, "%s: %s: give a scene file", path, strerror(errno));
        return NULL;
    }
    do {
        char *more = realloc(text, room + 65536 + 1);
        if (more == NULL) { break; }
        text = more;
        room += 65536;
        n += fread(text + n, 1, room - n, f);
    } while (n == room && room < 64u << 20);
    if (text == NULL || ferror(f) || memchr(text, '\0', n)) {
        snprintf(error, error_B, "%s: can't be read as text: give a scene file", path);
        free(text);
        text = NULL;
    } else {
        text[n] = '\0';
    }
    fclose(f);
    return text;
}

struct world *world_load_file(const char *path, char *error, size_t error_B)
{
    char *text = whole(path, error, error_B);
    struct world *w = text ? world_load(path, text, error, error_B) : NULL;
    free(text);
    return w;
}

void world_free(struct world *w)
{
    if (w == NULL) { return; }
    reach_stop(&w->reach);
    scene_free(w->scene);
    free(w);
}

const struct scene *world_scene(const struct world *w) { return w->scene; }

const struct hand *world_hand(const struct world *w) { return &w->hand; }

void world_cull(struct world *w, int on)
{
    w->cull = on;
    w->reach.all = !on;
    reach_wake(&w->reach, w->scene);
}

void world_carry(struct world *w, struct v3 by_m)
{
    w->carried_m = by_m;
    reach_wake(&w->reach, w->scene);
}

struct pose world_hand_at(const struct world *w, double t_s)
{
    struct pose p = motion_at(&w->scene->motion, &w->scene->hand, t_s);
    p.at = v3_add(p.at, w->carried_m);
    return p;
}

/* Rounded to the nearest; saturates. */
static int32_t q30(double v)
{
    const double x = v * 1073741824.0;
    if (!(x > -2147483648.0)) { return INT32_MIN; }
    if (x >= 2147483647.0) { return INT32_MAX; }
    return (int32_t)floor(x + 0.5);
}

static void to_q30(int32_t to[3], struct v3 v)
{
    to[0] = q30(v.x);
    to[1] = q30(v.y);
    to[2] = q30(v.z);
}

static void answer(
    const struct world *w, const struct ray *r, const struct hit *h, struct exh_wire_plane *to)
{
    const struct body *b = &w->reach.near[h->body < 0 ? 0 : h->body];
    double offset;
    struct v3 n;
    to->kind = EXH_PLANE_NONE;
    if (h->body < 0) { return; }
    n = hit_normal(b, r, h, &offset);
    /* The plane of a distant surface that the ray merely grazes passes near the finger long before
     * the surface itself does: no plane for the finger to be frozen at. */
    if (h->t > GRAZE_FROM_M && -v3_dot(n, r->along) < w->scene->graze) { return; }
    to->kind = EXH_PLANE_HIT;
    to->object = (uint16_t)b->object;
    to->material = (uint8_t)w->scene->object[b->object].material;
    to_q30(to->normal_q30, n);
    to_q30(to->point_m_q30, v3_times(n, offset));
    to_q30(to->hit_m_q30, v3_along(r->from, h->t, r->along));
}

static void count(struct world_stats *s, const struct world *w, const struct cast_stats *cs,
    const struct exh_wire_planes *out, unsigned moved)
{
    s->frames++;
    s->moved += moved;
    s->slept += (unsigned long)w->reach.sleepers;
    s->tests += cs->tested;
    s->culled += cs->culled;
    for (unsigned f = 0; f < FINGERS; f++) {
        s->rays += out->plane[f].kind != EXH_PLANE_UNTOLD;
        s->hits += out->plane[f].kind == EXH_PLANE_HIT;
    }
}

void world_frame(struct world *w, const struct exh_wire_state *in, double t_s,
    struct exh_wire_planes *out, struct world_stats *stats)
{
    const struct pose hand = world_hand_at(w, t_s);
    const unsigned moved = reach_update(&w->reach, w->scene, &hand, t_s);
    struct cast_stats cs = {0, 0};
    struct ray ray[FINGERS];
    struct hit hit[FINGERS];
    int n = 0;
    memset(out->plane, 0, sizeof out->plane); /* UNTOLD */
    out->fingers = (uint8_t)(in->fingers & w->scene->fingers);
    for (unsigned i = 0; i < FINGERS; i++) {
        struct finger f;
        if (!(out->fingers >> i & 1)) { continue; }
        finger_at(&f, &w->hand, i, in->joint_turn_q32[i]);
        ray[n].from = f.tip;
        ray[n].along = f.pad;
        ray[n].len = w->scene->ray_m;
        ray[n++].back = w->scene->back_m;
    }
    if (n > 0) { cast(w->reach.near, w->reach.nears, ray, n, w->cull, hit, &cs); }
    for (int i = 0, k = 0; i < FINGERS; i++) {
        if (out->fingers >> i & 1) { answer(w, &ray[k], &hit[k], &out->plane[i]), k++; }
    }
    if (stats) { count(stats, w, &cs, out, moved); }
}
