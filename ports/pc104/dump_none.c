/* SPDX-License-Identifier: MIT */
/* A scene without a black box. */
#include "pc104.h"

int pc104_dump_open(void)
{
    if (pc104_par.dump != PC104_LOG_OFF) {
        pc104_halt(PC104_EXIT_OPTION, "option dump: this scene has no black box");
    }
    return 0;
}

void pc104_dump_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    (void)board;
}

void pc104_dump_dry(void) {}

void pc104_dump_before(uint32_t tick, struct exh_scene_in *in)
{
    (void)tick;
    (void)in;
}

void pc104_dump_after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    (void)tick;
    (void)in;
    (void)out;
}

int pc104_dump_idle(void) { return 0; }

void pc104_dump_pause(void) {}

void pc104_dump_flush(int halted) { (void)halted; }
