/* SPDX-License-Identifier: MIT */
#include "base/scenes.h"

#include <stddef.h>
#include <string.h>

#define NAME_B 16 /* a log's name of its scene has no end if it is as long */

const struct exh_scene *const cli_scenes[CLI_SCENES] = {&exh_scene_drop, &exh_scene_guarded,
    &exh_scene_bilateral, &exh_scene_glove, &exh_scene_calibrate, &exh_scene_bringup,
    &exh_scene_identify};

const struct exh_scene *cli_scene_find(const char *name)
{
    for (size_t i = 0; i < CLI_SCENES; i++) {
        if (strncmp(cli_scenes[i]->name, name, NAME_B) == 0) { return cli_scenes[i]; }
    }
    return cli_scene_more && strncmp(cli_scene_more->name, name, NAME_B) == 0 ? cli_scene_more
                                                                              : NULL;
}
