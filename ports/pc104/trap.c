/* SPDX-License-Identifier: MIT */
#include "pc104.h"

#include "io.h"

#define VECTORS        64 /* 32 exceptions, 16 lines of the 8259 pair, 16 of the local APIC */
#define IRQ_BASE       32
#define GATE_INTERRUPT 0x8E00u /* present, ring 0, 32-bit, interrupts off inside */
#define GATE_TASK      0x8500u
#define CODE_SEGMENT   0x08u
#define FAULT_TASK     0x20u
#define DOUBLE_FAULT   8u
#define PAGE_FAULT     14u
#define MACHINE_CHECK  18u

enum { PIC1 = 0x20, PIC1_MASK = 0x21, PIC2 = 0xA0, PIC2_MASK = 0xA1 };

struct gate {
    uint16_t offset_low, segment, type, offset_high;
};
static struct gate gates[VECTORS];

extern const char pc104_vectors[VECTORS][16]; /* vectors.S: code, one stub each */
extern const char pc104_irq0[], pc104_irq7[], pc104_irq15[], pc104_second_irq[],
    pc104_apic_spurious[];

static void set_gate(unsigned vector, const char *entry)
{
    const uint32_t at = (uint32_t)entry;
    gates[vector] =
        (struct gate){(uint16_t)(at & 0xFFFFu), CODE_SEGMENT, GATE_INTERRUPT, (uint16_t)(at >> 16)};
}

/* The 8259 pair starts out on vectors that exceptions use: move it, and mask all
 * lines but the timer's. */
static void open_pic(void)
{
    pc104_out8(PIC1, 0x11); /* initialise, cascaded, edge, four words */
    pc104_out8(PIC2, 0x11);
    pc104_out8(PIC1_MASK, IRQ_BASE);
    pc104_out8(PIC2_MASK, IRQ_BASE + 8);
    pc104_out8(PIC1_MASK, 1u << 2); /* the second one is connected to line 2 */
    pc104_out8(PIC2_MASK, 2);
    pc104_out8(PIC1_MASK, 1); /* 8086 mode, explicit end of interrupt */
    pc104_out8(PIC2_MASK, 1);
    pc104_out8(PIC1_MASK, 0xFE);
    pc104_out8(PIC2_MASK, 0xFF);
}

void pc104_trap_open(void)
{
    struct {
        uint16_t limit, low, high; /* in words: the base is not aligned */
    } idtr;
    const uint32_t base = (uint32_t)gates;

    for (unsigned v = 0; v < VECTORS; v++) { set_gate(v, pc104_vectors[v]); }
    gates[DOUBLE_FAULT] = (struct gate){0, FAULT_TASK, GATE_TASK, 0};
    set_gate(IRQ_BASE + 0, pc104_irq0);
    set_gate(IRQ_BASE + 7, pc104_irq7);
    set_gate(IRQ_BASE + 15, pc104_irq15);
    set_gate(PC104_VECTOR_SECOND, pc104_second_irq);
    set_gate(PC104_VECTOR_SPURIOUS, pc104_apic_spurious);
    idtr.limit = sizeof gates - 1;
    idtr.low = (uint16_t)(base & 0xFFFFu);
    idtr.high = (uint16_t)(base >> 16);
    __asm__ volatile("lidt %0" : : "m"(idtr), "m"(gates));
    open_pic();
}

/* --- what went wrong; outputs are safe before the first word of it --- */

static void stop_first(void)
{
    exh_board_safe();
    pc104_log_flush(); /* the last records show the cause */
}

static const char *name_of(uint32_t vector)
{
    static const char *const name[] = {"divide error", "debug", "NMI", "breakpoint", "overflow",
        "bound", "invalid opcode", "no FPU", "double fault", "FPU segment", "invalid TSS",
        "segment not present", "stack segment", "general protection", "page fault", "reserved",
        "FPU error", "alignment", "machine check", "SIMD error"};
    return vector < sizeof name / sizeof name[0] ? name[vector] : "unexpected interrupt";
}

static uint32_t fault_address(void)
{
    uint32_t cr2;
    __asm__ volatile("movl %%cr2, %0" : "=r"(cr2));
    return cr2;
}

static void say_where(const char *what, uint32_t vector, uint32_t error, uint32_t eip)
{
    pc104_say(what);
    pc104_say(", vector ");
    pc104_say_u32(vector);
    pc104_say(", error ");
    pc104_say_hex(error);
    pc104_say(", eip ");
    pc104_say_hex(eip);
    if (vector == PAGE_FAULT || vector == DOUBLE_FAULT) {
        pc104_say(", address ");
        pc104_say_hex(fault_address());
    }
    pc104_say(", tick ");
    pc104_say_u32(pc104_tick());
    pc104_say("\n");
}

void pc104_fault(struct pc104_frame frame)
{
    if (frame.vector == MACHINE_CHECK) { pc104_mce_taken(); }
    stop_first();
    say_where(name_of(frame.vector), frame.vector, frame.error, frame.eip);
    if (frame.vector == MACHINE_CHECK) { pc104_mce_say("machine check"); }
    pc104_halt(PC104_EXIT_FAULT, "processor exception");
}

/* What it interrupted may have been what makes the outputs safe. */
void pc104_fault_again(void)
{
    exh_board_safe();
    pc104_halt(PC104_EXIT_FAULT, "another exception while one was dealt with");
}

void pc104_double_fault(void)
{
    stop_first();
    say_where(pc104_guard_hit(fault_address()) ? "stack overflow" : name_of(DOUBLE_FAULT),
        DOUBLE_FAULT, 0, pc104_guard_eip());
    pc104_halt(PC104_EXIT_FAULT, "processor exception");
}

void pc104_hung(uint32_t eip)
{
    stop_first();
    say_where("tick does not end", IRQ_BASE, pc104_ticks - pc104_tick_began, eip);
    pc104_halt(PC104_EXIT_OVERLOAD, "overload: a tick hangs");
}
