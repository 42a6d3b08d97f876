/* SPDX-License-Identifier: MIT */
#include "chips.h"

#define PS_PER_S UINT64_C(1000000000000)

/* --- 8259 pair: edges, fixed priorities, as far as an image needs --- */

enum { PIC1 = 0x20, PIC2 = 0xA0 };

static void raise_irq0(struct chips *c) { c->pic[0].irr |= 1; }

/* Lines that may go in: requested, not masked, none of higher priority in service. */
static unsigned wanting(const struct pic *p)
{
    const unsigned served = p->isr & (0u - p->isr);
    const unsigned above = served ? served - 1 : 0xFF;
    return p->irr & ~(unsigned)p->mask & above;
}

int pic_wants(const struct chips *c) { return wanting(&c->pic[0]) != 0; }

int pic_accept(struct chips *c)
{
    struct pic *p = &c->pic[0];
    const unsigned w = wanting(p);
    unsigned line = 0;
    if (w == 0) { return p->base + 7; }
    while (!(w >> line & 1)) { line++; }
    p->irr &= (uint8_t) ~(1u << line);
    if (!p->auto_eoi) { p->isr |= (uint8_t)(1u << line); }
    return (int)(p->base + line);
}

static void pic_command(struct pic *p, uint8_t v)
{
    if (v & 0x10) { /* first word of four, or of three */
        p->words_left = v & 1 ? 3 : 2;
        p->word = v & 2 ? 2 : 1;
        p->irr = p->isr = p->mask = p->auto_eoi = 0;
    } else if (v & 8) {
        p->read_isr = (v & 3) == 3;
    } else if ((v >> 5) == 1) { /* end of the one of highest priority */
        p->isr &= (uint8_t)(p->isr - 1);
    } else if ((v >> 5) == 3) {
        p->isr &= (uint8_t) ~(1u << (v & 7));
    }
}

static void pic_data(struct pic *p, uint8_t v)
{
    if (p->words_left == 0) {
        p->mask = v;
        return;
    }
    if (p->words_left == 3) { p->base = v & 0xF8; }
    if (p->words_left == 1) { p->auto_eoi = v >> 1 & 1; }
    p->words_left--;
}

/* --- 8254 --- */

enum { PIT0 = 0x40, PIT2 = 0x42, PIT_MODE = 0x43, GATE2 = 0x61 };

/* Counts of the 8254 in so long, without leaving 64 bits. */
static uint64_t pit_counts(uint64_t ps)
{
    return ps / PS_PER_S * PIT_HZ + (ps % PS_PER_S) / 1000 * PIT_HZ / (PS_PER_S / 1000);
}

static uint64_t pit_ps(uint64_t counts) /* rounded up: the count has been reached then */
{
    return counts / PIT_HZ * PS_PER_S + (counts % PIT_HZ * PS_PER_S + PIT_HZ - 1) / PIT_HZ;
}

static uint64_t pit_next_ps(const struct pit *p)
{
    return p->from_ps + pit_ps((p->done + 1) * p->divisor);
}

static uint16_t pit_count(uint64_t now_ps, uint64_t from_ps, uint32_t divisor)
{
    return (uint16_t)(divisor - pit_counts(now_ps - from_ps) % divisor);
}

static void pit_out(struct pit *p, uint64_t now_ps, uint16_t port, uint8_t v)
{
    if (port == PIT_MODE && (v & 0xF0) == 0x00) {
        p->latch = pit_count(now_ps, p->from_ps, p->divisor);
        p->latched = 1;
        p->read_high = 0;
    } else if (port == PIT_MODE) {
        if (v >> 6 == 0) { p->have_low = p->read_high = p->latched = 0; }
        if (v >> 6 == 2) { p->have_low2 = 0; }
    } else if (port == PIT0 && !p->have_low) {
        p->low = v;
        p->have_low = 1;
    } else if (port == PIT0) {
        const uint32_t n = (uint32_t)v << 8 | p->low;
        p->divisor = n ? n : 65536;
        p->from_ps = now_ps;
        p->done = 0;
        p->have_low = 0;
        p->loads++;
    } else if (port == PIT2 && !p->have_low2) {
        p->low2 = v;
        p->have_low2 = 1;
    } else if (port == PIT2) {
        const uint32_t n = (uint32_t)v << 8 | p->low2;
        p->div2 = n ? n : 65536;
        p->from2_ps = now_ps;
        p->have_low2 = 0;
    }
}

static uint8_t pit_in(struct pit *p, uint64_t now_ps)
{
    const uint16_t n = p->latched ? p->latch : pit_count(now_ps, p->from_ps, p->divisor);
    const uint8_t v = (uint8_t)(p->read_high ? n >> 8 : n);
    if (p->read_high) { p->latched = 0; }
    p->read_high ^= 1;
    return v;
}

/* Bit 5: output of channel 2, one-shot from its loading. */
static uint8_t gate_in(const struct pit *p, uint64_t now_ps)
{
    const int over = p->div2 && pit_counts(now_ps - p->from2_ps) >= p->div2;
    return (uint8_t)((p->gate2 & 3) | (over ? 0x20 : 0));
}

