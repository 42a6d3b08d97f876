/* SPDX-License-Identifier: MIT */
/* Record: the log as a stream of records, enough to replay a run bit for bit.
 *
 * Everything that crosses inward is in it: the header (scene, versions, period,
 * parameters), a frame per tick (raw inputs, outputs, signals), events at their
 * tick, and a keyframe (the scene's state) now and then, from which a replay
 * may start. Little-endian.
 *
 *   0  u16 sync 0x5845   2  u8 type   3  u8 version   4  u16 payload length
 *   6  u32 sequence     10  u32 tick  14  payload…    then u32 CRC of all before
 */
#ifndef EXHAND_RECORD_H
#define EXHAND_RECORD_H

#include "exhand/bytes.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_RECORD_VERSION  2       /* 1: keyframes had no values on their way */
#define EXH_RECORD_SYNC     0x5845u /* first bytes of every record, "EX" */
#define EXH_RECORD_HEAD_B   14      /* bytes before a payload */
#define EXH_RECORD_OVERHEAD 18      /* bytes around a payload */

/* What a record's payload is. */
enum exh_record_type {
    EXH_RECORD_HEADER = 1,   /* struct exh_record_header, images */
    EXH_RECORD_FRAME = 2,    /* a tick: raw inputs, outputs, signals */
    EXH_RECORD_EVENT = 3,    /* struct exh_event, at its tick */
    EXH_RECORD_KEYFRAME = 4, /* the scene's state: a replay may start here */
    EXH_RECORD_DROPPED = 5,  /* u32: records lost before this one */
    EXH_RECORD_END = 6,      /* u32: records lost in all */
    EXH_RECORD_PACKET = 7    /* bytes: came over the link for the frame that follows */
};

/* What came in that is no input of every tick. */
enum exh_event_type {
    EXH_EVENT_PARAM = 1,   /* id u16, instance u16, value: staged and applied */
    EXH_EVENT_COMMAND = 2, /* value: enum exh_command */
    EXH_EVENT_MISSED = 3,  /* value: ticks missed before this tick */
    EXH_EVENT_MARK = 4,    /* value: the operator's own mark */
    EXH_EVENT_FROZE = 5    /* the black box, at its end. value: enum exh_fault, what it froze for,
                            * 0: the box was halted; instance: ticks since then; id: causes that
                            * came later; both at most 65535 */
};

/* An event's payload, in this order; what a field is, is said of the type, 0 where nothing is. */
struct exh_event {
    uint16_t type;     /* enum exh_event_type */
    uint16_t id;       /* of a signal's row */
    uint16_t instance; /* of it: finger */
    int32_t value;     /* raw */
};

/* The fixed part of the header's payload; the parameter image follows it, and behind that whole
 * calibration images of fingers (calibrate.h), none or one each. */
struct exh_record_header {
    char scene[16];       /* zero-padded */
    char board[16];       /* exh_board_info.name, likewise */
    uint32_t lib_version; /* EXH_VERSION_NUMBER */
    uint32_t signal_crc;  /* of the scene's output table */
    struct exh_period T;  /* achieved */
    uint16_t fingers;     /* codes of so many are in a frame */
    uint16_t enc_bits;    /* width of the board's counters */
    uint16_t signals;     /* int32 values in a frame after the raw codes */
};

/* A record found in a buffer; payload points into it. */
struct exh_record {
    uint8_t type, version;  /* enum exh_record_type; EXH_RECORD_VERSION */
    uint16_t len_B;         /* of the payload */
    uint32_t seq, tick;     /* of the record; of the loop; both modulo 2^32 */
    const uint8_t *payload; /* len_B bytes */
};

/* Starts a record in c; the payload follows through c. */
void exh_record_begin(struct exh_bytes *c, uint8_t type, uint32_t seq, uint32_t tick);

/* Ends it: length and CRC. The record's size in bytes, or 0 if it did not fit. */
uint32_t exh_record_end(struct exh_bytes *c);

/* The record at the start of buf. Bytes it takes, or -EXH_E_SHORT (more needed),
 * -EXH_E_UNKNOWN (no sync here), -EXH_E_CRC, -EXH_E_VERSION. To go on after
 * damage, retry one byte on. Reads len_B bytes at most, whatever they say. */
int32_t exh_record_read(const void *buf, uint32_t len_B, struct exh_record *r);

/* Payloads through a cursor. Texts of the header need not end in a zero. */
void exh_record_header_bytes(struct exh_bytes *c, struct exh_record_header *h);
void exh_event_bytes(struct exh_bytes *c, struct exh_event *e);

/* --- a record a few bytes at a time, as bytes go out of a box that has a loop to keep --- */

/* A record on its way out. */
struct exh_record_out {
    const uint8_t *mem;              /* the payload's, where it may wrap */
    uint32_t cap_B, at;              /* the memory's; where the next byte lies */
    uint32_t done_B;                 /* bytes out, of the head, payload and CRC together */
    uint32_t crc;                    /* CRC-32 of head and payload so far */
    uint16_t len_B;                  /* the payload's */
    uint8_t head[EXH_RECORD_HEAD_B]; /* ready to go out */
};

/* The payload lies in mem from `at` on, and from its start behind its end: at < cap_B,
 * len_B <= cap_B. It has to stay as it is until it is out. */
struct exh_record_place {
    const uint8_t *mem; /* the caller's */
    uint32_t cap_B, at; /* bytes of it; where the payload begins */
    uint16_t len_B;     /* the payload's */
};

/* Makes ready a record of this type, sequence number and tick; nothing goes out yet. */
void exh_record_out_begin(struct exh_record_out *o, uint8_t type, uint32_t seq, uint32_t tick,
                          struct exh_record_place payload);

/* The next bytes, at most cap_B of them: how many; 0: all were taken. */
uint32_t exh_record_out(struct exh_record_out *o, uint8_t *to, uint32_t cap_B);

/* --- the newest records in memory of the caller's (ring.c) ---
 *
 * For a black box. What it holds begins with a keyframe and goes on without a gap to what was put
 * last; whole records only. It is kept in parts that each begin with a keyframe, and the oldest
 * part goes when room is needed: no loop over records, at most two parts a call while the rule
 * below is kept. Caller's rule: put a keyframe whenever exh_ring_due() says so, behind the records
 * of a tick. Then it holds, of what was put since the first keyframe, at least the last
 * cap_B - cap_B / EXH_RING_PARTS - (the records of a tick and two keyframes), as stored: 7 bytes
 * and the payload each. Who breaks it loses what does not fit: that is counted. */

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
int exh_ring_put(struct exh_ring *r, uint8_t type, uint32_t tick, const void *payload,
                 uint32_t len_B);

/* Reading, oldest first; nothing may be put meanwhile. */
struct exh_ring_place {
    uint32_t at, left_B; /* where the next one lies; bytes from it to the end */
};

/* The oldest; of an empty ring a place that has no next. */
struct exh_ring_place exh_ring_first(const struct exh_ring *r);

/* 1: the next record, to be put out with this sequence number; 0: there is none. */
int exh_ring_next(const struct exh_ring *r, struct exh_ring_place *p, uint32_t seq,
                  struct exh_record_out *o);

#ifdef __cplusplus
}
#endif
#endif
