/* SPDX-License-Identifier: MIT */
/* exhand-lab drop --border-check: does the simulation have the linear test's border if it contains
 * only what that test models? What does each further effect do to the border?
 *
 * The test models a taut string and small movements. So the mass is released on the wall, a fifth
 * of the penetration above where it would rest: no fall, no slack string, no force at its limits.
 * Dry friction, saturation, quantisation and the pull-back force are off. An encoder of 1 um is the
 * finest the scene takes. The controller is the scene itself, in integers. */
#ifndef CLI_BORDER_H
#define CLI_BORDER_H

#include "lab/drop/study.h"

/* Both tables on stdout, and DIR/check.csv with --out. o->columns and o->rows are of the check's
 * own grid over each rate's linear border. Returns 0 on success. 1: fewer than 99 % agree outside
 * |rho - 1| < 0.005, or a run failed. 2: a rate has no linear border, or its grid is beyond what
 * the scene takes. 130: interrupted. */
int border_check(const struct sweep_opt *o);

#endif
