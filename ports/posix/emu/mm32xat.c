/* SPDX-License-Identifier: MIT */
#include "mm32xat.h"

#include <stddef.h>

void *memset(void *dst, int value, size_t len_B);

/* offsets, and indices of what was last written there */
enum {
    START = 0,
    DATA_LOW = 0,
    DATA_HIGH = 1,
    DOUT = 1,
    LOW = 2,
    HIGH = 3,
    DA_LOW = 4,
    DA_HIGH = 5,
    THRESHOLD = 6,
    FIFO = 7,
    RESET = 8,
    INTERRUPT = 9,
    COUNTERS = 10,
    RANGE = 11,
    PAGED = 12
};

#define ALL_ONES 0xFFu
#define CHANNEL  0x1Fu

#define FIFO_EN      0x08u
#define FIFO_SCAN    0x04u
#define FIFO_RST     0x02u
#define FIFO_EMPTY   0x80u
#define FIFO_AT      0x40u
#define FIFO_FULL    0x20u
#define FIFO_OVER    0x10u
#define RESET_ALL    0x20u
#define RESET_NO_DA  0x10u
#define RESET_INT    0x08u
#define PAGE         0x07u
#define INT_AD       0x80u
#define INT_CLK      0x02u
#define INT_CLKSEL   0x01u
#define BUSY         0x80u
#define SINGLE_ENDED 0x60u
#define RANGE_10V    0x08u
#define RANGE_UNI    0x04u

