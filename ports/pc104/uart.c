#include "pc104.h"

#include "io.h"

/* 16550 at the standard address of COM1. */
enum { COM1 = 0x3F8 };
enum { DATA = COM1, INT_ENABLE = COM1 + 1, FIFO = COM1 + 2, LINE = COM1 + 3, STATUS = COM1 + 5 };
#define LINE_8N1       0x03u
#define LINE_DIVISOR   0x80u /* data and interrupt registers become the divisor */
#define STATUS_EMPTY   0x20u /* takes a character                               */
#define DIVISOR_115200 1u /* of 115200 baud                                  */
#define STATUS_READS   100000u /* 0.07 s and more on ISA; a character takes 87 us */

static uint8_t given_up, has_fifo;

void pc104_uart_open(void)
{
    pc104_out8(INT_ENABLE, 0);
    pc104_out8(LINE, LINE_DIVISOR);
    pc104_out8(DATA, DIVISOR_115200);
    pc104_out8(INT_ENABLE, 0);
    pc104_out8(LINE, LINE_8N1);
    pc104_out8(FIFO, 0x07); /* on, both emptied */
    has_fifo = (pc104_in8(FIFO) & 0xC0u) == 0xC0u;
}

void pc104_uart_put(char c)
{
    uint32_t reads = 0;

    if (given_up) { return; }
    while (!(pc104_in8(STATUS) & STATUS_EMPTY)) {
        if (++reads == STATUS_READS) {
            given_up = 1;
            return;
        }
    }
    pc104_out8(DATA, (uint8_t)c);
}

/* The FIFO is empty when the status says so, and takes 16; a line without FIFO takes one. */
unsigned pc104_uart_offer(const uint8_t *byte, unsigned n)
{
    const unsigned room = has_fifo ? 16 : 1;
    if (given_up || n == 0 || !(pc104_in8(STATUS) & STATUS_EMPTY)) { return 0; }
    n = n < room ? n : room;
    for (unsigned i = 0; i < n; i++) { pc104_out8(DATA, byte[i]); }
    return n;
}
