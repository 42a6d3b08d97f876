/* SPDX-License-Identifier: MIT */
/* The integer kernels of the paper's controller, one tick of five fingers: 22 low-passes,
 * fingertips, distances to five planes with the freeze rule, contact laws. What no converter or
 * switch is part of. */
#ifndef BENCH_TICK_H
#define BENCH_TICK_H

#include "exhand/exhand.h"

struct tick_box {
    struct exh_filter_cfg filter;
    struct exh_filter channel[EXH_GLOVE_SENSORS];
    struct exh_hand_finger hand[EXH_FINGERS];
    struct exh_precontact_par freeze;
    struct exh_precontact_cfg precontact;
    struct exh_precontact plane[EXH_FINGERS];
    struct exh_contact_par wall;
    struct exh_contact contact[EXH_FINGERS];
    struct exh_force_ledger force[EXH_FINGERS];
};

struct tick_in {
    int32_t angle_turn_q32[EXH_GLOVE_SENSORS]; /* finger f's joints are 3 f .. 3 f + 2 */
    int32_t pos_m_q30[EXH_FINGERS];
    int32_t vel_mps_q27[EXH_FINGERS];
};

int tick_setup(struct tick_box *b);

/* Fingers that bend and stretch over 1024 ticks, one after the other, into planes that they meet
 * half way. */
void tick_input(struct tick_in *in, uint32_t i);

/* Returns something of all that was computed. */
int32_t tick_once(struct tick_box *b, const struct tick_in *in);

#endif
