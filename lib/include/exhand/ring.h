/* SPDX-License-Identifier: MIT */
/* Ring: the newest records in a fixed memory, for a black box.
 *
 * The content starts with a keyframe and continues without a gap to the last record put. Each part
 * of the memory starts with a keyframe. If space is needed, the oldest part is dropped: no loop
 * over records, at most two parts per call. A record occupies 7 bytes and its payload.
 *
 * If exh_ring_due() returns 1, put a keyframe after the records of the tick. Then the ring keeps at
 * least the last cap_B - cap_B / EXH_RING_PARTS - (records of a tick and two keyframes) bytes.
 * Without keyframes in time, records that do not fit are lost and counted.
 *   exh_ring_put(&ring, EXH_RECORD_FRAME, tick, buf, len_B);
 *   if (exh_ring_due(&ring)) { exh_ring_put(&ring, EXH_RECORD_KEYFRAME, tick, state, state_B); } */
#ifndef EXHAND_RING_H
#define EXHAND_RING_H

#include "exhand/record.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_RING_PARTS  8           /* parts of a full ring */
#define EXH_RING_HEAD_B 7           /* before each payload: length u16, type u8, tick u32 */
#define EXH_RING_MIN_B  64u         /* smallest memory, B */
#define EXH_RING_MAX_B  0x40000000u /* largest memory, B */

/* A ring. Only exh_ring_put() writes it, except mem and cap_B. */
struct exh_ring {
    uint8_t *mem;                       /* the caller's */
    uint32_t cap_B;                     /* size of mem */
    uint32_t start[EXH_RING_PARTS + 2]; /* queue of the starts of parts */
    volatile uint32_t live;             /* index of the oldest, times 256, plus number */
    volatile uint32_t head;             /* index of the next byte */
    uint32_t lost; /* records without space or without a keyframe before them, saturating */
};

/* Set-up of an empty ring. -EXH_E_RANGE: cap_B is not EXH_RING_MIN_B .. EXH_RING_MAX_B. */
int exh_ring_setup(struct exh_ring *r, void *mem, size_t cap_B);

/* 1 if a keyframe is due: there is none, or the newest part is long enough. */
int exh_ring_due(const struct exh_ring *r);

/* Copies a record's payload into the ring. Returns 1, or 0 if it is lost: there is no keyframe
 * before it, or it exceeds 65535 bytes or the memory. If the call is interrupted at any
 * instruction, the ring keeps its content, perhaps without the oldest parts. */
int exh_ring_put(
    struct exh_ring *r, uint8_t type, uint32_t tick, const void *payload, uint32_t len_B);

/* Position of a reader, oldest record first. Do not put records while reading. */
struct exh_ring_place {
    uint32_t at, left_B; /* index of the next record; bytes from it to the end */
};

/* The position of the oldest record, or of the end if the ring is empty. */
struct exh_ring_place exh_ring_first(const struct exh_ring *r);

/* Prepares the next record in *o with this sequence number. Returns 1, or 0 at the end. */
int exh_ring_next(
    const struct exh_ring *r, struct exh_ring_place *p, uint32_t seq, struct exh_record_out *o);

#ifdef __cplusplus
}
#endif
#endif
