/* SPDX-License-Identifier: MIT */
/* Three serial lines: out by DMA when there is something, in by DMA into a circle that the tick
 * empties. No interrupt (RM0090: USART, DMA request mapping of DMA1). */
#include "stm.h"

#include <string.h>

#define CHANNEL     4u
#define TO_MEMORY   0u
#define FROM_MEMORY 1u
#define IN_B        2048u

static uint8_t link_in[IN_B], modbus_in[IN_B / 4];

static const struct {
    uint32_t base, baud;
    uint32_t clock; /* bit of APB1ENR */
    uint8_t out, in;
    uint8_t even; /* a parity bit: nine with the data */
    uint8_t *circle;
    uint32_t circle_B;
} line[STM_UARTS] = {{BASE_USART2, 2000000, RCC_APB1ENR_USART2EN, 6, 0, 0, NULL, 0},
    {BASE_USART3, 2000000, RCC_APB1ENR_USART3EN, 3, 1, 0, link_in, sizeof link_in},
    {BASE_UART4, 19200, RCC_APB1ENR_UART4EN, 4, 2, 1, modbus_in, sizeof modbus_in}};
static uint32_t taken[STM_UARTS]; /* place in the circle */

static void clear_flags(unsigned stream)
{
    static const uint8_t at[] = {0, 6, 16, 22};
    REG(BASE_DMA1, stream < 4 ? DMA_LIFCR : DMA_HIFCR) = DMA_FLAGS << at[stream & 3u];
}

static void start(unsigned stream, uint32_t usart, const uint8_t *byte, uint32_t n, uint32_t mode)
{
    const uint32_t s = BASE_DMA1 + DMA_STREAM(stream);
    clear_flags(stream);
    REG(s, DMA_SPAR) = usart + USART_DR;
    REG(s, DMA_SM0AR) = (uint32_t)byte;
    REG(s, DMA_SNDTR) = n;
    REG(s, DMA_SCR) = PUT(DMA_SCR_CHSEL, CHANNEL) | DMA_SCR_MINC | mode | DMA_SCR_EN;
}

void stm_uart_stop(enum stm_uart u)
{
    const uint32_t s = BASE_DMA1 + DMA_STREAM(line[u].out);
    REG(s, DMA_SCR) &= ~DMA_SCR_EN;
    for (uint32_t n = 0; n < 10000 && REG(s, DMA_SCR) & DMA_SCR_EN; n++) {}
}

void stm_uart_open(void)
{
    REG(BASE_RCC, RCC_AHB1ENR) |= RCC_AHB1ENR_DMA1EN;
    for (unsigned u = 0; u < STM_UARTS; u++) {
        const uint32_t base = line[u].base;
        REG(BASE_RCC, RCC_APB1ENR) |= line[u].clock;
        (void)REG(BASE_RCC, RCC_APB1ENR);
        REG(base, USART_CR1) = 0;
        REG(base, USART_BRR) = (STM_APB1_HZ + line[u].baud / 2) / line[u].baud;
        REG(base, USART_CR3) = USART_CR3_DMAT | (line[u].circle ? USART_CR3_DMAR : 0);
        REG(base, USART_CR1) = USART_CR1_UE | USART_CR1_TE |
                               (line[u].even ? USART_CR1_PCE | USART_CR1_M : 0) |
                               (line[u].circle ? USART_CR1_RE : 0);
        taken[u] = 0;
        if (line[u].circle) {
            start(line[u].in, base, line[u].circle, line[u].circle_B,
                DMA_SCR_CIRC | PUT(DMA_SCR_DIR, TO_MEMORY));
        }
    }
}

int stm_uart_busy(enum stm_uart u)
{
    return (REG(BASE_DMA1 + DMA_STREAM(line[u].out), DMA_SCR) & DMA_SCR_EN) != 0;
}

int stm_uart_send(enum stm_uart u, const uint8_t *byte, uint32_t n)
{
    if (stm_uart_busy(u)) { return 0; }
    start(line[u].out, line[u].base, byte, n, PUT(DMA_SCR_DIR, FROM_MEMORY));
    return 1;
}

uint32_t stm_uart_look(enum stm_uart u, const uint8_t **from)
{
    const uint32_t left = REG(BASE_DMA1 + DMA_STREAM(line[u].in), DMA_SNDTR);
    const uint32_t end = line[u].circle_B, at = taken[u];
    const uint32_t put = left == 0 || left > end ? at : end - left;
    *from = line[u].circle + at;
    return put < at ? end - at : put - at;
}

void stm_uart_skip(enum stm_uart u, uint32_t n)
{
    taken[u] += n;
    if (taken[u] == line[u].circle_B) { taken[u] = 0; }
}

/* Reading state, then data, clears it; the byte is damaged anyway. */
int stm_uart_damaged(enum stm_uart u)
{
    const uint32_t bad = USART_SR_PE | USART_SR_FE | USART_SR_NF | USART_SR_ORE;
    if (!(REG(line[u].base, USART_SR) & bad)) { return 0; }
    (void)REG(line[u].base, USART_DR);
    return 1;
}

int stm_fifo_put(struct stm_fifo *f, const uint8_t *byte, uint32_t len_B)
{
    const uint32_t at = f->put & (f->size_B - 1), end = f->size_B - at;
    if (len_B > f->size_B - (f->put - f->got)) { return 0; }
    memcpy(f->byte + at, byte, len_B < end ? len_B : end);
    if (len_B > end) { memcpy(f->byte, byte + end, len_B - end); }
    f->put += len_B;
    return (int)len_B;
}

void stm_fifo_out(struct stm_fifo *f)
{
    const uint32_t at = (f->got + f->under_way) & (f->size_B - 1);
    uint32_t n = f->put - f->got - f->under_way;
    if (stm_uart_busy(f->uart)) { return; }
    f->got += f->under_way;
    f->under_way = n < f->size_B - at ? n : f->size_B - at;
    if (f->under_way) { (void)stm_uart_send(f->uart, f->byte + at, f->under_way); }
}
