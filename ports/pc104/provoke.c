/* SPDX-License-Identifier: MIT */
/* Failures on request (provoke=NAME provoke_at=TICK): commissioning shows with them, on the real
 * box, that each ends with the outputs safe. */
#include "pc104.h"

#include "exhand/error.h"
#include "io.h"

static void spend(uint32_t periods_q1)
{
    const uint32_t began = pc104_timer_now();
    while (pc104_timer_now() - began < pc104_timer_counts() / 2 * periods_q1) {}
}

static void processor(int32_t what)
{
    static const uint32_t rom = 1;
    union {
        const uint32_t *view;
        volatile uint32_t *to;
    } u = {&rom};
    uint32_t at = 16;
    if (what == PC104_PROVOKE_DIVIDE) {
        __asm__ volatile("xorl %%ecx, %%ecx; divl %%ecx" : : : "eax", "ecx", "edx");
    } else if (what == PC104_PROVOKE_OPCODE || what == PC104_PROVOKE_TWICE) {
        __asm__ volatile("ud2");
    } else if (what == PC104_PROVOKE_NULL) {
        __asm__ volatile("movl (%0), %0" : "+r"(at));
    } else if (what == PC104_PROVOKE_WRITE) {
        *u.to = 2;
    } else if (what == PC104_PROVOKE_STACK) {
        __asm__ volatile("1: pushl %eax; jmp 1b");
    } else if (what == PC104_PROVOKE_NMI) {
        __asm__ volatile("int $2");
    } else if (what == PC104_PROVOKE_MCE) {
        __asm__ volatile("int $18");
    } else if (what == PC104_PROVOKE_SPURIOUS) {
        __asm__ volatile("int $39; int $47"); /* lines 7 and 15 of the 8259 pair */
    }
}

void pc104_provoke(int32_t what)
{
    if (what == PC104_PROVOKE_TIMER) { pc104_timer_kill(); }
    if (what == PC104_PROVOKE_MASK) { pc104_out8(0x21, 0xFF); } /* the 8259's, for good */
    if (what == PC104_PROVOKE_ASSERT) { EXH_ASSERT(what == PC104_PROVOKE_NONE); }
    if (what == PC104_PROVOKE_SLOW) {
        pc104_par.provoke_tick = pc104_par.provoke_tick + 1; /* this tick and all that follow */
        spend(3);
    }
    while (what == PC104_PROVOKE_HANG) {}
    if (what == PC104_PROVOKE_IDLE) { pc104_timer_hang(); }
    if (what == PC104_PROVOKE_RESET && !pc104_restart_fired()) {
        pc104_out8(0x64, 0xFE); /* the keyboard controller's line to the processor's reset */
        for (;;) {}
    }
    processor(what);
}
