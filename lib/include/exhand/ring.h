/* SPDX-License-Identifier: MIT */
/* Ring: the newest records, in memory of the caller's.
 *
 * For a black box. What it holds begins with a keyframe and goes on without a gap to what was put
 * last; whole records only. It is kept in parts that each begin with a keyframe, and the oldest
 * part goes when room is needed: no loop over records, at most two parts a call while the rule
 * below is kept. Caller's rule: put a keyframe whenever exh_ring_due() says so, behind the records
 * of a tick. Then it holds, of what was put since the first keyframe, at least the last
 * cap_B - cap_B / EXH_RING_PARTS - (the records of a tick and two keyframes), as stored: 7 bytes
 * and the payload each. Who breaks it loses what does not fit: that is counted.
 */
#ifndef EXHAND_RING_H
#define EXHAND_RING_H

#include "exhand/record.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_RING_PARTS  8           /* that a full ring is kept in */
#define EXH_RING_HEAD_B 7           /* length u16, type u8, tick u32 before each payload */
#define EXH_RING_MIN_B  64u         /* memory, B: at least */
#define EXH_RING_MAX_B  0x40000000u /* at most */

/* A ring; all but mem and cap_B is written by exh_ring_put() alone. */
struct exh_ring {
    uint8_t *mem;                       /* the caller's */
    uint32_t cap_B;                     /* bytes of it */
    uint32_t start[EXH_RING_PARTS + 2]; /* where parts begin, a queue: */
    volatile uint32_t live;             /* the oldest, times 256, and how many */
    volatile uint32_t head;             /* where the next byte goes */
    uint32_t lost; /* records that found no room or no keyframe before them, saturating */
};

/* Empty. -EXH_E_RANGE: cap_B is not EXH_RING_MIN_B .. EXH_RING_MAX_B. */
int exh_ring_setup(struct exh_ring *r, void *mem, size_t cap_B);

/* 1: a keyframe, please: there is none, or the newest part is long enough. */
int exh_ring_due(const struct exh_ring *r);

/* A record's payload, copied. 1, or 0: lost, as there is no keyframe before it, or it is longer
 * than 65535 bytes or than the memory. Interrupted at any instruction, the ring holds what it held,
 * maybe without its oldest parts: a box that is halted in the middle of it can still be read. */
int exh_ring_put(
    struct exh_ring *r, uint8_t type, uint32_t tick, const void *payload, uint32_t len_B);

/* Reading, oldest first; nothing may be put meanwhile. */
struct exh_ring_place {
    uint32_t at, left_B; /* where the next one lies; bytes from it to the end */
};

/* The oldest; of an empty ring a place that has no next. */
struct exh_ring_place exh_ring_first(const struct exh_ring *r);

/* 1: the next record, to be put out with this sequence number; 0: there is none. */
int exh_ring_next(
    const struct exh_ring *r, struct exh_ring_place *p, uint32_t seq, struct exh_record_out *o);

#ifdef __cplusplus
}
#endif
#endif
