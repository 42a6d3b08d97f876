/* SPDX-License-Identifier: MIT */
/* Parts of the scene reader: struct reading goes from statement to statement. */
#ifndef WORLD_SCENE_PART_H
#define WORLD_SCENE_PART_H

#include "scene_text.h"
#include "tokens.h"

#define SCENE_FAR_M 100.0

struct reading {
    struct scene *s;
    struct tokens w;
};

/* Makes room for one more of size_B in an array of n; doubles at powers of two. NULL: no memory. */
void *scene_room(void *array, int n, size_t size_B);

/* The name of what the statement is about; 0 or 1. */
int scene_named(struct reading *r, char to[SCENE_NAME_B]);

struct scene_object *scene_object_of(const struct scene *s, const char *name); /* or NULL */
int scene_material_of(const struct scene *s, const char *name);                /* or -1 */

static inline void to_v3(struct v3 *v, const double c[3]) { *v = v3(c[0], c[1], c[2]); }

/* One statement each; 0, or 1 with the error said. */
int scene_take_plane(struct reading *r);
int scene_take_sphere(struct reading *r);
int scene_take_box(struct reading *r);
int scene_take_capsule(struct reading *r);
int scene_take_mesh(struct reading *r);
int scene_take_motion(struct reading *r);
int scene_take_key(struct reading *r);

/* When all is read. */
int scene_check_keys(struct reading *r, const struct motion *m, const char *name);

#endif
