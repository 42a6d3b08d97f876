/* SPDX-License-Identifier: MIT */
/* Many fields in one call through a cursor. A cursor that writes and has room needs no call for
 * each field. Any other takes field by field. The bytes are the same. A packet needs no cursor,
 * since its length is known. */
#ifndef NUM_PACK_H
#define NUM_PACK_H

#include "exhand/bytes.h"

#include "mem.h"
#include "word.h"

/* The place of n bytes that are written now, or NULL. */
static inline uint8_t *pack_room(struct exh_bytes *c, uint32_t n)
{
    const uint32_t at = c->at;
    if (c->mode != EXH_BYTES_WRITE || at > c->cap || n > c->cap - at) { return NULL; }
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

/* --- fields at p: put there, or taken from there; each returns the place of the next --- */

static inline uint8_t *u8_field(uint8_t *p, uint8_t *v, int takes)
{
    *(takes ? v : p) = *(takes ? p : v);
    return p + 1;
}

static inline uint8_t *u16_field(uint8_t *p, uint16_t *v, int takes)
{
    if (takes) {
        *v = (uint16_t)(p[0] | (uint32_t)p[1] << 8);
    } else {
        p[0] = (uint8_t)(*v & 0xFF);
        p[1] = (uint8_t)(*v >> 8);
    }
    return p + 2;
}

/* Within a loop, GCC does not join the bytes of put_word(). So a little-endian CPU copies words. */
static inline uint8_t *u32_fields(uint8_t *p, uint32_t *v, unsigned n, int takes)
{
#if defined __GNUC__ && !defined __TINYC__ && defined __BYTE_ORDER__ && \
    __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    __builtin_memcpy(takes ? (void *)v : p, takes ? p : (void *)v, 4 * n);
    return p + 4 * n;
#else
    for (; n > 0; n--, v++, p += 4) {
        if (takes) {
            *v = word_at(p);
        } else {
            put_word(p, *v);
        }
    }
    return p;
#endif
}

/* Signed types of one width are two's complement (C99, 7.18.1.1). */
static inline uint8_t *i16_field(uint8_t *p, int16_t *v, int takes)
{
    return u16_field(p, (uint16_t *)v, takes);
}

static inline uint8_t *i32_fields(uint8_t *p, int32_t *v, unsigned n, int takes)
{
    return u32_fields(p, (uint32_t *)v, n, takes);
}

#endif
