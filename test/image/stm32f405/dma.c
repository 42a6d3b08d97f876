/* SPDX-License-Identifier: MIT */
/* DMA (RM0090 chapter 10): which stream and channel serves whom, items one by one, circles. It
 * reaches main memory, never the memory that is coupled to the core. */
#include "stm.h"

#include <string.h>

enum { LISR, HISR, LIFCR, HIFCR };
#define EN   1u
#define TEIE 4u
#define HTIE 8u
#define TCIE 16u
#define CIRC 0x100u
#define TE   0x08u
#define HT   0x10u
#define TC   0x20u

/* tables 42 and 43, as far as there are models */
static const struct {
    uint16_t request;
    uint8_t dma, stream, channel;
} table[] = {
    {STM_REQ_ADC + 1, 2, 0, 0},
    {STM_REQ_ADC + 1, 2, 4, 0},
    {STM_REQ_ADC + 2, 2, 2, 1},
    {STM_REQ_ADC + 2, 2, 3, 1},
    {STM_REQ_ADC + 3, 2, 0, 2},
    {STM_REQ_ADC + 3, 2, 1, 2},
    {STM_REQ_SPI_TX + 1, 2, 3, 3},
    {STM_REQ_SPI_TX + 1, 2, 5, 3},
    {STM_REQ_SPI_TX + 2, 1, 4, 0},
    {STM_REQ_SPI_TX + 3, 1, 5, 0},
    {STM_REQ_SPI_TX + 3, 1, 7, 0},
    {STM_REQ_SPI_RX + 1, 2, 0, 3},
    {STM_REQ_SPI_RX + 1, 2, 2, 3},
    {STM_REQ_SPI_RX + 2, 1, 3, 0},
    {STM_REQ_SPI_RX + 3, 1, 0, 0},
    {STM_REQ_SPI_RX + 3, 1, 2, 0},
    {STM_REQ_USART_TX + 1, 2, 7, 4},
    {STM_REQ_USART_TX + 2, 1, 6, 4},
    {STM_REQ_USART_TX + 3, 1, 3, 4},
    {STM_REQ_USART_TX + 3, 1, 4, 7},
    {STM_REQ_USART_TX + 4, 1, 4, 4},
    {STM_REQ_USART_TX + 5, 1, 7, 4},
    {STM_REQ_USART_TX + 6, 2, 6, 5},
    {STM_REQ_USART_TX + 6, 2, 7, 5},
    {STM_REQ_USART_RX + 1, 2, 2, 4},
    {STM_REQ_USART_RX + 1, 2, 5, 4},
    {STM_REQ_USART_RX + 2, 1, 5, 4},
    {STM_REQ_USART_RX + 3, 1, 1, 4},
    {STM_REQ_USART_RX + 4, 1, 2, 4},
    {STM_REQ_USART_RX + 5, 1, 0, 4},
    {STM_REQ_USART_RX + 6, 2, 1, 5},
    {STM_REQ_USART_RX + 6, 2, 2, 5},
};
static const uint8_t irq1[STM_STREAMS] = {11, 12, 13, 14, 15, 16, 17, 47};
static const uint8_t irq2[STM_STREAMS] = {56, 57, 58, 59, 60, 68, 69, 70};
static const uint8_t flag_at[4] = {0, 6, 16, 22};

static void set_flag(struct stm *s, unsigned n, unsigned stream, uint32_t flag, uint32_t enable)
{
    struct stm_dma *d = &s->dma[n];
    d->isr[stream / 4] |= flag << flag_at[stream % 4];
    if (d->stream[stream].cr & enable) {
        stm_pend(s, STM_IRQ0 + (n == 1 ? irq1[stream] : irq2[stream]));
    }
}

static uint8_t *memory(uint32_t at, unsigned size)
{
    const uint32_t off = at - STM_RAM;
    return at >= STM_RAM && off <= STM_RAM_B - size ? &stm_outside.ram[off] : NULL;
}

static const uint8_t *source(uint32_t at, unsigned size)
{
    const uint32_t off = at - STM_FLASH;
    if (at >= STM_FLASH && off <= STM_FLASH_B - size) { return &stm_outside.flash[off]; }
    return memory(at, size);
}

