/* SPDX-License-Identifier: MIT */
/* A hand for a world without a controller: fingers bend towards where keys or a script want them,
 * and stop at what they touch. Its forces are an illustration: they grow with how much further
 * the finger wants. */
#ifndef WORLD_SOLO_H
#define WORLD_SOLO_H

#include "world.h"

struct solo {
    double want[FINGERS], bend[FINGERS]; /* 0 straight .. 1 bent */
    int armed[FINGERS];                  /* the plane was seen from before it */
};

/* Towards where the script has the fingers at t_s: closing one after the other, pressing,
 * opening, over and over. */
void solo_script(struct solo *s, double t_s);

/* dt_s later; last: the planes of the frame before. Fills out as a controller would. */
void solo_step(struct solo *s, const struct world *w, const struct exh_wire_planes *last,
    double dt_s, struct exh_wire_state *out);

#endif
