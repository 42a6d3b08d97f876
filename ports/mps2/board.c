/* SPDX-License-Identifier: MIT */
/* The board's functions. Ticks are SysTick's, counted in its interrupt; time within a tick is the
 * board's timer 0, which counts the processor's clock. */
#include "box.h"
#include "mps2.h"

#include "exhand/board.h"
#include "exhand/error.h"

#include <limits.h>

#define CLOCK_HZ 25000000u
#define PPM_MAX  1000u
enum { STOP = -1 };
enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_FAULT = 5 };

/* SysTick, of every Cortex-M */
#define SYST_CONTROL MPS2_REG(0xE000E010)
#define SYST_RELOAD  MPS2_REG(0xE000E014)
#define SYST_VALUE   MPS2_REG(0xE000E018)
#define SYST_RUN     7u /* the processor's clock, interrupt, enabled */
#define SYST_MAX     0x1000000u

/* Timer 0 of the board: counts down. A real Cortex-M3 also has DWT's cycle counter; QEMU's has
 * none.
 */
#define TIMER_CONTROL MPS2_REG(0x40000000)
#define TIMER_VALUE   MPS2_REG(0x40000004)
#define TIMER_RELOAD  MPS2_REG(0x40000008)

const struct exh_board_info exh_board_info = {
    .name = "mps2",
    .version = EXH_BOARD_VERSION,
    .fingers = EXH_FINGERS,
    .enc_bits = 32,
    .rate_max_Hz = 20000,
};

static volatile uint32_t ticks; /* of SysTick */
static uint32_t seen, run, missed_in_all, enabled;
static uint32_t scene_start, scene_min = UINT32_MAX, scene_max; /* cycles between read and write */
static uint8_t exit_status = EXIT_FAILED;

void mps2_systick(void) { ticks++; }

int exh_board_init(uint32_t rate_Hz, struct exh_period *achieved)
{
    uint32_t counts, made, off;
    mps2_box_safe();
    TIMER_VALUE = TIMER_RELOAD = UINT32_MAX;
    TIMER_CONTROL = 1;
    if (rate_Hz < 1 || rate_Hz > exh_board_info.rate_max_Hz) { return -EXH_E_RATE; }
    counts = (CLOCK_HZ + rate_Hz / 2) / rate_Hz;
    made = counts * rate_Hz; /* counts used in one second */
    off = made > CLOCK_HZ ? made - CLOCK_HZ : CLOCK_HZ - made;
    if (counts > SYST_MAX || off > CLOCK_HZ / 1000000 * PPM_MAX) { return -EXH_E_RATE; }
    SYST_RELOAD = counts - 1;
    *achieved = (struct exh_period){counts, CLOCK_HZ};
    return mps2_box_open();
}

int exh_board_wait(void)
{
    uint32_t now, n;
    if (MPS2_TICKS && run == MPS2_TICKS) { return STOP; }
    if (run == 0) { /* set-up is not a missed tick */
        SYST_VALUE = 0;
        SYST_CONTROL = SYST_RUN;
    }
    /* An interrupt leaves a mark by which the next wfe falls through: none slips in before it. */
    while ((now = ticks) == seen) { __asm__ volatile("wfe" : : : "memory"); }
    n = now - seen;
    seen = now;
    run++;
    missed_in_all += n - 1;
    return n - 1 > INT_MAX ? INT_MAX : (int)(n - 1);
}

int exh_board_read_drive(struct exh_drive_in *in)
{
    const int err = mps2_box_read_drive(in);
    scene_start = exh_board_cycles();
    return err;
}

int exh_board_write_drive(const struct exh_drive_out *out)
{
    const uint32_t took = exh_board_cycles() - scene_start;
    if (took < scene_min) { scene_min = took; }
    if (took > scene_max) { scene_max = took; }
    enabled += out->enable != 0;
    return mps2_box_write_drive(out);
}

void exh_board_safe(void) { mps2_box_safe(); }

static void report(void)
{
    mps2_say("ticks ");
    mps2_say_u32(run);
    mps2_say(" run, ");
    mps2_say_u32(missed_in_all);
    mps2_say(" missed, ");
    mps2_say_u32(enabled);
    mps2_say(" with a drive on\ncycles per tick ");
    mps2_say_u32(scene_min);
    mps2_say(" .. ");
    mps2_say_u32(scene_max);
    mps2_say("\nstack ");
    mps2_say_u32(mps2_stack_B());
    mps2_say(" B\n");
    mps2_box_report();
}

static int is_done(const char *why)
{
    return why[0] == 'd' && why[1] == 'o' && why[2] == 'n' && why[3] == 'e' && why[4] == 0;
}

void exh_board_halt(const char *why)
{
    __asm__ volatile("cpsid i" : : : "memory");
    exh_board_safe();
    if (run) { report(); }
    mps2_say(why);
    mps2_say("\n");
    mps2_exit(is_done(why) ? EXIT_DONE : exit_status);
    for (;;) {} /* only a reset helps */
}

/* Outputs first: what broke may have broken the rest, too. */
void mps2_fault(uint32_t exception)
{
    exh_board_safe();
    exit_status = EXIT_FAULT;
    mps2_say("processor exception ");
    mps2_say_u32(exception);
    mps2_say("\n");
    exh_board_halt("fault");
}

/* --- only where the scene calls them --- */

int exh_board_read_glove(struct exh_glove_in *in)
{
    const int err = mps2_box_read_glove(in);
    scene_start = exh_board_cycles();
    return err;
}

uint32_t exh_board_cycles(void) { return ~TIMER_VALUE; }

/* No place to keep records and no network: nothing is taken, nothing comes. */
int exh_board_log(const void *rec, size_t len_B)
{
    (void)rec;
    (void)len_B;
    return 0;
}

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
