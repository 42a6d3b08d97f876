/* SPDX-License-Identifier: MIT */
/* Wire: the packets between a controller and the world it feels (docs/WIRE.md).
 *
 * A packet may be lost, late, twice, out of order or damaged; nothing is sent again but
 * parameters, by who set them. So each stands alone, and a receiver takes it only if it is
 * newer than all before; after a silence, and only then, a HELLO begins anew. Byte by byte,
 * little-endian:
 *
 *    0  u16 magic 0x5758    2  u8 version    3  u8 type    4  u16 payload length
 *    6  u32 session        10  u32 sequence 14  u32 time stamp, us
 *   18  payload            then u32 CRC of all before
 */
#ifndef EXHAND_WIRE_H
#define EXHAND_WIRE_H

#include "exhand/bytes.h"
#include "exhand/params.h"
#include "exhand/precontact.h"
#include "exhand/signal.h"
#include "exhand/trace.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_WIRE_VERSION  3       /* 2: HELLO had no pulls */
#define EXH_WIRE_MAGIC    0x5758u /* first bytes of every packet, "XW" */
#define EXH_WIRE_OVERHEAD 22      /* bytes around a payload */
#define EXH_WIRE_SEAL_B   24      /* behind a packet of a link with a key (keyed.h) */
#define EXH_WIRE_MAX_B    256     /* no packet is longer */
#define EXH_WIRE_NEVER_MS 65535u  /* age: never, or so old */
#define EXH_WIRE_FRAMES   11      /* of a trace in a packet, at most */
#define EXH_WIRE_AHEAD    65536u  /* sequence numbers that may be skipped at once, and one */
#define EXH_WIRE_QUIET_MS 500     /* a controller that accepts nothing for so long is open */

/* What a packet is. Each type but TRACE has one length. */
enum exh_wire_type {
    EXH_WIRE_HELLO = 1,     /* a sender's first packet, then now and then */
    EXH_WIRE_STATE = 2,     /* controller -> world, one an exchange */
    EXH_WIRE_PLANES = 3,    /* world -> controller, answers it */
    EXH_WIRE_PARAM = 4,     /* world -> controller: set a parameter */
    EXH_WIRE_ACK = 5,       /* controller -> world: it was, or why not */
    EXH_WIRE_TRACE_ASK = 6, /* world -> controller: trace these */
    EXH_WIRE_TRACE = 7      /* controller -> world: frames of it */
};

/* Who a sender is. */
enum exh_wire_role {
    EXH_WIRE_CONTROLLER, /* sends STATE, ACK, TRACE */
    EXH_WIRE_WORLD       /* sends PLANES, PARAM, TRACE_ASK */
};

/* --- payloads; arrays by finger, thumb first; vectors x y z in the palm's frame --- */

/* HELLO: who begins a session. */
struct exh_wire_hello {
    uint8_t role;         /* enum exh_wire_role */
    uint32_t lib_version; /* EXH_VERSION_NUMBER */
    uint32_t table_crc;   /* exh_signal_crc() of the parameters; 0: has none */
    int16_t pull_radpm_q7[EXH_FINGERS]
                         [2]; /* a controller's: how q1 and q2 turn per metre of string,
                                 +-250 rad/m; 0: untold */
};

/* What is not as it should be about a peer that has said HELLO: it is heard, and told of. */
enum exh_wire_difference {
    EXH_WIRE_ROLE = 1u << 0, /* the same as ours: two controllers, two worlds, an echo */
    EXH_WIRE_LIB = 1u << 1,  /* another version of the library */
    EXH_WIRE_TABLE = 1u << 2 /* another table of parameters; not if either has none */
};

/* enum exh_wire_difference of theirs, bits; 0: nothing. */
uint32_t exh_wire_compare(const struct exh_wire_hello *ours, const struct exh_wire_hello *theirs);

