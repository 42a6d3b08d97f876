/* SPDX-License-Identifier: MIT */
/* The experiments that run closed-loop: which device, hand and parameters. */
#ifndef HIL_SETUP_H
#define HIL_SETUP_H

#include "ref.h"

/* The scene of an image by its descriptor's symbol, "exh_scene_drop": 0, or -1: not one of them. */
int setup_for(struct ref_cfg *c, const char *symbol, uint64_t seed, uint32_t ticks);

#endif
