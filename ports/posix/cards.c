/* SPDX-License-Identifier: MIT */
#include "cards.h"

#include "emu/bus.h"

#include "../cards/box.h"

#include "exhand/bytes.h"

#include <stdio.h>
#include <string.h>

static struct {
    struct emu_box box;
    struct posix_cards cfg;
    unsigned fingers;
    uint64_t start_ns; /* when the first tick is */
    int said;
    struct posix_cards_watch watch;
} cards;

const struct posix_cards_watch *posix_cards_watch(void) { return &cards.watch; }

struct emu_box *posix_cards_box(void) { return &cards.box; }

/* --- wiring (docs/CARDS.md), seen from the device --- */

static unsigned card_of(unsigned finger) { return finger < EMU_AXES ? EMU_S526_A : EMU_S526_B; }

static unsigned axis_of(unsigned finger) { return finger % EMU_AXES; }

/* Where e-stop, dead-man, the watchdog's contact and supply are. */
static unsigned common(void) { return cards.fingers > 1 ? EMU_S526_B : EMU_S526_A; }

static void show_drive(const struct exh_drive_in *in)
{
    struct emu_pins *p = &cards.box.pins;
    p->din[EMU_S526_A] = p->din[EMU_S526_B] = 0;
    for (unsigned i = 0; i < cards.fingers; i++) {
        const unsigned card = card_of(i), axis = axis_of(i);
        p->enc_cnt[card][axis] = (int32_t)in->enc_raw[i];
        p->ad_uV[card][axis] = emu_ad_uV(in->mon_raw[i]);
        p->din[card] |= (uint8_t)((in->din / EXH_DIN_DRIVE0 >> i & 1) << axis);
    }
    p->din[common()] |= (uint8_t)(in->din & EXH_DIN_ESTOP ? 2 : 0);
    p->din[common()] |= (uint8_t)(in->din & EXH_DIN_DEADMAN ? 4 : 0);
    p->din[common()] |= (uint8_t)(in->din & EXH_DIN_WATCHDOG ? 8 : 0);
    p->ad_uV[common()][4] = emu_ad_uV(in->supply_raw);
}

static void see_drive(struct exh_drive_out *seen)
{
    const struct emu_pins *p = &cards.box.pins;
    memset(seen, 0, sizeof *seen);
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        const unsigned card = card_of(i), axis = axis_of(i);
        seen->dac_raw[i] = emu_da_code(p->da_uV[card][axis]);
        seen->enable |= (uint8_t)((p->dout[card] >> (4 + axis) & 1) << i);
    }
    if (cards.fingers == 1) { seen->enable &= 1; } /* its other lines mean something else */
    seen->alive = p->dout[common()] >> 5 & 1;
}

/* The farthest any enabled drive's code is from 0 A. */
static uint16_t farthest(const struct exh_drive_out *o)
{
    uint16_t most_raw = 0;
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        const int32_t off = (int32_t)o->dac_raw[i] - 32768;
        const uint16_t raw = (uint16_t)(off < 0 ? -off : off);
        if (o->enable >> i & 1 && raw > most_raw) { most_raw = raw; }
    }
    return most_raw;
}

/* What the device sees after a tick. */
static void watch(struct exh_drive_out *seen)
{
    struct posix_cards_watch *w = &cards.watch;
    see_drive(seen);
    w->ticks++;
    w->digest = exh_crc32(w->digest, seen->dac_raw, sizeof seen->dac_raw);
    w->digest = exh_crc32(w->digest, &seen->enable, 1);
    w->now_raw = farthest(seen);
    if (w->now_raw > w->most_raw) { w->most_raw = w->now_raw; }
    if (w->now_raw > POSIX_CARDS_REST_RAW) { w->pressed = w->ticks; }
}

/* --- the box --- */

static int say(int err)
{
    char text[160];
    if (err == 0 || cards.cfg.quiet || cards.said++ || exh_box_error()->code == 0) { return err; }
    (void)exh_box_error_text(text, sizeof text, exh_box_error());
    fprintf(stderr, "exhand: %s\n", text);
    return err;
}

/* A box left open by a run before would be made safe on the new cards. */
static void close_box(void)
{
    static const struct exh_box_config none;
    emu_bus_connect(NULL);
    (void)exh_box_open(&none, NULL);
}

int cards_start(const struct posix_cards *c, unsigned fingers, int glove)
{
    struct emu_config e = emu_box_config();
    struct exh_box_config b = exh_box_default;
    int err;
    close_box();
    memset(&cards, 0, sizeof cards);
    cards.cfg = *c;
    cards.fingers = fingers;
    e.fault = c->fault;
    e.s526[1].present = fingers > 1;
    emu_box_open(&cards.box, &e);
    emu_bus_connect(&cards.box);
    b.s526_base[0] = e.s526[0].base;
    b.s526_base[1] = e.s526[1].base;
    b.mm32xat_base = e.mm.base;
    b.fingers = (uint8_t)fingers;
    b.glove = glove ? EXH_BOX_NOW : EXH_BOX_NEVER;
    emu_bus_opening(1);
    err = exh_box_open(&b, NULL);
    emu_bus_opening(0);
    if (c->how == POSIX_CARDS_INSTANT) { emu_hasten(&cards.box); }
    cards.start_ns = cards.box.time_ns;
    return say(err);
}

void cards_at(double t_s)
{
    const uint64_t at_ns = cards.start_ns + (uint64_t)(t_s * 1e9 + 0.5);
    if (at_ns > cards.box.time_ns) { emu_advance_ns(&cards.box, at_ns - cards.box.time_ns); }
}

int cards_read_drive(struct exh_drive_in *in)
{
    show_drive(in);
    emu_enter(&cards.box, EMU_PHASE_READ);
    return say(exh_box_read_drive(in));
}

int cards_write_drive(const struct exh_drive_out *out, struct exh_drive_out *seen)
{
    int err;
    emu_enter(&cards.box, EMU_PHASE_WRITE);
    err = exh_box_write_drive(out);
    watch(seen);
    return say(err);
}

int cards_read_glove(int16_t code[EXH_GLOVE_SENSORS])
{
    struct exh_glove_in in;
    int err;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        cards.box.pins.glove_uV[i] = emu_ad_uV(code[i]);
    }
    emu_enter(&cards.box, EMU_PHASE_READ);
    err = exh_box_read_glove(&in);
    if (err == 0) { memcpy(code, in.raw, sizeof in.raw); }
    return say(err);
}

void cards_safe(struct exh_drive_out *seen)
{
    emu_enter(&cards.box, EMU_PHASE_SAFE);
    exh_box_safe();
    see_drive(seen);
    cards.watch.now_raw = farthest(seen);
}
