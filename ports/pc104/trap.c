#include "pc104.h"

#include "exhand/board.h"
#include "io.h"

#define VECTORS        48 /* 32 exceptions, then the 16 lines of the 8259 pair */
#define IRQ_BASE       32
#define GATE_INTERRUPT 0x8E00u /* present, ring 0, 32-bit, interrupts off inside */
#define CODE_SEGMENT   0x08u

enum { PIC1 = 0x20, PIC1_MASK = 0x21, PIC2 = 0xA0, PIC2_MASK = 0xA1 };

struct gate {
    uint16_t offset_low, segment, type, offset_high;
};
static struct gate gates[VECTORS];

extern const char pc104_vectors[VECTORS][16]; /* vectors.S: code, one stub each */
extern const char pc104_irq0[], pc104_irq7[];

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
    pc104_out8(PIC1_MASK, 1u << 2); /* the second one hangs on line 2 */
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

    for (unsigned v = 0; v < VECTORS; v++) {
        set_gate(v, pc104_vectors[v]);
    }
    set_gate(IRQ_BASE + 0, pc104_irq0);
    set_gate(IRQ_BASE + 7, pc104_irq7);
    idtr.limit = sizeof gates - 1;
    idtr.low = (uint16_t)(base & 0xFFFFu);
    idtr.high = (uint16_t)(base >> 16);
    __asm__ volatile("lidt %0" : : "m"(idtr), "m"(gates));
    open_pic();
}

void pc104_fault(uint32_t vector, uint32_t error, uint32_t eip)
{
    exh_board_safe(); /* first of all */
    pc104_say("processor exception, vector ");
    pc104_say_u32(vector);
    pc104_say(", error ");
    pc104_say_hex(error);
    pc104_say(", at ");
    pc104_say_hex(eip);
    pc104_say("\n");
    exh_board_halt("processor exception");
}
