/* SPDX-License-Identifier: MIT */
#include "bus.h"

#include "check.h"

#include "cards/box.h"
#include "cards/io.h"

#include <limits.h>

struct bus bus;

/* --- S526 --- */

static void convert(struct fake_s526 *c, uint16_t value)
{
    for (unsigned k = 0; k < 10; k++) {
        if (value >> (5 + k) & 1) {
            c->ad_converted[k] = (uint16_t)c->ad[k];
            if (k >= 8) { c->ad[k] = (int16_t)(c->ad[k] + c->ad_noise); }
        }
    }
    if (value & 0x6000) { c->ad_noise = (int16_t)-c->ad_noise; }
    c->wait = c->late;
    c->done_us = bus.time_us + (value & 0x8000 ? c->settle_us : 0);
    for (unsigned k = 0; k < 10; k++) { c->done_us += value >> (5 + k) & 1 ? c->channel_us : 0; }
    if (c->done_us != bus.time_us) { c->wait = UINT16_MAX; }
    if (!c->wait) { c->isr = (uint16_t)(c->isr | (4u & ~c->mute)); }
}

static void counter_out(struct fake_s526 *c, unsigned k, unsigned reg, uint16_t value)
{
    uint32_t *preload = &c->preload[k][c->mode[k] >> 14 & 1];
    if (reg == 0) { *preload = (*preload & 0xFF0000) | value; }
    if (reg == 2) { *preload = (*preload & 0xFFFF) | (uint32_t)(value & 0xFFu) << 16; }
    if (reg == 4) { c->mode[k] = value; }
    if (reg != 6) { return; }
    if (value & 1) { c->ecap[k] = c->ecap_set[k]; }
    if (value & 0x4000) { c->count[k] = c->preload[k][bus.n & 1]; } /* now one and now the other */
    if (value & 0x8000) { c->count[k] = 0; }
}

static uint16_t counter_in(struct fake_s526 *c, unsigned k, unsigned reg)
{
    if (reg == 0) {
        c->latch[k] = c->count[k] & ~c->count_stuck;
        return (uint16_t)(c->latch[k] & 0xFFFF);
    }
    if (reg == 2) { return (uint16_t)(0xAA00u | (c->latch[k] >> 16 & 0xFFu)); }
    return reg == 4 ? (uint16_t)(c->mode[k] & ~c->mode_stuck) : c->ecap[k];
}

static void s526_out(struct fake_s526 *c, unsigned at, uint16_t value)
{
    if (at >= 0x12 && at < 0x32) {
        counter_out(c, (at - 0x12) / 8, (at - 0x12) % 8, value);
        return;
    }
    switch (at) {
    case 0x04:
        c->da_select = value >> 1 & 3u;
        if (!(value & 1)) { break; }
        c->updates++;
        memcpy(c->da_out, c->da_put, sizeof c->da_out);
        c->isr = (uint16_t)(c->isr | (2u & ~c->mute));
        break;
    case 0x06:
        c->ad_select = value >> 1 & 15u;
        if (value & 1) { convert(c, value); }
        break;
    case 0x08: c->da_put[c->da_select] = value; break;
    case 0x0A: c->dio = value; break;
    case 0x0E: c->isr = (uint16_t)(c->isr & ~value); break;
    case 0x34:
        c->ee_at = value >> 3 & 63u;
        if ((value & 7) == 5) { c->isr = (uint16_t)(c->isr | (0x80u & ~c->mute)); }
        break;
    default: CHECK(0, "write to offset %#x", at);
    }
}

static uint16_t s526_in(struct fake_s526 *c, unsigned at)
{
    if (at >= 0x12 && at < 0x32) { return counter_in(c, (at - 0x12) / 8, (at - 0x12) % 8); }
    switch (at) {
    case 0x08: return c->ad_converted[c->ad_select];
    case 0x0A: return (uint16_t)(c->pins | c->pins_stuck | (c->dio & 0x800 ? c->dio & 0xF0 : 0xF0));
    case 0x0E:
        if (c->wait == UINT16_MAX && bus.time_us - c->done_us < UINT32_MAX / 2) { c->wait = 1; }
        if (c->wait && c->wait != UINT16_MAX && --c->wait == 0) {
            c->isr = (uint16_t)(c->isr | (4u & ~c->mute));
        }
        return c->isr;
    case 0x32: return c->ee[c->ee_at];
    case 0x34: return c->signature;
    default: CHECK(0, "read of offset %#x", at);
    }
    return 0;
}

