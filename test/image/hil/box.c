/* SPDX-License-Identifier: MIT */
#include "box.h"

#include <string.h>

/* Wiring, as in docs/CARDS.md. It is a separate table, so that it judges the driver's. */
enum {
    READY_A = 0,
    ONE_ESTOP = 1,
    ONE_DEADMAN = 2,
    ONE_WATCHDOG = 3,
    ONE_ENABLE = 4,
    ONE_ALIVE = 5,
    ONE_SUPPLY = 4
};
enum {
    B_READY4 = 0,
    B_ESTOP = 1,
    B_DEADMAN = 2,
    B_WATCHDOG = 3,
    B_ENABLE4 = 4,
    B_ALIVE = 5,
    B_SUPPLY = 4
};
#define ON_A 4u /* fingers */

void box_open(struct box *b, int one_finger, const struct emu_config *c)
{
    memset(b, 0, sizeof *b);
    b->one_finger = one_finger;
    emu_box_open(&b->emu, c);
    b->from_ns = b->emu.time_ns;
}

/* --- the bus --- */

static int is_card(const struct box *b, uint16_t port)
{
    const struct emu_box *e = &b->emu;
    for (unsigned i = 0; i < EMU_S526S; i++) {
        if (e->s526[i].cfg.present && (unsigned)port - e->s526[i].cfg.base < EMU_S526_PORTS) {
            return 1;
        }
    }
    return e->mm.cfg.present && (unsigned)port - e->mm.cfg.base < EMU_MM_PORTS;
}

/* Their time up to ours; then the access, which takes of both. */
static void catch_up(struct box *b, const struct hil *h)
{
    const uint64_t now_ns = b->from_ns + h->now_ps / 1000;
    if (now_ns > b->emu.time_ns) { emu_advance_ns(&b->emu, now_ns - b->emu.time_ns); }
}

static void charge(struct box *b, struct hil *h, uint64_t before_ns)
{
    h->ports++;
    h->cards++;
    h->now_ps += (b->emu.time_ns - before_ns) * 1000;
    if (h->now_ps >= h->wake_ps) { h->wake_ps = 0; }
}

int box_in(struct box *b, struct hil *h, uint16_t port, unsigned size, uint32_t *value)
{
    const unsigned glove = (unsigned)port - b->emu.mm.cfg.base;
    uint64_t before_ns;
    if (!is_card(b, port) || size > 2) { return 0; }
    catch_up(b, h);
    if (glove < 2 && b->glove && !b->glove_starts) { b->glove(b->ctx); }
    before_ns = b->emu.time_ns;
    *value = emu_in(&b->emu, port, size);
    charge(b, h, before_ns);
    return 1;
}

int box_out(struct box *b, struct hil *h, uint16_t port, unsigned size, uint32_t value)
{
    uint64_t before_ns;
    if (!is_card(b, port) || size > 2) { return 0; }
    catch_up(b, h);
    if (port == b->emu.mm.cfg.base && b->glove && b->glove_starts) { b->glove(b->ctx); }
    before_ns = b->emu.time_ns;
    emu_out(&b->emu, port, size, value);
    charge(b, h, before_ns);
    return 1;
}

/* --- the wiring --- */

static unsigned card_of(unsigned finger) { return finger < ON_A ? 0 : 1; }

static unsigned axis_of(unsigned finger) { return finger < ON_A ? finger : finger - ON_A; }

static uint8_t pin(uint32_t din, uint32_t bit, unsigned at)
{
    return (uint8_t)((din & bit ? 1u : 0u) << at);
}

void box_put(struct box *b, const struct exh_drive_in *in)
{
    struct emu_pins *p = &b->emu.pins;
    const unsigned fingers = b->one_finger ? 1 : EXH_FINGERS;
    p->din[0] = p->din[1] = 0;
    for (unsigned i = 0; i < fingers; i++) {
        const unsigned at = i < ON_A ? READY_A + i : B_READY4;
        p->enc_cnt[card_of(i)][axis_of(i)] = (int32_t)in->enc_raw[i];
        p->ad_uV[card_of(i)][axis_of(i)] = emu_ad_uV(in->mon_raw[i]);
        p->din[card_of(i)] |= pin(in->din, (uint32_t)EXH_DIN_DRIVE0 << i, at);
    }
    if (b->one_finger) {
        p->din[0] |= (uint8_t)(pin(in->din, EXH_DIN_ESTOP, ONE_ESTOP) |
                               pin(in->din, EXH_DIN_DEADMAN, ONE_DEADMAN) |
                               pin(in->din, EXH_DIN_WATCHDOG, ONE_WATCHDOG));
        p->ad_uV[0][ONE_SUPPLY] = emu_ad_uV(in->supply_raw);
    } else {
        p->din[1] |= (uint8_t)(pin(in->din, EXH_DIN_ESTOP, B_ESTOP) |
                               pin(in->din, EXH_DIN_DEADMAN, B_DEADMAN) |
                               pin(in->din, EXH_DIN_WATCHDOG, B_WATCHDOG));
        p->ad_uV[1][B_SUPPLY] = emu_ad_uV(in->supply_raw);
    }
}

void box_put_glove(struct box *b, const int16_t raw[EXH_GLOVE_SENSORS])
{
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        b->emu.pins.glove_uV[i] = emu_ad_uV(raw[i]);
    }
}

void box_get(const struct box *b, struct exh_drive_out *out)
{
    const struct emu_pins *p = &b->emu.pins;
    const unsigned alive = b->one_finger ? p->dout[0] >> ONE_ALIVE : p->dout[1] >> B_ALIVE;
    const unsigned fingers = b->one_finger ? 1 : EXH_FINGERS;
    memset(out, 0, sizeof *out);
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        const unsigned at = b->one_finger ? ONE_ENABLE : i < ON_A ? 4 + i : B_ENABLE4;
        out->dac_raw[i] = emu_da_code(p->da_uV[card_of(i)][axis_of(i)]);
        if (i < fingers && p->dout[card_of(i)] >> at & 1) { out->enable |= (uint8_t)(1u << i); }
    }
    out->alive = (uint8_t)(alive & 1);
}
