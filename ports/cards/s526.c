/* SPDX-License-Identifier: MIT */
/* What a tick needs of the card. Opening it is s526_open.c. */
#include "s526_reg.h"
#include "wait.h"

#include "exhand/error.h"
#include "exhand/fix.h"

/* Consecutive updates that may end without their flag. One may still run when the flags are read,
 * and one may be lost when a flag is cleared at the same instant. */
#define DA_UNSEEN 3

int s526_wait(const struct exh_s526 *s, unsigned flags, uint32_t limit_us, unsigned what,
    unsigned at, uint16_t *isr, struct exh_card_fault *f)
{
    struct exh_wait w = exh_wait_us(limit_us);
    do {
        *isr = s526_in(s, S526_ISR);
        /* All ones are no flags but an empty bus: the EEPROM's flag is set only after its command.
         */
        if (*isr == S526_ALL_ONES) { return exh_card_fault(f, EXH_CARD_EMPTY, at, *isr, 0, 0); }
        if (*isr & flags) { return 0; }
    } while (exh_wait_more(&w));
    return exh_card_fault(f, what, at, *isr, 0, 0);
}

/* --- inputs --- */

/* The read of the low word latches all 24 bits. */
uint32_t exh_s526_count(const struct exh_s526 *s, unsigned axis)
{
    const uint32_t low = s526_in(s, s526_counter(axis, S526_LOW));
    const uint32_t high = s526_in(s, s526_counter(axis, S526_HIGH)) & 0xFFu;
    return high << 16 | low;
}

/* A step that fits 16 bits, from what was last read. */
uint32_t exh_s526_follow(struct exh_s526 *s, unsigned axis)
{
    uint32_t step;
    if (!s->par.turns || !((unsigned)s->counted >> axis & 1u)) {
        s->count[axis] = exh_s526_count(s, axis);
        s->counted |= (uint8_t)(1u << axis);
        return s->count[axis];
    }
    step = (s526_in(s, s526_counter(axis, S526_LOW)) - s->count[axis]) & 0xFFFFu;
    s->count[axis] = (s->count[axis] + (step ^ 0x8000u) - 0x8000u) & 0xFFFFFFu;
    return s->count[axis];
}

static int high_word(struct exh_s526 *s, unsigned axis, struct exh_card_fault *f)
{
    const int32_t got = s526_in(s, s526_counter(axis, S526_HIGH)) & 0xFF;
    const int32_t want = (int32_t)(s->count[axis] >> 16);
    f->phase = EXH_CARD_INPUT;
    return got == want ? 0 : exh_card_fault(f, EXH_CARD_FOLLOW, axis, got, want, want);
}

static int quad(struct exh_s526 *s, unsigned axis, struct exh_card_fault *f)
{
    const unsigned at = s526_counter(axis, S526_CONTROL);
    if (!(s526_in(s, at) & S526_ECAP)) { return 0; }
    s526_out(s, at, S526_ECAP);
    s->quad[axis]++;
    f->phase = EXH_CARD_INPUT;
    return s->quad[axis] <= s->par.quad_limit ? 0
                                              : exh_card_fault(f, EXH_CARD_QUADRATURE, axis,
                                                    (int32_t)s->quad[axis], 0, s->par.quad_limit);
}

int exh_s526_check(struct exh_s526 *s, unsigned axes, struct exh_card_fault *f)
{
    const unsigned steps = s->par.turns ? 2 : 1;
    const unsigned turn = s->quad_next < steps * axes ? s->quad_next : 0;
    s->quad_next = (uint8_t)(turn + 1);
    if (s->par.turns && (turn < axes || !s->par.quad_check)) {
        return high_word(s, turn < axes ? turn : turn - axes, f);
    }
    return s->par.quad_check ? quad(s, turn - (steps - 1) * axes, f) : 0;
}

int exh_s526_alive(const struct exh_s526 *s, struct exh_card_fault *f)
{
    const uint16_t got = s526_in(s, S526_EEC);
    f->phase = EXH_CARD_INPUT;
    if (got == s->id.signature) { return 0; }
    if (got == S526_ALL_ONES) { return exh_card_fault(f, EXH_CARD_EMPTY, S526_EEC, got, 0, 0); }
    return exh_card_fault(f, EXH_CARD_SIGNATURE, S526_EEC, got, s->id.signature, s->id.signature);
}

int exh_s526_lines(const struct exh_s526 *s, uint8_t *pins, struct exh_card_fault *f)
{
    const uint8_t before = s->lines;
    const uint8_t got = (uint8_t)(s526_in(s, S526_DIO) & 0xFFu);
    const uint8_t lines = got & S526_DIO_LINES;
    *pins = got;
    f->phase = EXH_CARD_INPUT;
    /* They may have been made safe before this read, or after it. */
    return !s->par.line_check || lines == before || lines == s->lines
               ? 0
               : exh_card_fault(f, EXH_CARD_LINES, 0, lines, before, before);
}

static unsigned lowest(unsigned mask)
{
    unsigned k = 0;
    while (!(mask >> k & 1u)) { k++; }
    return k;
}

