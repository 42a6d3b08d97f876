/* SPDX-License-Identifier: MIT */
/* What the bilateral scene's rule of gains refused at set-up, in words. */
#ifndef BOX_HAND_RULE_H
#define BOX_HAND_RULE_H

#include <stdint.h>

/* After a failed set-up: 1 if a material caused it, which is then reported; else 0. */
int hand_rule_complain(uint32_t rate_Hz, int err);

#endif
