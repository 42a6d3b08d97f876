/* SPDX-License-Identifier: MIT */
/* The loop: waits, reads, ticks, writes, logs. It is the same for all scenes and ports. */
#ifndef EXHAND_RUN_LOOP_H
#define EXHAND_RUN_LOOP_H

#include "exhand/run/scene.h"

/* Hooks of the loop; each may be NULL. Only `before` may set in->command. It may also stage
 * parameters, which are applied directly after it. A hook that logs must be its last part, since
 * later changes are not recorded. */
struct exh_loop_hooks {
    void (*start)(const struct exh_scene *sc, struct exh_scene_board board);
    void (*before)(uint32_t tick, struct exh_scene_in *in);
    void (*after)(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out);
};

/* Runs the scene until the board stops it, then makes the outputs safe. rate_Hz 0: the scene's
 * rate. Returns 0 or the error of board or scene. -EXH_E_VERSION: a board of another version.
 * -EXH_E_ABSENT: too few fingers, or no glove for a scene that reads one. After a card failure, the
 * scene gets one more tick with EXH_DIN_CARDS open; its outputs are not written. */
int exh_loop(const struct exh_scene *sc, uint32_t rate_Hz, const struct exh_loop_hooks *hooks);

#endif
