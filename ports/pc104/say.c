/* SPDX-License-Identifier: MIT */
#include "pc104.h"

void pc104_say(const char *text)
{
    for (; *text; text++) {
        if (*text == '\n') { pc104_uart_put('\r'); }
        pc104_uart_put(*text);
    }
}

void pc104_say_u32(uint32_t value)
{
    char digits[11]; /* 2^32-1 has ten */
    unsigned at = sizeof digits - 1;

    digits[at] = 0;
    do {
        digits[--at] = (char)('0' + value % 10);
        value /= 10;
    } while (value);
    pc104_say(&digits[at]);
}

void pc104_say_hex(uint32_t value)
{
    pc104_say("0x");
    for (int shift = 28; shift >= 0; shift -= 4) {
        pc104_uart_put("0123456789abcdef"[value >> shift & 15]);
    }
}

int pc104_same_text(const char *a, const char *b)
{
    while (*a && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

/* Exact for up to 12 fraction bits' worth of decimals, cut behind. */
void pc104_say_fixed(int64_t raw, unsigned frac)
{
    uint64_t magnitude = raw < 0 ? UINT64_C(0) - (uint64_t)raw : (uint64_t)raw;
    const uint64_t mask = (UINT64_C(1) << frac) - 1;
    uint64_t rest = magnitude & mask; /* frac <= 60 */
    pc104_say(raw < 0 ? "-" : "");
    pc104_say_u32((uint32_t)(magnitude >> frac));
    pc104_say(rest ? "." : "");
    for (unsigned n = 0; rest && n < 12; n++) {
        rest *= 10;
        pc104_uart_put((char)('0' + (char)(rest >> frac)));
        rest &= mask;
    }
}
