/* SPDX-License-Identifier: MIT */
#include "world.h"

#include "ahead.h"
#include "reach.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
    size_t n = 0, room = 0, got;
    if (f == NULL) {
        snprintf(error, error_B, "%s: %s: give a scene file", path, strerror(errno));
        return NULL;
    }
    do {
        char *more = realloc(text, room + 65536 + 1);
        if (more == NULL) { break; }
        text = more;
        room += 65536;
        got = fread(text + n, 1, room - n, f);
        n += got;
    } while (n == room && room < 64u << 20 && !memchr(text + n - got, '\0', got));
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

/* One finger's frame. */
struct moment {
    const struct world *w;
    double t_s;
};

static struct pose hand_later(const void *ctx, double later_s)
{
    const struct moment *m = ctx;
    return world_hand_at(m->w, m->t_s + later_s);
}

static void answer(
    const struct world *w, const struct ahead_patch *patch, struct exh_wire_plane *to)
{
    to->kind = EXH_PLANE_NONE;
    if (patch->body < 0) { return; }
    to->kind = EXH_PLANE_HIT;
    to->object = (uint16_t)w->reach.near[patch->body].object;
    to->material = (uint8_t)w->scene->object[to->object].material;
    to_q30(to->normal_q30, patch->normal);
    to_q30(to->point_m_q30, v3_times(patch->normal, patch->offset_m));
    to_q30(to->hit_m_q30, patch->point);
}

static void count(struct world_stats *s, const struct world *w, const struct ahead_stats *as,
    const struct exh_wire_planes *out, unsigned moved)
{
    s->frames++;
    s->moved += moved;
    s->slept += (unsigned long)w->reach.sleepers;
    s->tests += as->tested;
    s->culled += as->culled;
    for (unsigned f = 0; f < FINGERS; f++) {
        s->looks += out->plane[f].kind != EXH_PLANE_UNTOLD;
        s->hits += out->plane[f].kind == EXH_PLANE_HIT;
    }
}

void world_frame(struct world *w, const struct exh_wire_state *in, const struct pace *pace,
    double t_s, struct exh_wire_planes *out, struct world_stats *stats)
{
    const struct pose hand = world_hand_at(w, t_s);
    const unsigned moved = reach_update(&w->reach, w->scene, &hand, t_s);
    const struct moment m = {w, t_s};
    const int still = w->scene->motion.kind == MOTION_NONE;
    struct ahead a = {.body = w->reach.near,
        .bodies = w->reach.nears,
        .cull = w->cull,
        .hand = &w->hand,
        .hand_at = still ? NULL : hand_later,
        .ctx = &m,
        .hand_mps = w->reach.speed + motion_turning(&w->scene->motion) * w->reach.span_m,
        .look_m = w->scene->look_m,
        .graze = w->scene->graze};
    struct ahead_stats as = {0, 0};
    memset(out->plane, 0, sizeof out->plane); /* UNTOLD */
    out->fingers = (uint8_t)(in->fingers & w->scene->fingers);
    for (unsigned f = 0; f < FINGERS; f++) {
        struct ahead_patch patch;
        if (!(out->fingers >> f & 1)) { continue; }
        a.finger = f;
        a.joint_turn_q32 = in->joint_turn_q32[f];
        a.turn_q32ps = pace ? pace->turn_q32ps[f] : NULL;
        a.pull_turn_q32ps = pace ? pace->pull_turn_q32ps[f] : NULL;
        ahead_look(&a, &patch, &as);
        answer(w, &patch, &out->plane[f]);
    }
    if (stats) { count(stats, w, &as, out, moved); }
}

double world_gap_m(struct world *w, unsigned finger, const int32_t joint_turn_q32[3], double t_s)
{
    const struct pose hand = world_hand_at(w, t_s);
    double least = 1e3 + FINGER_PAD_M;
    struct finger f;
    finger_at(&f, &w->hand, finger, joint_turn_q32);
    (void)reach_update(&w->reach, w->scene, &hand, t_s);
    for (int i = 0; i < w->reach.nears; i++) {
        least = fmin(least, body_away_m(&w->reach.near[i], f.tip, least));
    }
    return least - FINGER_PAD_M;
}
