/* SPDX-License-Identifier: MIT */
/* A/D converters (RM0090 chapter 13): a scan of regular channels, once or without end. */
#include "stm.h"

enum { SR = 0, CR1 = 1, CR2 = 2, SMPR1 = 3, SMPR2 = 4, SQR1 = 11, SQR2 = 12, SQR3 = 13, DR = 19 };
#define EOC     0x02u
#define STRT    0x10u
#define OVR     0x20u
#define SCAN    0x100u
#define ADON    0x01u
#define CONT    0x02u
#define DMA     0x100u
#define DDS     0x200u
#define SWSTART 0x40000000u

static unsigned channel_of(const struct stm_adc *a)
{
    const unsigned i = a->at;
    return i < 6    ? a->r[SQR3] >> 5 * i & 31
           : i < 12 ? a->r[SQR2] >> 5 * (i - 6) & 31
                    : a->r[SQR1] >> 5 * (i - 12) & 31;
}

static unsigned last_of(const struct stm_adc *a)
{
    return a->r[CR1] & SCAN ? a->r[SQR1] >> 20 & 15 : 0;
}

/* Sampling, then 12 cycles of the converter's clock. */
static uint64_t conversion_time(const struct stm *s, const struct stm_adc *a)
{
    static const uint16_t sample[8] = {3, 15, 28, 56, 84, 112, 144, 480};
    const unsigned c = channel_of(a), pre = 2 * (s->adc_ccr >> 16 & 3) + 2;
    const unsigned smp = c < 10 ? a->r[SMPR2] >> 3 * c & 7 : a->r[SMPR1] >> 3 * (c - 10) & 7;
    const uint32_t Hz = s->clk.pclk2_Hz / pre;
    return (uint64_t)(sample[smp] + 12u) * STM_HZ / Hz;
}

static void begin(struct stm *s, struct stm_adc *a, uint64_t from)
{
    a->runs = 1;
    a->done_at = from + conversion_time(s, a);
}

/* A conversion whose predecessor was not read is lost, and with it all later ones (OVR). */
static void end(struct stm *s, unsigned n)
{
    struct stm_adc *a = &s->adc[n];
    const unsigned c = channel_of(a);
    const int by_dma = (a->r[CR2] & DMA) != 0;
    a->conversions++;
    if (by_dma && a->r[SR] & OVR) {
        a->runs = 0;
        return;
    }
    a->r[DR] = stm_outside.analog ? stm_outside.analog(stm_outside.ctx, c) & 0xFFFu : 0;
    a->r[SR] |= EOC | STRT;
    if (by_dma && (s->wrong & 1u << STM_ADC_LATE || !stm_dma_request(s, STM_REQ_ADC + n))) {
        /* one value waits in DR; the next finds it there */
        if (a->r[SR] & 0x80000000u) { a->r[SR] |= OVR; }
        a->r[SR] |= 0x80000000u;
    } else if (by_dma) {
        a->r[SR] &= ~(EOC | 0x80000000u);
    }
    if (a->at < last_of(a)) {
        a->at++;
    } else {
        a->at = 0;
        if (!(a->r[CR2] & CONT)) {
            a->runs = 0;
            return;
        }
    }
    begin(s, a, a->done_at);
}

void stm_adc_go_on(struct stm *s)
{
    for (unsigned n = 1; n <= STM_ADCS; n++) {
        while (s->adc[n].runs && s->adc[n].done_at <= s->now) { end(s, n); }
    }
}

uint64_t stm_adc_next(const struct stm *s)
{
    uint64_t next = STM_NEVER;
    for (unsigned n = 1; n <= STM_ADCS; n++) {
        if (s->adc[n].runs && s->adc[n].done_at < next) { next = s->adc[n].done_at; }
    }
    return next;
}

uint32_t stm_adc_read(struct stm *s, unsigned n, uint32_t off)
{
    struct stm_adc *a = &s->adc[n];
    if (off >= 80) { return 0; }
    if (off >> 2 == DR) { a->r[SR] &= ~(EOC | 0x80000000u); }
    return off >> 2 == SR ? a->r[SR] & 0x3Fu : a->r[off >> 2];
}

void stm_adc_write(struct stm *s, unsigned n, uint32_t off, uint32_t v)
{
    struct stm_adc *a = &s->adc[n];
    s->wake = 0;
    switch (off >> 2) {
    case SR: a->r[SR] &= v | 0xFFFFFFC0u; return;
    case CR2:
        a->r[CR2] = v & ~SWSTART;
        if (!(v & ADON)) {
            a->runs = 0;
            a->at = 0;
        } else if (v & SWSTART && !a->runs) {
            a->at = 0;
            begin(s, a, s->now);
        }
        return;
    case DR: return;
    default:
        if (off < 80) { a->r[off >> 2] = v; }
        return;
    }
}

uint32_t stm_adc_common_read(struct stm *s, uint32_t off)
{
    return off == 4 ? s->adc_ccr : off == 0 ? s->adc[1].r[SR] & 0x3Fu : 0;
}

void stm_adc_common_write(struct stm *s, uint32_t off, uint32_t v)
{
    if (off == 4) { s->adc_ccr = v & 0x00C3EF1Fu; }
}
