/* SPDX-License-Identifier: MIT */
#include "scene_part.h"

#include "mesh.h"
#include "rpy.h"

#include "sim/lag.h"

#include "exhand/precontact.h"

#include <stdlib.h>
#include <string.h>

#define GRAZE_DEG 20.0

/* --- statements about the whole --- */

static int take_world(struct reading *r)
{
    size_t at = 0;
    for (int i = 1; i < r->w.n; i++) {
        const size_t len = strlen(r->w.word[i]);
        if (at + len + 2 > sizeof r->s->title) {
            return tokens_complain(&r->w,
                "world: the title has more than %d characters: shorten it",
                (int)sizeof r->s->title - 1);
        }
        if (i > 1) { r->s->title[at++] = ' '; }
        memcpy(r->s->title + at, r->w.word[i], len + 1);
        at += len;
    }
    return 0;
}

static int take_fingers(struct reading *r)
{
    struct tokens *w = &r->w;
    r->s->fingers = 0;
    for (int i = 1; i < w->n; i++) {
        unsigned f = 0;
        while (f < FINGERS && strcmp(w->word[i], finger_name[f]) != 0) { f++; }
        if (f == FINGERS && strcmp(w->word[i], "all") != 0) {
            return tokens_complain(w,
                "fingers: %.30s: no such finger: use thumb index middle ring "
                "little, or all",
                w->word[i]);
        }
        r->s->fingers |= f == FINGERS ? (1u << FINGERS) - 1 : 1u << f;
    }
    return r->s->fingers ? 0 : tokens_complain(w, "fingers: none: name those in use, or all");
}

static int take_look(struct reading *r)
{
    double graze = GRAZE_DEG;
    struct pair p[] = {
        {"ahead", 1, &r->s->look_m, 0.001, 1, 0, 0}, {"graze", 1, &graze, 0, 89, 0, 0}};
    if (tokens_pairs(&r->w, 1, p, 2)) { return 1; }
    r->s->graze = sim_sin(graze * RAD_PER_DEG);
    return 0;
}

static int take_hand(struct reading *r)
{
    double at[3] = {0, 0, 0}, palm[3] = {0, 0, -1}, point[3] = {0, 1, 0};
    struct pair p[] = {{"at", 3, at, -SCENE_FAR_M, SCENE_FAR_M, 1, 0},
        {"palm", 3, palm, -1e3, 1e3, 0, 0}, {"point", 3, point, -1e3, 1e3, 0, 0}};
    struct v3 x, z;
    if (tokens_pairs(&r->w, 1, p, 3)) { return 1; }
    to_v3(&r->s->hand.at, at);
    to_v3(&x, palm);
    to_v3(&z, point);
    return frame_from_z(&r->s->hand.turn, z, x) == 0
               ? 0
               : tokens_complain(&r->w,
                     "hand: palm and point are parallel or zero: the palm looks to "
                     "the side of where the fingers point");
}

static int take_camera(struct reading *r)
{
    double eye[3], look[3];
    struct pair p[] = {{"eye", 3, eye, -SCENE_FAR_M, SCENE_FAR_M, 1, 0},
        {"look", 3, look, -SCENE_FAR_M, SCENE_FAR_M, 1, 0}};
    if (tokens_pairs(&r->w, 1, p, 2)) { return 1; }
    to_v3(&r->s->eye, eye);
    to_v3(&r->s->look, look);
    r->s->eye_set = 1;
    return v3_len(v3_sub(r->s->eye, r->s->look)) > 1e-3
               ? 0
               : tokens_complain(&r->w, "camera: eye and look are the same point: part them");
}

/* The most that a controller takes. */
static double row_max(int i)
{
    return (double)exh_material_rows[i].max / (double)(INT64_C(1) << exh_material_rows[i].frac);
}

