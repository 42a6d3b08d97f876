/* SPDX-License-Identifier: MIT */
/* Freeze: writes down as C what a scene's set-up made, for the compiler that makes the image
 * (frozen.h).
 *
 * A scene that can be frozen has a file freeze.c, which includes it and lists what its set-up
 * fills; examples/minimal is one. freeze.c beside this header is the program; it has the tables of
 * the structures that scenes so far need: one for another module is a row for each field. What -D
 * of CFLAGS or SCENE_CFLAGS defines does not reach it: parameters stand in the scene's source, not
 * on the command line.
 */
#ifndef EXAMPLES_FREEZE_H
#define EXAMPLES_FREEZE_H

#include "exhand/run/scene.h"

struct freeze_type;
extern const struct freeze_type freeze_knot, freeze_quad, freeze_velocity_window, freeze_drive,
    freeze_track, freeze_safety;

/* One object or array that set-up fills, and that the tick only reads. */
struct freeze {
    const struct freeze_type *type;
    const char *name; /* in the scene's source */
    const void *of;
    unsigned n;          /* of an array, or 1 */
    const char *text[3]; /* of fields that point somewhere: what, in their order */
};

/* The scene's own. */
extern const struct exh_scene *const freeze_scene;
extern const struct freeze freeze_list[]; /* ends with a type of NULL */

#endif
