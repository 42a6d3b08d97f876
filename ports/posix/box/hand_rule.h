/* SPDX-License-Identifier: MIT */
/* What the bilateral scene's rule of gains refused at set-up, in words. */
#ifndef BOX_HAND_RULE_H
#define BOX_HAND_RULE_H

#include <stdint.h>

/* Behind a set-up that ended with err: 1 if it was a material, which is told then; else 0. */
int hand_rule_complain(uint32_t rate_Hz, int err);

#endif