/* Of the mask the channel behind the one that was last, or the first. */
static unsigned next_channel(const struct exh_s526 *s)
{
    unsigned upto = s->ad_now, behind;
    upto |= upto >> 1;
    upto |= upto >> 2;
    upto |= upto >> 4; /* all channels up to the last */
    behind = s->ad_mask & ~upto;
    return 1u << lowest(behind ? behind : s->ad_mask);
}

/* The word that starts also selects the result that is read first. */
void exh_s526_ad_start(struct exh_s526 *s)
{
    if (!s->par.turns || s->ad_first) {
        s->ad_now = s->ad_mask;
    } else {
        s->ad_now = next_channel(s);
    }
    s->ad_first = 0;
    s526_out(s, S526_ADC,
        (s->par.settle ? S526_AD_SETTLE : 0u) | s->ad_now * (unsigned)S526_AD_CONVERT0 |
            lowest(s->ad_now) << 1 | S526_AD_START);
}

/* An update since the last look must have ended by now; the flags say so in the same read. */
static int da_done(struct exh_s526 *s, uint16_t isr, struct exh_card_fault *f)
{
    if (isr & S526_DA_DONE) { s->da_sent = 0; }
    return !s->par.da_check || s->da_sent < DA_UNSEEN
               ? 0
               : exh_card_fault(f, EXH_CARD_DA_TIMEOUT, 0, isr, 0, 0);
}

int exh_s526_ad_read(struct exh_s526 *s, int16_t *code, struct exh_card_fault *f)
{
    const unsigned first = lowest(s->ad_now);
    uint16_t isr;
    int err;
    f->phase = EXH_CARD_MONITOR;
    err = s526_wait(s, S526_AD_DONE, s->par.ad_wait_us, EXH_CARD_AD_TIMEOUT, 0, &isr, f);
    if (err < 0) { return err; }
    /* Only what was seen: an update that ends between read and write keeps its flag. */
    s526_out(s, S526_ISR, isr & (S526_AD_DONE | S526_DA_DONE));
    for (unsigned k = first; k < EXH_S526_AD; k++) {
        if (!(s->ad_now >> k & 1u)) { continue; }
        if (k > first) { s526_out(s, S526_ADC, k << 1); }
        code[k] = exh_s526_ad_code(&s->id.ad, s526_result(s));
    }
    return da_done(s, isr, f);
}

/* --- outputs --- */

void exh_s526_da_put(const struct exh_s526 *s, unsigned channel, uint16_t nominal)
{
    s526_out(s, S526_DAC, channel << 1);
    s526_out(s, S526_ADD, exh_s526_da_code(&s->id.da[channel], nominal));
}

void exh_s526_da_start(struct exh_s526 *s)
{
    if (s->da_sent < DA_UNSEEN) { s->da_sent++; }
    s526_out(s, S526_DAC, S526_DA_START);
}

void exh_s526_lines_put(struct exh_s526 *s, unsigned lines)
{
    if (s->par.turns && s->lines == (lines & S526_DIO_LINES) &&
        ++s->lines_kept < EXH_S526_LINES_EVERY) {
        return;
    }
    s->lines_kept = 0;
    s->lines = (uint8_t)(lines & S526_DIO_LINES);
    s526_out(s, S526_DIO, S526_DIO_OUT4 | s->lines);
}

static void lines_off(struct exh_s526 *s)
{
    s->lines = s->lines_off;
    s526_out(s, S526_DIO, S526_DIO_OUT4 | s->lines_off);
}

static void da_zero(const struct exh_s526 *s)
{
    for (unsigned k = 0; k < EXH_S526_AXES; k++) {
        s526_out(s, S526_DAC, k << 1);
        s526_out(s, S526_ADD, s->da_zero_raw[k]);
    }
    s526_out(s, S526_DAC, S526_DA_START);
}

/* The drives first: one access a board takes their enables. All of it twice: the first update
 * may fall into one that is under way; when the second comes, that one is over. */
void exh_s526_safe(struct exh_s526 *s, unsigned n)
{
    for (int pass = 0; pass < 2; pass++) {
        for (unsigned i = 0; i < n; i++) {
            if (s[i].live) { lines_off(&s[i]); }
        }
        for (unsigned i = 0; i < n; i++) {
            if (s[i].live) { da_zero(&s[i]); }
        }
    }
}

/* --- calibration --- */

uint16_t exh_s526_da_code(const struct exh_s526_da *da, uint16_t nominal)
{
    const int64_t code_q30 = (int64_t)da->gain_q30 * ((int32_t)nominal - EXH_S526_DA_ZERO) +
                             (int64_t)da->zero_raw_q14 * (1 << (30 - 14));
    return (uint16_t)exh_clamp(exh_shr_round(code_q30, 30) + EXH_S526_DA_ZERO, 0, UINT16_MAX);
}

int16_t exh_s526_ad_code(const struct exh_s526_ad *ad, int16_t code)
{
    const int64_t from_zero_q14 = (int64_t)code * (1 << 14) - ad->zero_raw_q14;
    return (int16_t)exh_clamp(
        exh_shr_round(from_zero_q14 * ad->gain_q30, 14 + 30), INT16_MIN, INT16_MAX);
}
