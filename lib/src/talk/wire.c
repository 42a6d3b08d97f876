/* SPDX-License-Identifier: MIT */
/* Packets between controller and world: encoding, decoding, sequence and silence. */
#include "exhand/wire.h"

#include "exhand/error.h"
#include "exhand/safety.h"

#include "../num/mem.h"
#include "../num/pack.h"
#include "../num/word.h"

#define HEAD_B     UINT32_C(18)
#define LEN_AT     4u
#define CRC_B      4u
#define FINGERS_OF ((1u << EXH_FINGERS) - 1u)
#define WINDOW     64 /* number of past sequence numbers remembered */

struct head {
    uint16_t magic;
    uint8_t version, type;
    uint16_t len_B;
    uint32_t session, seq, stamp_us;
};

static void head_bytes(struct exh_bytes *c, struct head *h)
{
    exh_bytes_u16(c, &h->magic);
    exh_bytes_u8(c, &h->version);
    exh_bytes_u8(c, &h->type);
    exh_bytes_u16(c, &h->len_B);
    exh_bytes_u32(c, &h->session);
    exh_bytes_u32(c, &h->seq);
    exh_bytes_u32(c, &h->stamp_us);
}

/* --- payloads --- */

/* Requires a possible value; otherwise the whole packet is refused. */
static void demand(struct exh_bytes *c, int holds)
{
    if (!holds) { exh_bytes_fail(c); }
}

static void hello_bytes(struct exh_bytes *c, struct exh_wire_hello *h)
{
    exh_bytes_u8(c, &h->role);
    exh_bytes_u32(c, &h->lib_version);
    exh_bytes_u32(c, &h->table_crc);
    const uint8_t *const p = unpack_room(c, 4 * EXH_FINGERS);
    for (unsigned i = 0; i < 2 * EXH_FINGERS; i++) {
        int16_t *const pull = &h->pull_radpm_q7[i / 2][i % 2];
        if (p != NULL) {
            *pull = signed_half(half_at(p + 2 * i));
        } else {
            exh_bytes_i16(c, pull);
        }
    }
    demand(c, h->role <= EXH_WIRE_WORLD);
}

static void finger_bytes(struct exh_bytes *c, struct exh_wire_state *s, unsigned f)
{
    exh_bytes_i32s(c, s->joint_turn_q32[f], 3);
    exh_bytes_i32s(c, s->tip_m_q30[f], 3);
    exh_bytes_i32(c, &s->force_N_q20[f]);
    exh_bytes_i32(c, &s->d_m_q30[f]);
    exh_bytes_i32(c, &s->q_m_q30[f]);
    exh_bytes_i32(c, &s->q_lim_m_q30[f]);
}

static void state_bytes(struct exh_bytes *c, struct exh_wire_state *s)
{
    exh_bytes_u32(c, &s->tick);
    exh_bytes_u8(c, &s->fingers);
    exh_bytes_u8(c, &s->state);
    exh_bytes_u8(c, &s->frozen);
    exh_bytes_u8(c, &s->touching);
    exh_bytes_u16(c, &s->age_ms);
    exh_bytes_u32(c, &s->faults);
    for (unsigned f = 0; f < EXH_FINGERS; f++) { finger_bytes(c, s, f); }
    demand(c, (s->fingers | s->frozen | s->touching) <= FINGERS_OF && s->state <= EXH_STATE_FAULT);
}

static void plane_bytes(struct exh_bytes *c, struct exh_wire_plane *p)
{
    const uint8_t *const at = unpack_room(c, 40);
    if (at != NULL) {
        p->kind = at[0];
        p->material = at[1];
        p->object = half_at(at + 2);
        for (unsigned i = 0; i < 3; i++) {
            p->normal_q30[i] = exh_from_u32(word_at(at + 4 + 4 * i));
            p->point_m_q30[i] = exh_from_u32(word_at(at + 16 + 4 * i));
            p->hit_m_q30[i] = exh_from_u32(word_at(at + 28 + 4 * i));
        }
    } else {
        exh_bytes_u8(c, &p->kind);
        exh_bytes_u8(c, &p->material);
        exh_bytes_u16(c, &p->object);
        exh_bytes_i32s(c, p->normal_q30, 3);
        exh_bytes_i32s(c, p->point_m_q30, 3);
        exh_bytes_i32s(c, p->hit_m_q30, 3);
    }
    demand(c, p->kind <= EXH_PLANE_HIT);
}

