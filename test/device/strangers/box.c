/* SPDX-License-Identifier: MIT */
/* Box: the emulated cards of ports/posix/emu and their pins, for WebAssembly: what run.mjs calls.
 * Linked with the emulator's own objects, which are compiled unchanged.
 */
#include "emu.h"

#include <stddef.h>

#define EXPORT(name) __attribute__((export_name(#name))) name

static struct emu_box box;

void *memset(void *dst, int value, size_t len_B)
{
    unsigned char *d = dst;
    while (len_B--) { *d++ = (unsigned char)value; }
    return dst;
}

void *memcpy(void *restrict dst, const void *restrict src, size_t len_B)
{
    unsigned char *d = dst;
    const unsigned char *s = src;
    while (len_B--) { *d++ = *s++; }
    return dst;
}

/* Power off and on. The signals on the pins stay. The fault begins immediately. */
void EXPORT(box_open)(uint32_t kind, uint32_t card)
{
    const struct emu_pins before = box.pins;
    struct emu_config c = emu_box_config();
    c.fault.kind = (uint8_t)kind;
    c.fault.card = (uint8_t)card;
    emu_box_open(&box, &c);
    memcpy(box.pins.enc_cnt, before.enc_cnt, sizeof before.enc_cnt);
    memcpy(box.pins.ad_uV, before.ad_uV, sizeof before.ad_uV);
    memcpy(box.pins.glove_uV, before.glove_uV, sizeof before.glove_uV);
    memcpy(box.pins.din, before.din, sizeof before.din);
}

uint32_t EXPORT(box_in)(uint32_t port, uint32_t width_B)
{
    return emu_in(&box, (uint16_t)port, width_B);
}

void EXPORT(box_out)(uint32_t port, uint32_t width_B, uint32_t value)
{
    emu_out(&box, (uint16_t)port, width_B, value);
}

void EXPORT(box_advance_ns)(uint32_t ns) { emu_advance_ns(&box, ns); }

/* 1: the MM-32X-AT's interrupt line is up. */
uint32_t EXPORT(box_interrupt)(void) { return box.mm.flags != 0; }

/* A pin by the number that guest/pin.h gives it; high byte: which kind of pin. */
int32_t EXPORT(box_pin)(uint32_t n)
{
    const unsigned i = n & 0x1F;
    const unsigned axis = i & 3, card = i >> 2 & 1;
    switch (n >> 8) {
    case 0: return box.pins.enc_cnt[card][axis];
    case 1: return box.pins.ad_uV[i >> 3 & 1][i & 7];
    case 2: return box.pins.glove_uV[i];
    case 3: return box.pins.din[i & 1];
    case 4: return box.pins.da_uV[card][axis];
    case 5: return box.pins.dout[i & 1];
    case 6: return box.mm.da_out[axis];
    case 7: return box.mm.port[axis];
    default: return -1;
    }
}

void EXPORT(box_set_pin)(uint32_t n, int32_t value)
{
    const unsigned i = n & 0x1F;
    switch (n >> 8) {
    case 0: box.pins.enc_cnt[i >> 2 & 1][i & 3] = value; break;
    case 1: box.pins.ad_uV[i >> 3 & 1][i & 7] = value; break;
    case 2: box.pins.glove_uV[i] = value; break;
    case 3: box.pins.din[i & 1] = (uint8_t)value; break;
    default: break;
    }
}