static uint32_t noise(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

struct emu_mm32xat_config emu_mm32xat_nominal(void)
{
    struct emu_mm32xat_config c;
    memset(&c, 0, sizeof c);
    c.intrst_page0 = 1;
    c.din = 0x0F;
    c.revision = 0x40;
    c.scan_ns[0] = 20000;
    c.scan_ns[1] = 15000;
    c.scan_ns[2] = 10000;
    c.scan_ns[3] = 4000;
    c.convert_ns = 4000;
    c.wait_ns = 10000;
    c.dac_ns = 10000;
    c.reset_ns = 100000;
    memset(c.eeprom, 0xFF, sizeof c.eeprom);
    return c;
}

/* --- conversions and their FIFO --- */

static int16_t code_of(const struct emu_mm32xat *c, int32_t v_uV)
{
    const unsigned range = c->reg[RANGE] & 0xFu;
    if (!(range & RANGE_10V) && range & RANGE_UNI) { return -1; } /* there is no such range */
    return emu_ad_code_gain(
        v_uV, (range & 3) + (range & RANGE_10V ? 0 : 1), range & RANGE_UNI ? 1 : 0);
}

static unsigned fifo_size(const struct emu_mm32xat *c)
{
    return c->enhanced ? EMU_MM_FIFO : EMU_MM_FIFO / 2;
}

static void push(struct emu_mm32xat *c, int16_t code, unsigned channel)
{
    const unsigned at = (c->head + c->depth) % EMU_MM_FIFO;
    if (c->depth >= fifo_size(c)) {
        c->overflow = 1;
        return;
    }
    c->code[at] = code;
    c->from[at] = (uint8_t)channel;
    c->depth++;
}

static void interrupt_if(struct emu_mm32xat *c, int scan_over)
{
    const int at_threshold = c->depth >= 2u * c->reg[THRESHOLD];
    if (c->reg[INTERRUPT] & INT_AD && (c->reg[FIFO] & FIFO_EN ? at_threshold : scan_over)) {
        c->flags |= INT_AD;
    }
}

static void convert(
    struct emu_mm32xat *c, const struct emu_pins *pins, const struct emu_mm32xat_wrong *w)
{
    const unsigned settled = c->next_ns < c->wait_ns ? c->settled_channel : c->channel;
    if (w->lost && !c->lost_of_scan) {
        c->lost_of_scan = 1;
    } else {
        push(c, code_of(c, pins->glove_uV[settled]), settled);
    }
    c->channel = c->channel == c->reg[HIGH] ? c->reg[LOW] : (c->channel + 1u) & CHANNEL;
    c->scan_left--;
    interrupt_if(c, c->scan_left == 0);
    if (c->scan_left == 0 && w->overflow) {
        while (!c->overflow) { push(c, (int16_t)noise(&c->noise), c->channel); }
    }
}

static void start(struct emu_mm32xat *c, uint64_t now_ns)
{
    const unsigned scint = c->reg[RANGE] >> 4 & 3u;
    if (c->scan_left) { return; }
    c->lost_of_scan = 0;
    if (c->reg[FIFO] & FIFO_SCAN) {
        c->channel = c->reg[LOW];
        c->scan_left = (uint16_t)(((c->reg[HIGH] - c->reg[LOW]) & CHANNEL) + 1u);
        c->next_ns = now_ns + c->cfg.scan_ns[scint];
    } else {
        c->scan_left = 1;
        c->next_ns = now_ns + c->cfg.convert_ns;
    }
}

/* Counters 1 and 2, one after the other, divide 10 MHz or 100 kHz. 0: not programmed. */
static uint64_t pace_ns(const struct emu_mm32xat *c)
{
    const uint32_t clock_ns = c->reg[COUNTERS] & 0x80u ? 10000 : 100;
    return (uint64_t)clock_ns * c->counter[1] * c->counter[2];
}

static int paced(const struct emu_mm32xat *c)
{
    return (c->reg[INTERRUPT] & (INT_CLK | INT_CLKSEL)) == (INT_CLK | INT_CLKSEL) && pace_ns(c);
}

void emu_mm32xat_advance(struct emu_mm32xat *c, const struct emu_pins *pins,
    const struct emu_mm32xat_wrong *w, uint64_t now_ns)
{
    for (;;) {
        const int scans = c->scan_left && !w->busy;
        const int triggers = c->pace_ns != 0;
        if (scans && c->next_ns <= now_ns && (!triggers || c->next_ns <= c->pace_ns)) {
            convert(c, pins, w);
            c->next_ns += c->cfg.scan_ns[c->reg[RANGE] >> 4 & 3u];
        } else if (triggers && c->pace_ns <= now_ns) {
            start(c, c->pace_ns);
            c->pace_ns += pace_ns(c);
        } else {
            return;
        }
    }
}

static void pop(struct emu_mm32xat *c, const struct emu_pins *pins)
{
    if (c->depth == 0) {
        if (!c->cfg.empty_last) { c->popped = -1; }
        return;
    }
    c->popped = c->cfg.latch == EMU_LATCH_READ ? code_of(c, pins->glove_uV[c->from[c->head]])
                                               : c->code[c->head];
    c->head = (uint16_t)((c->head + 1u) % EMU_MM_FIFO);
    c->depth--;
}

static uint8_t in_fifo(struct emu_mm32xat *c)
{
    const unsigned at = 2u * c->reg[THRESHOLD];
    const unsigned v = (c->depth == 0 ? FIFO_EMPTY : 0) |
                       (c->depth && c->depth >= at ? FIFO_AT : 0) |
                       (c->depth == fifo_size(c) ? FIFO_FULL : 0) | (c->overflow ? FIFO_OVER : 0) |
                       (c->reg[FIFO] & (FIFO_EN | FIFO_SCAN)) | (c->page & 3u);
    c->overflow = 0;
    return (uint8_t)v;
}

static void out_fifo(struct emu_mm32xat *c, uint8_t value)
{
    c->reg[FIFO] = value & (FIFO_EN | FIFO_SCAN);
    if (value & FIFO_RST) { c->head = c->depth = c->overflow = 0; }
}

/* --- reset --- */

static void reset(struct emu_mm32xat *c, int da, uint64_t now_ns)
{
    memset(c->reg, 0, sizeof c->reg);
    c->reg[THRESHOLD] = 128;
    out_fifo(c, FIFO_RST);
    c->page = c->enhanced = c->channel = c->settled_channel = c->flags = 0;
    c->scan_left = 0;
    c->wait_ns = c->dac_ns = c->pace_ns = 0;
    c->reset_ns = now_ns + c->cfg.reset_ns;
    for (int i = 0; da && i < 4; i++) { c->da_moved[i] = c->da_out[i] = 0; }
}

void emu_mm32xat_reset(struct emu_mm32xat *c, const struct emu_mm32xat_config *cfg)
{
    memset(c, 0, sizeof *c);
    c->cfg = *cfg;
    c->noise = 3;
    c->port[3] = 0x9B;
    reset(c, 1, 0);
}

static void out_reset(struct emu_mm32xat *c, uint8_t value, uint64_t now_ns)
{
    if (value & (RESET_ALL | RESET_NO_DA)) {
        reset(c, value & RESET_ALL, now_ns);
        return;
    }
    if (value & RESET_INT) {
        c->flags = 0;
        if (!c->cfg.intrst_page0) { return; }
    }
    c->page = value & PAGE;
    if (!c->enhanced) { c->page &= 3; }
}

/* --- pages --- */

static void out_timer(struct emu_mm32xat *c, unsigned i, uint8_t value)
{
    if (i == 3) { /* control word: which counter, and which of its bytes follow */
        const unsigned n = value >> 6;
        if (n < 3) {
            c->counter_rw[n] = value >> 4 & 3;
            c->counter[n] = 0;
            c->counter_half &= (uint8_t) ~(1u << n);
        }
        return;
    }
    if (c->counter_rw[i] != 3) {
        c->counter[i] = (uint16_t)(c->counter_rw[i] == 2 ? value << 8 : value);
    } else if (c->counter_half >> i & 1) {
        c->counter[i] = (uint16_t)(value << 8 | c->counter_low[i]);
        c->counter_half &= (uint8_t) ~(1u << i);
    } else {
        c->counter_low[i] = value;
        c->counter_half |= (uint8_t)(1u << i);
    }
}

static void out_paged(
    struct emu_mm32xat *c, const struct emu_mm32xat_wrong *w, unsigned i, uint8_t value)
{
    if (c->page == 0) {
        out_timer(c, i, value);
    } else if (c->page == 1) {
        c->port[i] = value;
    } else if (c->page == 3) {
        if (i == 1) { c->ee_address = value & 0x7F; }
        if (i == 2 && (value & 0xC0) == 0xC0) {
            c->ee_data = w->eeprom ? (uint8_t)noise(&c->noise) : c->cfg.eeprom[c->ee_address];
        }
        if (i == 3 && value == 0xA6) { c->enhanced = 1; }
        if (i == 3 && value == 0xA7) { c->enhanced = 0; }
    }
}

static uint8_t in_paged(const struct emu_mm32xat *c, unsigned i)
{
    if (c->page == 0) { return i < 3 ? (uint8_t)c->counter[i] : ALL_ONES; }
    if (c->page == 1) { return c->port[i]; }
    if (c->page != 3) { return ALL_ONES; }
    return i == 0 ? c->ee_data : i == 1 ? c->ee_address : i == 2 ? 0 : c->cfg.revision;
}

/* --- the bus --- */

static void wait_from(struct emu_mm32xat *c, uint64_t now_ns)
{
    c->wait_ns = now_ns + c->cfg.wait_ns;
}

uint8_t emu_mm32xat_in(struct emu_mm32xat *c, const struct emu_pins *pins,
    const struct emu_mm32xat_wrong *w, unsigned offset, uint64_t now_ns)
{
    const unsigned stuck = w->busy ? BUSY : 0;
    emu_mm32xat_advance(c, pins, w, now_ns);
    switch (offset) {
    case DATA_LOW:
        pop(c, pins);
        if (w->read && noise(&c->noise) % 8 == 0) { pop(c, pins); } /* a read by another program */
        return (uint8_t)c->popped;
    case DATA_HIGH: return (uint8_t)((uint16_t)c->popped >> 8);
    case LOW: return c->reg[LOW];
    case HIGH: return c->reg[HIGH];
    case DA_LOW: return (uint8_t)(stuck | (now_ns < c->dac_ns ? BUSY : 0) | c->cfg.din);
    case DA_HIGH:
        for (int i = 0; i < 4 && !w->da_dead; i++) { c->da_out[i] = c->da_moved[i]; }
        return (uint8_t)(c->depth >> 9 & 1);
    case THRESHOLD: return (uint8_t)(c->depth >> 1);
    case FIFO: return in_fifo(c);
    case RESET: return (uint8_t)(stuck | (c->scan_left ? BUSY : 0) | SINGLE_ENDED | c->channel);
    case INTERRUPT:
        return (uint8_t)(c->flags | (c->page & 4u) | (c->reg[INTERRUPT] & (INT_CLK | INT_CLKSEL)));
    case COUNTERS: return c->reg[COUNTERS];
    case RANGE:
        return (uint8_t)(stuck | (now_ns < c->wait_ns ? BUSY : 0) |
                         (c->reg[RANGE] & (c->enhanced ? 0x3Fu : 0x0Fu)));
    default: return in_paged(c, offset - PAGED);
    }
}

static void out_da(struct emu_mm32xat *c, uint8_t value, uint64_t now_ns)
{
    if (now_ns < c->dac_ns) { return; } /* the transfer before is still under way */
    c->da_moved[value >> 6] = (uint16_t)((value & 0xFu) << 8 | c->reg[DA_LOW]);
    c->dac_ns = now_ns + c->cfg.dac_ns;
}

static void out_interrupt(struct emu_mm32xat *c, uint8_t value, uint64_t now_ns)
{
    c->reg[INTERRUPT] = value;
    c->pace_ns = paced(c) ? now_ns + pace_ns(c) : 0;
}

void emu_mm32xat_out(struct emu_mm32xat *c, const struct emu_pins *pins,
    const struct emu_mm32xat_wrong *w, unsigned offset, uint8_t value, uint64_t now_ns)
{
    emu_mm32xat_advance(c, pins, w, now_ns);
    if (now_ns < c->reset_ns) { return; }
    switch (offset) {
    case START:
        if (!(c->reg[INTERRUPT] & INT_CLK)) { start(c, now_ns); }
        break;
    case LOW:
        if (now_ns >= c->wait_ns) { c->settled_channel = c->channel; }
        c->reg[LOW] = c->channel = value & CHANNEL;
        wait_from(c, now_ns);
        break;
    case HIGH: c->reg[HIGH] = value & CHANNEL; break;
    case DA_HIGH: out_da(c, value, now_ns); break;
    case FIFO: out_fifo(c, value); break;
    case RESET: out_reset(c, value, now_ns); break;
    case INTERRUPT: out_interrupt(c, value, now_ns); break;
    case RANGE:
        c->reg[RANGE] = value & 0x3F;
        wait_from(c, now_ns);
        break;
    case DOUT:
    case DA_LOW:
    case THRESHOLD:
    case COUNTERS: c->reg[offset] = value; break;
    default: out_paged(c, w, offset - PAGED, value); break;
    }
}
