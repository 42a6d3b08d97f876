/* SPDX-License-Identifier: MIT */
/* Cards of the host program, instead of ports/posix/cards.c. The device shows its codes on the
 * cards' connectors as it does there, but Linux's drivers read and write the cards. It runs inside
 * the machine. comedi 0, 1, 2 are the cards A, B and MM-32X-AT, attached.
 */
#include "../../../ports/posix/cards.h"

#include "guest/check.h"
#include "guest/linux.h"
#include "guest/pin.h"

#include <errno.h>
#include <string.h>

#define QUADRATURE_X4 0x0480

static struct {
    struct emu_box none; /* the emulator is outside the machine */
    unsigned fingers;
} cards;

struct emu_box *posix_cards_box(void) { return &cards.none; }

/* There is no watch here. */
const struct posix_cards_watch *posix_cards_watch(void)
{
    static const struct posix_cards_watch nothing;
    return &nothing;
}

/* --- wiring: docs/CARDS.md, but for one finger's supply, see supply() --- */

static unsigned card_of(unsigned finger) { return finger < EMU_AXES ? A : B; }

static unsigned axis_of(unsigned finger) { return finger % EMU_AXES; }

static unsigned common(void) { return cards.fingers > 1 ? B : A; }

/* One finger: channel 1 instead of 4, since Debian's driver reads no channels but 0 and 1. */
static unsigned supply(void) { return cards.fingers > 1 ? 4 : 1; }

static void show_drive(const struct exh_drive_in *in)
{
    int32_t din[2] = {0, 0};
    for (unsigned i = 0; i < cards.fingers; i++) {
        const unsigned card = card_of(i), axis = axis_of(i);
        set_pin(PIN_ENC + 4 * card + axis, (int32_t)in->enc_raw[i]);
        set_pin(PIN_AD + 8 * card + axis, emu_ad_uV(in->mon_raw[i]));
        din[card] |= (int32_t)((in->din / EXH_DIN_DRIVE0 >> i & 1) << axis);
    }
    din[common()] |= (in->din & EXH_DIN_ESTOP ? 2 : 0) | (in->din & EXH_DIN_DEADMAN ? 4 : 0) |
                     (in->din & EXH_DIN_WATCHDOG ? 8 : 0);
    set_pin(PIN_AD + 8 * common() + supply(), emu_ad_uV(in->supply_raw));
    set_pin(PIN_DIN + A, din[A]);
    set_pin(PIN_DIN + B, din[B]);
}

static void see_drive(struct exh_drive_out *seen)
{
    memset(seen, 0, sizeof *seen);
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        const unsigned card = card_of(i), axis = axis_of(i);
        seen->dac_raw[i] = emu_da_code(pin(PIN_DA + 4 * card + axis));
        seen->enable |= (uint8_t)((pin(PIN_DOUT + card) >> (4 + axis) & 1) << i);
    }
    if (cards.fingers == 1) { seen->enable &= 1; }
    seen->alive = (uint8_t)(pin(PIN_DOUT + common()) >> 5 & 1);
}

/* --- through Linux --- */

static void put_lines(unsigned enable, unsigned alive)
{
    for (unsigned card = A; card <= common(); card++) {
        uint32_t bits = 0;
        for (unsigned i = 0; i < cards.fingers; i++) {
            if (card_of(i) == card) { bits |= (enable >> i & 1u) << (4 + axis_of(i)); }
        }
        if (card == common()) { bits |= alive << 5; }
        (void)lines(card, S526_DIO, 0xF0, bits);
    }
}

static void put_outputs(const struct exh_drive_out *out)
{
    for (unsigned i = 0; i < cards.fingers; i++) {
        put(card_of(i), S526_AO, axis_of(i), out->dac_raw[i]);
    }
    put_lines(out->enable, out->alive);
}

int cards_start(const struct posix_cards *c, unsigned fingers, int glove)
{
    (void)c;
    (void)glove;
    memset(&cards, 0, sizeof cards);
    cards.fingers = fingers;
    if (iopl(3)) { return -errno; }
    for (unsigned i = 0; i < fingers; i++) {
        set_pin(PIN_ENC + 4 * card_of(i) + axis_of(i), 0);
        config(
            card_of(i), GPCT, axis_of(i), 3, INSN_CONFIG_GPCT_QUADRATURE_ENCODER, QUADRATURE_X4, 0);
    }
    for (unsigned card = A; card <= common(); card++) {
        config(card, S526_DIO, 0, 1, INSN_CONFIG_DIO_INPUT, 0, 0);
        config(card, S526_DIO, 4, 1, INSN_CONFIG_DIO_OUTPUT, 0, 0);
        for (unsigned axis = 0; axis < EMU_AXES; axis++) { put(card, S526_AO, axis, 32768); }
    }
    put_lines(0, 0);
    return 0;
}

void cards_at(double t_s) { (void)t_s; /* the cards' time is the machine's */ }

static int16_t ad(unsigned card, unsigned channel)
{
    return (int16_t)((int32_t)get(card, S526_AI, channel, 0) - 32768);
}

int cards_read_drive(struct exh_drive_in *in)
{
    uint32_t pins[2] = {0, 0};
    show_drive(in);
    memset(in, 0, sizeof *in);
    for (unsigned card = A; card <= common(); card++) { pins[card] = lines(card, S526_DIO, 0, 0); }
    for (unsigned i = 0; i < cards.fingers; i++) {
        const unsigned card = card_of(i), axis = axis_of(i);
        in->enc_raw[i] = get(card, GPCT, axis, 0);
        in->mon_raw[i] = ad(card, axis);
        in->din |= (pins[card] >> axis & 1) * ((uint32_t)EXH_DIN_DRIVE0 << i);
    }
    in->supply_raw = ad(common(), supply());
    in->din |= (pins[common()] & 2 ? (uint32_t)EXH_DIN_ESTOP : 0) |
               (pins[common()] & 4 ? (uint32_t)EXH_DIN_DEADMAN : 0) |
               (pins[common()] & 8 ? (uint32_t)EXH_DIN_WATCHDOG : 0) | EXH_DIN_CARDS;
    return 0;
}

int cards_write_drive(const struct exh_drive_out *out, struct exh_drive_out *seen)
{
    put_outputs(out);
    see_drive(seen);
    return 0;
}

int cards_read_glove(int16_t code[EXH_GLOVE_SENSORS])
{
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        set_pin(PIN_GLOVE + i, emu_ad_uV(code[i]));
        code[i] = (int16_t)((int32_t)get(MM, MM_AI, i, 2) - 32768);
    }
    return 0;
}

void cards_safe(struct exh_drive_out *seen)
{
    struct exh_drive_out zero;
    memset(&zero, 0, sizeof zero);
    for (unsigned i = 0; i < EXH_FINGERS; i++) { zero.dac_raw[i] = 32768; }
    put_outputs(&zero);
    see_drive(seen);
}