/* STATE: where fingers and box are. */
struct exh_wire_state {
    uint32_t tick;    /* of the loop, modulo 2^32 */
    uint8_t fingers;  /* mask: in use */
    uint8_t state;    /* enum exh_state */
    uint8_t frozen;   /* mask */
    uint8_t touching; /* mask */
    uint16_t age_ms;  /* of the newest planes; EXH_WIRE_NEVER_MS: never or longer */
    uint32_t faults;  /* enum exh_fault */
    int32_t joint_turn_q32[EXH_FINGERS][3]; /* theta: q0, q1, q2 */
    int32_t tip_m_q30[EXH_FINGERS][3];      /* P_F */
    int32_t force_N_q20[EXH_FINGERS];       /* commanded */
    int32_t d_m_q30[EXH_FINGERS];           /* distance; INT32_MIN: no plane */
    int32_t q_m_q30[EXH_FINGERS];           /* string pulled out */
    int32_t q_lim_m_q30[EXH_FINGERS];       /* EXH_PRECONTACT_NO_LIM: no contact can be */
};

/* What is told of one finger. */
struct exh_wire_plane {
    uint8_t kind;           /* enum exh_plane_kind */
    uint8_t material;       /* index */
    uint16_t object;        /* whose surface */
    int32_t normal_q30[3];  /* outward, of length 1 */
    int32_t point_m_q30[3]; /* the plane's point nearest the origin */
    int32_t hit_m_q30[3];   /* P_C, for drawing: the controller does not use it */
};

/* PLANES: what the fingertips of a STATE are near to. */
struct exh_wire_planes {
    uint32_t echo_seq;      /* of the state answered, and its time stamp: the sender */
    uint32_t echo_stamp_us; /* subtracts it from its clock and has the round trip */
    uint8_t fingers;        /* mask: told of; of the others kind is UNTOLD */
    struct exh_wire_plane plane[EXH_FINGERS]; /* by finger */
};

/* PARAM: a parameter to be set. */
struct exh_wire_param {
    uint16_t id, instance; /* as in the signal table */
    int32_t value;         /* raw */
};

/* ACK: what became of it. */
struct exh_wire_ack {
    struct exh_wire_param param; /* as asked */
    int16_t result;              /* 0: staged, applied between ticks; or -EXH_E_... */
    uint32_t request_seq;        /* sequence number of the PARAM */
};

/* TRACE_ASK: another trace, as exh_trace_start() takes it. */
struct exh_wire_trace_request {
    uint32_t every;                    /* ticks from frame to frame; 0: none */
    uint16_t index[EXH_TRACE_SIGNALS]; /* of values in the table of outputs */
};

/* One frame of a TRACE. */
struct exh_wire_frame {
    uint32_t tick;                  /* of the loop, modulo 2^32 */
    int32_t raw[EXH_TRACE_SIGNALS]; /* in the order asked for */
};

/* TRACE: frames, oldest first. */
struct exh_wire_trace {
    uint32_t request_seq; /* of the newest TRACE_ASK */
    uint32_t first;       /* number of frame[0], or of the next one if there is none */
    int16_t result;       /* 0; or -EXH_E_...: refused, nothing is traced */
    uint8_t frames;       /* told of */
    struct exh_wire_frame frame[EXH_WIRE_FRAMES]; /* `frames` of them */
};

/* A packet, read or to be written. */
struct exh_wire_packet {
    uint8_t type;           /* enum exh_wire_type */
    uint32_t seq, stamp_us; /* of the sender: number; clock, both modulo 2^32 */
    union {
        struct exh_wire_hello hello;             /* HELLO */
        struct exh_wire_state state;             /* STATE */
        struct exh_wire_planes planes;           /* PLANES */
        struct exh_wire_param param;             /* PARAM */
        struct exh_wire_ack ack;                 /* ACK */
        struct exh_wire_trace_request trace_ask; /* TRACE_ASK */
        struct exh_wire_trace trace;             /* TRACE */
    } u;                                         /* the payload, by type */
};

/* --- sending --- */

/* A sender. */
struct exh_wire_tx {
    uint32_t session; /* not 0; another at every start: of a clock, or a counter that survives.
                       * The same again costs a silence: then its HELLO is taken */
    uint32_t seq;     /* of the next packet, modulo 2^32 */
};

/* Writes p (type and payload; seq and stamp_us are set here and left in p). Bytes written, or, in
 * this order, -EXH_E_UNKNOWN (no such type), -EXH_E_RANGE (session 0, or a role, kind, mask,
 * result or number of frames that no receiver would take), -EXH_E_SHORT (cap_B too small;
 * EXH_WIRE_MAX_B never is); then nothing is used up but what buf held. */
