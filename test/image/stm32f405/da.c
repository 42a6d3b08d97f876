/* SPDX-License-Identifier: MIT */
#include "da.h"

#include <string.h>

enum {
    DEVICEID = 1,
    STATUS = 2,
    SPICONFIG = 3,
    GENCONFIG = 4,
    BRDCONFIG = 5,
    SYNCCONFIG = 6,
    DACPWDWN = 9,
    DACRANGE0 = 11,
    TRIGGER = 14,
    DAC0 = 20
};
#define READ      0x800000u
#define DEV_PWDWN 0x20u   /* SPICONFIG */
#define SDO_EN    0x04u   /* SPICONFIG */
#define REF_PWDWN 0x4000u /* GENCONFIG */
#define LDAC      0x10u   /* TRIGGER */
#define RESET     0xAu    /* TRIGGER */

static int range_of(const struct da *d, unsigned n)
{
    return d->reg[DACRANGE0 + (n < 4)] >> 4 * (n % 4) & 15;
}

/* Zero of a range: the middle of one with both signs. */
static uint16_t zero_of(const struct da *d, unsigned n) { return range_of(d, n) >= 9 ? 0x8000 : 0; }

void da_power_on(struct da *d)
{
    memset(d, 0, sizeof *d);
    d->reg[DEVICEID] = 0x298u << 2;
    d->reg[SPICONFIG] = 0x0AA4;
    d->reg[GENCONFIG] = 0x7F00;
    d->reg[BRDCONFIG] = 0xFFFF;
    d->reg[DACPWDWN] = 0xFFFF;
    d->selected = 0;
}

static void act(struct da *d, unsigned n) { d->active[n] = d->reg[DAC0 + n]; }

static void write_reg(struct da *d, unsigned at, uint16_t v)
{
    if (at == TRIGGER) {
        if ((v & 15) == RESET) {
            da_power_on(d);
            return;
        }
        for (unsigned n = 0; n < 8 && v & LDAC; n++) {
            if (d->reg[SYNCCONFIG] >> (4 + n) & 1) { act(d, n); }
        }
    } else if (at >= DAC0 && at < DAC0 + 8) {
        d->reg[at] = v;
        if (!(d->reg[SYNCCONFIG] >> (4 + at - DAC0) & 1)) { act(d, at - DAC0); }
    } else if (at != DEVICEID && at != STATUS) {
        d->reg[at] = v;
    }
}

/* Ranges, trigger and codes are for writing only, as TI says of a sibling (E2E thread 1235803). */
static uint16_t read_reg(const struct da *d, unsigned at)
{
    return at <= DACPWDWN ? d->reg[at] : 0;
}

void da_sync(struct da *d, int level)
{
    if (!level) {
        d->selected = 1;
        d->bits = d->answered = 0;
        d->frame = 0;
        d->answer = d->next;
        d->next = 0;
        return;
    }
    if (!d->selected) { return; }
    d->selected = 0;
    if (d->bits != 24 || d->silent) {
        d->torn += d->bits != 24;
        return;
    }
    d->frames++;
    if (d->frame & READ) {
        d->next = (d->frame & 0xFF0000u) | read_reg(d, d->frame >> 16 & 31);
    } else {
        write_reg(d, d->frame >> 16 & 31, (uint16_t)d->frame);
    }
}

void da_clear(struct da *d, int level)
{
    d->cleared = !level;
    for (unsigned n = 0; n < 8 && !level; n++) { d->reg[DAC0 + n] = d->active[n] = zero_of(d, n); }
}

void da_byte(struct da *d, uint8_t byte)
{
    if (!d->selected) { return; }
    d->frame = d->frame << 8 | byte;
    d->bits = (uint8_t)(d->bits < 64 ? d->bits + 8 : 64);
}

uint8_t da_answer(struct da *d)
{
    const unsigned i = d->answered++;
    if (!d->selected || d->silent || i > 2 || !(d->reg[SPICONFIG] & SDO_EN)) { return 0; }
    return (uint8_t)(d->answer >> (16 - 8 * i));
}

/* Without power an output is held at ground. Ranges with both signs: 5, 10, 20, 2.5 V. */
int32_t da_uV(const struct da *d, unsigned n)
{
    static const int32_t half_uV[16] = {
        [9] = 5000000, [10] = 10000000, [12] = 20000000, [14] = 2500000};
    static const int32_t whole_uV[5] = {5000000, 10000000, 20000000, 40000000, 0};
    const int range = range_of(d, n);
    if (d->reg[SPICONFIG] & DEV_PWDWN || d->reg[DACPWDWN] >> (4 + n) & 1 ||
        d->reg[GENCONFIG] & REF_PWDWN) {
        return 0;
    }
    const int32_t code = d->cleared ? zero_of(d, n) : d->active[n];
    if (half_uV[range]) { /* the nearest */
        const int64_t twice = (int64_t)(code - 32768) * half_uV[range] / 16384;
        return (int32_t)((twice + (twice < 0 ? -1 : 1)) / 2);
    }
    return range < 4 ? (int32_t)((int64_t)code * whole_uV[range] / 65536) : 0;
}