static int take_material(struct reading *r)
{
    struct scene *s = r->s;
    struct scene_material m = {.k = 20000, .b = 60, .f_max = 10, .colour = {0.7, 0.7, 0.7}};
    struct pair p[] = {{"k", 1, &m.k, 0, row_max(0), 0, 0}, {"b", 1, &m.b, 0, row_max(1), 0, 0},
        {"fmax", 1, &m.f_max, 0, row_max(2), 0, 0}, {"colour", 3, m.colour, 0, 1, 0, 0}};
    if (scene_named(r, m.name) || tokens_pairs(&r->w, 2, p, 4)) { return 1; }
    if (scene_material_of(s, m.name) >= 0) {
        return tokens_complain(&r->w, "material %s: defined twice: use another name", m.name);
    }
    if (s->materials == SCENE_MATERIALS_MAX) {
        return tokens_complain(
            &r->w, "material %s: more than %d: share some", m.name, SCENE_MATERIALS_MAX);
    }
    s->material = scene_room(s->material, s->materials, sizeof m);
    if (s->material == NULL) { return tokens_complain(&r->w, "no memory"); }
    s->material[s->materials++] = m;
    return 0;
}

static const struct {
    const char *name;
    int (*take)(struct reading *r);
} statement[] = {
    {"world", take_world},
    {"fingers", take_fingers},
    {"look", take_look},
    {"hand", take_hand},
    {"camera", take_camera},
    {"material", take_material},
    {"plane", scene_take_plane},
    {"sphere", scene_take_sphere},
    {"box", scene_take_box},
    {"capsule", scene_take_capsule},
    {"mesh", scene_take_mesh},
    {"motion", scene_take_motion},
    {"key", scene_take_key},
};

static int take_line(struct reading *r, char *text)
{
    struct tokens *w = &r->w;
    if (tokens_part(w, text)) { return 1; }
    if (w->n == 0) { return 0; }
    for (size_t i = 0; i < sizeof statement / sizeof statement[0]; i++) {
        if (strcmp(statement[i].name, w->word[0]) == 0) { return statement[i].take(r); }
    }
    return tokens_complain(w,
        "%.30s: no such statement: use world, fingers, look, hand, camera, material, "
        "plane, sphere, box, capsule, mesh, motion or key",
        w->word[0]);
}

static int take_text(struct reading *r, const char *text)
{
    while (*text) {
        const size_t len = strcspn(text, "\n");
        char line[1024];
        r->w.line++;
        if (len >= sizeof line) {
            return tokens_complain(&r->w,
                "more than %d characters: is this a scene? Shorten the line", (int)sizeof line - 1);
        }
        memcpy(line, text, len);
        line[len] = '\0';
        if (take_line(r, line)) { return 1; }
        text += len + (text[len] == '\n');
    }
    if (scene_check_keys(r, &r->s->motion, "hand")) { return 1; }
    for (int i = 0; i < r->s->objects; i++) {
        if (scene_check_keys(r, &r->s->object[i].motion, r->s->object[i].name)) { return 1; }
    }
    return 0;
}

struct scene *scene_read(const char *name, const char *text, char *error, size_t error_B)
{
    struct reading r = {
        .s = calloc(1, sizeof *r.s), .w = {.file = name, .error = error, .error_B = error_B}};
    error[0] = '\0';
    if (r.s == NULL) {
        tokens_complain(&r.w, "no memory");
        return NULL;
    }
    r.s->fingers = (1u << FINGERS) - 1;
    r.s->look_m = 0.1;
    r.s->graze = sim_sin(GRAZE_DEG * RAD_PER_DEG);
    frame_from_z(&r.s->hand.turn, v3(0, 1, 0), v3(0, 0, -1));
    if (take_text(&r, text)) {
        scene_free(r.s);
        return NULL;
    }
    return r.s;
}

void scene_free(struct scene *s)
{
    if (s == NULL) { return; }
    for (int i = 0; i < s->meshes; i++) { mesh_free(s->mesh[i]); }
    for (int i = 0; i < s->objects; i++) { free(s->object[i].motion.key); }
    free(s->motion.key);
    free(s->mesh);
    free(s->object);
    free(s->material);
    free(s);
}
