/* SPDX-License-Identifier: MIT */
/* What is to be seen, as a list: made from a world and one exchange without any graphics, so that a
 * test can read it; gl.c paints it. */
#ifndef WORLD_DRAW_H
#define WORLD_DRAW_H

#include "world.h"

#include <stdio.h>

#define DRAW_BAR_M_PER_N 0.006 /* height of a force bar */

enum draw_kind {
    DRAW_SQUARE,  /* z = 0, half edge size.x: a plane's piece, with a grid */
    DRAW_SPHERE,  /* radius size.x */
    DRAW_BOX,     /* half edges size */
    DRAW_CAPSULE, /* along z; radius size.x, half length size.z */
    DRAW_MESH,    /* mesh */
    DRAW_DISC     /* z = 0, radius size.x */
};

enum draw_what { DRAW_OBJECT, DRAW_HAND, DRAW_PLANE, DRAW_WAY, DRAW_BAR, DRAW_BAR_SCALE };

struct draw_item {
    enum draw_kind kind;
    enum draw_what what;
    int which;      /* object or finger */
    struct pose at; /* in {W} */
    struct v3 size;
    int still;       /* neither it nor its colour ever changes */
    int hidden;      /* CAPSULE: ends that are within other bodies: 0, 1 (that at -z), 2 */
    float colour[4]; /* red, green, blue, opacity */
    const struct mesh *mesh;
};

/* On the screen, in pixels from the left upper corner; negative: from the right or lower edge. */
struct draw_text {
    int x, y;
    int large, right; /* right: x is where it ends */
    float colour[4];
    char text[100];
};
struct draw_rect {
    int x, y, w, h;
    int panel; /* all texts and other rectangles lie on one */
    float colour[4];
};

struct draw_list {
    struct draw_item *item;
    int items, room;
    struct draw_text text[64];
    struct draw_rect rect[32];
    int texts, rects;
    struct v3 eye, look;
    int lost; /* items there was no memory for */
};

/* One exchange and its surroundings. */
struct draw_moment {
    double t_s;
    struct pose hand; /* {R} in {W} */
    struct exh_wire_state in;
    struct exh_wire_planes out;
    int linked;     /* a controller answers; otherwise the hand is the world's own */
    double age_ms;  /* of in */
    double trip_ms; /* newest exchange, below 0: unknown */
    double fps, picture_fps;
    unsigned long lost, skipped; /* packets; pictures */
    int paused, help;
    struct v3 eye, look;
};

/* Fills the list, whose arrays it keeps from call to call; all zeros at first. */
void world_draw(const struct world *w, const struct draw_moment *m, struct draw_list *list);
void draw_free(struct draw_list *list);

/* One line a thing: `text X Y WORDS`, or `item KIND WHAT WHICH X Y Z` by the numbers above, in
 * metres. */
void draw_write(FILE *to, const struct draw_list *list);

/* Parts of world_draw(). */
struct draw_item *draw_add(
    struct draw_list *list, enum draw_kind kind, enum draw_what what, int which);
void draw_hand(const struct world *w, const struct draw_moment *m, struct draw_list *list);
void draw_numbers(const struct world *w, const struct draw_moment *m, struct draw_list *list);

#endif
