/* SPDX-License-Identifier: MIT */
#include "pc104.h"

#include "io.h"
#include "uart.h"

#define STATUS_READS 100000u /* 0.07 s and more on ISA; a character takes 87 us */

static uint8_t given_up, has_fifo;

int pc104_uart_set(uint16_t base, uint16_t divisor)
{
    pc104_out8((uint16_t)(base + UART_INT_ENABLE), 0);
    pc104_out8((uint16_t)(base + UART_LINE), UART_LINE_DIVISOR);
    pc104_out8((uint16_t)(base + UART_DATA), (uint8_t)(divisor & 0xFFu));
    pc104_out8((uint16_t)(base + UART_INT_ENABLE), (uint8_t)(divisor >> 8));
    pc104_out8((uint16_t)(base + UART_LINE), UART_LINE_8N1);
    pc104_out8((uint16_t)(base + UART_FIFO), UART_FIFO_EMPTY);
    return (pc104_in8((uint16_t)(base + UART_FIFO)) & 0xC0u) == 0xC0u;
}

void pc104_uart_open(void) { has_fifo = (uint8_t)pc104_uart_set(UART_COM1, 1); }

void pc104_uart_put(char c)
{
    uint32_t reads = 0;

    if (given_up) { return; }
    while (!(pc104_in8(UART_COM1 + UART_STATUS) & UART_STATUS_EMPTY)) {
        if (++reads == STATUS_READS) {
            given_up = 1;
            return;
        }
    }
    pc104_out8(UART_COM1 + UART_DATA, (uint8_t)c);
}

/* The FIFO is empty when the status says so, and takes 16; a line without FIFO takes one. */
unsigned pc104_uart_offer(const uint8_t *byte, unsigned n)
{
    const unsigned room = has_fifo ? UART_FIFO_B : 1;
    if (given_up || n == 0 || !(pc104_in8(UART_COM1 + UART_STATUS) & UART_STATUS_EMPTY)) {
        return 0;
    }
    n = n < room ? n : room;
    for (unsigned i = 0; i < n; i++) { pc104_out8(UART_COM1 + UART_DATA, byte[i]); }
    return n;
}
