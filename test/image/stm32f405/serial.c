/* SPDX-License-Identifier: MIT */
/* SPI as a master (RM0090 chapter 28) and USART (chapter 30): a word on the line, one behind it. */
#include "stm.h"

/* --- SPI --- */

enum { CR1, CR2, SPI_SR, SPI_DR };
#define RXNE 0x01u
#define TXE  0x02u
#define OVR  0x40u
#define BSY  0x80u
#define SPE  0x40u
#define MSTR 0x04u
#define DFF  0x800u

static uint64_t word_time(const struct stm *s, unsigned n)
{
    const uint32_t cr1 = s->spi[n].r[CR1];
    const uint32_t Hz = (n == 1 ? s->clk.pclk2_Hz : s->clk.pclk1_Hz) >> ((cr1 >> 3 & 7) + 1);
    return (uint64_t)(cr1 & DFF ? 16 : 8) * ((STM_HZ + Hz / 2) / Hz);
}

static void spi_shift(struct stm *s, unsigned n, uint16_t word, uint64_t from)
{
    struct stm_spi *p = &s->spi[n];
    p->shifts = 1;
    p->shift = word;
    p->back = stm_outside.miso ? stm_outside.miso(stm_outside.ctx, n) : 0;
    p->done_at = s->wrong & 1u << STM_SPI_STUCK ? STM_NEVER : from + word_time(s, n);
}

static void spi_done(struct stm *s, unsigned n)
{
    struct stm_spi *p = &s->spi[n];
    const uint64_t at = p->done_at;
    p->words++;
    p->shifts = 0;
    if (stm_outside.spi) {
        stm_outside.spi(stm_outside.ctx, n, p->shift, p->r[CR1] & DFF ? 16 : 8);
    }
    if (p->r[SPI_SR] & (RXNE | OVR)) { /* it is lost, and so are later words */
        p->r[SPI_SR] |= OVR;
    } else {
        p->r[SPI_SR] |= RXNE;
        p->r[SPI_DR] = p->back;
    }
    if (p->r[CR2] & 1) { (void)stm_dma_request(s, STM_REQ_SPI_RX + n); }
    if (p->waits) {
        p->waits = 0;
        spi_shift(s, n, p->next, at);
    }
    if (p->r[CR2] & 2) { (void)stm_dma_request(s, STM_REQ_SPI_TX + n); }
}

void stm_spi_go_on(struct stm *s)
{
    for (unsigned n = 1; n <= STM_SPIS; n++) {
        while (s->spi[n].shifts && s->spi[n].done_at <= s->now) { spi_done(s, n); }
    }
}

uint64_t stm_spi_next(const struct stm *s)
{
    uint64_t next = STM_NEVER;
    for (unsigned n = 1; n <= STM_SPIS; n++) {
        if (s->spi[n].shifts && s->spi[n].done_at < next) { next = s->spi[n].done_at; }
    }
    return next;
}

/* An overrun ends by a reading of DR and one of SR behind it (RM0402, "Overrun flag"). */
static uint32_t spi_status(struct stm_spi *p)
{
    const uint32_t is =
        (p->r[SPI_SR] & (RXNE | OVR)) | (p->waits ? 0 : TXE) | (p->shifts ? BSY : 0);
    if (p->taken) { p->r[SPI_SR] &= ~OVR; }
    p->taken = 0;
    return is;
}

uint32_t stm_spi_read(struct stm *s, unsigned n, uint32_t off)
{
    struct stm_spi *p = &s->spi[n];
    switch (off >> 2) {
    case SPI_SR: return spi_status(p);
    case SPI_DR:
        p->r[SPI_SR] &= ~RXNE;
        p->taken = 1;
        return p->r[SPI_DR];
    case 4: return 7; /* CRC polynomial, as a reset leaves it */
    default: return off < 36 ? p->r[off >> 2] : 0;
    }
}

void stm_spi_write(struct stm *s, unsigned n, uint32_t off, uint32_t v)
{
    struct stm_spi *p = &s->spi[n];
    s->wake = 0;
    if (off >> 2 == SPI_DR) {
        if ((p->r[CR1] & (SPE | MSTR)) != (SPE | MSTR)) { return; }
        if (!p->shifts) {
            spi_shift(s, n, (uint16_t)v, s->now);
        } else {
            p->next = (uint16_t)v;
            p->waits = 1;
        }
    } else if (off >> 2 == SPI_SR) {
        p->r[SPI_SR] &= v | ~0x10u;
    } else if (off < 36) {
        const uint32_t was = p->r[CR2];
        p->r[off >> 2] = v;
        if (off >> 2 == CR1 && !(v & SPE)) { p->shifts = p->waits = 0; }
        if (off >> 2 == CR2 && v & 2 && !(was & 2)) {
            (void)stm_dma_request(s, STM_REQ_SPI_TX + n);
        }
    }
}

/* --- USART --- */

enum { SR, DR, BRR, UCR1, UCR2, UCR3 };
#define U_ORE  0x08u
#define U_RXNE 0x20u
#define U_TC   0x40u
#define U_TXE  0x80u
#define U_RE   0x04u
#define U_TE   0x08u
#define U_UE   0x2000u
#define U_PCE  0x400u
#define U_M    0x1000u
#define U_DMAR 0x40u
#define U_DMAT 0x80u