static void planes_bytes(struct exh_bytes *c, struct exh_wire_planes *s)
{
    exh_bytes_u32(c, &s->echo_seq);
    exh_bytes_u32(c, &s->echo_stamp_us);
    exh_bytes_u8(c, &s->fingers);
    demand(c, s->fingers <= FINGERS_OF);
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        plane_bytes(c, &s->plane[f]);
        demand(c, s->fingers >> f & 1 || s->plane[f].kind == EXH_PLANE_UNTOLD);
    }
}

static void param_bytes(struct exh_bytes *c, struct exh_wire_param *p)
{
    exh_bytes_u16(c, &p->id);
    exh_bytes_u16(c, &p->instance);
    exh_bytes_i32(c, &p->value);
}

static void trace_ask_bytes(struct exh_bytes *c, struct exh_wire_trace_request *a)
{
    exh_bytes_u32(c, &a->every);
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) { exh_bytes_u16(c, &a->index[i]); }
}

static void trace_bytes(struct exh_bytes *c, struct exh_wire_trace *t)
{
    exh_bytes_u32(c, &t->request_seq);
    exh_bytes_u32(c, &t->first);
    exh_bytes_i16(c, &t->result);
    exh_bytes_u8(c, &t->frames);
    demand(c, t->frames <= EXH_WIRE_FRAMES && t->result <= 0 && (t->result == 0 || t->frames == 0));
    for (unsigned i = 0; i < t->frames && i < EXH_WIRE_FRAMES; i++) {
        exh_bytes_u32(c, &t->frame[i].tick);
        exh_bytes_i32s(c, t->frame[i].raw, EXH_TRACE_SIGNALS);
    }
}

/* The payload of p->type. 0: unknown type. */
static int payload_bytes(struct exh_bytes *c, struct exh_wire_packet *p)
{
    switch (p->type) {
    case EXH_WIRE_HELLO: hello_bytes(c, &p->u.hello); return 1;
    case EXH_WIRE_STATE: state_bytes(c, &p->u.state); return 1;
    case EXH_WIRE_PLANES: planes_bytes(c, &p->u.planes); return 1;
    case EXH_WIRE_PARAM: param_bytes(c, &p->u.param); return 1;
    case EXH_WIRE_ACK:
        param_bytes(c, &p->u.ack.param);
        exh_bytes_i16(c, &p->u.ack.result);
        exh_bytes_u32(c, &p->u.ack.request_seq);
        return 1;
    case EXH_WIRE_TRACE_ASK: trace_ask_bytes(c, &p->u.trace_ask); return 1;
    case EXH_WIRE_TRACE: trace_bytes(c, &p->u.trace); return 1;
    default: return 0;
    }
}

/* The size of a payload in memory by type, since others are up to ten times as long. */
static const uint16_t size_B[] = {0, sizeof(struct exh_wire_hello), sizeof(struct exh_wire_state),
    sizeof(struct exh_wire_planes), sizeof(struct exh_wire_param), sizeof(struct exh_wire_ack),
    sizeof(struct exh_wire_trace_request), sizeof(struct exh_wire_trace)};

/* --- sending --- */

int32_t exh_wire_encode(
    struct exh_wire_tx *tx, struct exh_wire_packet *p, uint32_t stamp_us, void *buf, size_t cap_B)
{
    struct head h = {EXH_WIRE_MAGIC, EXH_WIRE_VERSION, p->type, 0, tx->session, tx->seq, stamp_us};
    struct exh_bytes c = exh_bytes_writer(buf, cap_B);
    uint32_t end, crc;
    head_bytes(&c, &h);
    if (!payload_bytes(&c, p)) { return -EXH_E_UNKNOWN; }
    end = c.at;
    if (end == UINT32_MAX || tx->session == 0) { return -EXH_E_RANGE; }
    if (cap_B < end + CRC_B) { return -EXH_E_SHORT; }
    h.len_B = (uint16_t)(end - HEAD_B); /* the length is known only here */
    c.at = LEN_AT;
    exh_bytes_u16(&c, &h.len_B);
    c.at = end;
    crc = exh_crc32(0, buf, end);
    exh_bytes_u32(&c, &crc);
    p->seq = tx->seq++;
    p->stamp_us = stamp_us;
    return (int32_t)c.at;
}

