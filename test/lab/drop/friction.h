/* SPDX-License-Identifier: MIT */
/* exhand-lab drop --friction N: the stability border against the friction of the string.
 *
 * At each rate both gains are raised together, along the ray through the paper's point, until falls
 * no longer come to rest. N amounts of friction are tried, from none to twice the device's. Each
 * amount is tried for the whole friction, for its dry part alone, and for its viscous part alone.
 */
#ifndef CLI_FRICTION_H
#define CLI_FRICTION_H

#include "lab/drop/study.h"

#define FRICTION_POINTS_MAX 65

/* A table on stdout; friction.csv and friction.gp in o->dir, which must be given. The
 * exit status. */
int friction_run(const struct sweep_opt *o, int points);

#endif
