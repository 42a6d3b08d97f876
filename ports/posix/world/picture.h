/* SPDX-License-Identifier: MIT */
/* A window (or, headless, none) that a draw list is painted in: SDL2 and OpenGL 2.1. Built without
 * them, picture_open() says which packages are missing, and all else goes on. */
#ifndef WORLD_PICTURE_H
#define WORLD_PICTURE_H

#include "draw.h"

#include <stddef.h>

struct picture;

struct picture_want {
    const char *title;
    int width, height;
    int headless;
    int samples; /* per pixel, against jagged edges; 0 or 1: one */
};

/* NULL with the reason, and what to do, in error. */
struct picture *picture_open(const struct picture_want *want, char *error, size_t error_B);
void picture_close(struct picture *p);

/* Paints; it is seen after picture_show(). The numbers may be those of 50 ms ago. */
void picture_paint(struct picture *p, const struct draw_list *list);
void picture_show(struct picture *p);
void picture_wait(struct picture *p); /* until it is painted, for measuring */

/* Paints, all numbers of now, and writes as PNG what an option asks for; 0, or 1 after a line on
 * stderr. */
int picture_save(
    struct picture *p, const struct draw_list *list, const char *option, const char *path);

/* What was pressed since the last call: keys as their characters, arrows as below; 0: nothing
 * more. Turning and zooming by mouse is added to the view. */
enum { KEY_LEFT = 256, KEY_RIGHT, KEY_UP, KEY_DOWN, KEY_QUIT, KEY_SHIFT = 1024 };
struct picture_drag {
    double turn, tilt, nearer;
};
int picture_key(struct picture *p, struct picture_drag *drag);

#endif
