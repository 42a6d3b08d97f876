/* SPDX-License-Identifier: MIT */
/* Record: the log as a stream of records, sufficient to replay a run bit for bit.
 *
 * The log contains all inputs: a header (scene, versions, period, parameters), a frame per tick
 * (raw inputs, outputs, signals), and events at their tick. Periodic keyframes hold the scene's
 * state; a replay may start at each. Little-endian:
 *
 *   0  u16 sync 0x5845   2  u8 type   3  u8 version   4  u16 payload length
 *   6  u32 sequence     10  u32 tick  14  payload...  then u32 CRC of all bytes before */
#ifndef EXHAND_RECORD_H
#define EXHAND_RECORD_H

#include "exhand/bytes.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_RECORD_VERSION  3       /* version 2 lacks the limit PERSON and the source of events */
#define EXH_RECORD_SYNC     0x5845u /* first bytes of every record, "EX" */
#define EXH_RECORD_HEAD_B   14      /* bytes before a payload */
#define EXH_RECORD_OVERHEAD 18      /* bytes around a payload */

/* The type of a record's payload. */
enum exh_record_type {
    EXH_RECORD_HEADER = 1,   /* struct exh_record_header, then images */
    EXH_RECORD_FRAME = 2,    /* a tick: raw inputs, outputs, signals */
    EXH_RECORD_EVENT = 3,    /* struct exh_event, at its tick */
    EXH_RECORD_KEYFRAME = 4, /* state of the scene: a replay may start here */
    EXH_RECORD_DROPPED = 5,  /* u32: records lost before this one */
    EXH_RECORD_END = 6,      /* u32: total of records lost */
    EXH_RECORD_PACKET = 7    /* bytes received over the link for the next frame */
};

/* An input that does not occur in every tick. */
enum exh_event_type {
    EXH_EVENT_PARAM = 1,   /* id, instance, value: staged and applied; source */
    EXH_EVENT_COMMAND = 2, /* value: enum exh_command */
    EXH_EVENT_MISSED = 3,  /* value: ticks missed before this tick */
    EXH_EVENT_MARK = 4,    /* value: the operator's own mark */
    EXH_EVENT_FROZE = 5    /* end of a black box log. value: enum exh_fault that froze it, 0:
                            * halted; instance: ticks since then; id: later causes */
};

/* Payload of an event, in this order. The type defines the fields; unused ones are 0. */
struct exh_event {
    uint16_t type;     /* enum exh_event_type */
    uint16_t id;       /* id of a signal's row */
    uint16_t instance; /* its instance: the finger */
    int32_t value;     /* raw */
    uint16_t source;   /* bit 1 << enum exh_source for each source that staged in this tick */
};

/* The fixed part of the header's payload. The parameter image follows, then whole calibration
 * images of fingers (calibrate.h), at most one each. */
struct exh_record_header {
    char scene[16];       /* zero-padded */
    char board[16];       /* exh_board_info.name, zero-padded */
    uint32_t lib_version; /* EXH_VERSION_NUMBER */
    uint32_t signal_crc;  /* CRC of the scene's output table */
    struct exh_period T;  /* achieved period */
    uint16_t fingers;     /* number of fingers whose codes a frame contains */
    uint16_t enc_bits;    /* width of the board's counters */
    uint16_t signals;     /* int32 values in a frame after the raw codes */
};

/* A decoded record. payload points into the buffer. */
struct exh_record {
    uint8_t type, version;  /* enum exh_record_type; EXH_RECORD_VERSION */
    uint16_t len_B;         /* length of the payload */
    uint32_t seq, tick;     /* sequence number; tick of the loop; both modulo 2^32 */
    const uint8_t *payload; /* len_B bytes */
};

/* Starts a record in c. Write the payload through c next. */
void exh_record_begin(struct exh_bytes *c, uint8_t type, uint32_t seq, uint32_t tick);

/* Ends the record with length and CRC. Returns its size in bytes, or 0 if it did not fit. */
uint32_t exh_record_end(struct exh_bytes *c);

/* Decodes the record at the start of buf; reads at most len_B bytes. Returns its length, or
 * -EXH_E_SHORT (more bytes needed), -EXH_E_UNKNOWN (no sync), -EXH_E_CRC or -EXH_E_VERSION. After
 * damage, try again one byte later. */
int32_t exh_record_decode(const void *buf, uint32_t len_B, struct exh_record *r);

/* Payloads through a cursor. Texts of the header need no terminating zero. */
void exh_record_header_serialize(struct exh_bytes *c, struct exh_record_header *h);
void exh_event_serialize(struct exh_bytes *c, struct exh_event *e);

/* --- output of a record in small pieces, from a real-time loop --- */

/* A record in output. */
struct exh_record_out {
    const uint8_t *mem;              /* memory of the payload, which may wrap */
    uint32_t cap_B, at;              /* size of mem; index of the next byte */
    uint32_t done_B;                 /* bytes output, of head, payload and CRC together */
    uint32_t crc;                    /* CRC-32 of head and payload so far */
    uint16_t len_B;                  /* length of the payload */
    uint8_t head[EXH_RECORD_HEAD_B]; /* encoded head */
};

/* The place of a payload in mem: it starts at index at and wraps at the end, at < cap_B,
 * len_B <= cap_B. It must not change until it has been output. */
struct exh_record_place {
    const uint8_t *mem; /* the caller's */
    uint32_t cap_B, at; /* size of mem; index of the payload */
    uint16_t len_B;     /* length of the payload */
};

/* Prepares a record of this type, sequence number and tick. Outputs nothing yet. */
void exh_record_out_begin(struct exh_record_out *o, uint8_t type, uint32_t seq, uint32_t tick,
    struct exh_record_place payload);

/* Writes the next bytes to to[cap_B]. Returns their number; 0: the record is complete. */
uint32_t exh_record_out(struct exh_record_out *o, uint8_t *to, uint32_t cap_B);

#ifdef __cplusplus
}
#endif
#endif
