/* SPDX-License-Identifier: MIT */
/* A scene with parameters and records: options by the names of its table, log to a serial line or
 * to the port that emulators listen to. */
#include "pc104.h"

#include "io.h"
#include "exhand/run/log.h"

#include "exhand/error.h"
#include "exhand/exhand.h"

#define DEBUG_PORT 0xE9u
#define RING_B     32768u /* a power of two: six of the largest records, 200 ms of frames */

static uint8_t ring[RING_B];
static struct pc104_fifo fifo = {ring, RING_B, 0, 0};
static uint32_t unsent; /* bytes given up at the end */
static uint32_t last_tick;
static uint8_t started, dry, boxed, begun;
static const struct exh_scene *scene;

/* --- the log --- */

int pc104_log_take(const void *rec, size_t len_B)
{
    const uint8_t *byte = rec;
    if (dry) { fifo.put = fifo.got; }
    if (pc104_par.log == PC104_LOG_DEBUG && !dry) {
        for (size_t i = 0; i < len_B; i++) { pc104_out8(DEBUG_PORT, byte[i]); }
        return (int)len_B;
    }
    return pc104_fifo_put(&fifo, byte, (uint32_t)len_B);
}

int pc104_idle(void) { return pc104_fifo_out(&fifo, pc104_par.log, 0) | pc104_dump_idle(); }

int pc104_scene_option(const struct exh_scene *sc, const char *name, const char *value)
{
    const struct exh_signal_table *t = sc->params->table;
    int found = pc104_modbus_option(name, value);
    for (uint32_t i = 0; i < exh_signal_count(t); i++) {
        uint16_t instance;
        const struct exh_signal *row = exh_signal_at(t, i, &instance);
        if (!pc104_same_text(row->name, name)) { continue; }
        if (exh_params_stage(sc->params, row->id, instance, pc104_value_of(row, value)) < 0) {
            pc104_refuse_range(row, value);
        }
        found = 1; /* of every finger, material or whatever there are several of */
    }
    return found;
}

void pc104_scene_check(const struct exh_scene *sc) { pc104_modbus_check(sc); }

/* Before anything is timed: the parameters are part of what a tick costs. */
void pc104_scene_ready(const struct exh_scene *sc)
{
    scene = sc;
    exh_params_apply(sc->params);
    pc104_modules(sc);
    pc104_modbus_open(sc);
}

/* The log's hooks, or the black box's, which calls them. */
static void start_records(const struct exh_scene *sc, struct exh_scene_board board)
{
    if (boxed) {
        pc104_dump_start(sc, board);
    } else if (pc104_par.log != PC104_LOG_OFF) {
        exh_log_start(sc, board);
    }
}

/* As when all values were staged just now and the loop runs: none is another, so the scene stays as
 * it is. */
static void apply_dry(struct exh_params *p)
{
    const uint8_t locked = p->locked;
    p->locked = p->pending = 1;
    (void)exh_params_apply(p);
    p->locked = locked;
}

/* Records of a dry tick, which only cost time. Every 16th has a keyframe, one for each function of
 * Modbus. Values that Modbus stages are applied in the next tick, which has no request; values from
 * a link in any. Nothing else stages while the loop runs. */
void pc104_scene_dry(const struct exh_scene *sc, uint32_t tick, const struct exh_scene_in *in,
    const struct exh_drive_out *out)
{
    const uint32_t every = EXH_LOG_KEYFRAME_TICKS / 16u;
    if (tick == 0) { boxed = (uint8_t)pc104_dump_open(); }
    if ((pc104_modbus_dry(tick / 16 % 4) || sc->link) && sc->params) { apply_dry(sc->params); }
    if (pc104_par.log == PC104_LOG_OFF && !boxed) { return; }
    dry = 1;
    if (tick == 0) {
        start_records(sc, (struct exh_scene_board){{1, sc->rate_Hz}, exh_board_info.enc_bits});
    }
    if (boxed && tick % 16 == 0) { pc104_dump_dry(); }
    exh_log_after(tick * every + every - 1, in, out);
    fifo.put = fifo.got = 0;
    dry = 0;
}

void pc104_scene_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    boxed = (uint8_t)pc104_dump_open();
    started = pc104_par.log != PC104_LOG_OFF;
    begun = 1;
    pc104_modbus_start(board);
    start_records(sc, board);
}

void pc104_scene_before(uint32_t tick, struct exh_scene_in *in)
{
    const uint8_t command = pc104_modbus_command();
    if (command != EXH_CMD_NONE) { in->command = command; }
    if (boxed) {
        pc104_dump_before(tick, in);
    } else if (started) {
        exh_log_before(tick, in);
    }
}

void pc104_scene_after(
    uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    last_tick = tick;
    if (boxed) {
        pc104_dump_after(tick, in, out);
    } else if (started) {
        exh_log_after(tick, in, out);
    }
    pc104_modbus_poll(in);
}

void pc104_log_flush(void)
{
    unsent += pc104_fifo_flush(&fifo, pc104_par.log);
    pc104_dump_pause();
}

/* The step at which the last arming was refused. Without a real tick it belongs to the dry ticks,
 * and the cause of the failed start has been reported. */
static void say_refusal(const struct exh_safety *s)
{
    for (unsigned k = 0; begun && k < EXH_ARMS; k++) {
        if (s->refused == 1u << k) {
            pc104_say("arming refused at ");
            pc104_say(exh_arm_name(k));
            pc104_say("\n");
        }
    }
}

void pc104_scene_end(void)
{
    uint32_t lost;
    if (scene && scene->safety) { say_refusal(scene->safety); }
    pc104_modbus_report();
    pc104_log_flush();
    if (!started) { return; }
    lost = exh_log_end(last_tick + 1);
    pc104_log_flush();
    if (pc104_par.log == PC104_LOG_UDP) {
        for (unsigned i = 0; i < 3; i++) {
            (void)pc104_link_log(ring, 0, 2);
        } /* may be lost, too */
    }
    pc104_say("\nrecords lost ");
    pc104_say_u32(lost);
    if (unsent) {
        pc104_say(", bytes given up ");
        pc104_say_u32(unsent);
    }
    pc104_say("\n");
}
