/* SPDX-License-Identifier: MIT */
/* Pin: the signals on the connectors of the emulated cards, seen from inside the machine through
 * ports that no card has. The drivers do not use them.
 */
#ifndef GUEST_PIN_H
#define GUEST_PIN_H

#include <stdint.h>
#include <sys/io.h>

/* numbers of pins: kind, then card and channel */
enum {
    PIN_ENC = 0x000,    /* encoder, counts x4              + 4 card + axis */
    PIN_AD = 0x100,     /* A/D of an S526, uV              + 8 card + channel */
    PIN_GLOVE = 0x200,  /* A/D of the MM-32X-AT, uV       + channel */
    PIN_DIN = 0x300,    /* eight lines from outside        + card */
    PIN_DA = 0x400,     /* D/A of an S526, uV; read only   + 4 card + axis */
    PIN_DOUT = 0x500,   /* eight lines as driven; read only + card */
    PIN_MM_DA = 0x600,  /* D/A of the MM-32X-AT, codes; read only + channel */
    PIN_MM_PORT = 0x700 /* its 8255: ports A, B, C; read only + port */
};

#define PIN_PORT   0xE000 /* which pin; then its value at + 4 */
#define MARK_PORT  0xE008 /* a golden trace of this number begins, 0: ends */
#define POWER_PORT 0xE00C /* power off and on: fault | card << 8 */
#define FILE_PORT  0xE010 /* n: a log begins, 0: ends; bytes at + 4; reads 1: it is as expected */
#define EXIT_PORT  0x00F4

static inline int32_t pin(uint32_t n)
{
    outl(n, PIN_PORT);
    return (int32_t)inl(PIN_PORT + 4);
}

static inline void set_pin(uint32_t n, int32_t value)
{
    outl(n, PIN_PORT);
    outl((uint32_t)value, PIN_PORT + 4);
}

#endif
