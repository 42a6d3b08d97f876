/* SPDX-License-Identifier: MIT */
/* Ticks from the HPET, or from the 8254 if there is none or an option asks for it. With the HPET a
 * tick is due when the main counter has passed its time; the interrupt only wakes the processor. So
 * a missed tick is detected even if its interrupt was lost. The 8254 has no such counter; its
 * interrupts are the ticks. */
#include "pc104.h"

#include "cards/io.h"

#include "exhand/error.h"
#include "exhand/fix.h"

#define PPM_MAX     1000u
#define RATE_MAX_HZ 20000u
#define US_PER_S    1000000u
#define SILENT_MAX  4u /* ticks in a row; emulators lose the interrupt of one now and then */

static struct pc104_timer timer;
static uint8_t is_hpet, running;
static volatile uint8_t hangs; /* a test: what is done between ticks never ends */
static uint32_t counts;        /* of a period */
static uint32_t next;          /* HPET: instant of the next tick */
static uint32_t seen;          /* 8254: its ticks so far */
static uint32_t us_per_count_q32, us_last;
static uint64_t us_q32;

/* --- which, and how often --- */

static int open_one(int (*open)(struct pc104_timer *, const char **), const char *name)
{
    const char *why = "";
    const int err = open(&timer, &why);
    if (err < 0) {
        pc104_say("timer ");
        pc104_say(name);
        pc104_say(": ");
        pc104_say(why);
        pc104_say("\n");
    }
    return err;
}

int pc104_timer_choose(int32_t wanted)
{
    int err = -EXH_E_ABSENT;
    running = 0;
    if (wanted != PC104_TIMER_PIT) {
        err = open_one(pc104_hpet_open, "HPET");
        is_hpet = err == 0;
    }
    if (err < 0 && wanted != PC104_TIMER_HPET) {
        if (wanted == PC104_TIMER_PIT) { pc104_hpet_stop(); } /* set by firmware or a loader */
        err = open_one(pc104_pit_open, "8254");
        is_hpet = 0;
    }
    if (err < 0) { return err; }
    counts = timer.counts_max;
    us_per_count_q32 = (uint32_t)exh_udiv64((uint64_t)US_PER_S << 32, timer.Hz, NULL);
    if (!is_hpet) {
        counts = 65536;
        __asm__ volatile("sti" : : : "memory"); /* its interrupts count from here on */
    }
    us_last = pc104_timer_now();
    return 0;
}

static uint32_t nearest(uint32_t rate_Hz)
{
    return (uint32_t)exh_udiv64((uint64_t)timer.Hz + rate_Hz / 2, rate_Hz, NULL);
}

static int can_have(uint32_t rate_Hz)
{
    uint64_t made, off;
    uint32_t n;
    if (rate_Hz < 1 || rate_Hz > RATE_MAX_HZ) { return 0; }
    n = nearest(rate_Hz);
    made = (uint64_t)rate_Hz * n; /* counts used in one second */
    off = made > timer.Hz ? made - timer.Hz : timer.Hz - made;
    return n <= timer.counts_max && off * (US_PER_S / PPM_MAX) <= timer.Hz;
}

static void offer_nearest(uint32_t rate_Hz)
{
    const uint32_t from_Hz = rate_Hz < RATE_MAX_HZ ? rate_Hz : RATE_MAX_HZ;
    uint32_t below_Hz = from_Hz, above_Hz = from_Hz;

    while (below_Hz > 0 && !can_have(below_Hz)) { below_Hz--; }
    while (above_Hz <= RATE_MAX_HZ && !can_have(above_Hz)) { above_Hz++; }
    pc104_say("rate ");
    pc104_say_u32(rate_Hz);
    pc104_say(" Hz (the ");
    pc104_say(timer.name);
    pc104_say(" does not come within 1000 ppm of it): take");
    if (below_Hz > 0) {
        pc104_say(" ");
        pc104_say_u32(below_Hz);
    }
    if (above_Hz <= RATE_MAX_HZ) {
        pc104_say(" ");
        pc104_say_u32(above_Hz);
    }
    pc104_say("\n");
}

uint32_t pc104_timer_highest_Hz(uint32_t cost_counts)
{
    uint64_t Hz = cost_counts ? exh_udiv64(timer.Hz, cost_counts, NULL) : RATE_MAX_HZ;
    if (Hz > RATE_MAX_HZ) { Hz = RATE_MAX_HZ; }
    while (Hz > 0 && (!can_have((uint32_t)Hz) || nearest((uint32_t)Hz) < cost_counts)) { Hz--; }
    return (uint32_t)Hz;
}

static uint32_t common_divisor(uint32_t a, uint32_t b)
{
    while (b) {
        const uint32_t r = a % b;
        a = b;
        b = r;
    }
    return a;
}

/* Reduced, so that a clock that divides evenly gives the very ratio one would write by hand. */
static struct exh_period period(void)
{
    const uint32_t d = common_divisor(timer.Hz, counts);
    return (struct exh_period){counts / d, timer.Hz / d};
}

