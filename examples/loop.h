/* The loop: waits, reads, ticks, writes, logs. It exists once. */
#ifndef EXAMPLES_LOOP_H
#define EXAMPLES_LOOP_H

#include "scene.h"

/* What may hang on to the loop; each may be NULL. `before` may change in->command
 * and stage parameters; they are applied right after it, before the tick. */
struct exh_loop_hooks {
    void (*start)(const struct exh_scene *sc, struct exh_period T);
    void (*before)(uint32_t tick, struct exh_scene_in *in);
    void (*after)(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out);
};

/* Runs the scene until the board says stop, then makes it safe. Commands RUN at
 * the first tick. 0, or the -EXH_E… of board or scene. rate_Hz 0: the scene's. */
int exh_loop(const struct exh_scene *sc, uint32_t rate_Hz, const struct exh_loop_hooks *hooks);

#endif
