/* SPDX-License-Identifier: MIT */
#include "emu.h"

#include <stddef.h>

void *memset(void *dst, int value, size_t len_B);

#define POWER_ON_NS 1000000u

struct emu_config emu_box_config(void)
{
    struct emu_config c;
    memset(&c, 0, sizeof c);
    c.s526[0] = c.s526[1] = emu_s526_nominal();
    c.mm = emu_mm32xat_nominal();
    c.s526[0].base = 0x2C0;
    c.s526[1].base = 0x280;
    c.mm.base = 0x300;
    c.s526[0].present = c.s526[1].present = c.mm.present = 1;
    c.access8_ns = c.access16_ns = 1000;
    return c;
}

void emu_box_open(struct emu_box *b, const struct emu_config *c)
{
    memset(b, 0, sizeof *b);
    for (unsigned i = 0; i < EMU_S526S; i++) {
        emu_s526_reset(&b->s526[i], &c->s526[i], &b->pins, i);
    }
    emu_mm32xat_reset(&b->mm, &c->mm);
    b->access8_ns = c->access8_ns;
    b->access16_ns = c->access16_ns;
    b->fault = c->fault;
    b->time_ns = POWER_ON_NS;
}

/* --- what is wrong --- */

void emu_enter(struct emu_box *b, enum emu_phase phase) { b->phase = (uint8_t)phase; }

static uint8_t is_wrong(const struct emu_box *b, unsigned card, enum emu_kind kind)
{
    return b->wrong && b->fault.card == card && b->fault.kind == kind;
}

static struct emu_s526_wrong s526_wrong(const struct emu_box *b, unsigned card)
{
    const uint8_t line = (uint8_t)(1u << (b->fault.axis & (EMU_AXES - 1)));
    struct emu_s526_wrong w;
    memset(&w, 0, sizeof w);
    w.busy = is_wrong(b, card, EMU_BUSY);
    w.lost = is_wrong(b, card, EMU_LOST) && (b->fault.times == 0 || b->lost < b->fault.times);
    w.read = is_wrong(b, card, EMU_READ_ORDER);
    w.line_stuck = is_wrong(b, card, EMU_LINE_STUCK) ? line : 0;
    w.line_noisy = is_wrong(b, card, EMU_LINE_NOISY) ? line : 0;
    w.da_dead = is_wrong(b, card, EMU_DA_DEAD);
    w.da_mute = is_wrong(b, card, EMU_DA_MUTE);
    w.eeprom = is_wrong(b, card, EMU_EEPROM);
    return w;
}

static struct emu_mm32xat_wrong mm_wrong(const struct emu_box *b)
{
    struct emu_mm32xat_wrong w;
    memset(&w, 0, sizeof w);
    w.busy = is_wrong(b, EMU_MM32XAT, EMU_BUSY);
    w.lost = is_wrong(b, EMU_MM32XAT, EMU_LOST);
    w.overflow = is_wrong(b, EMU_MM32XAT, EMU_OVERFLOW);
    w.read = is_wrong(b, EMU_MM32XAT, EMU_READ_ORDER);
    w.da_dead = is_wrong(b, EMU_MM32XAT, EMU_DA_DEAD);
    w.eeprom = is_wrong(b, EMU_MM32XAT, EMU_EEPROM);
    return w;
}

/* --- the bus --- */

/* The card of a port and the offset in its ports; EMU_CARDS: none. */
static unsigned owner(const struct emu_box *b, uint16_t port, unsigned *offset)
{
    for (unsigned i = 0; i < EMU_S526S; i++) {
        *offset = (unsigned)port - b->s526[i].cfg.base;
        if (*offset < EMU_S526_PORTS && b->s526[i].cfg.present) { return i; }
    }
    *offset = (unsigned)port - b->mm.cfg.base;
    return *offset < EMU_MM_PORTS && b->mm.cfg.present ? EMU_MM32XAT : EMU_CARDS;
}

/* The same, of cards that answer. */
static unsigned card_at(const struct emu_box *b, uint16_t port, unsigned *offset)
{
    const unsigned card = owner(b, port, offset);
    return card < EMU_CARDS && is_wrong(b, card, EMU_ABSENT) ? EMU_CARDS : card;
}

