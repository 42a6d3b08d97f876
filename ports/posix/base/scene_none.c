/* SPDX-License-Identifier: MIT */
#include "base/scenes.h"

#include <stddef.h>

const struct exh_scene *const cli_scene_more = NULL;

const char *cli_scene_more_unknown(void) { return NULL; }

uint32_t cli_scene_more_rate_Hz(void) { return 0; }
