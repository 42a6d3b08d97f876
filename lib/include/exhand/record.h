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

#define EXH_RECORD_VERSION  3       /* 2: no limit PERSON, no source of an event */
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
    EXH_EVENT_PARAM = 1,   /* id, instance, value: staged and applied; source */
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
    uint16_t source;   /* bits, 1 << enum exh_source: who staged; more than one where more did in
                        * the same tick */
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
int32_t exh_record_decode(const void *buf, uint32_t len_B, struct exh_record *r);

/* Payloads through a cursor. Texts of the header need not end in a zero. */
void exh_record_header_serialize(struct exh_bytes *c, struct exh_record_header *h);
void exh_event_serialize(struct exh_bytes *c, struct exh_event *e);

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

#ifdef __cplusplus
}
#endif
#endif
