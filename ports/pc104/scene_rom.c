/* SPDX-License-Identifier: MIT */
/* A scene of constants, without records: SCENE_ROM in its scene.mk. */
#include "pc104.h"

int pc104_scene_option(const struct exh_scene *sc, const char *name, const char *value)
{
    (void)sc;
    (void)name;
    (void)value;
    return 0;
}

void pc104_scene_check(const struct exh_scene *sc) { (void)sc; }

void pc104_scene_ready(const struct exh_scene *sc) { (void)sc; }

void pc104_scene_dry(const struct exh_scene *sc, uint32_t tick, const struct exh_scene_in *in,
    const struct exh_drive_out *out)
{
    (void)sc;
    (void)tick;
    (void)in;
    (void)out;
}

void pc104_scene_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    (void)board;
    if (pc104_par.log != PC104_LOG_OFF || pc104_par.dump != PC104_LOG_OFF) {
        pc104_halt(PC104_EXIT_OPTION, "options log and dump: this scene has no records");
    }
}

void pc104_scene_before(uint32_t tick, struct exh_scene_in *in)
{
    (void)tick;
    (void)in;
}

void pc104_scene_after(
    uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    (void)tick;
    (void)in;
    (void)out;
}

void pc104_scene_end(void) {}

int pc104_idle(void) { return 0; }

int pc104_log_take(const void *rec, size_t len_B)
{
    (void)rec;
    (void)len_B;
    return 0;
}

void pc104_log_flush(void) {}

void pc104_dump_flush(int halted) { (void)halted; }
