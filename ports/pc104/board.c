/* PC/104 board, first stage: processor, timer and serial line are real, the cards
 * are constants. It shows that scene and library run on the bare machine. */
#include "pc104.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "io.h"

#include <limits.h>

#define TICKS_DEFAULT 1000u /* an emulator has no other way to say "enough" */
#define DAC_ZERO_RAW  32768u
#define DEADMAN_TICK  200u
/* Debug exit of emulators: status 2 * value + 1. Neither may look like a failure
 * of the emulator itself, which is 1. Real machines have nothing at this port. */
enum { EXIT_PORT = 0xF4, EXIT_DONE = 0x10, EXIT_FAILED = 0x11 };
enum { STOP = -1 };

/* 24-bit counters of the encoder cards; 19906 Hz is divisor 60 less 1000 ppm. */
const struct exh_board_info exh_board_info = {
    .name = "pc104",
    .version = EXH_BOARD_VERSION,
    .fingers = EXH_FINGERS,
    .enc_bits = 24,
    .rate_max_Hz = 19906,
};

static struct {
    uint32_t wanted, run, missed, seen;      /* ticks */
    uint32_t tick_start, tick_min, tick_max; /* cycles of the scene's tick alone */
    uint8_t started;
} run = {.tick_min = UINT32_MAX};

static struct exh_drive_out applied; /* what the cards would hold */
static struct exh_drive_out last;    /* the last frame of the loop */

int exh_board_init(uint32_t rate_Hz, struct exh_period *achieved)
{
    exh_board_safe();
    const int err = pc104_timer_set(rate_Hz, achieved);
    if (err < 0) { return err; }
    pc104_say_banner(rate_Hz, *achieved);
    run.wanted = pc104_option_u32("ticks", TICKS_DEFAULT);
    return 0;
}

int exh_board_wait(void)
{
    if (run.run == run.wanted) { return STOP; }
    if (!run.started) { /* set-up and its text are not missed ticks */
        run.seen = pc104_timer_start();
        run.started = 1;
    }
    const uint32_t now = pc104_timer_wait(run.seen);
    const uint32_t missed = now - run.seen - 1;
    run.seen = now;
    run.run++;
    run.missed = missed > UINT32_MAX - run.missed ? UINT32_MAX : run.missed + missed;
    return missed > INT_MAX ? INT_MAX : (int)missed;
}

int exh_board_read_drive(struct exh_drive_in *in)
{
    /* A hand that takes hold of the dead-man switch after a while. */
    *in = (struct exh_drive_in){.din = EXH_DIN_ESTOP | (run.run > DEADMAN_TICK ? EXH_DIN_DEADMAN : 0)};
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        in->din |= (uint32_t)EXH_DIN_DRIVE0 << i;
    }
    run.tick_start = exh_board_cycles();
    return 0;
}

int exh_board_write_drive(const struct exh_drive_out *out)
{
    const uint32_t tick = exh_board_cycles() - run.tick_start;
    run.tick_min = tick < run.tick_min ? tick : run.tick_min;
    run.tick_max = tick > run.tick_max ? tick : run.tick_max;
    last = applied = *out;
    return 0;
}

void exh_board_safe(void)
{
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        applied.dac_raw[i] = DAC_ZERO_RAW;
    }
    applied.enable = 0;
}

static void report(void)
{
    pc104_say("ticks ");
    pc104_say_u32(run.run);
    pc104_say(" run, ");
    pc104_say_u32(run.missed);
    pc104_say(" missed\ncycles per tick ");
    pc104_say_u32(run.tick_min);
    pc104_say(" .. ");
    pc104_say_u32(run.tick_max);
    pc104_say("\ndac");
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
    __asm__ volatile("cli" : : : "memory");
    exh_board_safe();
    if (run.run) { report(); }
    pc104_say(why);
    pc104_say("\n");
    pc104_out8(EXIT_PORT, pc104_same_text(why, "done") ? EXIT_DONE : EXIT_FAILED);
    for (;;) { /* only a reset helps */
        __asm__ volatile("cli; hlt");
    }
}

/* --- only where the scene calls them; a scene that wants a log or the link does not link
 * before their cards are here --- */

int exh_board_read_glove(struct exh_glove_in *in)
{
    /* A hand at rest, somewhere in the middle of every sensor. */
    *in = (struct exh_glove_in){.age_ticks = 0};
    return 0;
}

/* No network card yet: nobody is there. */
int exh_board_link_send(const void *buf, size_t len_B)
{
    (void)buf;
    (void)len_B;
    return 0;
}

int exh_board_link_recv(void *buf, size_t cap_B)
{
    (void)buf;
    (void)cap_B;
    return 0;
}

uint32_t exh_board_cycles(void)
{
    uint32_t low, high;
    __asm__ volatile("rdtsc" : "=a"(low), "=d"(high) : : "memory");
    return low;
}
