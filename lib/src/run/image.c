/* SPDX-License-Identifier: MIT */
/* main() of a firmware image: one scene, named by the build, run by the dead-man switch. A port
 * that has more to offer (options, a log) brings its own, PORT_MAIN in its port.mk. */
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
    /* A build that says so (make UNCALIBRATED=1): no option can, and there is no calibration. */
    if (EXH_SCENE.calib) { (void)exh_params_stage(EXH_SCENE.params, 0x8903, 0, 1); }
#endif
    err = exh_loop(&EXH_SCENE, 0, &hooks);
    exh_board_halt(err < 0 ? exh_error_text(err) : "done");
    return 0;
}