/* Units of time a character: with 9 bits of data one more. */
static uint64_t char_time(const struct stm *s, unsigned n)
{
    const uint32_t brr = s->usart[n].r[BRR];
    const uint32_t Hz = n == 1 || n == 6 ? s->clk.pclk2_Hz : s->clk.pclk1_Hz;
    const uint64_t bits = s->usart[n].r[UCR1] & U_M ? 11 : 10;
    return bits * (brr ? brr : 1) * STM_HZ / Hz;
}

/* The data register is free: a DMA that serves it puts the next byte there. */
static void ask(struct stm *s, unsigned n)
{
    struct stm_usart *u = &s->usart[n];
    if (!u->waits && u->r[UCR3] & U_DMAT) { (void)stm_dma_request(s, STM_REQ_USART_TX + n); }
}

static void shift(struct stm *s, unsigned n, uint8_t byte, uint64_t from)
{
    s->usart[n].sends = 1;
    s->usart[n].shift = byte;
    s->usart[n].tx_at = from + char_time(s, n);
}

static void sent(struct stm *s, unsigned n)
{
    struct stm_usart *u = &s->usart[n];
    const uint64_t at = u->tx_at;
    u->sent++;
    u->sends = 0;
    if (stm_outside.sent) { stm_outside.sent(stm_outside.ctx, n, u->shift); }
    if (u->waits) {
        u->waits = 0;
        shift(s, n, u->next, at);
        ask(s, n);
    }
    if (!u->sends) { u->r[SR] |= U_TC; }
}

static void received(struct stm *s, unsigned n)
{
    struct stm_usart *u = &s->usart[n];
    const uint8_t byte = u->rx[u->rx_got++ % STM_RX_B];
    u->received++;
    if ((u->r[UCR1] & (U_UE | U_RE)) != (U_UE | U_RE)) { return; }
    if (u->r[SR] & U_RXNE) {
        u->r[SR] |= U_ORE;
        u->lost++;
    } else {
        u->r[DR] = byte;
        u->r[SR] |= U_RXNE;
    }
    if (u->r[UCR3] & U_DMAR) { (void)stm_dma_request(s, STM_REQ_USART_RX + n); }
}

void stm_usart_go_on(struct stm *s)
{
    for (unsigned n = 1; n <= STM_USARTS; n++) {
        struct stm_usart *u = &s->usart[n];
        while (u->sends && u->tx_at <= s->now) { sent(s, n); }
        while (u->rx_put != u->rx_got && u->rx_at <= s->now) {
            received(s, n);
            u->rx_at += char_time(s, n);
        }
    }
}

uint64_t stm_usart_next(const struct stm *s)
{
    uint64_t next = STM_NEVER;
    for (unsigned n = 1; n <= STM_USARTS; n++) {
        const struct stm_usart *u = &s->usart[n];
        if (u->sends && u->tx_at < next) { next = u->tx_at; }
        if (u->rx_put != u->rx_got && u->rx_at < next) { next = u->rx_at; }
    }
    return next;
}

unsigned stm_usart_put(struct stm *s, unsigned n, const uint8_t *byte, unsigned count)
{
    struct stm_usart *u = &s->usart[n];
    unsigned i = 0;
    if (u->rx_put == u->rx_got) { u->rx_at = s->now + char_time(s, n); }
    while (i < count && u->rx_put - u->rx_got < STM_RX_B) {
        u->rx[u->rx_put++ % STM_RX_B] = byte[i++];
    }
    s->wake = 0;
    return i;
}

uint32_t stm_usart_read(struct stm *s, unsigned n, uint32_t off)
{
    struct stm_usart *u = &s->usart[n];
    switch (off >> 2) {
    case SR: return (u->r[SR] & ~U_TXE) | (u->waits ? 0 : U_TXE);
    case DR: u->r[SR] &= ~(U_RXNE | U_ORE | 7u); return u->r[DR];
    default: return off < 28 ? u->r[off >> 2] : 0;
    }
}

void stm_usart_write(struct stm *s, unsigned n, uint32_t off, uint32_t v)
{
    struct stm_usart *u = &s->usart[n];
    s->wake = 0;
    switch (off >> 2) {
    case SR: u->r[SR] &= v | ~(U_TC | U_RXNE); return;
    case DR:
        if ((u->r[UCR1] & (U_UE | U_TE)) != (U_UE | U_TE)) { return; }
        u->r[SR] &= ~U_TC;
        if (u->sends) {
            u->next = (uint8_t)v;
            u->waits = 1;
        } else {
            shift(s, n, (uint8_t)v, s->now);
            ask(s, n);
        }
        return;
    default:
        if (off < 28) { u->r[off >> 2] = v; }
        if (off >> 2 == UCR3 && v & U_DMAT) { ask(s, n); }
        return;
    }
}

void stm_serial_ask(struct stm *s)
{
    for (unsigned n = 1; n <= STM_USARTS; n++) {
        struct stm_usart *u = &s->usart[n];
        if ((u->r[UCR1] & (U_UE | U_TE)) == (U_UE | U_TE)) { ask(s, n); }
        if (u->r[SR] & U_RXNE && u->r[UCR3] & U_DMAR) {
            (void)stm_dma_request(s, STM_REQ_USART_RX + n);
        }
    }
    for (unsigned n = 1; n <= STM_SPIS; n++) {
        if (!s->spi[n].waits && s->spi[n].r[CR2] & 2) {
            (void)stm_dma_request(s, STM_REQ_SPI_TX + n);
        }
    }
}
