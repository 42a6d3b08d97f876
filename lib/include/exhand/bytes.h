/* SPDX-License-Identifier: MIT */
/* Bytes: little-endian input and output through one cursor, and the one CRC.
 *
 * A module lists its fields once, in a function that takes a cursor; the cursor
 * decides whether they are written, read or only measured. So what is saved and
 * what is restored cannot drift apart. Never a struct cast, never "packed".
 */
#ifndef EXHAND_BYTES_H
#define EXHAND_BYTES_H

#include "exhand/error.h"
#include "exhand/units.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Which way a cursor goes. */
enum exh_bytes_mode {
    EXH_BYTES_WRITE,  /* from the fields into the buffer */
    EXH_BYTES_READ,   /* from the buffer into the fields */
    EXH_BYTES_MEASURE /* nowhere: the bytes are counted */
};

/* A cursor: made by the three functions below, on the caller's stack. */
struct exh_bytes {
    uint8_t *p;   /* the caller's buffer; may be NULL when only measuring */
    uint32_t cap; /* its size, B */
    uint32_t at;  /* bytes done so far; goes on counting past cap */
    uint8_t mode; /* enum exh_bytes_mode */
};

/* Cursors over a buffer. A reader never writes to what it reads. */
struct exh_bytes exh_bytes_writer(void *buf, size_t cap_B);
struct exh_bytes exh_bytes_reader(const void *buf, size_t len_B);
struct exh_bytes exh_bytes_measure(void);

/* 1 if everything so far fitted; a short buffer writes nothing past its end and
 * reads as zeros. Check once, at the end. */
static inline int exh_bytes_ok(const struct exh_bytes *c)
{
    return c->mode == EXH_BYTES_MEASURE || c->at <= c->cap;
}

/* What was read makes no sense: not ok from now on. */
static inline void exh_bytes_fail(struct exh_bytes *c) { c->at = UINT32_MAX; }

/* One field, little-endian, in the direction of the cursor. */
void exh_bytes_u8(struct exh_bytes *c, uint8_t *v);
void exh_bytes_u16(struct exh_bytes *c, uint16_t *v);
void exh_bytes_i16(struct exh_bytes *c, int16_t *v);
void exh_bytes_u32(struct exh_bytes *c, uint32_t *v);
void exh_bytes_i32(struct exh_bytes *c, int32_t *v);
void exh_bytes_i64(struct exh_bytes *c, int64_t *v);
/* n of them, one behind the other, n < 2^30: as n calls, and much faster. */
void exh_bytes_i32s(struct exh_bytes *c, int32_t *v, uint32_t n);

/* x, y, z in this order. */
static inline void exh_bytes_vec3(struct exh_bytes *c, struct exh_vec3 *v)
{
    exh_bytes_i32(c, &v->x);
    exh_bytes_i32(c, &v->y);
    exh_bytes_i32(c, &v->z);
}

/* CRC-32, reflected 0xEDB88320, start and final 0xFFFFFFFF; the check value of
 * "123456789" is 0xCBF43926. crc is 0 at first, the last result to go on. */
uint32_t exh_crc32(uint32_t crc, const void *buf, size_t len_B);

#ifdef __cplusplus
}
#endif
#endif
