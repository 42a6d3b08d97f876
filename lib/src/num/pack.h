/* SPDX-License-Identifier: MIT */
/* Many fields in one call through a cursor. A cursor that writes and has room needs no call for
 * each field. Any other takes field by field. The bytes are the same. A packet is read in the same
 * way. */
#ifndef NUM_PACK_H
#define NUM_PACK_H

#include "exhand/bytes.h"

#include "mem.h"

/* The place of n bytes that are written now, or NULL. */
static inline uint8_t *pack_room(struct exh_bytes *c, uint32_t n)
{
    const uint32_t at = c->at;
    if (c->mode != EXH_BYTES_WRITE || at > c->cap || n > c->cap - at) { return NULL; }
    c->at = at + n;
    return c->p + at;
}

static inline uint16_t half_at(const uint8_t *p) { return (uint16_t)(p[0] | (uint32_t)p[1] << 8); }

/* The value of a 16-bit pattern read as two's complement. */
static inline int16_t signed_half(uint16_t u)
{
    return (int16_t)(u < 0x8000u ? (int32_t)u : (int32_t)u - 0x10000);
}

/* The place of n bytes that are read now, or NULL. */
static inline const uint8_t *unpack_room(struct exh_bytes *c, uint32_t n)
{
    const uint32_t at = c->at;
    if (c->mode != EXH_BYTES_READ || at > c->cap || n > c->cap - at) { return NULL; }
    c->at = at + n;
    return c->p + at;
}

static inline void pack_i16s(struct exh_bytes *c, int16_t *v, uint32_t n)
{
    uint8_t *p = pack_room(c, 2 * n);
    for (; n > 0; n--, v++) {
        if (p != NULL) {
            p[0] = (uint8_t)((uint16_t)*v & 0xFF);
            p[1] = (uint8_t)((uint16_t)*v >> 8);
            p += 2;
        } else {
            exh_bytes_i16(c, v);
        }
    }
}

#endif
