/* SPDX-License-Identifier: MIT */
/* Ring of the newest records in the caller's memory, and output of records in pieces. */
#include "exhand/ring.h"

#include "exhand/error.h"

#include <stddef.h>
#include "../num/mem.h"

#define SLOTS (EXH_RING_PARTS + 2u)

/* --- a record in pieces --- */

void exh_record_out_begin(struct exh_record_out *o, uint8_t type, uint32_t seq, uint32_t tick,
    struct exh_record_place payload)
{
    struct exh_bytes c = exh_bytes_writer(o->head, sizeof o->head);
    uint16_t len = payload.len_B;
    exh_record_begin(&c, type, seq, tick);
    c.at = 4;
    exh_bytes_u16(&c, &len);
    o->mem = payload.mem;
    o->cap_B = payload.cap_B;
    o->at = payload.at;
    o->len_B = len;
    o->done_B = 0;
    o->crc = 0;
}

static uint32_t least(uint32_t a, uint32_t b) { return a < b ? a : b; }

/* Outputs payload bytes up to the wrap of its memory. */
static uint32_t payload_out(struct exh_record_out *o, uint8_t *to, uint32_t n)
{
    n = least(n, o->cap_B - o->at);
    memcpy(to, o->mem + o->at, n);
    o->at += n;
    if (o->at == o->cap_B) { o->at = 0; }
    return n;
}

static uint32_t crc_out(const struct exh_record_out *o, uint8_t *to, uint32_t from, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) { to[i] = (uint8_t)(o->crc >> 8 * (from + i)); }
    return n;
}

uint32_t exh_record_out(struct exh_record_out *o, uint8_t *to, uint32_t cap_B)
{
    const uint32_t body_B = EXH_RECORD_HEAD_B + (uint32_t)o->len_B;
    uint32_t n = 0;
    while (n < cap_B && o->done_B < body_B + 4) {
        const uint32_t room = cap_B - n, done = o->done_B;
        uint32_t k;
        if (done < EXH_RECORD_HEAD_B) {
            k = least(room, EXH_RECORD_HEAD_B - done);
            memcpy(to + n, o->head + done, k);
        } else if (done < body_B) {
            k = payload_out(o, to + n, least(room, body_B - done));
        } else {
            k = crc_out(o, to + n, done - body_B, least(room, body_B + 4 - done));
        }
        if (done < body_B) { o->crc = exh_crc32(o->crc, to + n, k); }
        o->done_B += k;
        n += k;
    }
    return n;
}

/* --- the ring --- */

int exh_ring_setup(struct exh_ring *r, void *mem, size_t cap_B)
{
    static const struct exh_ring empty = {0};
    if (cap_B < EXH_RING_MIN_B || cap_B > EXH_RING_MAX_B) { return -EXH_E_RANGE; }
    *r = empty;
    r->mem = (uint8_t *)mem;
    r->cap_B = (uint32_t)cap_B;
    return 0;
}

static uint32_t parts(const struct exh_ring *r) { return r->live & 0xFFu; }

static uint32_t oldest(const struct exh_ring *r) { return r->live >> 8; }

/* The slot of the i-th part, 0 being the oldest. */
static uint32_t slot(const struct exh_ring *r, uint32_t i)
{
    const uint32_t at = oldest(r) + i;
    return at < SLOTS ? at : at - SLOTS;
}

/* Bytes from the start of the i-th part to the head. Never 0, since the ring is never full. */
static uint32_t from_part(const struct exh_ring *r, uint32_t i)
{
    const uint32_t start = r->start[slot(r, i)], head = r->head;
    return head >= start ? head - start : head + r->cap_B - start;
}

static uint32_t used(const struct exh_ring *r) { return parts(r) ? from_part(r, 0) : 0; }

int exh_ring_due(const struct exh_ring *r)
{
    return parts(r) == 0 || from_part(r, parts(r) - 1) >= r->cap_B / EXH_RING_PARTS;
}

/* One store, so that an interrupt sees the part or does not. */
static void drop_oldest(struct exh_ring *r) { r->live = slot(r, 1) << 8 | (parts(r) - 1); }

static int lose(struct exh_ring *r)
{
    r->lost += r->lost < UINT32_MAX;
    return 0;
}

/* Copies to free memory from `at` on. Returns the index of the next byte. */
static uint32_t copy_in(struct exh_ring *r, uint32_t at, const uint8_t *from, uint32_t n)
{
    const uint32_t first = least(n, r->cap_B - at);
    memcpy(r->mem + at, from, first);
    if (n > first) { memcpy(r->mem, from + first, n - first); }
    at += n;
    return at < r->cap_B ? at : at - r->cap_B;
}

int exh_ring_put(
    struct exh_ring *r, uint8_t type, uint32_t tick, const void *payload, uint32_t len_B)
{
    const uint32_t need = EXH_RING_HEAD_B + len_B;
    const int begins = type == EXH_RECORD_KEYFRAME && exh_ring_due(r);
    uint8_t head[EXH_RING_HEAD_B];
    uint16_t len = (uint16_t)len_B;
    struct exh_bytes c = exh_bytes_writer(head, sizeof head);
    uint32_t at;

    if (len_B > UINT16_MAX || need >= r->cap_B || (parts(r) == 0 && !begins)) { return lose(r); }
    if (begins && parts(r) == SLOTS) { drop_oldest(r); }
    while (parts(r) > 0 && need >= r->cap_B - used(r)) { drop_oldest(r); }
    if (parts(r) == 0 && !begins) { return lose(r); } /* its own part had to go */
    exh_bytes_u16(&c, &len);
    exh_bytes_u8(&c, &type);
    exh_bytes_u32(&c, &tick);
    if (begins) { r->start[slot(r, parts(r))] = r->head; }
    at = copy_in(r, r->head, head, sizeof head);
    r->head = copy_in(r, at, (const uint8_t *)payload, len_B); /* from here on it is there */
    if (begins) { r->live = r->live + 1; }
    return 1;
}

struct exh_ring_place exh_ring_first(const struct exh_ring *r)
{
    const struct exh_ring_place p = {r->start[oldest(r)], used(r)};
    return p;
}

int exh_ring_next(
    const struct exh_ring *r, struct exh_ring_place *p, uint32_t seq, struct exh_record_out *o)
{
    uint8_t head[EXH_RING_HEAD_B] = {0};
    struct exh_bytes c = exh_bytes_reader(head, sizeof head);
    struct exh_record_place payload = {r->mem, r->cap_B, p->at, 0};
    uint8_t type = 0;
    uint32_t tick = 0;
    if (p->left_B < EXH_RING_HEAD_B) { return 0; }
    for (unsigned i = 0; i < EXH_RING_HEAD_B; i++) {
        head[i] = r->mem[payload.at];
        payload.at = payload.at + 1 < r->cap_B ? payload.at + 1 : 0;
    }
    exh_bytes_u16(&c, &payload.len_B);
    exh_bytes_u8(&c, &type);
    exh_bytes_u32(&c, &tick);
    if (payload.len_B > p->left_B - EXH_RING_HEAD_B) { return 0; } /* damaged memory */
    exh_record_out_begin(o, type, seq, tick, payload);
    p->left_B -= EXH_RING_HEAD_B + (uint32_t)payload.len_B;
    p->at = payload.at + payload.len_B;
    if (p->at >= r->cap_B) { p->at -= r->cap_B; }
    return 1;
}
