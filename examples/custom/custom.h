/* SPDX-License-Identifier: MIT */
/* Drop, with a controller of your own in the place of the wall: it asks for a force, and all that
 * stands behind drop's law stands behind it. */
#ifndef EXAMPLES_CUSTOM_H
#define EXAMPLES_CUSTOM_H

#include "../drop/drop.h"
#include "slot.h"

/* What a slot may name beside the scene's parameters. */
#define CUSTOM_INPUT_ROWS 5
extern const struct exh_signal custom_input_rows[CUSTOM_INPUT_ROWS];

struct custom_inputs {
    int32_t q_m_q30;    /* string pulled out */
    int32_t qd_mps_q27; /* its velocity */
    int32_t d_m_q30;    /* q - q_lim: into the wall is positive */
    int32_t c;          /* 1: the contact condition applies, with its hysteresis */
    int32_t on;         /* 1: what is asked for goes out; else it comes to nothing */
};

struct custom_signals {
    struct drop_signals drop;
    int32_t ask_N_q20; /* the controller's answer, SLOT_NONE among them */
};

struct custom {
    struct drop drop;
    uint8_t dumb; /* 1: no answer in the last tick */
};

/* The input at which set-up refused the slot with -EXH_E_UNKNOWN; else NULL. */
const char *custom_unknown(void);

extern const struct exh_scene exh_scene_custom;

#endif