/* An access takes its time, and a fault that begins with it begins. */
static void begin(struct emu_box *b, uint16_t port, unsigned width_B)
{
    const struct emu_fault *f = &b->fault;
    unsigned offset;
    b->time_ns += width_B == 2 ? b->access16_ns : b->access8_ns;
    b->accesses++;
    if (f->kind == EMU_WELL || owner(b, port, &offset) != f->card || b->phase >= EMU_PHASES) {
        return;
    }
    if (b->in_phase[b->phase]++ >= f->after && b->phase == f->phase && !b->wrong) {
        b->wrong = 1;
        if (f->kind == EMU_ABSENT && f->card < EMU_S526S) { emu_s526_dark(&b->pins, f->card); }
    }
}

/* One byte from an 8-bit card or an empty bus. */
static uint32_t in_byte(struct emu_box *b, uint16_t port)
{
    const struct emu_mm32xat_wrong w = mm_wrong(b);
    unsigned offset;
    if (card_at(b, port, &offset) != EMU_MM32XAT) { return 0xFF; }
    return emu_mm32xat_in(&b->mm, &b->pins, &w, offset, b->time_ns);
}

static void out_byte(struct emu_box *b, uint16_t port, uint8_t value)
{
    const struct emu_mm32xat_wrong w = mm_wrong(b);
    unsigned offset;
    if (card_at(b, port, &offset) != EMU_MM32XAT) { return; }
    emu_mm32xat_out(&b->mm, &b->pins, &w, offset, value, b->time_ns);
}

uint32_t emu_in(struct emu_box *b, uint16_t port, unsigned width_B)
{
    unsigned offset, card;
    begin(b, port, width_B);
    card = card_at(b, port, &offset);
    if (card >= EMU_S526S) { /* low byte first: the DMM's FIFO moves with it */
        const uint32_t low = in_byte(b, port);
        return width_B == 2 ? low | in_byte(b, (uint16_t)(port + 1u)) << 8 : low;
    } else {
        struct emu_s526_wrong w = s526_wrong(b, card);
        const uint32_t v = emu_s526_in(&b->s526[card], &b->pins, card, &w, offset, b->time_ns);
        return width_B == 2 ? v : 0xFF;
    }
}

void emu_out(struct emu_box *b, uint16_t port, unsigned width_B, uint32_t value)
{
    unsigned offset, card;
    begin(b, port, width_B);
    card = card_at(b, port, &offset);
    if (card >= EMU_S526S) {
        out_byte(b, port, (uint8_t)value);
        if (width_B == 2) { out_byte(b, (uint16_t)(port + 1u), (uint8_t)(value >> 8)); }
    } else if (width_B == 2) {
        struct emu_s526_wrong w = s526_wrong(b, card);
        const uint8_t lost = w.lost;
        emu_s526_out(&b->s526[card], &b->pins, card, &w, offset, (uint16_t)value, b->time_ns);
        b->lost += lost != w.lost;
    }
}

void emu_advance_ns(struct emu_box *b, uint64_t ns)
{
    const struct emu_mm32xat_wrong w = mm_wrong(b);
    b->time_ns += ns;
    emu_mm32xat_advance(&b->mm, &b->pins, &w, b->time_ns);
}

void emu_hasten(struct emu_box *b)
{
    b->access8_ns = b->access16_ns = 0;
    for (unsigned i = 0; i < EMU_S526S; i++) {
        struct emu_s526_config *c = &b->s526[i].cfg;
        c->settle_ns = c->convert_ns = c->update_ns = c->eeprom_ns = 0;
    }
    for (unsigned i = 0; i < 4; i++) { b->mm.cfg.scan_ns[i] = 0; }
    b->mm.cfg.convert_ns = b->mm.cfg.wait_ns = b->mm.cfg.dac_ns = b->mm.cfg.reset_ns = 0;
}

/* --- words --- */

const char *emu_kind_text(unsigned kind)
{
    static const char *const text[EMU_KINDS] = {"well", "absent", "stuck busy", "lost conversion",
        "FIFO overflow", "wrong read order", "stuck encoder line", "noisy encoder line",
        "D/A never updates", "D/A silently never updates", "EEPROM garbage"};
    return kind < EMU_KINDS ? text[kind] : "?";
}

const char *emu_phase_text(unsigned phase)
{
    static const char *const text[EMU_PHASES] = {
        "detect", "self-test", "calibration", "tick read", "tick write", "safe"};
    return phase < EMU_PHASES ? text[phase] : "?";
}
