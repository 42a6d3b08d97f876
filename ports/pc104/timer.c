#include "pc104.h"

#include "exhand/error.h"
#include "io.h"

/* 8254, channel 0, mode 2: one interrupt every `divisor` counts, reloaded by the
 * hardware, so that periods do not drift whatever the software does. */
enum { PIT_COUNT0 = 0x40, PIT_MODE = 0x43 };
#define PIT_MODE_RATE  0x34u /* channel 0, low then high byte, mode 2 */
#define PIT_MODE_LATCH 0x00u /* channel 0, hold the count for reading */
#define DIVISOR_MAX    65535u
#define PPM_MAX        1000u
#define RATE_MAX_HZ    20000u
#define PROBE_READS    100000u /* 0.1 s and more on ISA; one count takes 0.84 us */

static uint32_t programmed; /* divisor */

static void load(uint32_t divisor)
{
    pc104_out8(PIT_MODE, PIT_MODE_RATE);
    pc104_out8(PIT_COUNT0, (uint8_t)(divisor & 0xFFu));
    pc104_out8(PIT_COUNT0, (uint8_t)(divisor >> 8));
}

static uint32_t count_now(void)
{
    pc104_out8(PIT_MODE, PIT_MODE_LATCH);
    const uint32_t low = pc104_in8(PIT_COUNT0);
    return low | (uint32_t)pc104_in8(PIT_COUNT0) << 8;
}

/* A timer that stands still, or an empty bus, must be found before currents flow. */
static int counts(void)
{
    const uint32_t first = count_now();
    for (uint32_t i = 0; i < PROBE_READS; i++) {
        if (count_now() != first) { return 1; }
    }
    return 0;
}

static uint32_t nearest_divisor(uint32_t rate_Hz)
{
    return (PC104_PIT_HZ + rate_Hz / 2) / rate_Hz;
}

uint32_t pc104_timer_off_Hz(uint32_t rate_Hz, uint32_t divisor)
{
    const uint32_t made_Hz = rate_Hz * divisor; /* counts used in one second */
    return made_Hz > PC104_PIT_HZ ? made_Hz - PC104_PIT_HZ : PC104_PIT_HZ - made_Hz;
}

static int can_have(uint32_t rate_Hz)
{
    if (rate_Hz < 1 || rate_Hz > RATE_MAX_HZ) { return 0; }
    const uint32_t divisor = nearest_divisor(rate_Hz);
    /* off / PIT <= ppm / 10^6, without leaving 32 bits: off is below 10^4 here */
    return divisor <= DIVISOR_MAX &&
           pc104_timer_off_Hz(rate_Hz, divisor) * (1000000u / PPM_MAX) <= PC104_PIT_HZ;
}

static void offer_nearest(uint32_t rate_Hz)
{
    const uint32_t from_Hz = rate_Hz < RATE_MAX_HZ ? rate_Hz : RATE_MAX_HZ;
    uint32_t below_Hz = from_Hz, above_Hz = from_Hz;

    while (below_Hz > 0 && !can_have(below_Hz)) {
        below_Hz--;
    }
    while (above_Hz <= RATE_MAX_HZ && !can_have(above_Hz)) {
        above_Hz++;
    }
    pc104_say("rate ");
    pc104_say_u32(rate_Hz);
    pc104_say(" Hz (the timer comes within 1000 ppm of few): take");
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

int pc104_timer_set(uint32_t rate_Hz, struct exh_period *achieved)
{
    if (!can_have(rate_Hz)) {
        offer_nearest(rate_Hz);
        return -EXH_E_RATE;
    }
    programmed = nearest_divisor(rate_Hz);
    *achieved = (struct exh_period){programmed, PC104_PIT_HZ};
    load(programmed);
    return counts() ? 0 : -EXH_E_ABSENT;
}

uint32_t pc104_timer_start(void)
{
    /* A request from before still waits in the 8259: let it come, it is not a tick. */
    __asm__ volatile("sti; nop; nop; cli" : : : "memory");
    load(programmed); /* a whole period from here to the first tick */
    const uint32_t seen_ticks = pc104_ticks;
    __asm__ volatile("sti" : : : "memory");
    return seen_ticks;
}

uint32_t pc104_timer_wait(uint32_t seen_ticks)
{
    __asm__ volatile("cli" : : : "memory");
    while (pc104_ticks == seen_ticks) {
        /* sti acts after the next instruction: no tick slips in before the hlt */
        __asm__ volatile("sti; hlt; cli" : : : "memory");
    }
    const uint32_t now_ticks = pc104_ticks;
    __asm__ volatile("sti" : : : "memory");
    return now_ticks;
}
