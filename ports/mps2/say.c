/* SPDX-License-Identifier: MIT */
/* Text over UART 0 of the board, and the way out of an emulator. */
#include "mps2.h"

#define UART_DATA    MPS2_REG(0x40004000)
#define UART_STATE   MPS2_REG(0x40004004)
#define UART_CONTROL MPS2_REG(0x40004008)
#define UART_BAUDDIV MPS2_REG(0x40004010)
#define TX_FULL      1u
#define TX_ENABLE    1u
#define POLLS        100000u

void mps2_say_open(void)
{
    UART_BAUDDIV = 25000000 / 115200;
    UART_CONTROL = TX_ENABLE;
}

void mps2_say(const char *text)
{
    for (; *text; text++) {
        for (uint32_t n = 0; n < POLLS && UART_STATE & TX_FULL; n++) {}
        UART_DATA = (uint8_t)*text;
    }
}

void mps2_say_u32(uint32_t value)
{
    char digits[11]; /* 2^32-1 has ten */
    char *p = digits + sizeof digits - 1;
    *p = 0;
    do {
        *--p = (char)('0' + value % 10);
        value /= 10;
    } while (value);
    mps2_say(p);
}

/* Semihosting: a breakpoint that emulators and debuggers answer. Without one it is a fault, and the
 * processor stops there. */
void mps2_exit(uint32_t status)
{
    const uint32_t block[2] = {0x20026 /* the program ended normally */, status};
    register uint32_t operation __asm__("r0") = 0x20; /* SYS_EXIT_EXTENDED */
    register const uint32_t *argument __asm__("r1") = block;
    __asm__ volatile("bkpt 0xab" : "+r"(operation) : "r"(argument) : "memory");
}
