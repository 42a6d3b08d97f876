/* SPDX-License-Identifier: MIT */
/* The local APIC's timer: another clock than the one that makes the ticks, in the processor
 * itself. Armed while the loop sleeps; it fires only when no tick came for several periods. Its
 * frequency is known to no register, so it is taken from the ticks' clock, and only roughly. */
#include "pc104.h"

#include "exhand/fix.h"

#define BASE 0xFEE00000u
enum {
    VERSION = 0x30,
    END = 0xB0,
    SPURIOUS = 0xF0,
    LVT_TIMER = 0x320,
    LVT_LINT0 = 0x350,
    LVT_LINT1 = 0x360,
    INITIAL = 0x380,
    CURRENT = 0x390,
    DIVIDE = 0x3E0
};
#define APIC_ENABLE   (1u << 8)
#define LVT_MASKED    (1u << 16)
#define LINT_EXTINT   0x700u /* the 8259 goes on as if there were no APIC */
#define LINT_NMI      0x400u
#define DIVIDE_BY_16  0x3u
#define MSR_APIC_BASE 0x1Bu
#define MSR_APIC_ON   (1u << 11)
#define CPUID_MSR     (1u << 5)
#define CPUID_APIC    (1u << 9)
#define PATIENCE      4u /* periods without a tick, and 1 ms more */

static uint32_t patience; /* counts; 0: there is no second clock */

static uint32_t get(unsigned reg) { return *(volatile uint32_t *)(BASE + reg); }

static void put(unsigned reg, uint32_t value) { *(volatile uint32_t *)(BASE + reg) = value; }

static int is_there(void)
{
    uint32_t a = 1, b, c = 0, d, low, high;
    __asm__ volatile("cpuid" : "+a"(a), "=b"(b), "+c"(c), "=d"(d));
    if ((d & (CPUID_MSR | CPUID_APIC)) != (CPUID_MSR | CPUID_APIC)) { return 0; }
    __asm__ volatile("rdmsr" : "=a"(low), "=d"(high) : "c"(MSR_APIC_BASE));
    if (!(low & MSR_APIC_ON) || (low & 0xFFFFF000u) != BASE) { return 0; }
    return (get(VERSION) & 0xF0u) == 0x10u; /* built in, as all of them are */
}

int pc104_second_open(uint32_t (*now)(void), uint32_t Hz, uint32_t period)
{
    const uint32_t window = Hz / 500; /* 2 ms */
    const uint64_t wait = (uint64_t)PATIENCE * period + Hz / 1000;
    uint32_t began, used;
    uint64_t counts;

    patience = 0;
    if (!is_there()) { return 0; }
    put(SPURIOUS, APIC_ENABLE | PC104_VECTOR_SPURIOUS);
    put(LVT_LINT0, LINT_EXTINT);
    put(LVT_LINT1, LINT_NMI);
    put(LVT_TIMER, LVT_MASKED | PC104_VECTOR_SECOND);
    put(DIVIDE, DIVIDE_BY_16);
    put(INITIAL, UINT32_MAX);
    began = now();
    while (now() - began < window) {} /* the clock was seen to count */
    used = UINT32_MAX - get(CURRENT);
    put(INITIAL, 0);
    if (used < 1000) { return 0; } /* 2 ms of nothing: less than 8 MHz before division */
    counts = exh_udiv64(wait * used, window, NULL);
    patience = counts < UINT32_MAX ? (uint32_t)counts : UINT32_MAX;
    put(LVT_TIMER, PC104_VECTOR_SECOND); /* once */
    return 1;
}

void pc104_second_arm(void)
{
    pc104_second_fired = 0;
    if (patience) { put(INITIAL, patience); }
}

void pc104_second_disarm(void)
{
    if (patience) { put(INITIAL, 0); }
}
