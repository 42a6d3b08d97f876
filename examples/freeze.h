/* SPDX-License-Identifier: MIT */
/* Freeze: writes the results of a scene's set-up as C source for the compiler of the image
 * (frozen.h).
 *
 * A scene that can be frozen has a file freeze.c, which includes it and lists the results of its
 * set-up; examples/minimal is one. freeze.c beside this header is the program. It contains tables
 * of the structures that scenes need so far; another module needs a row per field. Definitions by
 * -D in CFLAGS or SCENE_CFLAGS do not reach it, so parameters must be in the scene's source. */
#ifndef EXAMPLES_FREEZE_H
#define EXAMPLES_FREEZE_H

#include "exhand/run/scene.h"

struct freeze_type;
extern const struct freeze_type freeze_knot, freeze_quad, freeze_velocity_window, freeze_drive,
    freeze_track, freeze_safety;

/* One object or array that set-up fills and the tick only reads. */
struct freeze {
    const struct freeze_type *type;
    const char *name; /* its name in the scene's source */
    const void *of;
    unsigned n;          /* length of an array, or 1 */
    const char *text[3]; /* text of the pointer fields, in their order */
};

/* The scene's own list. */
extern const struct exh_scene *const freeze_scene;
extern const struct freeze freeze_list[]; /* ends with a type of NULL */

#endif
