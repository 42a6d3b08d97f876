/* SPDX-License-Identifier: MIT */
/* CRC unit (RM0090 chapter 4). What it waits: bus.c. */
#include "stm.h"

enum { DR, IDR, CR };
#define POLYNOMIAL 0x04C11DB7u

uint32_t stm_crc_read(const struct stm *s, uint32_t off)
{
    return off >> 2 == DR ? s->crc.data : off >> 2 == IDR ? s->crc.own : 0;
}

void stm_crc_write(struct stm *s, uint32_t off, uint32_t v)
{
    if (off >> 2 == IDR) { s->crc.own = (uint8_t)v; }
    if (off >> 2 == CR && v & 1) { s->crc.data = 0xFFFFFFFFu; }
    if (off >> 2 != DR) { return; }
    s->crc.data ^= v;
    for (int i = 0; i < 32; i++) {
        s->crc.data = s->crc.data << 1 ^ (s->crc.data >> 31 ? POLYNOMIAL : 0);
    }
}
