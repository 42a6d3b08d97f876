/* SPDX-License-Identifier: MIT */
/* What every adapter to a controller in floats needs: raw values to numbers and back. */
#ifndef EXAMPLES_CUSTOM_SLOT_REAL_H
#define EXAMPLES_CUSTOM_SLOT_REAL_H

#include "slot.h"

/* At init: n wires, tick 0. */
void real_wire(const struct slot_wire *wire, unsigned n, struct exh_period T);

/* Input i in its row's unit: exact, as 31 bits fit a double. */
double real_in(unsigned i);
/* The period and the time of this tick since init, s, each within half a unit of its last place. */
double real_T_s(void);
double real_t_s(void);
/* A force of N for the slot, rounded to half an LSB (0.5 uN), saturating beyond +-2048 N; none for
 * what is not a number or infinite. The tick is over. */
int32_t real_out(double force_N);
/* No answer. The tick is over, too. */
int32_t real_none(void);

#endif