/* --- 16550, sending alone --- */

enum { COM1 = 0x3F8 };

static int uart_out(struct uart *u, uint64_t now_ps, uint64_t char_ps, unsigned reg, uint8_t v)
{
    const unsigned room = u->fifo & 1 ? 16 : 1;
    if (reg == 3) { u->line = v; }
    if (reg == 2) { u->fifo = v; }
    if (reg == 4) { u->modem = v; }
    if (reg == 7) { u->scratch = v; }
    if (u->line & 0x80) {
        if (reg == 0) { u->divisor_low = v; }
        if (reg == 1) { u->divisor_high = v; }
        return -1;
    }
    if (reg == 1) { u->ier = v; }
    if (reg != 0) { return -1; }
    if (u->busy_ps < now_ps) { u->busy_ps = now_ps; }
    if (char_ps && (u->busy_ps - now_ps) / char_ps > room) { /* beside the one on the line */
        u->lost++;
        return -1;
    }
    u->busy_ps += char_ps;
    return v;
}

static uint8_t uart_in(const struct uart *u, uint64_t now_ps, uint64_t char_ps, unsigned reg)
{
    const int idle = u->busy_ps <= now_ps;
    const int empty = idle || u->busy_ps - now_ps <= char_ps;
    if (u->line & 0x80 && reg < 2) { return reg ? u->divisor_high : u->divisor_low; }
    switch (reg) {
    case 1: return u->ier;
    case 2: return u->fifo & 1 ? 0xC1 : 0x01;
    case 3: return u->line;
    case 4: return u->modem;
    case 5: return (uint8_t)((idle ? 0x40 : 0) | (empty ? 0x20 : 0));
    case 6: return 0xB0; /* a peer is connected */
    case 7: return u->scratch;
    default: return 0;
    }
}

/* --- all of them --- */

void chips_open(struct chips *c, uint32_t hpet_fs)
{
    const struct chips none = {.char_ps = UART_CHAR_PS};
    *c = none;
    c->hpet.period_fs = hpet_fs;
    /* as a BIOS leaves them: 18.2 Hz, interrupts where exceptions are */
    c->pit.divisor = 65536;
    c->pic[0].base = 8;
    c->pic[1].base = 0x70;
    c->pic[0].mask = 0xB8;
    c->pic[1].mask = 0xFF;
}

int chips_advance(struct chips *c, uint64_t now_ps)
{
    int fired = hpet_advance(&c->hpet, now_ps);
    while (pit_next_ps(&c->pit) <= now_ps) {
        c->pit.done++;
        fired |= !(hpet_is_legacy(&c->hpet));
    }
    if (fired) { raise_irq0(c); }
    return fired;
}

uint64_t chips_next_ps(const struct chips *c)
{
    const uint64_t pit_at = pit_next_ps(&c->pit), hpet_at = hpet_next_ps(&c->hpet);
    return pit_at < hpet_at ? pit_at : hpet_at;
}

uint64_t chips_timer_loads(const struct chips *c) { return c->pit.loads + c->hpet.loads; }

double chips_period_s(const struct chips *c)
{
    if (hpet_is_legacy(&c->hpet)) {
        return (double)c->hpet.timer[0].period * (double)c->hpet.period_fs * 1e-15;
    }
    return (double)c->pit.divisor / PIT_HZ;
}

int chips_in8(struct chips *c, uint64_t now_ps, uint16_t port, uint8_t *value)
{
    const unsigned second = (port & 0xF0u) == PIC2;
    switch (port) {
    case PIC1:
    case PIC2: *value = c->pic[second].read_isr ? c->pic[second].isr : c->pic[second].irr; return 1;
    case PIC1 + 1:
    case PIC2 + 1: *value = c->pic[second].mask; return 1;
    case PIT0: *value = pit_in(&c->pit, now_ps); return 1;
    case GATE2: *value = gate_in(&c->pit, now_ps); return 1;
    default: break;
    }
    if (port < COM1 || port > COM1 + 7) { return 0; }
    *value = uart_in(&c->uart, now_ps, c->char_ps, port - COM1);
    return 1;
}

int chips_out8(struct chips *c, uint64_t now_ps, uint16_t port, uint8_t value, int *sent)
{
    *sent = -1;
    switch (port) {
    case PIC1: pic_command(&c->pic[0], value); return 1;
    case PIC2: pic_command(&c->pic[1], value); return 1;
    case PIC1 + 1: pic_data(&c->pic[0], value); return 1;
    case PIC2 + 1: pic_data(&c->pic[1], value); return 1;
    case PIT0:
    case PIT2:
    case PIT_MODE: pit_out(&c->pit, now_ps, port, value); return 1;
    case GATE2: c->pit.gate2 = value; return 1;
    default: break;
    }
    if (port < COM1 || port > COM1 + 7) { return 0; }
    *sent = uart_out(&c->uart, now_ps, c->char_ps, port - COM1, value);
    return 1;
}
