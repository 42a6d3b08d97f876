/* SPDX-License-Identifier: MIT */
/* Packets between controller and world: encoding, decoding, sequence and silence. */
#include "exhand/wire.h"

#include "exhand/error.h"
#include "exhand/safety.h"

#include "../num/mem.h"
#include "../num/pack.h"

#define HEAD_B     UINT32_C(18)
#define CRC_B      4u
#define FRAMES_AT  10u /* in a TRACE: the number of frames */
#define FINGERS_OF ((1u << EXH_FINGERS) - 1u)
#define WINDOW     64 /* number of past sequence numbers remembered */

struct head {
    uint16_t magic;
    uint8_t version, type;
    uint16_t len_B;
    uint32_t session, seq, stamp_us;
};

static void head_bytes(uint8_t *p, struct head *h, int takes)
{
    p = u16_field(p, &h->magic, takes);
    p = u8_field(p, &h->version, takes);
    p = u8_field(p, &h->type, takes);
    p = u16_field(p, &h->len_B, takes);
    p = u32_fields(p, &h->session, 1, takes);
    p = u32_fields(p, &h->seq, 1, takes);
    (void)u32_fields(p, &h->stamp_us, 1, takes);
}

/* --- payloads --- */

static void hello_bytes(uint8_t *p, struct exh_wire_hello *h, int takes)
{
    p = u8_field(p, &h->role, takes);
    p = u32_fields(p, &h->lib_version, 1, takes);
    p = u32_fields(p, &h->table_crc, 1, takes);
    for (unsigned i = 0; i < 2 * EXH_FINGERS; i++) {
        p = i16_field(p, &h->pull_radpm_q7[i / 2][i % 2], takes);
    }
}

static void state_bytes(uint8_t *p, struct exh_wire_state *s, int takes)
{
    p = u32_fields(p, &s->tick, 1, takes);
    p = u8_field(p, &s->fingers, takes);
    p = u8_field(p, &s->state, takes);
    p = u8_field(p, &s->frozen, takes);
    p = u8_field(p, &s->touching, takes);
    p = u16_field(p, &s->age_ms, takes);
    p = u32_fields(p, &s->faults, 1, takes);
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        p = i32_fields(p, s->joint_turn_q32[f], 3, takes);
        p = i32_fields(p, s->tip_m_q30[f], 3, takes);
        p = i32_fields(p, &s->force_N_q20[f], 1, takes);
        p = i32_fields(p, &s->d_m_q30[f], 1, takes);
        p = i32_fields(p, &s->q_m_q30[f], 1, takes);
        p = i32_fields(p, &s->q_lim_m_q30[f], 1, takes);
    }
}

static void planes_bytes(uint8_t *p, struct exh_wire_planes *s, int takes)
{
    p = u32_fields(p, &s->echo_seq, 1, takes);
    p = u32_fields(p, &s->echo_stamp_us, 1, takes);
    p = u8_field(p, &s->fingers, takes);
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        struct exh_wire_plane *const plane = &s->plane[f];
        p = u8_field(p, &plane->kind, takes);
        p = u8_field(p, &plane->material, takes);
        p = u16_field(p, &plane->object, takes);
        p = i32_fields(p, plane->normal_q30, 3, takes);
        p = i32_fields(p, plane->point_m_q30, 3, takes);
        p = i32_fields(p, plane->hit_m_q30, 3, takes);
    }
}

static uint8_t *param_bytes(uint8_t *p, struct exh_wire_param *s, int takes)
{
    p = u16_field(p, &s->id, takes);
    p = u16_field(p, &s->instance, takes);
    return i32_fields(p, &s->value, 1, takes);
}

static void trace_bytes(uint8_t *p, struct exh_wire_trace *t, int takes)
{
    p = u32_fields(p, &t->request_seq, 1, takes);
    p = u32_fields(p, &t->first, 1, takes);
    p = i16_field(p, &t->result, takes);
    p = u8_field(p, &t->frames, takes);
    for (unsigned i = 0; i < t->frames && i < EXH_WIRE_FRAMES; i++) {
        p = u32_fields(p, &t->frame[i].tick, 1, takes);
        p = i32_fields(p, t->frame[i].raw, EXH_TRACE_SIGNALS, takes);
    }
}