/* --- MM-32X-AT --- */

static void scan(struct fake_mm *m)
{
    const unsigned channels = m->reg[3] + 1u, n = channels - m->drop + m->more;
    CHECK(m->reg[7] == 4 && m->reg[9] == 0 && m->reg[2] == 0, "scan not set up");
    m->busy = m->stuck ? 255 : m->busy_for;
    m->done_us = bus.time_us + m->sample_us * channels;
    if (m->read == m->samples) { m->read = m->samples = 0; }
    for (unsigned k = 0; k < n && m->samples < 1024; k++) {
        m->fifo[m->samples++] = m->in[k % channels];
    }
    m->scans++;
}

static void mm_out(struct fake_mm *m, unsigned at, uint8_t value)
{
    if (at == 0) {
        scan(m);
        return;
    }
    if (at == 7 && value & 2) { m->samples = m->read = m->overflow = 0; }
    if (at == 8 && value & 0x20) {
        memset(m->reg, 0, sizeof m->reg);
        m->samples = m->read = m->overflow = m->busy = 0;
        return;
    }
    if (at == 2 || at == 11) { m->settle = m->settle_for; }
    m->reg[at] = (uint8_t)(at == 2 || at == 3 ? value & 31u : at == 7 ? value & 0x0Cu : value);
}

static uint8_t fifo(struct fake_mm *m, unsigned high)
{
    int16_t v = -1;
    CHECK(m->half == high, "byte %u of a sample first", high);
    if (m->read < m->samples) { v = m->fifo[m->read]; }
    m->half = !high;
    if (high && m->read < m->samples) { m->read++; }
    return (uint8_t)((uint16_t)v >> 8 * high);
}

static uint8_t mm_in(struct fake_mm *m, unsigned at)
{
    if (m->settle) { m->settle--; }
    switch (at) {
    case 0:
    case 1: return fifo(m, at);
    case 7:
        return (uint8_t)(m->reg[7] | (m->overflow ? 0x10 : 0) |
                         (m->samples - m->read >= 8 ? 0x40 : 0) |
                         (m->read == m->samples ? 0x80 : 0));
    case 8:
        if (m->stuck) { return m->misc | 0x80; }
        if (m->sample_us) { m->busy = bus.time_us - m->done_us > UINT32_MAX / 2; }
        if (m->busy && !m->sample_us) { m->busy--; }
        return (uint8_t)(m->misc | (m->busy ? 0x80 : 0));
    case 11:
        if (m->settle_stuck) { return 0x80; }
        return (uint8_t)((m->reg[11] & 0x0F) | (m->settle ? 0x80 : 0));
    default: return m->reg[at];
    }
}

/* --- the bus --- */

/* Is there a card at this port, and does it still answer? */
static int at(unsigned card, uint16_t port)
{
    const uint16_t base = card < 2 ? bus.s526[card].base : bus.mm.base;
    const unsigned size = card < 2 ? 0x40 : 0x10;
    return base && port >= base && port < base + size &&
           !(bus.dead_card == card && bus.n > bus.dead_from);
}

static void note(char op, uint16_t port, uint16_t value)
{
    if (bus.n <= BUS_LOG) { bus.log[bus.n - 1] = (struct access){op, port, value}; }
}

static void begin(void)
{
    if (bus.n == bus.safe_at) {
        bus.safe_at = UINT_MAX;
        exh_box_safe();
        bus.hot = 0;
    }
    if (!bus_safe()) { bus.hot++; }
    bus.n++;
    if (!bus.stopped) { bus.time_us += bus.access_us; }
}

uint16_t exh_io_in16(uint16_t port)
{
    uint16_t v = 0xFFFF;
    begin();
    for (unsigned k = 0; k < 2; k++) {
        if (at(k, port)) { v = s526_in(&bus.s526[k], port - (unsigned)bus.s526[k].base); }
    }
    if (at(2, port)) {
        v = mm_in(&bus.mm, 0);
        v = (uint16_t)(v | mm_in(&bus.mm, 1) << 8);
    }
    note('r', port, v);
    return v;
}

