/* SPDX-License-Identifier: MIT */
/* The loop: waits, reads, ticks, writes, logs. It exists once. */
#ifndef EXHAND_RUN_LOOP_H
#define EXHAND_RUN_LOOP_H

#include "exhand/run/scene.h"

/* What may hang on to the loop; each may be NULL. `before` may set in->command (the
 * loop itself commands nothing) and stage parameters, which are applied right after
 * it. A hook that logs comes last in it: what is staged later is not on record. */
struct exh_loop_hooks {
    void (*start)(const struct exh_scene *sc, struct exh_scene_board board);
    void (*before)(uint32_t tick, struct exh_scene_in *in);
    void (*after)(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out);
};

/* Runs the scene until the board says stop, then makes it safe. 0, or the -EXH_E… of
 * board or scene: -EXH_E_VERSION for a board of another version, -EXH_E_ABSENT for
 * one with fewer fingers than the scene's, or without the glove that the scene reads. After a card
 * that failed the scene has one more tick, with EXH_DIN_CARDS open, whose outputs go nowhere.
 * rate_Hz 0: the scene's. */
int exh_loop(const struct exh_scene *sc, uint32_t rate_Hz, const struct exh_loop_hooks *hooks);

#endif
