/* SPDX-License-Identifier: MIT */
/* main() of an image: banner, what flash has kept, the loop with its hooks. */
#include "stm.h"

#include "exhand/run/deadman.h"
#include "exhand/run/loop.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/exhand.h"

#include "scene.h"

extern const struct exh_scene EXH_SCENE;

static void say_version(const char *what, uint32_t version)
{
    stm_say(what);
    stm_say_u32(version);
}

static void banner(const struct exh_scene *sc)
{
    static const char *const clock[] = {"none", "168 MHz by the crystal", "168 MHz by HSI"};
    say_version("exhand ", EXH_VERSION_MAJOR);
    say_version(".", EXH_VERSION_MINOR);
    say_version(".", EXH_VERSION_PATCH);
    say_version(", board stm32f405 version ", exh_board_info.version);
    stm_say(", scene ");
    stm_say(sc->name);
    stm_say("\nclock ");
    stm_say(clock[stm_clock()]);
    stm_say("\n");
}

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    exh_deadman_start(sc, board);
    stm_scene_start(sc, board);
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    exh_deadman_before(tick, in);
    stm_scene_before(tick, in);
}

int main(void)
{
    static const struct exh_loop_hooks hooks = {start, before, stm_scene_after};
    const struct exh_scene *sc = &EXH_SCENE;
    int err;
    banner(sc);
    if (sc->defaults) { sc->defaults(); }
#ifdef UNCALIBRATED
    if (sc->calib) { (void)exh_params_stage(sc->params, 0x8903, 0, 1); }
#endif
    stm_scene_ready(sc);
    stm_watch();
    err = exh_loop(sc, STM_RATE_HZ, &hooks);
    exh_board_safe();
    stm_scene_end(sc);
    exh_board_halt(err < 0 ? exh_error_text(err) : "done");
    return 0;
}
