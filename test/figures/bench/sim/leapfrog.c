/* SPDX-License-Identifier: MIT */
/* The simulator's own source, under another name: what is compared is what is shipped. Its name is
 * then ours to give, so that a whole simulator can be linked with another method (statistics.c). */
#define plant_advance            leapfrog_own_advance
#define plant_advance_hand       leapfrog_own_advance_hand
#define plant_advance_piece      leapfrog_own_advance_piece
#define plant_advance_hand_piece leapfrog_own_advance_hand_piece
#include "../../../../ports/posix/sim/plant.c"

#include "method.h"

void leapfrog_advance(struct plant *p, const struct sim_device *d, double dt_s, double ref_A,
    const struct plant_hand *hand)
{
    if (hand) {
        leapfrog_own_advance_hand(p, d, dt_s, ref_A, hand);
    } else {
        leapfrog_own_advance(p, d, dt_s, ref_A, 0);
    }
}

void leapfrog_hold(struct plant *p, const struct sim_device *d, double dt_s, double ref_A)
{
    leapfrog_own_advance(p, d, dt_s, ref_A, 1);
}