/* --- receiving --- */

/* Checks that the packet is whole, undamaged and possible. Returns 0 or the counted error. */
static int read_packet(struct exh_wire_rx *rx, struct head *h, struct exh_wire_packet *p,
    const uint8_t *buf, size_t len_B)
{
    struct exh_bytes c = exh_bytes_reader(buf, len_B);
    const uint8_t *const head = unpack_room(&c, HEAD_B);
    uint32_t whole_B;
    if (head != NULL) {
        *h = (struct head){half_at(head), head[2], head[3], half_at(head + LEN_AT),
            word_at(head + 6), word_at(head + 10), word_at(head + 14)};
    }
    whole_B = HEAD_B + h->len_B + CRC_B;
    if (head == NULL || (len_B != whole_B && len_B != whole_B + EXH_WIRE_SEAL_B)) {
        rx->corrupt++;
        return -EXH_E_SHORT;
    }
    if (h->magic != EXH_WIRE_MAGIC || h->session == 0 ||
        word_at(buf + HEAD_B + h->len_B) != exh_crc32(0, buf, HEAD_B + h->len_B)) {
        rx->corrupt++;
        return -EXH_E_CRC;
    }
    if (h->version != EXH_WIRE_VERSION || len_B != whole_B) { /* longer: with a key; we have none */
        rx->version++;
        return -EXH_E_VERSION;
    }
    p->type = h->type;
    p->seq = h->seq;
    p->stamp_us = h->stamp_us;
    if (p->type == 0 || p->type > EXH_WIRE_TRACE) {
        rx->unknown++;
        return -EXH_E_UNKNOWN;
    }
    memset(&p->u, 0, size_B[p->type]);
    (void)payload_bytes(&c, p);
    if (c.at != HEAD_B + h->len_B) { /* failed, or another length */
        rx->corrupt++;
        return -EXH_E_CRC;
    }
    return 0;
}

static void begin_session(struct exh_wire_rx *rx, const struct head *h)
{
    if (h->session != rx->session) { rx->former = rx->session; }
    rx->session = h->session;
    rx->seq = h->seq;
    rx->seen = UINT64_MAX; /* do not wait for packets sent before */
}

/* 1 for a packet of the session that is newer than all before, but not too far ahead. */
static int is_next(const struct exh_wire_rx *rx, const struct head *h)
{
    return h->session == rx->session && h->seq - rx->seq - 1u < EXH_WIRE_AHEAD;
}

/* 1 for the first HELLO, or a new one after a silence. While the peer is heard, no other session
 * may start: a sender of HELLOs with new sessions would lock it out. */
static int begins(const struct exh_wire_rx *rx, const struct head *h)
{
    if (h->type != EXH_WIRE_HELLO) { return 0; }
    if (h->session == rx->session) { return rx->open && h->seq != rx->seq; }
    return rx->open || rx->session == 0;
}

/* The error of a packet of the session that is not next, counted. */
static int out_of_order(struct exh_wire_rx *rx, const struct head *h)
{
    const uint32_t late = rx->seq - h->seq;
    if (late > UINT32_C(0x80000000)) {
        rx->far++;
        return -EXH_E_RANGE;
    }
    if (late >= WINDOW) {
        rx->old++;
    } else if (rx->seen >> late & 1u) {
        rx->duplicate++;
    } else {
        rx->seen |= UINT64_C(1) << late;
        rx->missing--;
        rx->reordered++;
    }
    return -EXH_E_STALE;
}

/* Their order does not matter; with many packets out of order, a parameter would take very long. */
static int may_be_late(uint8_t type) { return type == EXH_WIRE_PARAM || type == EXH_WIRE_ACK; }

static int refuse(struct exh_wire_rx *rx, const struct head *h)
{
    if (h->session == rx->session) { return out_of_order(rx, h); }
    if (h->session == rx->former) {
        rx->old++;
        return -EXH_E_STALE;
    }
    rx->stranger++;
    return -EXH_E_STATE;
}

static void advance(struct exh_wire_rx *rx, const struct head *h)
{
    const uint32_t ahead = h->seq - rx->seq;
    rx->seen = ahead < WINDOW ? rx->seen << ahead | 1u : 1u;
    rx->missing += ahead - 1u;
    rx->seq = h->seq;
}