/* One item between the part's register and memory. 0, or -1: that is no memory for a DMA. */
static int move(struct stm *s, uint32_t par, uint32_t at, uint32_t cr)
{
    const unsigned size = 1u << (cr >> 13 & 3), part = 1u << (cr >> 11 & 3);
    uint32_t v = 0;
    if ((cr >> 6 & 3) == 0) { /* from the part */
        uint8_t *to = memory(at, size);
        if (to == NULL) { return -1; }
        v = stm_read(s, par, part);
        memcpy(to, &v, size);
    } else {
        const uint8_t *from = source(at, size);
        if (from == NULL) { return -1; }
        memcpy(&v, from, size);
        stm_write(s, par, part, v);
    }
    s->accesses--; /* not the processor's */
    return 0;
}

/* The item is taken off first: what it makes its part ask for may be the next. */
static void item(struct stm *s, unsigned n, unsigned i)
{
    struct stm_dma *d = &s->dma[n];
    const uint32_t cr = d->stream[i].cr;
    const uint32_t at = d->stream[i].m0ar + (cr & 0x400 ? d->stream[i].done << (cr >> 13 & 3) : 0);
    const int half = ++d->stream[i].done == d->stream[i].reload / 2;
    const int whole = --d->stream[i].ndtr == 0;
    if (whole) {
        d->stream[i].done = 0;
        d->stream[i].ndtr = cr & CIRC ? d->stream[i].reload : 0;
        d->stream[i].cr = cr & CIRC ? cr : cr & ~EN;
    }
    if (move(s, d->stream[i].par, at, cr) < 0) {
        d->stream[i].cr &= ~EN;
        set_flag(s, n, i, TE, TEIE);
        return;
    }
    if (half) { set_flag(s, n, i, HT, HTIE); }
    if (whole) { set_flag(s, n, i, TC, TCIE); }
}

int stm_dma_request(struct stm *s, unsigned request)
{
    for (unsigned i = 0; i < sizeof table / sizeof table[0]; i++) {
        const unsigned n = table[i].dma, stream = table[i].stream;
        const uint32_t cr = s->dma[n].stream[stream].cr;
        if (table[i].request == request && cr & EN && (cr >> 25 & 7) == table[i].channel) {
            item(s, n, stream);
            return 1;
        }
    }
    return 0;
}

uint32_t stm_dma_read(struct stm *s, unsigned n, uint32_t off)
{
    const struct stm_dma *d = &s->dma[n];
    const unsigned i = (off - 0x10) / 0x18;
    if (off < 8) { return d->isr[off >> 2]; }
    if (off < 0x10 || i >= STM_STREAMS) { return 0; }
    switch ((off - 0x10) % 0x18 / 4) {
    case 0: return d->stream[i].cr;
    case 1: return d->stream[i].ndtr;
    case 2: return d->stream[i].par;
    case 3: return d->stream[i].m0ar;
    case 4: return d->stream[i].m1ar;
    default: return d->stream[i].fcr;
    }
}

/* A stream that was off and is enabled begins anew; its flags must have been cleared. */
static void write_cr(struct stm_dma *d, unsigned i, uint32_t v)
{
    const uint32_t flags = d->isr[i / 4] >> flag_at[i % 4] & 0x3D;
    if (v & EN && !(d->stream[i].cr & EN)) {
        if (flags || d->stream[i].ndtr == 0) { v &= ~EN; }
        d->stream[i].reload = d->stream[i].ndtr;
        d->stream[i].done = 0;
    }
    d->stream[i].cr = v & 0x0FEFFFFFu;
}

void stm_dma_write(struct stm *s, unsigned n, uint32_t off, uint32_t v)
{
    struct stm_dma *d = &s->dma[n];
    const unsigned i = (off - 0x10) / 0x18, what = (off - 0x10) % 0x18 / 4;
    s->wake = 0;
    if (off == 8 || off == 12) { d->isr[(off - 8) >> 2] &= ~v; }
    if (off < 0x10 || i >= STM_STREAMS) { return; }
    if (what == 0) {
        write_cr(d, i, v);
        if (d->stream[i].cr & EN) { stm_serial_ask(s); }
    } else if (!(d->stream[i].cr & EN)) {
        uint32_t *const at[] = {NULL, &d->stream[i].ndtr, &d->stream[i].par, &d->stream[i].m0ar,
            &d->stream[i].m1ar, &d->stream[i].fcr};
        *at[what] = what == 1 ? v & 0xFFFF : v;
    }
}
