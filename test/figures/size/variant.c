/* SPDX-License-Identifier: MIT */
/* main() of an image that costs.py compares with itself: with or without a log, and with the
 * fingers of a mask. Unlike lib/src/run/image.c, it passes no calibration to a scene that needs
 * one.
 *     -DVARIANT_LOG         lib/src/run/log.c, to the board's log
 *     -DVARIANT_FINGERS=n   mask: fingers in use, of a scene that asks */
#include "exhand/run/deadman.h"
#include "exhand/run/log.h"
#include "exhand/run/loop.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/exhand.h"

#define FINGERS_ID      0x8610 /* examples/bilateral */
#define UNCALIBRATED_ID 0x8903 /* lib/src/run/calib_set */

extern const struct exh_scene EXH_SCENE;

#ifdef VARIANT_LOG
static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    exh_deadman_start(sc, board);
    exh_log_start(sc, board);
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    exh_deadman_before(tick, in);
    exh_log_before(tick, in);
}

static const struct exh_loop_hooks hooks = {
    .start = start, .before = before, .after = exh_log_after};
#else
static const struct exh_loop_hooks hooks = {
    .start = exh_deadman_start, .before = exh_deadman_before};
#endif

int main(void)
{
    int err;
    if (EXH_SCENE.defaults) { EXH_SCENE.defaults(); }
    if (EXH_SCENE.params) {
        (void)exh_params_stage(EXH_SCENE.params, UNCALIBRATED_ID, 0, 1);
#ifdef VARIANT_FINGERS
        (void)exh_params_stage(EXH_SCENE.params, FINGERS_ID, 0, VARIANT_FINGERS);
#endif
    }
    err = exh_loop(&EXH_SCENE, 0, &hooks);
    exh_board_halt(err < 0 ? exh_error_text(err) : "done");
    return 0;
}
