/* SPDX-License-Identifier: MIT */
/* main() of an image: banner, options, dry ticks, the loop with its hooks. */
#include "pc104.h"

#include "exhand/run/deadman.h"
#include "exhand/run/loop.h"

#include "exhand/error.h"
#include "exhand/exhand.h"

extern const struct exh_scene EXH_SCENE;

static void say_version(const char *what, uint32_t version)
{
    pc104_say(what);
    pc104_say_u32(version);
}

static void banner(const struct exh_scene *sc)
{
    say_version("exhand ", EXH_VERSION_MAJOR);
    say_version(".", EXH_VERSION_MINOR);
    say_version(".", EXH_VERSION_PATCH);
    say_version(", wire ", EXH_WIRE_VERSION);
    say_version(", record ", EXH_RECORD_VERSION);
    say_version(", board pc104 version ", exh_board_info.version);
    pc104_say(", scene ");
    pc104_say(sc->name);
    say_version("\nfingers ", sc->fingers);
    pc104_say(sc->read_glove ? ", glove\n" : ", no glove\n");
}

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    exh_deadman_start(sc, board);
    pc104_scene_start(sc, board);
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    exh_deadman_before(tick, in);
    pc104_scene_before(tick, in);
}

/* Reports an implausible ratio of force and current. */
static void say_far(const struct exh_scene_calib *k)
{
    say_version(", finger ", k->finger);
    say_version(", point ", k->point_at + 1u);
    pc104_say(": ");
    pc104_say_fixed(k->ratio_NpA_q20, EXH_Q_FORCE);
    pc104_say(" N/A (allowed ");
    pc104_say_fixed(k->expected_NpA_q20, EXH_Q_FORCE + 1);
    pc104_say(" to ");
    pc104_say_fixed(3 * (int64_t)k->expected_NpA_q20, EXH_Q_FORCE + 1);
    pc104_say("): refused\n"
              "calibrate again, or correct kf; far_calibration=1 believes it\n");
}

/* Which module set-up did not take, and what of it: an option that is refused. */
static void say_refused(const struct exh_scene_calib *k)
{
    if (k == NULL || k->refused == 0) { return; }
    pc104_exit_code = PC104_EXIT_OPTION;
    say_version("calibration ", k->image_at + 1u);
    pc104_say(": ");
    pc104_say(k->what);
    if (k->expected_NpA_q20) {
        say_far(k);
        return;
    }
    if (k->point_at) { say_version(", point ", k->point_at + 1u); }
    pc104_say(": refused\n");
}

int main(void)
{
    static const struct exh_loop_hooks hooks = {start, before, pc104_scene_after};
    const struct exh_scene *sc = &EXH_SCENE;
    int err;

    banner(sc);
    pc104_fpu_open();
    if (sc->defaults) { sc->defaults(); }
    pc104_options(sc);
    pc104_board_for(sc);
    err = pc104_board_clock();
    if (err == 0) {
        pc104_board_still();
        pc104_link_open(sc); /* may wait for seconds */
        pc104_scene_ready(sc);
        pc104_load_scene(sc);
        err = exh_loop(sc, (uint32_t)pc104_par.rate_Hz, &hooks);
        pc104_load_stop();
        if (err < 0) { say_refused(sc->calib); }
    }
    pc104_restart_end(); /* also after a card failure, which was reported and is no crash */
    pc104_scene_end();
    exh_board_halt(err < 0 ? exh_error_text(err) : "done");
    return 0;
}
