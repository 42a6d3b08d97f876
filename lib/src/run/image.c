/* SPDX-License-Identifier: MIT */
/* main() of a firmware image with one scene, which the build names. The dead-man switch controls
 * it. A port with options or a log brings its own main, PORT_MAIN in its port.mk. */
#include "exhand/run/deadman.h"
#include "exhand/run/loop.h"

#include "exhand/board.h"
#include "exhand/error.h"

extern const struct exh_scene EXH_SCENE;

int main(void)
{
    static const struct exh_loop_hooks hooks = {
        .start = exh_deadman_start, .before = exh_deadman_before};
    int err;
    if (EXH_SCENE.defaults) { EXH_SCENE.defaults(); }
#ifdef UNCALIBRATED
    /* Built with make UNCALIBRATED=1: the image has no options and no calibration. */
    if (EXH_SCENE.calib) { (void)exh_params_stage(EXH_SCENE.params, 0x8903, 0, 1); }
#endif
    err = exh_loop(&EXH_SCENE, 0, &hooks);
    exh_board_halt(err < 0 ? exh_error_text(err) : "done");
    return 0;
}
