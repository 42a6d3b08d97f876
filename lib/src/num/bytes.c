/* SPDX-License-Identifier: MIT */
/* Cursor over a buffer: reads, writes or measures fields. */
#include "exhand/bytes.h"

#include "exhand/fix.h"

#include "word.h"

/* A cursor counts to UINT32_MAX, so every cap must stay below. */
static uint32_t capacity(size_t B) { return B < UINT32_MAX ? (uint32_t)B : UINT32_MAX - 1; }

struct exh_bytes exh_bytes_writer(void *buf, size_t cap_B)
{
    const struct exh_bytes c = {(uint8_t *)buf, capacity(cap_B), 0, EXH_BYTES_WRITE};
    return c;
}

struct exh_bytes exh_bytes_reader(const void *buf, size_t len_B)
{
    /* One pointer serves both directions; a reader only reads from it. */
    union {
        const void *in;
        uint8_t *p;
    } u;
    struct exh_bytes c = {NULL, capacity(len_B), 0, EXH_BYTES_READ};
    u.in = buf;
    c.p = u.p;
    return c;
}

struct exh_bytes exh_bytes_measure(void)
{
    const struct exh_bytes c = {NULL, 0, 0, EXH_BYTES_MEASURE};
    return c;
}

/* The place of the next n bytes, or NULL if there is no room or the cursor only measures. Counts
 * beyond cap, which gives the required size, and saturates instead of wrapping. */
static uint8_t *move_past(struct exh_bytes *c, uint32_t n)
{
    const uint32_t at = c->at;
    if (at <= c->cap && n <= c->cap - at) {
        c->at = at + n;
        return c->mode != EXH_BYTES_MEASURE ? c->p + at : NULL;
    }
    c->at = at > UINT32_MAX - n ? UINT32_MAX : at + n;
    return NULL;
}

/* 1 if the value keeps its content: writing or measuring. */
static int stays(const struct exh_bytes *c) { return c->mode != EXH_BYTES_READ; }

void exh_bytes_u8(struct exh_bytes *c, uint8_t *v)
{
    uint8_t *const p = move_past(c, 1);
    if (!stays(c)) {
        *v = (uint8_t)(p != NULL ? *p : 0);
    } else if (p != NULL) {
        *p = *v;
    }
}

void exh_bytes_u16(struct exh_bytes *c, uint16_t *v)
{
    uint8_t *const p = move_past(c, 2);
    if (!stays(c)) {
        *v = (uint16_t)(p != NULL ? p[0] | (uint32_t)p[1] << 8 : 0);
    } else if (p != NULL) {
        p[0] = (uint8_t)(*v & 0xFF);
        p[1] = (uint8_t)(*v >> 8);
    }
}

void exh_bytes_i16(struct exh_bytes *c, int16_t *v)
{
    uint16_t u = (uint16_t)*v;
    exh_bytes_u16(c, &u);
    *v = (int16_t)(u < 0x8000u ? (int32_t)u : (int32_t)u - 0x10000);
}

void exh_bytes_i32(struct exh_bytes *c, int32_t *v)
{
    uint8_t *const p = move_past(c, 4);
    if (!stays(c)) {
        *v = p != NULL ? exh_from_u32(word_at(p)) : 0;
    } else if (p != NULL) {
        put_word(p, (uint32_t)*v);
    }
}

void exh_bytes_u32(struct exh_bytes *c, uint32_t *v)
{
    int32_t i = exh_from_u32(*v);
    exh_bytes_i32(c, &i);
    *v = (uint32_t)i;
}

/* If the buffer ends among them, processes each value that fits. */
void exh_bytes_i32s(struct exh_bytes *c, int32_t *v, uint32_t n)
{
    const uint32_t at = c->at;
    uint8_t *p = move_past(c, 4 * n);
    if (p == NULL) {
        c->at = at;
        for (; n > 0; n--, v++) { exh_bytes_i32(c, v); }
    } else if (stays(c)) {
        for (; n > 0; n--, v++, p += 4) { put_word(p, (uint32_t)*v); }
    } else {
        for (; n > 0; n--, v++, p += 4) { *v = exh_from_u32(word_at(p)); }
    }
}

void exh_bytes_i64(struct exh_bytes *c, int64_t *v)
{
    uint8_t *const p = move_past(c, 8);
    const uint64_t u = (uint64_t)*v;
    if (!stays(c)) {
        *v = p != NULL ? exh_from_u64(word_at(p) | (uint64_t)word_at(p + 4) << 32) : 0;
    } else if (p != NULL) {
        put_word(p, (uint32_t)(u & UINT32_MAX));
        put_word(p + 4, (uint32_t)(u >> 32));
    }
}
