/* SPDX-License-Identifier: MIT */
#include "s526.h"

#include <stddef.h>

void *memset(void *dst, int value, size_t len_B);

/* offsets */
enum {
    TCR = 0x00,
    WDC = 0x02,
    DAC = 0x04,
    ADC = 0x06,
    ADD = 0x08,
    DIO = 0x0A,
    IER = 0x0C,
    ISR = 0x0E,
    MSC = 0x10,
    COUNTERS = 0x12,
    COUNTERS_END = 0x32,
    EED = 0x32,
    EEC = 0x34,
    END = 0x36
};
enum { LOW, HIGH, MODE, CONTROL }; /* words of a counter */

#define ISR_DA     0x0002u
#define ISR_AD     0x0004u
#define ISR_EEPROM 0x0080u

#define AD_START    0x0001u
#define AD_SETTLE   0x8000u
#define AD_CHANNELS 10
#define DA_START    0x0001u
#define DA_RESET    0x0008u
#define EE_START    0x0001u
#define EE_READ     2u
#define DIO_LOW     0x0400u /* DIO0..3 are outputs */
#define DIO_HIGH    0x0800u /* DIO4..7 are outputs */

#define MODE_SOFTWARE 0x1000u
#define MODE_ON_EVENT 0x2000u
#define MODE_PR1      0x4000u
#define CTL_HELD      0x1FC0u
#define CTL_LOAD      0x4000u
#define CTL_RESET     0x8000u
#define FLAG_ERROR    0x01u
#define FLAG_ROLLED   0x08u
#define COUNT_MASK    0xFFFFFFu

#define ALL_ONES 0xFFFFu

#define NOMINAL_GAIN_Q16 (3249 * 65536)

