/* SPDX-License-Identifier: MIT */
/* Built without SDL2 and OpenGL. */
#include "picture.h"

#include <stdio.h>

struct picture *picture_open(const struct picture_want *want, char *error, size_t error_B)
{
    (void)want;
    snprintf(error, error_B,
        "pictures need SDL2 and OpenGL, which were missing when this program was "
        "built: install libsdl2-dev libsdl2-ttf-dev libgl-dev libegl-dev "
        "libgl1-mesa-dri libpng-dev fonts-dejavu-core and run `make world` again, "
        "or use --headless without --png and --video");
    return NULL;
}

void picture_close(struct picture *p) { (void)p; }

void picture_paint(struct picture *p, const struct draw_list *list) { (void)p, (void)list; }

void picture_show(struct picture *p) { (void)p; }

void picture_wait(struct picture *p) { (void)p; }

int picture_save(
    struct picture *p, const struct draw_list *list, const char *option, const char *path)
{
    (void)p, (void)list, (void)option, (void)path;
    return 1; /* there is no picture to be saved: picture_open() said why */
}

int picture_key(struct picture *p, struct picture_drag *drag)
{
    (void)p, (void)drag;
    return 0;
}
