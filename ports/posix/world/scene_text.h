/* SPDX-License-Identifier: MIT */
/* A scene: the content of a world, read from a text (format: scenes/README.md). */
#ifndef WORLD_SCENE_TEXT_H
#define WORLD_SCENE_TEXT_H

#include "finger.h"
#include "motion.h"
#include "shape.h"

#include <stddef.h>

#define SCENE_NAME_B        32
#define SCENE_MATERIALS_MAX 255
#define SCENE_OBJECTS_MAX   65535

struct scene_material {
    char name[SCENE_NAME_B];
    double k, b, f_max; /* N/m, N s/m, N */
    double colour[3];   /* 0..1 */
};

struct scene_object {
    char name[SCENE_NAME_B];
    struct shape shape;
    int material;
    struct pose stand; /* in {W}, at rest */
    struct motion motion;
    double draw_m; /* PLANE: half the edge of the square that is drawn */
};

struct scene {
    char title[80];
    unsigned fingers;     /* mask: which are in use */
    struct pose hand;     /* {R} in {W}, at rest */
    struct motion motion; /* of the hand */
    double look_m;        /* how far ahead of a pad, and around it */
    double graze;         /* least sine between a pad's way and a far surface */
    struct v3 eye, look;  /* camera */
    int eye_set;
    struct scene_material *material;
    struct scene_object *object;
    struct mesh **mesh;
    int materials, objects, meshes;
};

/* NULL on failure, with "name:line: what: what to do" in error. name: where the text is from;
 * mesh files are looked for in its directory. */
struct scene *scene_read(const char *name, const char *text, char *error, size_t error_B);
void scene_free(struct scene *s);

#endif
