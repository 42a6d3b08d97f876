/* SPDX-License-Identifier: MIT */
/* Wire: the packets between a controller and the virtual world (docs/WIRE.md).
 *
 * A packet may be lost, late, duplicated, reordered or damaged. Only parameters are sent again, by
 * their sender. So each packet is independent, and a receiver accepts it only if it is newer than
 * all before. Only after a silence, a HELLO starts a new session. Little-endian bytes:
 *
 *    0  u16 magic 0x5758    2  u8 version    3  u8 type    4  u16 payload length
 *    6  u32 session        10  u32 sequence 14  u32 time stamp, us
 *   18  payload            then u32 CRC of all bytes before
 *
 * A receiver:
 *
 *   exh_wire_poll(&rx, passed_us, EXH_WIRE_QUIET_MS * 1000u);
 *   if (exh_wire_decode(&rx, &p, buf, len_B) == EXH_WIRE_PLANES) { use(&p.u.planes); } */
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

#define EXH_WIRE_VERSION  3       /* version 2 lacks pulls in HELLO */
#define EXH_WIRE_MAGIC    0x5758u /* first bytes of every packet, "XW" */
#define EXH_WIRE_OVERHEAD 22      /* bytes around a payload */
#define EXH_WIRE_SEAL_B   24      /* bytes after a packet on a link with a key (keyed.h) */
#define EXH_WIRE_MAX_B    256     /* longest packet */
#define EXH_WIRE_NEVER_MS 65535u  /* age of a message never received, or of this age or more */
#define EXH_WIRE_FRAMES   11      /* most trace frames in a packet */
#define EXH_WIRE_AHEAD    65536u  /* limit of a forward jump of the sequence number */
#define EXH_WIRE_QUIET_MS 500     /* silence after which a controller is open */

/* The type of a packet. Each type except TRACE has one length. */
enum exh_wire_type {
    EXH_WIRE_HELLO = 1,     /* first packet of a sender, then repeated */
    EXH_WIRE_STATE = 2,     /* controller -> world, once per exchange */
    EXH_WIRE_PLANES = 3,    /* world -> controller, answers STATE */
    EXH_WIRE_PARAM = 4,     /* world -> controller: set a parameter */
    EXH_WIRE_ACK = 5,       /* controller -> world: result of PARAM */
    EXH_WIRE_TRACE_ASK = 6, /* world -> controller: start a trace */
    EXH_WIRE_TRACE = 7      /* controller -> world: frames of the trace */
};

/* The role of a sender. */
enum exh_wire_role {
    EXH_WIRE_CONTROLLER, /* sends STATE, ACK, TRACE */
    EXH_WIRE_WORLD       /* sends PLANES, PARAM, TRACE_ASK */
};

/* --- payloads; arrays by finger, thumb first; vectors x y z in the frame of the palm --- */

/* HELLO: starts a session. */
struct exh_wire_hello {
    uint8_t role;         /* enum exh_wire_role */
    uint32_t lib_version; /* EXH_VERSION_NUMBER */
    uint32_t table_crc;   /* exh_signal_crc() of the parameters; 0: has none */
    int16_t pull_radpm_q7[EXH_FINGERS]
                         [2]; /* a controller's: how q1 and q2 turn per metre of string,
                                 +-250 rad/m; 0: untold */
};

/* Differences of a peer's HELLO from ours. The peer is accepted; report them. */
enum exh_wire_difference {
    EXH_WIRE_ROLE = 1u << 0, /* same role: two controllers, two worlds, or an echo */
    EXH_WIRE_LIB = 1u << 1,  /* another version of the library */
    EXH_WIRE_TABLE = 1u << 2 /* another table of parameters; not if either has none */
};

/* Compares two HELLOs. Returns bits of enum exh_wire_difference; 0: none. */
uint32_t exh_wire_compare(const struct exh_wire_hello *ours, const struct exh_wire_hello *theirs);

