/* SPDX-License-Identifier: MIT */
/* A scene with parameters and records. */
#include "scene.h"

#include "stm.h"

#include "exhand/run/log_later.h"

#include "exhand/board.h"
#include "exhand/exhand.h"

static const struct exh_scene *scene;
static uint32_t last_tick;
static uint8_t begun;

/* What a keyframe takes: the full box has 3.6 KiB of state and 3.8 of parameters. */
static uint8_t record[EXH_LOG_RECORD_B], held[16384]; /* frames of the ticks of a keyframe */
static uint64_t copy[1024];

static void idle(void)
{
    stm_log_out();
    if (scene->link) { stm_link_out(); }
}

void stm_scene_ready(const struct exh_scene *sc)
{
    scene = sc;
    stm_slot_write();
    stm_slot_load(sc);
    exh_params_apply(sc->params);
    stm_modbus_open(sc);
    stm_idle = idle;
}

void stm_scene_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    begun = 1;
    static const struct exh_log_later memory = {
        record, (uint8_t *)copy, held, sizeof copy, sizeof held};
    stm_modbus_start(board);
    exh_log_later(&memory);
    exh_log_start(sc, board);
}

void stm_scene_before(uint32_t tick, struct exh_scene_in *in)
{
    const uint8_t command = stm_modbus_command();
    if (command != EXH_CMD_NONE) { in->command = command; }
    exh_log_before(tick, in);
}

void stm_scene_after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    last_tick = tick;
    exh_log_after(tick, in, out);
    stm_modbus_poll(in);
    if (stm_modbus_save()) { stm_slot_save(scene); }
}

/* The step at which the last arming was refused. */
static void say_refusal(const struct exh_safety *s)
{
    for (unsigned k = 0; k < EXH_ARMS; k++) {
        if (s->refused == 1u << k) {
            stm_say("arming refused at ");
            stm_say(exh_arm_name(k));
            stm_say("\n");
        }
    }
}

void stm_scene_end(const struct exh_scene *sc)
{
    uint32_t lost;
    if (!begun) { return; }
    stm_log_flush();
    lost = exh_log_end(last_tick + 1);
    stm_log_flush();
    stm_say("\nrecords lost ");
    stm_say_u32(lost);
    stm_say("\n");
    if (sc->safety) { say_refusal(sc->safety); }
    if (sc->link) { stm_link_report(); }
}
