/* SPDX-License-Identifier: MIT */
/* The library's CRC-32 by the chip's unit instead of a table. The unit has the same polynomial, but
 * takes the highest bit of a word first. RBIT reverses the bits (RM0090, CRC). The unit always
 * starts from ones; a changed first word gives any other start. Only the loop calls it, no
 * interrupt. */
#include "stm.h"

#include "exhand/bytes.h"

typedef uint32_t __attribute__((may_alias, aligned(1))) word;

static uint32_t turned(uint32_t v)
{
    __asm__("rbit %0, %0" : "+r"(v));
    return v;
}

static void feed(uint32_t v) { REG(BASE_CRC, CRC_DR) = turned(v); }

/* What is left behind the last word. */
static uint32_t bytes(uint32_t crc, const uint8_t *p, size_t len_B)
{
    for (; len_B > 0; len_B--, p++) {
        crc ^= *p;
        for (int i = 0; i < 8; i++) { crc = crc >> 1 ^ (0xEDB88320u & (0u - (crc & 1u))); }
    }
    return crc;
}

uint32_t exh_crc32(uint32_t crc, const void *buf, size_t len_B)
{
    const uint8_t *p = buf;
    const word *w = buf;
    if (len_B < 4) { return ~bytes(~crc, p, len_B); }
    REG(BASE_CRC, CRC_CR) = CRC_CR_RESET;
    feed(*w++ ^ crc);
    for (len_B -= 4; len_B >= 16; len_B -= 16, w += 4) {
        feed(w[0]);
        feed(w[1]);
        feed(w[2]);
        feed(w[3]);
    }
    for (; len_B >= 4; len_B -= 4) { feed(*w++); }
    p = (const uint8_t *)w;
    return ~bytes(turned(REG(BASE_CRC, CRC_DR)), p, len_B);
}
