/* SPDX-License-Identifier: MIT */
#include "bus.h"

#include "../../cards/io.h"

#include <stddef.h>

static struct emu_box *box;
static int opening;
static enum emu_phase phase[EMU_CARDS];

void emu_bus_connect(struct emu_box *b)
{
    box = b;
    opening = 0;
}

void emu_bus_opening(int on)
{
    opening = on;
    for (int i = 0; i < EMU_CARDS; i++) { phase[i] = EMU_PHASE_DETECT; }
}

/* The phase a card is in with this access; value < 0: a read. */
static void follow_s526(enum emu_phase *p, unsigned offset, int32_t value)
{
    if (value < 0) { return; }
    if (offset == 0x34 || (offset == 0x06 && value & 0x6000)) {
        *p = EMU_PHASE_CALIBRATE;
    } else if (*p == EMU_PHASE_DETECT) {
        *p = EMU_PHASE_SELF_TEST;
    }
}

static void follow(uint16_t port, int32_t value)
{
    for (unsigned i = 0; i < EMU_S526S; i++) {
        const unsigned offset = (unsigned)port - box->s526[i].cfg.base;
        if (offset < EMU_S526_PORTS) {
            follow_s526(&phase[i], offset, value);
            emu_enter(box, phase[i]);
            return;
        }
    }
    if ((unsigned)port - box->mm.cfg.base < EMU_MM_PORTS) {
        if (port - box->mm.cfg.base == 7 && value >= 0 && value & 0x02) {
            phase[EMU_MM32XAT] = EMU_PHASE_SELF_TEST;
        }
        emu_enter(box, phase[EMU_MM32XAT]);
    }
}

static uint32_t in(uint16_t port, unsigned width_B)
{
    if (box == NULL) { return 0xFFFF; }
    if (opening) { follow(port, -1); }
    return emu_in(box, port, width_B);
}

static void out(uint16_t port, unsigned width_B, uint16_t value)
{
    if (box == NULL) { return; }
    if (opening) { follow(port, value); }
    emu_out(box, port, width_B, value);
}

uint8_t exh_io_in8(uint16_t port) { return (uint8_t)in(port, 1); }

void exh_io_out8(uint16_t port, uint8_t value) { out(port, 1, value); }

uint16_t exh_io_in16(uint16_t port) { return (uint16_t)in(port, 2); }

void exh_io_out16(uint16_t port, uint16_t value) { out(port, 2, value); }

uint32_t exh_io_time_us(void) { return box ? (uint32_t)(box->time_ns / 1000) : 0; }
