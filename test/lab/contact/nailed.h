/* SPDX-License-Identifier: MIT */
/* Nailed: the same hands before a wall that no controller could better: the string's end is held
 * fast, without delay, count or limit, where the wall is. What then does not settle is the finger
 * on its string. */
#ifndef LAB_CONTACT_NAILED_H
#define LAB_CONTACT_NAILED_H

#include "box/hand.h"

/* Of each approach of the index how long the string's tension takes to stay within 5 % of what it
 * is at the end of the hold, s; < 0: never. At most cap; how many. */
int nailed_settle(const struct bilateral_run_cfg *c, double *settle_s, int cap);

#endif
