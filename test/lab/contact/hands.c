/* SPDX-License-Identifier: MIT */
#include "lab/contact/hands.h"

#define PRESS_N 4.5

void lab_hand(struct bilateral_run_cfg *c, int i, double at[3])
{
    static const double mass_kg[] = {0.02, 0.05, 0.1, 0.2}, hand_Npm[] = {150, 300, 600, 1200},
                        hand_Nspm[] = {2, 5, 10, 20, 40};
    const double is[3] = {mass_kg[i / 20], hand_Npm[i / 5 % 4], hand_Nspm[i % 5]};
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        c->board.exo.finger[f].mass_kg = is[0];
        c->board.exo.finger[f].k_Npm = is[1];
        c->board.exo.finger[f].b_Nspm = is[2];
        c->board.exo.path[f].push_m = PRESS_N / is[1];
    }
    for (int k = 0; at && k < 3; k++) { at[k] = is[k]; }
}
