/* SPDX-License-Identifier: MIT */
/* The emulated cards inside an image, instead of its port instructions, with a device of integers
 * behind them. Strings are pulled out and let in in turn, so that they meet and leave walls. It is
 * for emulators of the machine that have no such cards. The drivers, the timer and its interrupt
 * are the image's. It is a load under which a period is kept, not a model of a device. */
#include "cards/io.h"

#include "posix/emu/emu.h"

#include "exhand/run/scene.h"

#define HOLD_TICKS 4096u /* so often the dead-man switch is let go, */
#define OPEN_TICKS 300u  /* for so long */
#define TURN_TICKS 2048u /* drawn out so long, then let in */
#define PULL_Q16   200   /* counts per tick and tick */
#define DA_CONTROL 0x04u /* of an S526; its bit 0 updates the outputs: a tick's last word */

extern const struct exh_scene EXH_SCENE;

static struct emu_box box;
static struct string {
    int32_t at_q16, speed_q16; /* counts, counts per tick */
} string[EXH_FINGERS];
static uint32_t ticks, last_us;
static int on;

/* Healthy; A 2 is the third finger's drive, or, with one finger, the dead-man switch. */
static void lines(void)
{
    const unsigned held = ticks % HOLD_TICKS >= OPEN_TICKS ? 4 : 0;
    box.pins.din[0] = (uint8_t)(EXH_SCENE.fingers > 1 ? 0xF : 0xB | held);
    box.pins.din[1] = (uint8_t)(0xB | held);
}

static void power_on(void)
{
    struct emu_config c = emu_box_config();
    c.s526[1].present = EXH_SCENE.fingers > 1; /* a box of one finger has A alone */
    emu_box_open(&box, &c);
    on = 1;
    lines();
}

/* What the finger is drawn by, less what the motor does. */
static void step(unsigned i)
{
    struct string *s = &string[i];
    const unsigned card = i / EMU_AXES, axis = i % EMU_AXES;
    const unsigned enabled = box.pins.dout[card] >> (4 + axis) & 1;
    const int32_t draw = EXH_SCENE.setup ? PULL_Q16 : 0; /* the contract's box is idle */
    const int32_t pull = (ticks / TURN_TICKS & 1) ? -draw : draw;
    const int32_t motor = box.pins.da_uV[card][axis] / 32768; /* 114 at 3.75 V */
    s->speed_q16 += pull - motor - s->speed_q16 / 512;
    s->at_q16 += s->speed_q16;
    if (s->at_q16 < 0) { s->at_q16 = s->speed_q16 = 0; }
    if (s->at_q16 > 3000 << 16) {
        s->at_q16 = 3000 << 16;
        s->speed_q16 = 0;
    }
    box.pins.enc_cnt[card][axis] = s->at_q16 / 65536;
    /* The monitor: 1.76 A/V by 0.591 V/A. */
    box.pins.ad_uV[card][axis] =
        enabled ? box.pins.da_uV[card][axis] + box.pins.da_uV[card][axis] / 25 : 0;
}

/* The cards' clock goes on with their accesses, a microsecond each, and here up to the timer's. */
static void next_tick(void)
{
    const uint32_t now_us = exh_io_time_us(), passed_us = now_us - last_us;
    if (passed_us < 1000000u) { emu_advance_ns(&box, (uint64_t)passed_us * 1000); }
    last_us = now_us;
    ticks++;
    for (unsigned i = 0; i < EXH_FINGERS; i++) { step(i); }
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        box.pins.glove_uV[i] = (int32_t)(ticks % TURN_TICKS) * 1000 - 1000000;
    }
    lines();
}

uint8_t exh_io_in8(uint16_t port)
{
    if (!on) { power_on(); }
    return (uint8_t)emu_in(&box, port, 1);
}

void exh_io_out8(uint16_t port, uint8_t value)
{
    if (!on) { power_on(); }
    emu_out(&box, port, 1, value);
}

uint16_t exh_io_in16(uint16_t port)
{
    if (!on) { power_on(); }
    return (uint16_t)emu_in(&box, port, 2);
}

void exh_io_out16(uint16_t port, uint16_t value)
{
    if (!on) { power_on(); }
    emu_out(&box, port, 2, value);
    if (port == box.s526[0].cfg.base + DA_CONTROL && value & 1) { next_tick(); }
}