/* STATE: positions of the fingers and state of the device. */
struct exh_wire_state {
    uint32_t tick;    /* of the loop, modulo 2^32 */
    uint8_t fingers;  /* mask of the fingers in use */
    uint8_t state;    /* enum exh_state */
    uint8_t frozen;   /* mask */
    uint8_t touching; /* mask */
    uint16_t age_ms;  /* age of the newest planes; EXH_WIRE_NEVER_MS: none, or this age or more */
    uint32_t faults;  /* enum exh_fault */
    int32_t joint_turn_q32[EXH_FINGERS][3]; /* theta: q0, q1, q2 */
    int32_t tip_m_q30[EXH_FINGERS][3];      /* P_F */
    int32_t force_N_q20[EXH_FINGERS];       /* commanded force */
    int32_t d_m_q30[EXH_FINGERS];           /* distance; INT32_MIN: no plane */
    int32_t q_m_q30[EXH_FINGERS];           /* length of string pulled out */
    int32_t q_lim_m_q30[EXH_FINGERS];       /* EXH_PRECONTACT_NO_LIM: no contact possible */
};

/* The plane of one finger. */
struct exh_wire_plane {
    uint8_t kind;           /* enum exh_plane_kind */
    uint8_t material;       /* index */
    uint16_t object;        /* id of the object */
    int32_t normal_q30[3];  /* outward unit vector */
    int32_t point_m_q30[3]; /* point of the plane nearest the origin */
    int32_t hit_m_q30[3];   /* P_C, for drawing only */
};

/* PLANES: the surfaces near the fingertips of a STATE. */
struct exh_wire_planes {
    uint32_t echo_seq;      /* sequence number of the STATE answered */
    uint32_t echo_stamp_us; /* its time stamp; the sender of STATE computes the round trip */
    uint8_t fingers;        /* mask of reported fingers; the others have kind UNTOLD */
    struct exh_wire_plane plane[EXH_FINGERS]; /* by finger */
};

/* PARAM: a parameter to set. */
struct exh_wire_param {
    uint16_t id, instance; /* as in the signal table */
    int32_t value;         /* raw */
};

/* ACK: the result of a PARAM. */
struct exh_wire_ack {
    struct exh_wire_param param; /* copied from PARAM */
    int16_t result;              /* 0: staged, applied between ticks; or -EXH_E_... */
    uint32_t request_seq;        /* sequence number of the PARAM */
};

/* TRACE_ASK: a request for exh_trace_start(). */
struct exh_wire_trace_request {
    uint32_t every;                    /* ticks between frames; 0: no trace */
    uint16_t index[EXH_TRACE_SIGNALS]; /* indices into the table of outputs */
};

/* One frame of a TRACE. */
struct exh_wire_frame {
    uint32_t tick;                  /* of the loop, modulo 2^32 */
    int32_t raw[EXH_TRACE_SIGNALS]; /* in the order of the request */
};

/* TRACE: frames, oldest first. */
struct exh_wire_trace {
    uint32_t request_seq; /* sequence number of the newest TRACE_ASK */
    uint32_t first;       /* number of frame[0], or of the next frame if there is none */
    int16_t result;       /* 0, or -EXH_E_...: refused, no trace */
    uint8_t frames;       /* number of frames */
    struct exh_wire_frame frame[EXH_WIRE_FRAMES]; /* array; the first frames are valid */
};

