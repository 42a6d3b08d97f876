/* SPDX-License-Identifier: MIT */
/* Machine checks: memory, a cache or a bus has an error that it cannot correct. If CR4.MCE is
 * clear, the processor shuts down: the machine resets or hangs, and the last D/A codes stay. If it
 * is set, exception 18 occurs and ends as every other: outputs safe first. A bank reports what its
 * control register enables. They are set up as in Intel's Software Developer's Manual, volume 3,
 * "Machine-Check Initialization".
 *
 * Intel's processors deliver it to each core and thread, and one that was never started shuts the
 * machine down anyway. So docs/BRINGUP.md requires a single one. */
#include "pc104.h"

#define CPUID_MCE    (1u << 7)
#define CPUID_MCA    (1u << 14)
#define CR4_MCE      (1u << 6)
#define CAP_BANKS    0xFFu
#define CAP_CONTROL  (1u << 8)
#define HIGH_VALID   (1u << 31) /* of the status' upper half */
#define HIGH_ADDRESS (1u << 26)
#define ALL          UINT32_MAX
enum { MCG_CAP = 0x179, MCG_STATUS = 0x17A, MCG_CONTROL = 0x17B };
/* Of bank i, at BANK_AT + 4 i. */
enum { BANK_AT = 0x400, CONTROL = 0, STATUS = 1, ADDRESS = 2 };

static uint8_t banks; /* 0: the processor reports no causes */

static uint32_t get(uint32_t msr, uint32_t *high)
{
    uint32_t low;
    __asm__ volatile("rdmsr" : "=a"(low), "=d"(*high) : "c"(msr));
    return low;
}

static void put(uint32_t msr, uint32_t both)
{
    __asm__ volatile("wrmsr" : : "a"(both), "d"(both), "c"(msr));
}

void pc104_mce_say(const char *what)
{
    for (uint32_t i = 0; i < banks; i++) {
        const uint32_t at = BANK_AT + 4 * i;
        uint32_t high, where_high;
        const uint32_t low = get(at + STATUS, &high);
        if (!(high & HIGH_VALID)) { continue; }
        pc104_say(what);
        pc104_say(" bank ");
        pc104_say_u32(i);
        pc104_say(": status ");
        pc104_say_hex(high);
        pc104_say(" ");
        pc104_say_hex(low);
        if (high & HIGH_ADDRESS) {
            const uint32_t where = get(at + ADDRESS, &where_high);
            pc104_say(", address ");
            pc104_say_hex(where_high);
            pc104_say(" ");
            pc104_say_hex(where);
        }
        pc104_say("\n");
    }
}

/* Bank 0 of family 6 below model 0x1A has its control register from the firmware. */
static uint32_t first_to_enable(uint32_t signature)
{
    const uint32_t family = signature >> 8 & 15u;
    const uint32_t model = (signature >> 4 & 15u) | (signature >> 12 & 0xF0u);
    return family == 6 && model < 0x1A ? 1 : 0;
}

/* Their status outlives a reset: what is there now was the end of the run before. */
static void open_banks(uint32_t signature)
{
    uint32_t high;
    const uint32_t cap = get(MCG_CAP, &high);
    banks = (uint8_t)(cap & CAP_BANKS);
    pc104_mce_say("before this start: machine check");
    if (cap & CAP_CONTROL) { put(MCG_CONTROL, ALL); }
    for (uint32_t i = 0; i < banks; i++) {
        if (i >= first_to_enable(signature)) { put(BANK_AT + 4 * i + CONTROL, ALL); }
        put(BANK_AT + 4 * i + STATUS, 0);
    }
}

void pc104_mce_open(void)
{
    uint32_t eax = 1, ebx, ecx, edx, cr;
    __asm__ volatile("cpuid" : "+a"(eax), "=b"(ebx), "=c"(ecx), "=d"(edx));
    if (!(edx & CPUID_MCE)) { return; }
    if (edx & CPUID_MCA) { open_banks(eax); }
    __asm__ volatile("movl %%cr4, %0" : "=r"(cr));
    __asm__ volatile("movl %0, %%cr4" : : "r"(cr | CR4_MCE));
}

/* The processor shuts down at a second one that comes before this. */
void pc104_mce_taken(void)
{
    if (banks) { put(MCG_STATUS, 0); }
}
