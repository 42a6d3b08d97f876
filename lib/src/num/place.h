/* SPDX-License-Identifier: MIT */
/* Fields at fixed places of a packet. The cursor checks the room once, as a check costs more than a
 * field. reads is a constant of the caller, so that one direction is left. */
#ifndef NUM_PLACE_H
#define NUM_PLACE_H

#include "exhand/bytes.h"
#include "exhand/fix.h"

#include "word.h"

/* The place of the next n bytes, or NULL if there is no room. */
static inline uint8_t *place_of(struct exh_bytes *c, uint32_t n)
{
    const uint32_t at = c->at;
    c->at = at > UINT32_MAX - n ? UINT32_MAX : at + n;
    return c->at <= c->cap ? c->p + at : NULL;
}

/* Calls fields(p, v, reads) with both constants. */
#define PLACE(c, fields, p, v) \
    do { \
        if ((c)->mode == EXH_BYTES_READ) { \
            fields(p, v, 1); \
        } else { \
            fields(p, v, 0); \
        } \
    } while (0)

static inline void place_u8(uint8_t *p, uint8_t *v, int reads)
{
    if (reads) {
        *v = *p;
    } else {
        *p = *v;
    }
}

static inline void place_u16(uint8_t *p, uint16_t *v, int reads)
{
    if (reads) {
        *v = (uint16_t)(p[0] | (uint32_t)p[1] << 8);
    } else {
        p[0] = (uint8_t)(*v & 0xFF);
        p[1] = (uint8_t)(*v >> 8);
    }
}

static inline void place_i16(uint8_t *p, int16_t *v, int reads)
{
    uint16_t u = reads ? 0 : (uint16_t)*v;
    place_u16(p, &u, reads);
    if (reads) { *v = (int16_t)(u < 0x8000u ? (int32_t)u : (int32_t)u - 0x10000); }
}

static inline void place_u32(uint8_t *p, uint32_t *v, int reads)
{
    if (reads) {
        *v = word_at(p);
    } else {
        put_word(p, *v);
    }
}

static inline void place_vec3(uint8_t *p, int32_t v[3], int reads)
{
    for (unsigned i = 0; i < 3; i++) {
        uint32_t u = reads ? 0 : (uint32_t)v[i];
        place_u32(p + 4 * i, &u, reads);
        if (reads) { v[i] = exh_from_u32(u); }
    }
}

#endif