/* The payload of p->type, which is known, put at a place of length_B() or taken from there. */
static void payload_bytes(uint8_t *at, struct exh_wire_packet *p, int takes)
{
    struct exh_wire_trace_request *const ask = &p->u.trace_ask;
    switch (p->type) {
    case EXH_WIRE_HELLO: hello_bytes(at, &p->u.hello, takes); break;
    case EXH_WIRE_STATE: state_bytes(at, &p->u.state, takes); break;
    case EXH_WIRE_PLANES: planes_bytes(at, &p->u.planes, takes); break;
    case EXH_WIRE_PARAM: (void)param_bytes(at, &p->u.param, takes); break;
    case EXH_WIRE_ACK:
        at = param_bytes(at, &p->u.ack.param, takes);
        at = i16_field(at, &p->u.ack.result, takes);
        (void)u32_fields(at, &p->u.ack.request_seq, 1, takes);
        break;
    case EXH_WIRE_TRACE_ASK:
        at = u32_fields(at, &ask->every, 1, takes);
        for (int i = 0; i < EXH_TRACE_SIGNALS; i++) { at = u16_field(at, &ask->index[i], takes); }
        break;
    default: trace_bytes(at, &p->u.trace, takes);
    }
}

static int planes_can_be(const struct exh_wire_planes *s)
{
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const unsigned most = s->fingers >> f & 1 ? EXH_PLANE_HIT : EXH_PLANE_UNTOLD;
        if (s->plane[f].kind > most) { return 0; }
    }
    return s->fingers <= FINGERS_OF;
}

/* With an impossible value, the whole packet is refused. */
static int can_be(const struct exh_wire_packet *p)
{
    const struct exh_wire_state *const s = &p->u.state;
    const struct exh_wire_trace *const t = &p->u.trace;
    switch (p->type) {
    case EXH_WIRE_HELLO: return p->u.hello.role <= EXH_WIRE_WORLD;
    case EXH_WIRE_STATE:
        return (s->fingers | s->frozen | s->touching) <= FINGERS_OF && s->state <= EXH_STATE_FAULT;
    case EXH_WIRE_PLANES: return planes_can_be(&p->u.planes);
    case EXH_WIRE_TRACE:
        return t->frames <= EXH_WIRE_FRAMES && t->result <= 0 && (t->result == 0 || t->frames == 0);
    default: return 1;
    }
}

static int is_known(uint8_t type) { return type != 0 && type <= EXH_WIRE_TRACE; }

/* Bytes of a payload. Only that of a TRACE depends on its frames. */
static uint32_t length_B(uint8_t type, uint32_t frames)
{
    static const uint8_t least_B[] = {0, 9 + 4 * EXH_FINGERS, 14 + 40 * EXH_FINGERS,
        9 + 40 * EXH_FINGERS, 8, 14, 4 + 2 * EXH_TRACE_SIGNALS, FRAMES_AT + 1};
    return least_B[type] + (type == EXH_WIRE_TRACE ? frames * (4 + 4 * EXH_TRACE_SIGNALS) : 0);
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
    uint8_t *const at = (uint8_t *)buf;
    const uint32_t frames = p->type == EXH_WIRE_TRACE ? p->u.trace.frames : 0;
    uint32_t end;
    if (!is_known(p->type)) { return -EXH_E_UNKNOWN; }
    if (!can_be(p) || tx->session == 0) { return -EXH_E_RANGE; }
    h.len_B = (uint16_t)length_B(p->type, frames);
    end = HEAD_B + h.len_B;
    if (cap_B < end + CRC_B) { return -EXH_E_SHORT; }
    head_bytes(at, &h, 0);
    payload_bytes(at + HEAD_B, p, 0);
    put_word(at + end, exh_crc32(0, buf, end));
    p->seq = tx->seq++;
    p->stamp_us = stamp_us;
    return (int32_t)(end + CRC_B);
}

/* --- receiving --- */

/* Checks that the packet is whole, undamaged and possible. Returns 0 or the counted error. */
static int read_packet(struct exh_wire_rx *rx, struct head *h, struct exh_wire_packet *p,
    const uint8_t *buf, size_t len_B)
{
    uint8_t *const at = exh_bytes_reader(buf, len_B).p;
    uint32_t whole_B;
    int whole;
    if (len_B >= HEAD_B) { head_bytes(at, h, 1); }
    whole_B = HEAD_B + h->len_B + CRC_B;
    if (len_B != whole_B && len_B != whole_B + EXH_WIRE_SEAL_B) {
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
    if (!is_known(p->type)) {
        rx->unknown++;
        return -EXH_E_UNKNOWN;
    }
    whole = h->len_B == length_B(p->type, h->len_B > FRAMES_AT ? at[HEAD_B + FRAMES_AT] : 0);
    if (whole) { payload_bytes(at + HEAD_B, p, 1); }
    if (!whole || !can_be(p)) {
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