static uint32_t noise(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

/* --- what the card is --- */

struct emu_s526_config emu_s526_nominal(void)
{
    struct emu_s526_config c;
    memset(&c, 0, sizeof c);
    c.signature = 0x526A;
    c.settle_ns = 15000;
    c.convert_ns = 10000;
    c.update_ns = 10000;
    c.eeprom_ns = 30000;
    c.ref_V_q16 = 650240; /* 9.921875 V: code 32512 */
    c.ad_gain_q16 = 65536;
    for (int i = 0; i < EMU_AXES; i++) {
        c.da_gain_q16[i] = NOMINAL_GAIN_Q16;
        c.da_zero_q16[i] = 0;
    }
    emu_s526_describe(&c);
    return c;
}

/* q16 as an IEEE double, least significant word first. */
static void put_double(uint16_t word[4], int64_t v_q16)
{
    uint64_t mag = v_q16 < 0 ? (uint64_t)-v_q16 : (uint64_t)v_q16;
    uint64_t bits = 0;
    if (mag) {
        int exponent = 1023 + 52 - 16;
        while (mag < UINT64_C(1) << 52) {
            mag <<= 1;
            exponent--;
        }
        bits = (uint64_t)exponent << 52 | (mag & ((UINT64_C(1) << 52) - 1));
        if (v_q16 < 0) { bits |= UINT64_C(1) << 63; }
    }
    for (int i = 0; i < 4; i++) { word[i] = (uint16_t)(bits >> (16 * i)); }
}

static int64_t zero_q16(const struct emu_s526_config *c, unsigned ch)
{
    return (INT64_C(32768) << 16) + c->da_zero_q16[ch];
}

void emu_s526_describe(struct emu_s526_config *c)
{
    for (unsigned i = 0; i < EMU_S526_WORDS; i++) { c->eeprom[i] = ALL_ONES; }
    for (unsigned ch = 0; ch < EMU_AXES; ch++) {
        put_double(&c->eeprom[8 * ch], c->da_gain_q16[ch]);
        put_double(&c->eeprom[8 * ch + 4], zero_q16(c, ch));
    }
    put_double(&c->eeprom[0x20], c->ref_V_q16);
}

/* --- D/A --- */

static uint64_t divide(uint64_t n, uint64_t d)
{
    uint64_t q = 0, rest = 0;
    for (int i = 63; i >= 0; i--) {
        rest = rest << 1 | (n >> i & 1);
        q <<= 1;
        if (rest >= d) {
            rest -= d;
            q |= 1;
        }
    }
    return q;
}

static int32_t da_uV(const struct emu_s526_config *c, unsigned ch, uint16_t code)
{
    const int64_t above_q16 = ((int64_t)code << 16) - zero_q16(c, ch);
    uint64_t mag;
    if (c->da_gain_q16[ch] == NOMINAL_GAIN_Q16 && c->da_zero_q16[ch] == 0) {
        return emu_da_uV(code);
    }
    mag = (uint64_t)(above_q16 < 0 ? -above_q16 : above_q16) * 1000000u;
    mag = divide(mag + (uint32_t)c->da_gain_q16[ch] / 2, (uint32_t)c->da_gain_q16[ch]);
    return above_q16 < 0 ? -(int32_t)mag : (int32_t)mag;
}

static void update_outputs(struct emu_s526 *c, struct emu_pins *pins, unsigned card,
    const struct emu_s526_wrong *w, uint64_t now_ns)
{
    if (!w->da_dead) { c->da_done_ns = now_ns + c->cfg.update_ns; }
    if (w->da_dead || w->da_mute) { return; }
    for (unsigned ch = 0; ch < EMU_AXES; ch++) {
        c->da_code[ch] = c->da_preload[ch];
        pins->da_uV[card][ch] = da_uV(&c->cfg, ch, c->da_code[ch]);
    }
}

/* After a reset: 0 V (which no source says). */
static void reset_outputs(struct emu_s526 *c, struct emu_pins *pins, unsigned card)
{
    for (unsigned ch = 0; ch < EMU_AXES; ch++) {
        const int64_t code = (zero_q16(&c->cfg, ch) + 0x8000) >> 16;
        c->da_preload[ch] = c->da_code[ch] = (uint16_t)code;
        pins->da_uV[card][ch] = 0;
    }
}

static void out_dac(struct emu_s526 *c, struct emu_pins *pins, unsigned card,
    const struct emu_s526_wrong *w, uint16_t value, uint64_t now_ns)
{
    c->dac = value;
    if (value & DA_RESET && !w->da_dead && !w->da_mute) { reset_outputs(c, pins, card); }
    if (value & DA_START) { update_outputs(c, pins, card, w, now_ns); }
}

/* --- A/D --- */

static int16_t converted(
    const struct emu_s526 *c, const struct emu_pins *pins, unsigned card, unsigned ch)
{
    int32_t code;
    if (ch == EMU_S526_REF_0V) {
        code = 0;
    } else if (ch == EMU_S526_REF_10V) { /* 65536 a volt into 3276.8 a volt */
        code = (c->cfg.ref_V_q16 + 10) / 20;
    } else {
        code = emu_ad_code(pins->ad_uV[card][ch]);
    }
    code = (int32_t)(((int64_t)code * c->cfg.ad_gain_q16 + 0x8000) >> 16) + c->cfg.ad_offset_raw;
    return (int16_t)(code > 32767 ? 32767 : code < -32768 ? -32768 : code);
}

static void out_adc(struct emu_s526 *c, const struct emu_pins *pins, unsigned card,
    struct emu_s526_wrong *w, uint16_t value, uint64_t now_ns)
{
    uint64_t takes_ns = value & AD_SETTLE ? c->cfg.settle_ns : 0;
    c->adc = value;
    if (!(value & AD_START)) { return; }
    if (w->lost) {
        w->lost = 0;
        return;
    }
    c->ad_channels = value >> 5 & 0x3FF;
    for (unsigned ch = 0; ch < AD_CHANNELS; ch++) {
        if (c->ad_channels >> ch & 1) {
            c->ad_pending[ch] = converted(c, pins, card, ch);
            takes_ns += c->cfg.convert_ns;
        }
    }
    c->ad_done_ns = now_ns + takes_ns;
}

/* Another program may have selected something else in between. */
static uint16_t in_add(struct emu_s526 *c, const struct emu_s526_wrong *w)
{
    const unsigned ch = (c->adc >> 1 & 0xFu) + (w->read ? noise(&c->noise) & 1 : 0);
    return ch < AD_CHANNELS ? (uint16_t)c->ad_result[ch] : ALL_ONES;
}

/* --- what ends in time --- */

static int due(uint64_t *at_ns, uint64_t now_ns)
{
    if (*at_ns == 0 || *at_ns > now_ns) { return 0; }
    *at_ns = 0;
    return 1;
}

static void sync(struct emu_s526 *c, const struct emu_s526_wrong *w, uint64_t now_ns)
{
    if (w->busy) { return; }
    if (due(&c->ad_done_ns, now_ns)) {
        for (unsigned ch = 0; ch < AD_CHANNELS; ch++) {
            if (c->ad_channels >> ch & 1) { c->ad_result[ch] = c->ad_pending[ch]; }
        }
        c->isr |= ISR_AD;
    }
    if (due(&c->da_done_ns, now_ns)) { c->isr |= ISR_DA; }
    if (due(&c->eeprom_done_ns, now_ns)) {
        c->eed = w->eeprom ? (uint16_t)noise(&c->noise) : c->eeprom_word;
        c->isr |= ISR_EEPROM;
    }
}

/* --- counters --- */

/* Where the lines are, in steps of the mode: 1, 2 or 4 to a period. */
static int32_t place(struct emu_s526_counter *n, struct emu_pins *pins, unsigned card, unsigned i,
    const struct emu_s526_wrong *w, uint32_t *state)
{
    const unsigned clock = n->mode >> 9 & 3;
    int32_t at = pins->enc_cnt[card][i];
    if (w->line_stuck >> i & 1) {
        /* Line B alone: one step down where it rises, one up where it falls. */
        const int32_t b = (int32_t)((uint32_t)at >> 1 & 1);
        if (!n->was_stuck) {
            n->stuck_cnt = at + b;
            n->was_stuck = 1;
        }
        at = n->stuck_cnt - b;
    }
    if (w->line_noisy >> i & 1) {
        const uint32_t r = noise(state);
        at = (int32_t)((uint32_t)at + r % 3 - 1);
        if (r >> 8 & 1) { n->flags |= FLAG_ERROR; } /* both lines between two clocks */
    }
    return clock == 0 ? at >> 2 : clock == 1 ? at >> 1 : at;
}

static void count(struct emu_s526 *c, struct emu_pins *pins, unsigned card, unsigned i,
    const struct emu_s526_wrong *w)
{
    struct emu_s526_counter *n = &c->counter[i];
    const unsigned enable = n->mode >> 7 & 3;
    const int32_t at = place(n, pins, card, i, w, &c->noise);
    const uint32_t moved = (uint32_t)at - (uint32_t)n->seen;
    n->seen = at;
    if ((enable & 1) == 0 || n->mode & MODE_SOFTWARE) { return; } /* the enable pin is open */
    if (moved < 0x80000000u ? n->count + (moved & COUNT_MASK) > COUNT_MASK
                            : n->count < ((0u - moved) & COUNT_MASK)) {
        n->flags |= FLAG_ROLLED;
    }
    n->count = (n->count + moved) & COUNT_MASK;
}

static void set_mode(struct emu_s526 *c, struct emu_pins *pins, unsigned card, unsigned i,
    const struct emu_s526_wrong *w, uint16_t mode)
{
    struct emu_s526_counter *n = &c->counter[i];
    count(c, pins, card, i, w);
    n->mode = mode & 0x7FFF;
    n->seen = place(n, pins, card, i, w, &c->noise); /* in the new steps */
}

/* The counter loads from the two preload registers alternately; which is next is undocumented. */
static void control(struct emu_s526 *c, struct emu_pins *pins, unsigned card, unsigned i,
    const struct emu_s526_wrong *w, uint16_t value)
{
    struct emu_s526_counter *n = &c->counter[i];
    count(c, pins, card, i, w);
    n->flags &= (uint8_t) ~(value & 0xF);
    n->held = value & CTL_HELD;
    if (value & CTL_LOAD) { n->count = n->preload[n->loads++ & 1]; }
    if (value & CTL_RESET) { n->count = 0; }
}

static uint16_t in_counter(struct emu_s526 *c, struct emu_pins *pins, unsigned card,
    const struct emu_s526_wrong *w, unsigned i, unsigned word)
{
    struct emu_s526_counter *n = &c->counter[i];
    count(c, pins, card, i, w);
    switch (word) {
    case LOW:
        if (!(n->mode & MODE_ON_EVENT)) { n->latch = n->count; }
        return (uint16_t)n->latch;
    case HIGH: /* upper byte undefined; another program's low word may be in between */
        return (uint16_t)(0xFF00 | ((n->latch >> 16) + (w->read ? noise(&c->noise) & 1 : 0)));
    case MODE: return n->mode;
    default: return (uint16_t)(n->held | n->flags);
    }
}

static void out_counter(struct emu_s526 *c, struct emu_pins *pins, unsigned card,
    const struct emu_s526_wrong *w, unsigned i, unsigned word, uint16_t value)
{
    struct emu_s526_counter *n = &c->counter[i];
    switch (word) {
    case LOW: n->preload[n->mode & MODE_PR1 ? 1 : 0] = (n->high & 0xFFu) << 16 | value; break;
    case HIGH: n->high = value; break;
    case MODE: set_mode(c, pins, card, i, w, value); break;
    default: control(c, pins, card, i, w, value); break;
    }
}

/* --- digital lines --- */

static uint8_t driven(const struct emu_s526 *c)
{
    return (uint8_t)((c->dio & DIO_LOW ? 0x0F : 0) | (c->dio & DIO_HIGH ? 0xF0 : 0));
}

static uint16_t in_dio(const struct emu_s526 *c, const struct emu_pins *pins, unsigned card)
{
    return (uint16_t)((pins->din[card] & ~driven(c) & 0xFF) | (c->dio & driven(c)));
}

/* --- the bus --- */

void emu_s526_dark(struct emu_pins *pins, unsigned card)
{
    for (unsigned ch = 0; ch < EMU_AXES; ch++) { pins->da_uV[card][ch] = 0; }
    pins->dout[card] = 0;
}

void emu_s526_reset(
    struct emu_s526 *c, const struct emu_s526_config *cfg, struct emu_pins *pins, unsigned card)
{
    memset(c, 0, sizeof *c);
    c->cfg = *cfg;
    c->noise = 1 + card;
    emu_s526_dark(pins, card);
    reset_outputs(c, pins, card);
    for (unsigned i = 0; i < EMU_AXES; i++) { c->counter[i].seen = pins->enc_cnt[card][i] >> 2; }
}

uint16_t emu_s526_in(struct emu_s526 *c, struct emu_pins *pins, unsigned card,
    struct emu_s526_wrong *w, unsigned offset, uint64_t now_ns)
{
    sync(c, w, now_ns);
    if (offset & 1 || offset >= END) { return ALL_ONES; }
    if (offset >= COUNTERS && offset < COUNTERS_END) {
        return in_counter(c, pins, card, w, (offset - COUNTERS) >> 3, (offset - COUNTERS) >> 1 & 3);
    }
    switch (offset) {
    case TCR: return c->tcr;
    case WDC: return c->wdc;
    case DAC: return c->dac;
    case ADC: return c->adc;
    case ADD: return in_add(c, w);
    case DIO: return in_dio(c, pins, card);
    case IER: return c->ier;
    case ISR: return c->isr;
    case EED: return c->eed;
    case EEC: return c->cfg.signature;
    default: return ALL_ONES;
    }
}

void emu_s526_out(struct emu_s526 *c, struct emu_pins *pins, unsigned card,
    struct emu_s526_wrong *w, unsigned offset, uint16_t value, uint64_t now_ns)
{
    sync(c, w, now_ns);
    if (offset & 1 || offset >= END) { return; }
    if (offset >= COUNTERS && offset < COUNTERS_END) {
        out_counter(
            c, pins, card, w, (offset - COUNTERS) >> 3, (offset - COUNTERS) >> 1 & 3, value);
        return;
    }
    switch (offset) {
    case TCR: c->tcr = value; break;
    case WDC: c->wdc = value; break;
    case DAC: out_dac(c, pins, card, w, value, now_ns); break;
    case ADC: out_adc(c, pins, card, w, value, now_ns); break;
    case ADD: c->da_preload[c->dac >> 1 & 3] = value; break;
    case DIO:
        c->dio = value;
        pins->dout[card] = (uint8_t)(value & driven(c));
        break;
    case IER: c->ier = value; break;
    case ISR: c->isr &= (uint16_t)~value; break;
    case MSC: c->msc = value; break;
    case EED: c->eed = value; break;
    case EEC:
        if (value & EE_START && (value >> 1 & 3) == EE_READ) {
            c->eeprom_word = c->cfg.eeprom[value >> 3 & 0x3F];
            c->eeprom_done_ns = now_ns + c->cfg.eeprom_ns;
        }
        break;
    default: break;
    }
}
