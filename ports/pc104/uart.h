/* SPDX-License-Identifier: MIT */
/* A 16550, by its registers from its base. */
#ifndef PC104_UART_H
#define PC104_UART_H

enum { UART_COM1 = 0x3F8, UART_COM2 = 0x2F8 };
enum {
    UART_DATA,
    UART_INT_ENABLE,
    UART_FIFO,
    UART_LINE,
    UART_MODEM,
    UART_STATUS,
    UART_SCRATCH = 7
};
#define UART_LINE_8N1      0x03u
#define UART_LINE_DIVISOR  0x80u /* data and interrupt registers become the divisor */
#define UART_STATUS_READY  0x01u /* a character has come */
#define UART_STATUS_BAD    0x1Eu /* overrun, parity, frame, break */
#define UART_STATUS_EMPTY  0x20u /* takes a character; the FIFO is empty */
#define UART_STATUS_SILENT 0x40u /* and the last is out */
/* FIFO on; its content is dropped. The threshold is 14 characters: no interrupt is used, but
 * emulators deliver that many in one piece. */
#define UART_FIFO_EMPTY 0xC7u
#define UART_BASE_BAUD  115200u /* divisor 1 */
#define UART_FIFO_B     16u

/* 8N1, no interrupts, FIFO on and emptied. 1: it has one. */
int pc104_uart_set(uint16_t base, uint16_t divisor);

#endif
