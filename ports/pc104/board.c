/* SPDX-License-Identifier: MIT */
/* The board's functions: the box (ports/cards), the timer, the two ways out for records. */
#include "pc104.h"

#include "box.h"
#include "io.h"

#include "exhand/error.h"

#include <limits.h>

/* Debug exit of emulators. Real machines have nothing at this port. */
#define EXIT_PORT 0xF4u
enum { STOP = -1 };

/* 24-bit counters of the encoder cards. The 8254, where it has to do, reaches 19906 Hz alone. */
const struct exh_board_info exh_board_info = {
    .name = "pc104",
    .version = EXH_BOARD_VERSION,
    .fingers = EXH_FINGERS,
    .enc_bits = 24,
    .rate_max_Hz = 20000,
};

static struct {
    const struct exh_scene *scene;
    uint32_t run, missed;                    /* ticks */
    uint32_t tick_start, tick_min, tick_max; /* cycles of the scene's tick alone */
    uint8_t ready, opened, started;
} run = {.tick_min = UINT32_MAX};

static struct exh_drive_out last; /* the last frame of the loop */

void pc104_board_for(const struct exh_scene *sc) { run.scene = sc; }

uint32_t pc104_tick(void) { return run.run; }

int pc104_board_clock(void)
{
    const int err = run.ready ? 0 : pc104_timer_choose(pc104_par.timer);
    run.ready = err == 0;
    if (err < 0) { pc104_exit_code = PC104_EXIT_TIMER; }
    return err;
}

/* Ends the power-on state of the outputs. exh_board_init() opens everything again and reports
 * errors. */
void pc104_board_still(void)
{
    struct exh_box_config config;
    pc104_box_config(run.scene, &config);
    (void)exh_box_open(&config, NULL);
}

int exh_board_init(uint32_t rate_Hz, struct exh_period *achieved)
{
    struct exh_box_config config;
    struct exh_box_report report;
    int err;

    exh_board_safe();
    if (run.scene == NULL && !run.ready) { pc104_options(NULL); } /* not from main() */
    pc104_restart_look();
    err = pc104_board_clock();
    if (err < 0) { return err; }
    pc104_exit_code = PC104_EXIT_RATE;
    err = pc104_timer_set(rate_Hz, achieved);
    if (err < 0) { return err; }
    pc104_box_config(run.scene, &config);
    err = exh_box_open(&config, &report);
    pc104_box_say(&report);
    pc104_exit_code = err == -EXH_E_RANGE ? PC104_EXIT_OPTION : PC104_EXIT_ABSENT;
    if (err < 0) { return err; }
    run.opened = 1;
    pc104_exit_code = PC104_EXIT_RATE;
    err = pc104_load_fits(rate_Hz);
    if (err < 0) { return err; }
    pc104_exit_code = 0;
    if (exh_box_error()->code != 0) { return -EXH_E_IO; } /* a card that passed and then failed */
    return exh_box_open(&config, NULL); /* as new: what was read in vain is forgotten */
}

int exh_board_wait(void)
{
    uint32_t missed, late;
    int dead;
    if (run.started) {
        pc104_link_poll(); /* behind the outputs, where it delays none of them */
        pc104_load_end();
    }
    if (pc104_par.ticks && run.run == (uint32_t)pc104_par.ticks) {
        exh_board_safe();
        pc104_load_stop();
        return STOP;
    }
    if (!run.started) { /* set-up and its text are not missed ticks */
        pc104_restart_begin();
        pc104_timer_start();
        run.started = 1;
    }
    dead = pc104_timer_wait(pc104_idle, &missed, &late);
    if (dead) {
        pc104_halt(PC104_EXIT_TIMER, dead == -1
                                         ? "timer: no tick for four periods, by the second clock"
                                         : "timer: it counts, but its interrupts do not come");
    }
    pc104_load_missed(run.run, missed, late);
    run.run++;
    run.missed = missed > UINT32_MAX - run.missed ? UINT32_MAX : run.missed + missed;
    pc104_load_begin();
    if (pc104_par.provoke && run.run == (uint32_t)pc104_par.provoke_tick) {
        pc104_provoke(pc104_par.provoke);
    }
    return missed > INT_MAX ? INT_MAX : (int)missed;
}

/* The scene's tick lies between the last thing that is read and what is written. */
static int read_done(int err)
{
    run.tick_start = exh_board_cycles();
    return err;
}

int exh_board_read_drive(struct exh_drive_in *in)
{
    const int err = exh_box_read_drive(in);
    if (pc104_restart_fired()) { in->din &= ~(uint32_t)EXH_DIN_WATCHDOG; }
    return read_done(err);
}

int exh_board_read_glove(struct exh_glove_in *in) { return read_done(exh_box_read_glove(in)); }

int exh_board_write_drive(const struct exh_drive_out *out)
{
    const uint32_t tick = exh_board_cycles() - run.tick_start;
    if (run.started) {
        run.tick_min = tick < run.tick_min ? tick : run.tick_min;
        run.tick_max = tick > run.tick_max ? tick : run.tick_max;
    }
    last = *out;
    return exh_box_write_drive(out);
}

void exh_board_safe(void) { exh_box_safe(); }

static void report(void)
{
    if (run.opened) { pc104_box_report(); }
    if (run.run == 0) { return; }
    pc104_say("ticks ");
    pc104_say_u32(run.run);
    pc104_say(" run, ");
    pc104_say_u32(run.missed);
    pc104_say(" missed\ncycles per tick ");
    pc104_say_u32(run.tick_min);
    pc104_say(" .. ");
    pc104_say_u32(run.tick_max);
    pc104_say("\n");
    pc104_load_report();
    pc104_link_report();
    pc104_say("dac");
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        pc104_say(" ");
        pc104_say_u32(last.dac_raw[i]);
    }
    pc104_say(", enable ");
    pc104_say_hex(last.enable);
    pc104_say("\n");
}

void exh_board_halt(const char *why)
{
    const int done = pc104_same_text(why, "done");
    __asm__ volatile("cli" : : : "memory");
    exh_board_safe();
    if (done) { pc104_restart_end(); }
    pc104_log_flush();
    report();
    pc104_say(why);
    pc104_say("\n");
    exh_board_safe(); /* once more, long after any update that was under way */
    pc104_dump_flush(!done);
    pc104_out8(EXIT_PORT, done              ? PC104_EXIT_DONE
                          : pc104_exit_code ? pc104_exit_code
                                            : PC104_EXIT_FAILED);
    for (;;) { /* only a reset helps */
        __asm__ volatile("cli; hlt");
    }
}

/* --- only where the scene calls them --- */

int exh_board_log(const void *rec, size_t len_B) { return pc104_log_take(rec, len_B); }

uint32_t exh_board_cycles(void)
{
    uint32_t low, high;
    __asm__ volatile("rdtsc" : "=a"(low), "=d"(high) : : "memory");
    return low;
}
