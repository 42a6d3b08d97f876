/* SPDX-License-Identifier: MIT */
/* 32-bit words from bytes. */
#ifndef NUM_WORD_H
#define NUM_WORD_H

#include <stdint.h>

/* Little-endian. Written byte by byte; compilers make one access of it where the CPU has one. */
static inline uint32_t word_at(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static inline void put_word(uint8_t *p, uint32_t v)
{
    p[0] = (uint8_t)(v & 0xFF);
    p[1] = (uint8_t)(v >> 8 & 0xFF);
    p[2] = (uint8_t)(v >> 16 & 0xFF);
    p[3] = (uint8_t)(v >> 24);
}

#endif