static void say_period(uint32_t rate_Hz)
{
    const struct exh_period T = period();
    const uint64_t made = (uint64_t)rate_Hz * counts;
    const uint64_t off = made > timer.Hz ? made - timer.Hz : timer.Hz - made;
    pc104_say("rate ");
    pc104_say_u32(rate_Hz);
    pc104_say(" Hz asked, timer ");
    pc104_say(timer.name);
    pc104_say(" of ");
    pc104_say_u32(timer.Hz);
    pc104_say(" Hz, period ");
    pc104_say_u32(T.num);
    pc104_say("/");
    pc104_say_u32(T.den);
    pc104_say(" s, ");
    pc104_say_fixed((int64_t)exh_udiv64((off * US_PER_S) << 10, timer.Hz, NULL), 10);
    pc104_say(" ppm off\n");
}

int pc104_timer_set(uint32_t rate_Hz, struct exh_period *achieved)
{
    if (!can_have(rate_Hz)) {
        offer_nearest(rate_Hz);
        return -EXH_E_RATE;
    }
    (void)exh_io_time_us(); /* the time until here, in the old counts */
    counts = nearest(rate_Hz);
    *achieved = period();
    if (!is_hpet) { pc104_pit_load(counts); }
    us_last = pc104_timer_now();
    say_period(rate_Hz);
    pc104_say(pc104_second_open(pc104_timer_now, timer.Hz, counts)
                  ? "second clock local APIC\n"
                  : "second clock none: a timer that dies is not noticed\n");
    return 0;
}

/* --- ticks --- */

void pc104_timer_start(void)
{
    /* A request from before still waits in the 8259: let it come, it is not a tick. */
    __asm__ volatile("sti; nop; nop; cli" : : : "memory");
    if (is_hpet) {
        next = pc104_hpet_now() + counts;
        pc104_hpet_start(next, counts);
    } else {
        pc104_pit_load(counts); /* a whole period from here to the first tick */
    }
    seen = pc104_ticks;
    running = 1;
    __asm__ volatile("sti" : : : "memory");
}

/* Ticks that have become due since it was asked last. */
static uint32_t due(void)
{
    uint32_t n = 0;
    if (!is_hpet) {
        n = pc104_ticks - seen;
        seen += n;
        return n;
    }
    while (pc104_hpet_now() - next < UINT32_C(0x80000000)) {
        next += counts;
        n++;
    }
    return n;
}

/* 1 if only the counter detects ticks, since the processor did not sleep. Then nothing would end a
 * tick that hangs. */
static int silent(void)
{
    static uint32_t in_a_row, interrupts;
    in_a_row = pc104_ticks == interrupts ? in_a_row + 1 : 0;
    interrupts = pc104_ticks;
    return in_a_row > SILENT_MAX;
}

int pc104_timer_wait(int (*idle)(void), uint32_t *missed, uint32_t *late)
{
    const uint32_t interrupts = pc104_ticks;
    uint32_t n = due();
    int dead = 0;

    *late = n;
    pc104_second_arm();
    while (hangs) {}
    for (;;) {
        const int more = n == 0 && (idle() || pc104_par.spin);
        __asm__ volatile("cli" : : : "memory");
        n += due();
        if (n > 0 || dead) { break; }
        /* One look more behind the second clock's: both interrupts may have been waiting. */
        dead = pc104_second_fired != 0;
        /* sti acts after the next instruction: no tick slips in before the hlt */
        if (more || dead) {
            __asm__ volatile("sti; nop; nop; cli" : : : "memory");
        } else {
            __asm__ volatile("sti; hlt; cli" : : : "memory");
        }
        __asm__ volatile("sti" : : : "memory");
    }
    pc104_second_disarm();
    /* Its counter may go on while its interrupt is lost. */
    dead = n == 0 || (pc104_second_fired && pc104_ticks == interrupts);
    __asm__ volatile("sti" : : : "memory");
    *missed = n - 1;
    return dead ? -1 : silent() ? -2 : 0;
}

/* --- time --- */

uint32_t pc104_timer_due(void) { return is_hpet ? next - counts : seen * counts; }

uint32_t pc104_timer_counts(void) { return counts; }

uint32_t pc104_timer_Hz(void) { return timer.Hz; }

/* The 8254 may have started a period whose interrupt is pending; time does not advance until
 * then. */
uint32_t pc104_timer_now(void)
{
    static uint32_t last_ticks, last_count = UINT32_MAX;
    uint32_t ticks, count;
    if (is_hpet) { return pc104_hpet_now(); }
    do { /* an interrupt between the two would make them belong to different periods */
        ticks = pc104_ticks;
        count = pc104_pit_count();
    } while (ticks != pc104_ticks);
    if (ticks == last_ticks && count > last_count) { count = last_count; }
    last_ticks = ticks;
    last_count = count;
    return ticks * counts + (counts - count);
}

/* For the drivers' time-outs: free-running; 0 until there is a timer. */
uint32_t exh_io_time_us(void)
{
    uint32_t now;
    if (timer.Hz == 0) { return 0; }
    now = pc104_timer_now();
    us_q32 += (uint64_t)(now - us_last) * us_per_count_q32;
    us_last = now;
    return (uint32_t)(us_q32 >> 32);
}

void pc104_timer_kill(void)
{
    if (is_hpet) {
        pc104_hpet_stop();
    } else {
        pc104_pit_load(65536); /* the slowest rate: mode 2 cannot be stopped */
    }
}

void pc104_timer_hang(void) { hangs = 1; }
