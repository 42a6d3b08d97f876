/* SPDX-License-Identifier: MIT */
/* Still: a mass that stands, to the last bit, and will for as long as the D/A output stays as it
 * is.
 *
 * Nothing of it is an estimate. Speeds are 0 and friction holds both ends, with 1e-9 N to spare: no
 * step of any length moves them. Current and monitor have come so close to the reference that the
 * longest step there can be rounds to where they are; a shorter one rounds to something between
 * that and where they are. */
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
