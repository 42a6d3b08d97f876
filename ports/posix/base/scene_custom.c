/* SPDX-License-Identifier: MIT */
#include "base/scenes.h"

#include "custom/custom.h"

const struct exh_scene *const cli_scene_more = &exh_scene_custom;

const char *cli_scene_more_unknown(void) { return custom_unknown(); }

uint32_t cli_scene_more_rate_Hz(void) { return slot.rate_Hz; }
