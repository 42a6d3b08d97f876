/* SPDX-License-Identifier: MIT */
/* The black box of a scene that has one (SCENE_BOX_B in its scene.mk), and its output after a
 * fault. After the outputs of a tick, at most DUMP_TICK_B bytes enter a queue. While the processor
 * waits for the next tick, they leave it as fast as the line allows. */
#include "pc104.h"

#include "exhand/run/blackbox.h"
#include "io.h"

#include "cards/wait.h"

#define DEBUG_PORT  0xE9u
#define DUMP_TICK_B 256u
#define QUEUE_B     4096u /* a power of two: three pieces of a stream */

extern uint8_t __box_start[], __box_end[]; /* ldscripts/pc104.ld: behind all else */

static uint8_t queue[QUEUE_B];
static struct pc104_fifo fifo = {queue, QUEUE_B, 0, 0};
static uint8_t on, going, halting;
static uint32_t dumps;

int pc104_dump_open(void)
{
    const uint32_t room = (uint32_t)(__box_end - __box_start);
    const uint32_t asked = (uint32_t)pc104_par.dump_KiB * 1024u;
    const uint32_t len_B = asked && asked < room ? asked : room;
    on = pc104_par.dump != PC104_LOG_OFF;
    if (!on) { return 0; }
    if (pc104_par.dump == pc104_par.log) {
        pc104_halt(PC104_EXIT_OPTION, "option dump: the log goes there");
    }
    if (pc104_par.dump == PC104_LOG_UDP && !pc104_link_up()) {
        pc104_halt(PC104_EXIT_OPTION, "option dump=udp: needs ip= and peer=, and a network card");
    }
    exh_blackbox_memory(__box_start, len_B, pc104_par.log == PC104_LOG_OFF);
    return 1;
}

void pc104_dump_start(const struct exh_scene *sc, struct exh_scene_board board)
{
    exh_blackbox_start(sc, board);
    if (exh_blackbox_is().state == EXH_BLACKBOX_OFF) {
        pc104_halt(PC104_EXIT_OPTION, "option dump_kib: too little to hold a fault at this rate");
    }
}

/* It holds a keyframe before every record of a dry tick, so the dearest tick is among them. */
void pc104_dump_dry(void) { exh_blackbox_clear(); }

void pc104_dump_before(uint32_t tick, struct exh_scene_in *in) { exh_blackbox_before(tick, in); }

/* --- out --- */

/* What one call of exh_blackbox_read() gives, into the queue; 0: the dump is at its end. */
static uint32_t fill(uint32_t most_B)
{
    uint8_t byte[DUMP_TICK_B];
    const uint32_t room = QUEUE_B - (fifo.put - fifo.got);
    uint32_t n = most_B < room ? most_B : room;
    if (n == 0) { return 1; } /* later */
    n = exh_blackbox_read(byte, n);
    if (pc104_par.dump == PC104_LOG_DEBUG) {
        for (uint32_t i = 0; i < n; i++) { pc104_out8(DEBUG_PORT, byte[i]); }
    } else {
        (void)pc104_fifo_put(&fifo, byte, n);
    }
    return n;
}

static void begin(void)
{
    if (going || exh_blackbox_is().state != EXH_BLACKBOX_FROZEN) { return; }
    if (pc104_par.dump == PC104_LOG_UDP && dumps > 0) { pc104_link_log_new(); }
    going = 1;
    dumps++;
}

/* The line has taken all of it. */
static void finish(void)
{
    if (pc104_par.dump == PC104_LOG_UDP) {
        for (unsigned i = 0; i < 3; i++) {
            (void)pc104_link_log(queue, 0, 2);
        } /* may be lost, too */
    }
    going = 0;
}

void pc104_dump_after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    exh_blackbox_after(tick, in, out);
    begin();
    if (going == 1 && fill(DUMP_TICK_B) == 0) { going = 2; } /* what is queued has to go yet */
    if (going == 2 && fifo.put == fifo.got) { finish(); }
}

int pc104_dump_idle(void)
{
    if (!on || !going) { return 0; }
    return pc104_fifo_out(&fifo, pc104_par.dump, going == 2);
}

void pc104_dump_pause(void)
{
    uint32_t rest;
    if (!on || !going || halting || pc104_par.dump != PC104_LOG_SERIAL) { return; }
    while (pc104_fifo_wait(&fifo, pc104_par.dump) && (rest = exh_blackbox_rest()) > 0) {
        (void)fill(rest < DUMP_TICK_B ? rest : DUMP_TICK_B);
    }
}

/* A listener takes no flood: a piece a millisecond is 1.4 MB/s. 0: the card takes nothing. */
static int out_paced(void)
{
    for (unsigned stuck = 0; stuck < 1000; stuck++) {
        const uint32_t before = fifo.got;
        struct exh_wait pace = exh_wait_us(1000);
        (void)pc104_fifo_out(&fifo, pc104_par.dump, 1);
        while (exh_wait_more(&pace)) {}
        if (fifo.got != before || fifo.put == fifo.got) { return 1; }
    }
    return 0;
}

/* Nothing runs any more, outputs are safe and the words are said. An exception in here comes here
 * again, and finds nothing to do. */
void pc104_dump_flush(int halted)
{
    int goes = 1;
    if (!on || halting) { return; }
    halting = 1;
    exh_blackbox_stop(halted);
    begin();
    if (!going) { return; }
    pc104_say("black box: the dump follows\n");
    while (goes && (going == 1 || fifo.put != fifo.got)) {
        while (going == 1 && QUEUE_B - (fifo.put - fifo.got) >= DUMP_TICK_B) {
            if (fill(DUMP_TICK_B) == 0) { going = 2; }
        }
        goes =
            pc104_par.dump == PC104_LOG_UDP ? out_paced() : pc104_fifo_wait(&fifo, pc104_par.dump);
    }
    finish();
    pc104_say(goes ? "\nblack box: its end\n" : "\nblack box: the line takes no more of it\n");
}