/* A packet, received or to send. */
struct exh_wire_packet {
    uint8_t type;           /* enum exh_wire_type */
    uint32_t seq, stamp_us; /* the sender's sequence number and clock, both modulo 2^32 */
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

/* State of a sender. */
struct exh_wire_tx {
    uint32_t session; /* not 0; must differ at every start (a clock or stored counter), or the peer
                       * accepts HELLO only after a silence */
    uint32_t seq;     /* sequence number of the next packet, modulo 2^32 */
};

/* Writes packet p to buf. The caller sets type and payload; this function sets seq and stamp_us.
 * Returns the bytes written, or the first error: -EXH_E_UNKNOWN (type), -EXH_E_RANGE (session 0, or
 * a value that no receiver accepts), -EXH_E_SHORT. A cap_B of EXH_WIRE_MAX_B suffices. An error
 * uses no sequence number, but buf may have changed. */
int32_t exh_wire_encode(
    struct exh_wire_tx *tx, struct exh_wire_packet *p, uint32_t stamp_us, void *buf, size_t cap_B);

/* --- receiving --- */

/* State of a receiver. All zeros at first. Every packet increments one counter, apart from missing
 * and silences; modulo 2^32. */
struct exh_wire_rx {
    uint64_t seen;            /* bit k: seq - k was received, or precedes the HELLO */
    uint32_t seq;             /* newest accepted sequence number */
    uint32_t session, former; /* session of the peer, and the one before; 0: none */
    uint32_t quiet_us;        /* time since the last accepted packet, saturating */
    uint32_t open;            /* 1: silent for too long, the next HELLO is accepted */
    uint32_t accepted;        /* accepted; their payload is used, also of late PARAM and ACK */
    uint32_t missing;         /* sequence numbers skipped and not received late: lost */
    uint32_t duplicate;       /* received before, or older than its session's HELLO */
    uint32_t reordered;       /* late: a newer packet came first */
    uint32_t old;             /* more than 63 late, or of the session before */
    uint32_t stranger;        /* of a session that has not started */
    uint32_t corrupt;         /* magic, length, CRC or an impossible value */
    uint32_t version;         /* another version; or with a key, and we have none */
    uint32_t unknown;         /* unknown type */
    uint32_t far;             /* more than EXH_WIRE_AHEAD ahead */
    uint32_t silences;        /* number of silences */
};

/* Reports elapsed time; call it in every tick or frame before decoding. After limit_us without an
 * accepted packet, the receiver is open. The next HELLO of any session and number then starts anew.
 * So neither an old nor a forged packet blocks the receiver for longer than limit_us and the time
 * to a HELLO. Returns 1 if it has just become open. */
int exh_wire_poll(struct exh_wire_rx *rx, uint32_t passed_us, uint32_t limit_us);

/* Decodes one datagram; reads at most len_B bytes. Returns its type, > 0, if it is accepted. Only
 * then *p is written, in p->u only the member of that type. Errors: -EXH_E_SHORT, -EXH_E_VERSION,
 * -EXH_E_UNKNOWN, -EXH_E_STATE (stranger), -EXH_E_RANGE (far), -EXH_E_STALE (duplicate, reordered,
 * old), -EXH_E_CRC. The last includes impossible values. An error changes only a counter, and the
 * record of a reordered packet.
 *
 * The first HELLO starts the session. While packets of it arrive, any other session is a stranger.
 * An open receiver accepts any HELLO except a copy of the newest packet, since the peer has
 * restarted. A late PARAM or ACK is accepted once. */
int exh_wire_decode(
    struct exh_wire_rx *rx, struct exh_wire_packet *p, const void *buf, size_t len_B);

/* The plane of one finger in the form for exh_precontact_update(). */
struct exh_plane exh_wire_plane_of(const struct exh_wire_planes *planes, unsigned finger);

/* Stages the parameter of a PARAM packet if authority.h allows it to a world, and returns the ACK.
 * open is 1 unless the device is in OFF or FAULT. The loop applies it between ticks. */
struct exh_wire_ack exh_wire_stage(
    struct exh_params *params, const struct exh_wire_packet *p, int open);

/* Round trip time of an exchange, us: now minus the echoed time stamp. */
static inline uint32_t exh_wire_round_trip_us(uint32_t now_us, const struct exh_wire_planes *planes)
{
    return now_us - planes->echo_stamp_us;
}

/* Number of lost frames, modulo 2^32, of a reader that has all frames before next. Its next number
 * is then t->first + t->frames. */
static inline uint32_t exh_wire_trace_missed(uint32_t next, const struct exh_wire_trace *t)
{
    return t->first - next;
}

/* The link's state of a controller, through a cursor. */
void exh_wire_tx_serialize(struct exh_bytes *c, struct exh_wire_tx *s);
void exh_wire_rx_serialize(struct exh_bytes *c, struct exh_wire_rx *s);

#ifdef __cplusplus
}
#endif
#endif