int32_t exh_wire_encode(
    struct exh_wire_tx *tx, struct exh_wire_packet *p, uint32_t stamp_us, void *buf, size_t cap_B);

/* --- receiving --- */

/* All zeros at first. Every packet raises exactly one of the counters, all but `missing` and
 * `silences`; modulo 2^32. */
struct exh_wire_rx {
    uint64_t seen;            /* bit k: seq - k came, or was before the HELLO */
    uint32_t seq;             /* newest accepted */
    uint32_t session, former; /* the peer's, the one before it; 0: none */
    uint32_t quiet_us;        /* since the last that was accepted; 2^32 - 1: longer, too */
    uint32_t open;            /* 1: for too long */
    uint32_t accepted;        /* taken: of these, and of late PARAM and ACK, the payload is used */
    uint32_t missing;         /* sequence numbers skipped, less those that came late: lost */
    uint32_t duplicate;       /* came before, or was sent before its session's HELLO */
    uint32_t reordered;       /* late: a newer one had come */
    uint32_t old;             /* more than 63 late, or of the session before */
    uint32_t stranger;        /* of a session that has not begun */
    uint32_t corrupt;         /* magic, length, CRC, or a value that cannot be */
    uint32_t version;         /* another than ours; or with a key, and we have none */
    uint32_t unknown;         /* type */
    uint32_t far;             /* more than EXH_WIRE_AHEAD ahead */
    uint32_t silences;        /* how often it became open */
};

/* So much time has passed: to be called now and then, in every tick or frame, before packets are
 * taken. With nothing accepted for limit_us or longer the receiver is open: the next HELLO, of
 * whatever session and number, begins anew, be it that of the session before. So no packet makes
 * it deaf for longer than limit_us and a HELLO's time, not one of a session long gone, not a
 * forged one far ahead. 1 if it has become open now. */
int exh_wire_poll(struct exh_wire_rx *rx, uint32_t passed_us, uint32_t limit_us);

/* One datagram. Its type, > 0, when it was accepted. Only then *p is written, and of its u what
 * that type has; and more changes than a counter (and, of a reordered one, that it came). Else
 * -EXH_E_SHORT, -EXH_E_CRC (also a value that cannot be), -EXH_E_VERSION, -EXH_E_UNKNOWN,
 * -EXH_E_STATE (stranger), -EXH_E_STALE (duplicate, reordered, old), -EXH_E_RANGE (far). The first
 * HELLO begins. Then another session is a stranger, be it HELLO, as long as this one is heard: only
 * an open receiver takes any HELLO but the newest packet itself once more: the peer has started
 * anew. A PARAM or ACK that came late, but not before, is taken, too, once. Reads len_B bytes at
 * most. */
int exh_wire_decode(
    struct exh_wire_rx *rx, struct exh_wire_packet *p, const void *buf, size_t len_B);

/* The plane of one finger as precontact wants it. */
struct exh_plane exh_wire_plane_of(const struct exh_wire_planes *planes, unsigned finger);

/* What a PARAM packet asks for, staged if authority.h allows it a world; the answer to it. open: 1
 * unless the box is in OFF or FAULT. The loop applies between ticks. */
struct exh_wire_ack exh_wire_stage(
    struct exh_params *params, const struct exh_wire_packet *p, int open);

/* Newest time of an exchange, us: now less the stamp that came back. */
static inline uint32_t exh_wire_round_trip_us(uint32_t now_us, const struct exh_wire_planes *planes)
{
    return now_us - planes->echo_stamp_us;
}

/* Frames that never came, modulo 2^32, to one who has all before number `next`; his next is then
 * t->first + t->frames. */
static inline uint32_t exh_wire_trace_missed(uint32_t next, const struct exh_wire_trace *t)
{
    return t->first - next;
}

/* State through a cursor: what a controller keeps of its link. */
void exh_wire_tx_serialize(struct exh_bytes *c, struct exh_wire_tx *s);
void exh_wire_rx_serialize(struct exh_bytes *c, struct exh_wire_rx *s);

#ifdef __cplusplus
}
#endif
#endif
