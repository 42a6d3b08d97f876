/* SPDX-License-Identifier: MIT */
/* exhand-lab drop --border-check: does the simulation have the border of the linear test
 * when nothing is in it but what that test knows, and what does each thing more do to it.
 *
 * The test knows a taut string and small movements. So the mass hangs on the wall, held a
 * fifth of the penetration above where it would rest, and is let go: no fall, no slack
 * string, no force at its limits. Dry friction, saturation, steps and the pull-back force
 * are off; what is off of steps is an encoder of 1 um, the finest the scene takes. The
 * controller is the scene itself, in integers. */
#ifndef CLI_BORDER_H
#define CLI_BORDER_H

#include "lab/drop/study.h"

/* Both tables on stdout, and DIR/check.csv with --out. o->columns and o->rows are of the
 * check's own grid over each rate's linear border. 0, 1 when fewer than 99 % agree outside
 * |rho - 1| < 0.005 or a run failed, 2 when a rate has no linear border or its grid is beyond
 * what the scene takes, 130 interrupted. */
int border_check(const struct sweep_opt *o);

#endif
