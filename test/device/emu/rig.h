/* SPDX-License-Identifier: MIT */
/* A box on the bus, and accesses as the sources of the facts write them. */
#ifndef TEST_EMU_RIG_H
#define TEST_EMU_RIG_H

#include "../../../ports/posix/emu/emu.h"

#include "check.h"

#define A      0x2C0u
#define B      0x280u
#define MM     0x300u
#define DIM(a) (sizeof(a) / sizeof((a)[0]))

static struct emu_box box;

static inline void power_on(void)
{
    const struct emu_config c = emu_box_config();
    emu_box_open(&box, &c);
}

/* With one fault, there from the first access of its card on. */
static inline void power_on_with(enum emu_kind kind, enum emu_card card, unsigned axis)
{
    struct emu_config c = emu_box_config();
    c.fault.kind = (uint8_t)kind;
    c.fault.card = (uint8_t)card;
    c.fault.axis = (uint8_t)axis;
    emu_box_open(&box, &c);
}

static inline uint32_t inw(unsigned port) { return emu_in(&box, (uint16_t)port, 2); }
static inline void outw(uint32_t value, unsigned port) { emu_out(&box, (uint16_t)port, 2, value); }
static inline uint32_t inb(unsigned port) { return emu_in(&box, (uint16_t)port, 1); }
static inline void outb(uint32_t value, unsigned port) { emu_out(&box, (uint16_t)port, 1, value); }

/* Reads a port until the bits of mask are `want`: reads it took, 0 if never. */
static inline uint32_t poll(unsigned port, unsigned width_B, uint32_t mask, uint32_t want)
{
    for (uint32_t n = 1; n <= 1000; n++) {
        if ((emu_in(&box, (uint16_t)port, width_B) & mask) == want) { return n; }
    }
    return 0;
}

static inline void pass_us(uint32_t us) { emu_advance_ns(&box, (uint64_t)us * 1000); }

#endif