int exh_wire_poll(struct exh_wire_rx *rx, uint32_t passed_us, uint32_t limit_us)
{
    const uint32_t was = rx->open;
    if (rx->session == 0) { return 0; } /* any HELLO starts a session */
    rx->quiet_us = passed_us < UINT32_MAX - rx->quiet_us ? rx->quiet_us + passed_us : UINT32_MAX;
    rx->open = rx->quiet_us >= limit_us;
    if (rx->open <= was) { return 0; }
    rx->silences++;
    return 1;
}

int exh_wire_decode(
    struct exh_wire_rx *rx, struct exh_wire_packet *p, const void *buf, size_t len_B)
{
    struct exh_wire_packet now; /* not cleared whole: a trace is three times as long as planes */
    struct head h = {0, 0, 0, 0, 0, 0, 0};
    const uint32_t reordered = rx->reordered;
    int r = read_packet(rx, &h, &now, (const uint8_t *)buf, len_B);
    if (r < 0) { return r; }
    if (is_next(rx, &h)) {
        advance(rx, &h);
    } else if (begins(rx, &h)) {
        begin_session(rx, &h);
    } else {
        r = refuse(rx, &h);
        if (rx->reordered == reordered || !may_be_late(h.type)) { return r; }
    }
    if (r == 0) {
        rx->accepted++;
        rx->quiet_us = 0;
        rx->open = 0;
    }
    memcpy(p, &now, offsetof(struct exh_wire_packet, u) + size_B[now.type]);
    return h.type;
}

/* --- use of packets --- */

uint32_t exh_wire_compare(const struct exh_wire_hello *ours, const struct exh_wire_hello *theirs)
{
    const int tables = ours->table_crc != 0 && theirs->table_crc != 0;
    return (ours->role == theirs->role ? EXH_WIRE_ROLE : 0u) |
           (ours->lib_version != theirs->lib_version ? EXH_WIRE_LIB : 0u) |
           (tables && ours->table_crc != theirs->table_crc ? EXH_WIRE_TABLE : 0u);
}

struct exh_plane exh_wire_plane_of(const struct exh_wire_planes *planes, unsigned finger)
{
    const struct exh_wire_plane *w = &planes->plane[finger];
    return (struct exh_plane){
        w->kind,
        w->material,
        w->object,
        {w->normal_q30[0], w->normal_q30[1], w->normal_q30[2]},
        {w->point_m_q30[0], w->point_m_q30[1], w->point_m_q30[2]},
    };
}

struct exh_wire_ack exh_wire_stage(
    struct exh_params *params, const struct exh_wire_packet *p, int open)
{
    const struct exh_authority world = {EXH_FROM_WORLD, 1, open != 0};
    const struct exh_wire_param *ask = &p->u.param;
    const int32_t i = exh_signal_find(params->table, ask->id, ask->instance);
    const int result = i < 0 ? (int)i : exh_params_stage_by(params, world, (uint32_t)i, ask->value);
    return (struct exh_wire_ack){*ask, (int16_t)result, p->seq};
}

/* --- state --- */

void exh_wire_tx_serialize(struct exh_bytes *c, struct exh_wire_tx *s)
{
    exh_bytes_u32(c, &s->session);
    exh_bytes_u32(c, &s->seq);
}

void exh_wire_rx_serialize(struct exh_bytes *c, struct exh_wire_rx *s)
{
    int64_t seen = exh_from_u64(s->seen);
    exh_bytes_i64(c, &seen);
    s->seen = (uint64_t)seen;
    exh_bytes_u32(c, &s->seq);
    exh_bytes_u32(c, &s->session);
    exh_bytes_u32(c, &s->former);
    exh_bytes_u32(c, &s->quiet_us);
    exh_bytes_u32(c, &s->open);
    s->open = s->open != 0;
    exh_bytes_u32(c, &s->accepted);
    exh_bytes_u32(c, &s->missing);
    exh_bytes_u32(c, &s->duplicate);
    exh_bytes_u32(c, &s->reordered);
    exh_bytes_u32(c, &s->old);
    exh_bytes_u32(c, &s->stranger);
    exh_bytes_u32(c, &s->corrupt);
    exh_bytes_u32(c, &s->version);
    exh_bytes_u32(c, &s->unknown);
    exh_bytes_u32(c, &s->far);
    exh_bytes_u32(c, &s->silences);
}
