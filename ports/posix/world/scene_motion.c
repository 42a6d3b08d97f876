/* SPDX-License-Identifier: MIT */
#include "scene_part.h"

#include "rpy.h"

#include <string.h>

static struct motion *moved(struct reading *r)
{
    struct tokens *w = &r->w;
    struct scene_object *o;
    if (w->n < 2) {
        tokens_complain(w, "%s: what moves is missing: name an object, or hand", w->word[0]);
        return NULL;
    }
    if (strcmp(w->word[1], "hand") == 0) { return &r->s->motion; }
    o = scene_object_of(r->s, w->word[1]);
    if (o == NULL) {
        tokens_complain(
            w, "%s %.30s: no such object so far: define it above", w->word[0], w->word[1]);
    }
    return o ? &o->motion : NULL;
}

int scene_take_motion(struct reading *r)
{
    struct tokens *w = &r->w;
    struct motion *m = moved(r);
    double move[3] = {0, 0, 0}, turn[3] = {0, 0, 0}, phase = 0;
    const char *kind = w->n > 2 ? w->word[2] : "";
    if (m == NULL) { return 1; }
    if (m->kind != MOTION_NONE) {
        return tokens_complain(w, "motion %s: given twice: leave one out", w->word[1]);
    }
    m->hz = 1;
    if (strcmp(kind, "linear") == 0 || strcmp(kind, "sine") == 0) {
        struct pair p[] = {{"move", 3, move, -SCENE_FAR_M, SCENE_FAR_M, 0, 0},
            {"turn", 3, turn, -36000, 36000, 0, 0}, {"hz", 1, &m->hz, 1e-6, 1000, 0, 0},
            {"phase", 1, &phase, -360, 360, 0, 0}};
        m->kind = kind[0] == 'l' ? MOTION_LINEAR : MOTION_SINE;
        if (tokens_pairs(w, 3, p, kind[0] == 'l' ? 2 : 4)) { return 1; }
    } else if (strcmp(kind, "keys") == 0 && w->n <= 4 &&
               (w->n == 3 || strcmp(w->word[3], "loop") == 0)) {
        m->kind = MOTION_KEYS;
        m->loop = w->n == 4;
    } else {
        return tokens_complain(w,
            "motion %s: %.30s: no such motion: use linear, sine, keys or keys loop", w->word[1],
            w->n > 3 && kind[0] == 'k' ? w->word[3] : kind);
    }
    to_v3(&m->move, move);
    m->turn = v3_times(v3(turn[0], turn[1], turn[2]), RAD_PER_DEG);
    m->phase_rad = phase * RAD_PER_DEG;
    return 0;
}

int scene_take_key(struct reading *r)
{
    struct tokens *w = &r->w;
    struct motion *m = moved(r);
    struct motion_key k;
    double move[3] = {0, 0, 0}, turn[3] = {0, 0, 0};
    struct pair p[] = {{"t", 1, &k.t_s, 0, 1e6, 1, 0},
        {"move", 3, move, -SCENE_FAR_M, SCENE_FAR_M, 0, 0}, {"turn", 3, turn, -36000, 36000, 0, 0}};
    if (m == NULL || tokens_pairs(w, 2, p, 3)) { return 1; }
    if (m->kind != MOTION_KEYS) {
        return tokens_complain(w, "key %s: it has no motion by keys: add `motion %s keys` above",
            w->word[1], w->word[1]);
    }
    if (m->keys && !(k.t_s > m->key[m->keys - 1].t_s)) {
        return tokens_complain(
            w, "key %s: t %g is not after the one before: let times rise", w->word[1], k.t_s);
    }
    to_v3(&k.move_m, move);
    k.turn_rad = v3_times(v3(turn[0], turn[1], turn[2]), RAD_PER_DEG);
    m->key = scene_room(m->key, m->keys, sizeof k);
    if (m->key == NULL) { return tokens_complain(w, "no memory"); }
    m->key[m->keys++] = k;
    return 0;
}

int scene_check_keys(struct reading *r, const struct motion *m, const char *name)
{
    const struct motion_key *a = m->key, *b = m->keys ? &m->key[m->keys - 1] : NULL;
    if (m->kind != MOTION_KEYS) { return 0; }
    if (m->keys < 2) {
        return tokens_complain(
            &r->w, "motion %s keys: fewer than two keys: add `key %s t ...` lines", name, name);
    }
    if (m->loop && (v3_len(v3_sub(a->move_m, b->move_m)) > 1e-9 ||
                       v3_len(v3_sub(a->turn_rad, b->turn_rad)) > 1e-9)) {
        return tokens_complain(&r->w,
            "motion %s keys loop: the last key is not where the first is: it "
            "would jump; add one that closes the loop",
            name);
    }
    return 0;
}
