/* SPDX-License-Identifier: MIT */
/* Still: a mass at rest to the last bit, until the D/A output changes. No estimate is involved.
 * Speeds are 0 and friction holds both ends, with a margin of 1e-9 N, so no step of any length
 * moves them. Current and monitor are so close to the reference that the longest possible step
 * rounds to their present values. A shorter step rounds to a value between that and the present
 * one. */
#ifndef SIM_STILL_H
#define SIM_STILL_H

#include "mass.h"

/* Whether a fall's mass does, by steps of longest_s at most. */
int sim_mass_still(const struct sim_mass *m, double longest_s);

/* Up to and at until_s, of one that does: what sim_mass_advance() would leave. 0: the fall ends
 * before, and nothing is done. */
int sim_mass_pass(struct sim_mass *m, double until_s);

/* Whether its monitor shows nothing below *low_raw nor above *high_raw then, whatever the noise. */
void sim_mass_monitor(const struct sim_mass *m, int16_t *low_raw, int16_t *high_raw);

#endif
