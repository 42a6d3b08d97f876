/* SPDX-License-Identifier: MIT */
/* Two flash slots for one image: the newest valid one survives a power cut. */
#include "exhand/slots.h"

#include "exhand/bytes.h"
#include "exhand/error.h"

#define MAGIC         0x53485845u /* "EXHS" */
#define SEQUENCE_LAST 0xFFFFFFFEu /* erased memory reads as 0 or 2^32 - 1 */

static uint32_t u32_at(const uint8_t *p, size_t at)
{
    struct exh_bytes c = exh_bytes_reader(p + at, 4);
    uint32_t v = 0;
    exh_bytes_u32(&c, &v);
    return v;
}

int exh_slot_decode(struct exh_slot *is, const void *slot, size_t slot_B)
{
    const uint8_t *p = (const uint8_t *)slot;
    uint32_t sequence, len_B;
    size_t end;
    if (slot_B < EXH_SLOT_B(0)) { return -EXH_E_SHORT; }
    if (u32_at(p, 0) != MAGIC) { return -EXH_E_UNKNOWN; }
    sequence = u32_at(p, 4);
    len_B = u32_at(p, 8);
    if (len_B > slot_B - EXH_SLOT_B(0)) { return -EXH_E_SHORT; }
    end = EXH_SLOT_HEAD_B + (size_t)len_B;
    if (sequence == 0 || sequence > SEQUENCE_LAST || u32_at(p, end + 4) != sequence ||
        u32_at(p, end) != exh_crc32(0, p, end)) {
        return -EXH_E_CRC;
    }
    is->image = p + EXH_SLOT_HEAD_B;
    is->len_B = len_B;
    is->sequence = sequence;
    return 0;
}

static int same(const uint8_t *a, const uint8_t *b, size_t n)
{
    size_t i = 0;
    while (i < n && a[i] == b[i]) { i++; }
    return i == n;
}

int exh_slots_find(struct exh_slot *newest, const void *slot0, const void *slot1, size_t slot_B)
{
    struct exh_slot a, b;
    const int has_a = exh_slot_decode(&a, slot0, slot_B) == 0;
    const int has_b = exh_slot_decode(&b, slot1, slot_B) == 0;
    int at = has_b;
    if (!has_a && !has_b) { return -EXH_E_ABSENT; }
    if (has_a && has_b) { at = b.sequence - a.sequence - 1 < 0x7FFFFFFFu; }
    *newest = at ? b : a;
    return at;
}

int32_t exh_slots_encode(unsigned *to, const void *slot0, const void *slot1, size_t slot_B,
    void *buf, size_t cap_B, size_t image_B)
{
    const size_t room_B = cap_B < slot_B ? cap_B : slot_B;
    struct exh_slot newest = {NULL, 0, 0};
    uint32_t magic = MAGIC, len_B = (uint32_t)image_B, sequence, crc;
    struct exh_bytes c = exh_bytes_writer(buf, cap_B);
    uint8_t *image = (uint8_t *)buf + EXH_SLOT_HEAD_B;
    int at;
    if (room_B > INT32_MAX || room_B < EXH_SLOT_B(0) || image_B > room_B - EXH_SLOT_B(0)) {
        return -EXH_E_SHORT;
    }
    at = exh_slots_find(&newest, slot0, slot1, slot_B);
    if (at >= 0 && newest.len_B == len_B && same(newest.image, image, image_B)) {
        *to = (unsigned)at;
        return 0;
    }
    *to = at == 0;
    sequence = newest.sequence == SEQUENCE_LAST ? 1 : newest.sequence + 1;
    exh_bytes_u32(&c, &magic);
    exh_bytes_u32(&c, &sequence);
    exh_bytes_u32(&c, &len_B);
    c.at += len_B;
    crc = exh_crc32(0, buf, c.at);
    exh_bytes_u32(&c, &crc);
    exh_bytes_u32(&c, &sequence);
    return (int32_t)c.at;
}
