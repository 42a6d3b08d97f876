/* SPDX-License-Identifier: MIT */
/* Common part of adapters to controllers in floats: converts raw values to numbers and back. */
#ifndef EXAMPLES_CUSTOM_SLOT_REAL_H
#define EXAMPLES_CUSTOM_SLOT_REAL_H

#include "slot.h"

/* Call it at init: n wires, tick 0. */
void real_wire(const struct slot_wire *wire, unsigned n, struct exh_period T);

/* Input i in the unit of its row. Exact, since 31 bits fit a double. */
double real_in(unsigned i);
/* The period and the time of this tick since init, s; each within half a unit in the last place. */
double real_T_s(void);
double real_t_s(void);
/* A force in N for the slot, rounded to half an LSB (0.5 uN), saturated at +-2048 N. SLOT_NONE for
 * infinite or not a number. Ends the tick. */
int32_t real_out(double force_N);
/* SLOT_NONE. Ends the tick. */
int32_t real_none(void);

#endif
