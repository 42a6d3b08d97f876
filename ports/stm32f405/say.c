/* SPDX-License-Identifier: MIT */
/* Text over USART2, polled. */
#include "stm.h"

#define POLLS 100000u

void stm_say(const char *text)
{
    for (; *text; text++) {
        for (uint32_t n = 0; n < POLLS && !(REG(BASE_USART2, USART_SR) & USART_SR_TXE); n++) {}
        REG(BASE_USART2, USART_DR) = (uint8_t)*text;
    }
}

static void say_in(uint32_t value, uint32_t radix)
{
    char digits[11]; /* 2^32-1 has ten */
    char *p = digits + sizeof digits - 1;
    *p = 0;
    do {
        *--p = "0123456789abcdef"[value % radix];
        value /= radix;
    } while (value);
    stm_say(p);
}

void stm_say_u32(uint32_t value) { say_in(value, 10); }

void stm_say_hex(uint32_t value)
{
    stm_say("0x");
    say_in(value, 16);
}

int stm_same(const char *a, const char *b)
{
    for (; *a && *a == *b; a++, b++) {}
    return *a == *b;
}
