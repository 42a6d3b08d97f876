/* SPDX-License-Identifier: MIT */
/* The scenes of this program, by their descriptors alone. A source that needs a scene's own
 * parameters or signals includes its header. */
#ifndef CLI_SCENES_H
#define CLI_SCENES_H

#include "exhand/run/scene.h"

#include <stdint.h>

extern const struct exh_scene exh_scene_drop, exh_scene_guarded, exh_scene_bilateral,
    exh_scene_glove, exh_scene_calibrate, exh_scene_bringup, exh_scene_identify;

/* All of these, in that order. */
#define CLI_SCENES 7
extern const struct exh_scene *const cli_scenes[CLI_SCENES];

/* One of them, or cli_scene_more; NULL: none has this name. */
const struct exh_scene *cli_scene_find(const char *name);

/* A scene that not every program has (scene_custom.c, scene_none.c): custom with the model it was
 * linked with, or NULL. */
extern const struct exh_scene *const cli_scene_more;
/* Why its set-up said -EXH_E_UNKNOWN: the input that it does not know; or NULL. */
const char *cli_scene_more_unknown(void);
/* The only rate that its controller may run at, Hz; 0: any. */
uint32_t cli_scene_more_rate_Hz(void);

#endif
