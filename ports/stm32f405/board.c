/* SPDX-License-Identifier: MIT */
/* The board's functions. Ticks are SysTick's, counted in its interrupt; time is TIM5's. */
#include "stm.h"

#include "exhand/board.h"
#include "exhand/error.h"

#include <limits.h>

#define PPM_MAX   1000u
#define SYST_MAX  0x1000000u
#define SYST_OFF  0u
#define SYST_ON   3u /* counts, interrupts */
#define SYST_CORE 4u /* the processor's clock; without: an eighth of it */
enum { STOP = -1, EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_FAULT = 5 };

const struct exh_board_info exh_board_info = {
    .name = "stm32f405",
    .version = EXH_BOARD_VERSION,
    .fingers = EXH_FINGERS,
    .enc_bits = 16,
    .rate_max_Hz = 20000,
};

void (*stm_idle)(void);

static volatile uint32_t ticks; /* of SysTick */
static uint32_t seen, run, missed_in_all, enabled, syst;
static uint32_t scene_start, scene_min = UINT32_MAX, scene_max; /* of TIM5, from read to write */
static struct exh_period period;
static uint8_t watched, alive, whole; /* whole: the loop has ended a tick since the last wait */
static uint8_t exit_status = EXIT_FAILED;

void stm_systick(void) { ticks++; }
uint32_t stm_ticks(void) { return ticks; }
void stm_watch(void) { watched = 1; }

/* The clock that hits the rate: the processor's, or an eighth of it for long periods. */
static int set_rate(uint32_t rate_Hz, struct exh_period *achieved)
{
    for (uint32_t slow = 0; slow < 2 && rate_Hz > 0; slow++) {
        const uint32_t Hz = STM_CORE_HZ >> (slow ? 3 : 0);
        const uint32_t counts = (Hz + rate_Hz / 2) / rate_Hz, made = counts * rate_Hz;
        const uint32_t off = made > Hz ? made - Hz : Hz - made;
        if (counts <= SYST_MAX && off <= Hz / 1000000u * PPM_MAX) {
            syst = SYST_ON | (slow ? 0 : SYST_CORE);
            REG(BASE_SCS, SYST_RVR) = counts - 1;
            *achieved = period = (struct exh_period){counts, Hz};
            return 0;
        }
    }
    return -EXH_E_RATE;
}

int exh_board_init(uint32_t rate_Hz, struct exh_period *achieved)
{
    stm_box_safe();
    REG(BASE_SCS, SYST_CSR) = SYST_OFF;
    if (rate_Hz > exh_board_info.rate_max_Hz || set_rate(rate_Hz, achieved) < 0) {
        return -EXH_E_RATE;
    }
    run = 0;
    return stm_box_open();
}

/* The first call: set-up is no missed tick. */
static void begin(void)
{
    if (watched) { stm_watchdog_start(period); }
    REG(BASE_SCS, SYST_CVR) = 0;
    seen = ticks;
    REG(BASE_SCS, SYST_CSR) = syst;
}

int exh_board_wait(void)
{
    uint32_t now, n;
    if (STM_TICKS && run == STM_TICKS) { return STOP; }
    if (whole) { /* a whole tick lies behind: this alone feeds */
        whole = 0;
        PIN_PUT(ALIVE, alive & 1u);
        if (watched) { stm_watchdog_feed(); }
    }
    if (run == 0) { begin(); }
    /* An interrupt leaves a mark by which the next wfe falls through: none slips in before it. */
    while ((now = ticks) == seen) {
        if (stm_idle) { stm_idle(); }
        __asm__ volatile("wfe" : : : "memory");
    }
    n = now - seen;
    seen = now;
    run++;
    missed_in_all += n - 1;
    return n - 1 > INT_MAX ? INT_MAX : (int)(n - 1);
}

int exh_board_read_drive(struct exh_drive_in *in)
{
    const int err = stm_box_read_drive(in);
    scene_start = stm_now();
    return err;
}

int exh_board_write_drive(const struct exh_drive_out *out)
{
    const uint32_t took = stm_now() - scene_start;
    if (took < scene_min) { scene_min = took; }
    if (took > scene_max) { scene_max = took; }
    enabled += out->enable != 0;
    whole |= out->alive != alive;
    alive = out->alive;
    return stm_box_write_drive(out);
}

void exh_board_safe(void) { stm_box_safe(); }

static void report(void)
{
    stm_say("ticks ");
    stm_say_u32(run);
    stm_say(" run, ");
    stm_say_u32(missed_in_all);
    stm_say(" missed, ");
    stm_say_u32(enabled);
    stm_say(" with a drive on\nfrom read to write, counts of TIM5: ");
    stm_say_u32(scene_min);
    stm_say(" .. ");
    stm_say_u32(scene_max);
    stm_say("\nstack ");
    stm_say_u32(stm_stack_B());
    stm_say(" B\n");
    stm_box_report();
}

/* Emulators without the chip end here: semihosting. Without a debugger a breakpoint is a fault, so
 * others see the loop of stm_halted(). */
static void end_emulation(uint32_t status)
{
    const uint32_t block[2] = {0x20026 /* the application has ended */, status};
    register uint32_t operation __asm__("r0") = 0x20; /* SYS_EXIT_EXTENDED */
    register const uint32_t *argument __asm__("r1") = block;
    __asm__ volatile("bkpt 0xab" : "+r"(operation) : "r"(argument) : "memory");
}

/* For good: only a reset helps. Each pass makes the outputs safe, then feeds the watchdog, or a
 * bite would start the scene anew. */
void stm_halted(void);
__attribute__((noinline)) void stm_halted(void)
{
    for (;;) {
        stm_box_safe();
        if (watched) { stm_watchdog_feed(); }
    }
}

void exh_board_halt(const char *why)
{
    __asm__ volatile("cpsid i" : : : "memory");
    exh_board_safe();
    stm_log_flush();
    if (run) { report(); }
    stm_say(why);
    stm_say("\n");
    if (stm_clock() == STM_CLOCK_NONE) {
        end_emulation(stm_same(why, "done") ? EXIT_DONE : exit_status);
    }
    stm_halted();
}

#define NMI 2u

/* Outputs first: what broke may have broken the rest, too. */
void stm_fault(uint32_t exception)
{
    exh_board_safe();
    exit_status = EXIT_FAULT;
    if (exception == NMI) { stm_clock_hsi(); }
    stm_log_flush();
    stm_say("processor exception ");
    stm_say_u32(exception);
    stm_say(", cause ");
    stm_say_hex(REG(BASE_SCS, SCB_CFSR));
    stm_say("\n");
    exh_board_halt(exception == NMI ? "clock: the crystal has stopped" : "fault");
}

/* --- only where the scene calls them --- */

int exh_board_read_glove(struct exh_glove_in *in)
{
    const int err = stm_box_read_glove(in, seen);
    scene_start = stm_now();
    return err;
}

uint32_t exh_board_cycles(void) { return stm_now(); }
