/* SPDX-License-Identifier: MIT */
/* A scene that not every host program has. */
#ifndef CLI_SCENE_MORE_H
#define CLI_SCENE_MORE_H

#include "exhand/run/scene.h"

#include <stdint.h>

/* Scene custom with the model it was linked with, or NULL. */
extern const struct exh_scene *const cli_scene_more;
/* Why its set-up said -EXH_E_UNKNOWN: the input that it does not know; or NULL. */
const char *cli_scene_more_unknown(void);
/* The only rate that its controller may run at, Hz; 0: any. */
uint32_t cli_scene_more_rate_Hz(void);

#endif
