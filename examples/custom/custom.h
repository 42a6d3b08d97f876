/* SPDX-License-Identifier: MIT */
/* The drop scene with a controller of your own instead of the wall. It requests a force, which
 * passes the same limits and checks as that of drop's law. */
#ifndef EXAMPLES_CUSTOM_H
#define EXAMPLES_CUSTOM_H

#include "../drop/drop.h"
#include "slot.h"

/* Inputs that a slot may name in addition to the scene's parameters. */
#define CUSTOM_INPUT_ROWS 5
extern const struct exh_signal custom_input_rows[CUSTOM_INPUT_ROWS];

struct custom_inputs {
    int32_t q_m_q30;    /* string length pulled out */
    int32_t qd_mps_q27; /* its velocity */
    int32_t d_m_q30;    /* q - q_lim: positive inside the wall */
    int32_t c;          /* 1: the contact condition applies, with its hysteresis */
    int32_t on;         /* 1: the request takes effect; else it is ignored */
};

struct custom_signals {
    struct drop_signals drop;
    int32_t ask_N_q20; /* answer of the controller, or SLOT_NONE */
};

struct custom {
    struct drop drop;
    uint8_t dumb; /* 1: no answer in the last tick */
};

/* The input for which set-up refused the slot with -EXH_E_UNKNOWN; else NULL. */
const char *custom_unknown(void);

extern const struct exh_scene exh_scene_custom;

#endif