void exh_io_out16(uint16_t port, uint16_t value)
{
    begin();
    note('w', port, value);
    for (unsigned k = 0; k < 2; k++) {
        if (at(k, port)) { s526_out(&bus.s526[k], port - (unsigned)bus.s526[k].base, value); }
    }
    CHECK(!at(2, port), "16 bits to the glove's card");
}

uint8_t exh_io_in8(uint16_t port)
{
    uint8_t v = 0xFF;
    begin();
    CHECK(!at(0, port) && !at(1, port), "8 bits from an S526");
    if (at(2, port)) { v = mm_in(&bus.mm, port - (unsigned)bus.mm.base); }
    note('i', port, v);
    return v;
}

void exh_io_out8(uint16_t port, uint8_t value)
{
    begin();
    note('o', port, value);
    CHECK(!at(0, port) && !at(1, port), "8 bits to an S526");
    if (at(2, port)) { mm_out(&bus.mm, port - (unsigned)bus.mm.base, value); }
}

uint32_t exh_io_time_us(void) { return bus.time_us; }

/* --- scripts --- */

void bus_double(uint16_t *word, int negative, uint64_t mantissa, int exponent)
{
    uint64_t bits = 0;
    if (mantissa) {
        while (mantissa >> 52 == 0) {
            mantissa <<= 1;
            exponent--;
        }
        bits = (mantissa & ((UINT64_C(1) << 52) - 1)) | (uint64_t)(exponent + 1075) << 52;
    }
    bits |= (uint64_t)(negative != 0) << 63;
    for (unsigned i = 0; i < 4; i++) { word[i] = (uint16_t)(bits >> 16 * i); }
}

void bus_reset(void)
{
    memset(&bus, 0, sizeof bus);
    bus.access_us = 1;
    bus.dead_card = 3;
    bus.safe_at = UINT_MAX;
    for (unsigned i = 0; i < 2; i++) {
        struct fake_s526 *c = &bus.s526[i];
        c->base = exh_box_default.s526_base[i];
        c->signature = (uint16_t)(0x526A + i);
        c->pins = 0x0F;
        c->ad[8] = 32767; /* 10 V are one code more than there are */
        for (unsigned k = 0; k < 4; k++) {
            bus_double(&c->ee[8 * k], 0, 3249, 0);
            bus_double(&c->ee[8 * k + 4], 0, 32768, 0);
            c->da_out[k] = 0xFFFF; /* whatever ran before */
        }
        bus_double(&c->ee[0x20], 0, 10, 0);
    }
    bus.mm.base = exh_box_default.mm32xat_base;
    bus.mm.misc = 0x60;
    bus.mm.busy_for = 5;
    bus.mm.settle_for = 3;
}

void bus_clear(void) { bus.n = 0; }

int bus_safe(void)
{
    for (unsigned i = 0; i < 2; i++) {
        const struct fake_s526 *c = &bus.s526[i];
        if (bus.dead_card == i && bus.n > bus.dead_from) { continue; } /* it takes no writes */
        for (unsigned k = 0; k < 4 && c->base; k++) {
            if (c->da_out[k] != 32768) { return 0; }
        }
        if (c->base && c->dio & 0xF0) { return 0; }
    }
    return 1;
}

static const char *hex(const char *s, unsigned *v)
{
    *v = 0;
    for (; (*s >= '0' && *s <= '9') || (*s >= 'A' && *s <= 'F'); s++) {
        *v = *v << 4 | (unsigned)(*s <= '9' ? *s - '0' : *s - 'A' + 10);
    }
    return s;
}

int bus_said(unsigned i, const char *want)
{
    for (; *want != '\0'; i++) {
        const struct access *a = &bus.log[i];
        const char op = *want;
        unsigned port, value;
        want = hex(want + 2, &port);
        value = a->value;
        if (*want == ' ') { want = hex(want + 1, &value); }
        if (i >= bus.n || a->op != op || a->port != port || a->value != value) {
            CHECK(0, "access %u of %u is %c %X %X, want %c %X %X", i, bus.n, a->op,
                (unsigned)a->port, (unsigned)a->value, op, port, value);
            return 0;
        }
        while (*want == ',' || *want == ' ' || *want == '\n') { want++; }
    }
    CHECK(i == bus.n, "%u accesses, want %u", bus.n, i);
    return i == bus.n;
}
