/* SPDX-License-Identifier: MIT */
/* Bytes: little-endian input and output through one cursor, and the one CRC.
 *
 * A module lists its fields once, in a function that takes a cursor. The mode of the cursor decides
 * whether the function writes, reads or measures them. Saving and restoring therefore always agree.
 * No code casts a struct to bytes or uses "packed".
 *
 *   struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
 *   exh_contact_serialize(&c, &contact);
 *   if (!exh_bytes_ok(&c)) { return -EXH_E_SHORT; } */
#ifndef EXHAND_BYTES_H
#define EXHAND_BYTES_H

#include "exhand/error.h"
#include "exhand/units.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The direction of a cursor. */
enum exh_bytes_mode {
    EXH_BYTES_WRITE,  /* from the fields into the buffer */
    EXH_BYTES_READ,   /* from the buffer into the fields */
    EXH_BYTES_MEASURE /* counts the bytes only */
};

/* A cursor. Make one on the stack by the three functions below. */
struct exh_bytes {
    uint8_t *p;   /* the caller's buffer; may be NULL when only measuring */
    uint32_t cap; /* size of the buffer, B */
    uint32_t at;  /* bytes processed so far; continues to count beyond cap */
    uint8_t mode; /* enum exh_bytes_mode */
};

/* Cursors over a buffer of the given length in bytes. A reader never writes to its buffer. */
struct exh_bytes exh_bytes_writer(void *buf, size_t cap_B);
struct exh_bytes exh_bytes_reader(const void *buf, size_t len_B);
struct exh_bytes exh_bytes_measure(void);

/* 1 if all fields so far fitted into the buffer. A short buffer is never written beyond its end,
 * and missing bytes read as zeros. So one check at the end is enough. */
static inline int exh_bytes_ok(const struct exh_bytes *c)
{
    return c->mode == EXH_BYTES_MEASURE || c->at <= c->cap;
}

/* Marks the input as invalid: exh_bytes_ok() returns 0 from now on. */
static inline void exh_bytes_fail(struct exh_bytes *c) { c->at = UINT32_MAX; }

/* Each processes one little-endian field in the direction of the cursor. */
void exh_bytes_u8(struct exh_bytes *c, uint8_t *v);
void exh_bytes_u16(struct exh_bytes *c, uint16_t *v);
void exh_bytes_i16(struct exh_bytes *c, int16_t *v);
void exh_bytes_u32(struct exh_bytes *c, uint32_t *v);
void exh_bytes_i32(struct exh_bytes *c, int32_t *v);
void exh_bytes_i64(struct exh_bytes *c, int64_t *v);
/* n consecutive fields, n < 2^30. Same bytes as n calls of exh_bytes_i32(), but much faster. */
void exh_bytes_i32s(struct exh_bytes *c, int32_t *v, uint32_t n);

/* x, y, z in this order. */
static inline void exh_bytes_vec3(struct exh_bytes *c, struct exh_vec3 *v)
{
    exh_bytes_i32(c, &v->x);
    exh_bytes_i32(c, &v->y);
    exh_bytes_i32(c, &v->z);
}

/* CRC-32 with the reflected polynomial 0xEDB88320, initial value and final XOR 0xFFFFFFFF. The CRC
 * of "123456789" is 0xCBF43926. Pass crc = 0 first, then the last result to continue. */
uint32_t exh_crc32(uint32_t crc, const void *buf, size_t len_B);

#ifdef __cplusplus
}
#endif
#endif
