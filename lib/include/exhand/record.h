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

#define EXH_RECORD_VERSION 1
#define EXH_RECORD_SYNC 0x5845u
#define EXH_RECORD_OVERHEAD 18 /* bytes around a payload                         */

enum exh_record_type {
    EXH_RECORD_HEADER = 1,
    EXH_RECORD_FRAME = 2,
    EXH_RECORD_EVENT = 3,
    EXH_RECORD_KEYFRAME = 4,
    EXH_RECORD_DROPPED = 5, /* u32: records lost before this one                */
    EXH_RECORD_END = 6,     /* u32: records lost in all                         */
    EXH_RECORD_PACKET = 7   /* bytes: came over the link for the frame that follows */
};

enum exh_event_type {
    EXH_EVENT_PARAM = 1,   /* id u16, instance u16, value: staged and applied    */
    EXH_EVENT_COMMAND = 2, /* value: enum exh_command                           */
    EXH_EVENT_MISSED = 3,  /* value: ticks missed before this tick               */
    EXH_EVENT_MARK = 4     /* value: the operator's own mark                     */
};

struct exh_event {
    uint16_t type; /* enum exh_event_type                                      */
    uint16_t id;
    uint16_t instance;
    int32_t value;
};

/* The fixed part of the header's payload; the parameter image follows it. */
struct exh_record_header {
    char scene[16]; /* zero-padded                                             */
    char board[16];
    uint32_t lib_version;  /* EXH_VERSION_NUMBER                                */
    uint32_t signal_crc;   /* of the scene's output table                       */
    struct exh_period T;
    uint16_t fingers;
    uint16_t enc_bits; /* width of the board's counters                        */
    uint16_t signals; /* int32 values in a frame after the raw codes           */
};

/* A record found in a buffer; payload points into it. */
struct exh_record {
    uint8_t type, version;
    uint16_t len_B;
    uint32_t seq, tick;
    const uint8_t *payload;
};

/* Starts a record in c; the payload follows through c. */
void exh_record_begin(struct exh_bytes *c, uint8_t type, uint32_t seq, uint32_t tick);

/* Ends it: length and CRC. The record's size in bytes, or 0 if it did not fit. */
uint32_t exh_record_end(struct exh_bytes *c);

/* The record at the start of buf. Bytes it takes, or -EXH_E_SHORT (more needed),
 * -EXH_E_UNKNOWN (no sync here), -EXH_E_CRC, -EXH_E_VERSION. To go on after
 * damage, retry one byte on. Reads len_B bytes at most, whatever they say. */
int32_t exh_record_read(const void *buf, uint32_t len_B, struct exh_record *r);

void exh_record_header_bytes(struct exh_bytes *c, struct exh_record_header *h);
void exh_event_bytes(struct exh_bytes *c, struct exh_event *e);

#ifdef __cplusplus
}
#endif
#endif
