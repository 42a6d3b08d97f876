/* SPDX-License-Identifier: MIT */
/* Words and halves of them from bytes. */
#ifndef NUM_WORD_H
#define NUM_WORD_H

#include <stdint.h>

/* Little-endian. Written byte by byte; compilers make one access of it where the CPU has one. */
static inline uint32_t word_at(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static inline uint16_t half_at(const uint8_t *p) { return (uint16_t)(p[0] | (uint32_t)p[1] << 8); }

/* The value of a 16-bit pattern read as two's complement. */
static inline int16_t signed_half(uint16_t u)
{
    return (int16_t)(u < 0x8000u ? (int32_t)u : (int32_t)u - 0x10000);
}

static inline void put_word(uint8_t *p, uint32_t v)
{
    p[0] = (uint8_t)(v & 0xFF);
    p[1] = (uint8_t)(v >> 8 & 0xFF);
    p[2] = (uint8_t)(v >> 16 & 0xFF);
    p[3] = (uint8_t)(v >> 24);
}

#endif
