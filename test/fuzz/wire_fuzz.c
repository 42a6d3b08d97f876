/* SPDX-License-Identifier: MIT */
/* The receiving end of a controller gets any bytes from a socket.
 *
 * An input is a sequence of datagrams. Before each are three bytes: repairs before it is sent, and
 * its length (u16). The repairs let a mutation pass the first checks. By bit: 0 magic and version,
 * 1 length, 2 session, 3 sequence number, 4 CRC. Bit 5: some time passes first. Bit 6: a silence.
 * Bit 7: the datagram comes twice.
 *
 * Rules: No read or write is outside. A refused packet changes only one counter. An accepted packet
 * encodes to the same bytes again; it is the next one, or a HELLO that may begin a session. After a
 * silence, a HELLO of any peer is accepted. The law does not touch before the freeze.
 *
 * LLVMFuzzerTestOneInput() is libFuzzer's; driver.c calls it without libFuzzer. */
#include "fails.h"
#include "must.h"

#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/precontact.h"
#include "exhand/wire.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FIX_MAGIC   1u
#define FIX_LENGTH  2u
#define FIX_SESSION 4u
#define FIX_SEQ     8u
#define FIX_CRC     16u
#define A_WHILE     32u
#define A_SILENCE   64u
#define TWICE       128u
#define LIMIT_US    1000000u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const struct exh_material_par material[2] = {{1 << 24, 1 << 24, 1 << 22}, {1, 1, 1}};
static const struct exh_precontact_par par = {
    -5368709, 1073741, 1 << 24, 0, 0, 100, 5368709, 100, 50, 100};

/* All that a packet may reach. */
struct box {
    struct exh_wire_rx rx;
    struct exh_wire_packet last;
    struct exh_precontact finger[EXH_FINGERS];
    int32_t active[EXH_MATERIAL_ROWS], staged[EXH_MATERIAL_ROWS];
    uint8_t pending;
};

static uint32_t counters(const struct exh_wire_rx *rx)
{
    return rx->accepted + rx->duplicate + rx->reordered + rx->old + rx->stranger + rx->corrupt +
           rx->version + rx->unknown + rx->far;
}

/* The same but for what a refused packet may count. */
static void must_be_unchanged(const struct box *was, const struct box *now)
{
    struct box is = *now;
    is.rx.missing = was->rx.missing;
    is.rx.duplicate = was->rx.duplicate;
    is.rx.reordered = was->rx.reordered;
    is.rx.old = was->rx.old;
    is.rx.stranger = was->rx.stranger;
    is.rx.corrupt = was->rx.corrupt;
    is.rx.version = was->rx.version;
    is.rx.unknown = was->rx.unknown;
    is.rx.far = was->rx.far;
    if (now->rx.reordered != was->rx.reordered) { is.rx.seen = was->rx.seen; }
    MUST(memcmp(&is, was, sizeof is) == 0);
}

static int was_frozen(const struct exh_precontact *s) { return s->phase == EXH_PRECONTACT_FROZEN; }

static void planes_came(struct box *b, const struct exh_precontact_cfg *cfg)
{
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const struct exh_plane p = exh_wire_plane_of(&b->last.u.planes, f);
        struct exh_precontact *s = &b->finger[f];
        const struct exh_precontact was = *s;
        const int r = exh_precontact_update(s, cfg, &p, 0);
        const struct exh_vec3 *n = &s->newest.normal_q30;
        MUST(p.kind <= EXH_PLANE_HIT);
        MUST(p.kind == EXH_PLANE_UNTOLD || b->last.u.planes.fingers >> f & 1);
        MUST(s->newest.material < cfg->materials);
        if (n->x | n->y | n->z) { /* a unit vector, within 2^-10 at least */
            const int64_t x = n->x >> 15, y = n->y >> 15, z = n->z >> 15;
            const int64_t off = x * x + y * y + z * z - (1 << 30);
            MUST(off < 1 << 20 && off > -(1 << 20));
        }
        if (r < 0) {
            struct exh_precontact is = *s;
            is.refused_n--;
            MUST(memcmp(&is, &was, sizeof is) == 0);
        }
        MUST(s->lim_m_q30 == was.lim_m_q30 && (s->phase == was.phase || !was_frozen(&was)));
    }
}

/* Every finger's tick: it is where the world's bytes say, which is as hostile as can be. */
static void tick(struct box *b, const struct exh_precontact_cfg *cfg, int on_the_plane)
{
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        struct exh_precontact *s = &b->finger[f];
        const struct exh_wire_plane *p = &b->last.u.planes.plane[f];
        const int32_t *at = on_the_plane ? p->point_m_q30 : p->hit_m_q30;
        const struct exh_precontact_in in = {
            {at[0], at[1], at[2]}, {0, 0, 0}, at[0] / 2, 0, 0, 1, at[1]};
        const struct exh_precontact was = *s;
        const uint32_t bits = exh_precontact_step(s, cfg, &in);
        const uint32_t froze_late = bits & EXH_PRECONTACT_LATE ? bits & EXH_PRECONTACT_FREEZE : 0;
        if (froze_late) { /* immediately, and the finger is inside */
            MUST(s->late && s->lim_m_q30 <= in.pos_m_q30);
        } else if (bits & EXH_PRECONTACT_STANDS) {
            MUST(s->lim_m_q30 == was.lim_m_q30);
        } else {
            MUST(in.pos_m_q30 < s->lim_m_q30);
        }
        MUST(!(bits & EXH_PRECONTACT_FREEZE) || froze_late || was.phase == EXH_PRECONTACT_TRACK);
    }
}

static void same_bytes(const struct box *b, const uint8_t *packet, size_t len)
{
    struct exh_wire_packet p = b->last;
    struct exh_wire_tx tx = {b->rx.session, p.seq};
    uint8_t again[EXH_WIRE_MAX_B];
    MUST(exh_wire_encode(&tx, &p, p.stamp_us, again, sizeof again) == (int32_t)len);
    MUST(memcmp(packet, again, len) == 0);
}

/* It is next and not too far ahead, or a HELLO that may begin. */
static void heard(
    const struct exh_wire_rx *was, const struct exh_wire_rx *is, uint32_t seq, int type)
{
    const uint32_t ahead = is->seq - was->seq;
    const int same = is->session == was->session;
    MUST(is->session != 0 && is->seq == seq && is->open == 0 && is->quiet_us == 0);
    if (same && ahead - 1 < EXH_WIRE_AHEAD) { return; }
    MUST(type == EXH_WIRE_HELLO && (was->open || was->session == 0));
    MUST(!same || ahead != 0);
    MUST(is->former == (same ? was->former : was->session));
}

/* A message whose order does not matter, from before the newest, and not taken before. */
static void taken_late(
    const struct exh_wire_rx *was, const struct exh_wire_rx *is, uint32_t seq, int type)
{
    const uint32_t late = is->seq - seq;
    MUST(type == EXH_WIRE_PARAM || type == EXH_WIRE_ACK);
    MUST(late > 0 && late < 64 && !(was->seen >> late & 1u) && (is->seen >> late & 1u));
    MUST(is->seq == was->seq && is->session == was->session && is->missing == was->missing - 1);
    MUST(is->quiet_us == was->quiet_us && is->open == was->open);
}

static void time_goes_by(struct exh_wire_rx *rx, unsigned what)
{
    const struct exh_wire_rx was = *rx;
    const uint32_t us = what & A_SILENCE ? LIMIT_US : what & A_WHILE ? LIMIT_US / 2 : 0;
    const int now = exh_wire_poll(rx, us, LIMIT_US);
    MUST(rx->silences == was.silences + (uint32_t)now);
    MUST(rx->open == (rx->session != 0 && rx->quiet_us >= LIMIT_US));
    MUST(rx->quiet_us >= was.quiet_us && rx->seq == was.seq && rx->session == was.session);
}

/* Whatever has come before. */
static void must_hear(struct exh_wire_rx *rx, uint32_t session)
{
    struct exh_wire_tx tx = {session, rx->seq - 1};
    struct exh_wire_packet p = {.type = EXH_WIRE_HELLO};
    uint8_t buf[EXH_WIRE_MAX_B];
    int32_t n = exh_wire_encode(&tx, &p, 0, buf, sizeof buf);
    (void)exh_wire_poll(rx, LIMIT_US, LIMIT_US);
    MUST(exh_wire_decode(rx, &p, buf, (size_t)n) == EXH_WIRE_HELLO);
    p.type = EXH_WIRE_PARAM;
    n = exh_wire_encode(&tx, &p, 0, buf, sizeof buf);
    MUST(exh_wire_decode(rx, &p, buf, (size_t)n) == EXH_WIRE_PARAM);
}

/* Any request is traced or refused. A trace of any values is read back as one in range. */
static void asked(const struct exh_wire_trace_request *a)
{
    struct exh_trace t;
    struct exh_trace_frame frame[4];
    const int32_t signal[300] = {0};
    struct exh_trace_request what = {a->every, {0}};
    struct exh_bytes c = exh_bytes_reader(a, sizeof *a);
    int bad = 0, r;
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) {
        what.index[i] = a->index[i];
        bad |= a->index[i] >= 300;
    }
    MUST(exh_trace_setup(&t, frame, 4, 300) == 0);
    r = exh_trace_start(&t, &what);
    MUST((r < 0) == bad);
    exh_trace_step(&t, 1, signal);
    MUST(t.head == (r == 0 && a->every > 0));
    exh_trace_serialize(&c, &t);
    for (int k = 0; k < 9; k++) { exh_trace_step(&t, 2, signal); }
}

static void datagram(struct box *b, const struct exh_precontact_cfg *cfg, struct exh_params *params,
    const uint8_t *packet, size_t len)
{
    const struct box was = *b;
    const int r = exh_wire_decode(&b->rx, &b->last, packet, len);
    uint32_t late;
    MUST(counters(&b->rx) == counters(&was.rx) + 1);
    if (r < 0) {
        MUST(b->rx.accepted == was.rx.accepted);
        must_be_unchanged(&was, b);
        return;
    }
    late = b->rx.reordered - was.rx.reordered;
    MUST(r == b->last.type && b->rx.accepted == was.rx.accepted + 1 - late);
    if (r == EXH_WIRE_HELLO) {
        MUST(exh_wire_compare(&b->last.u.hello, &b->last.u.hello) == EXH_WIRE_ROLE);
    }
    if (late) {
        taken_late(&was.rx, &b->rx, b->last.seq, r);
    } else {
        heard(&was.rx, &b->rx, b->last.seq, r);
    }
    same_bytes(b, packet, len);
    if (r == EXH_WIRE_PLANES) {
        planes_came(b, cfg);
        tick(b, cfg, 0);
        tick(b, cfg, 1);
    } else if (r == EXH_WIRE_PARAM) {
        const struct exh_wire_ack ack = exh_wire_stage(params, &b->last, 0);
        MUST(ack.result == 0 || memcmp(was.staged, b->staged, sizeof b->staged) == 0);
    } else if (r == EXH_WIRE_TRACE) {
        const struct exh_wire_trace *t = &b->last.u.trace;
        MUST(t->frames <= EXH_WIRE_FRAMES && t->result <= 0 && (t->result == 0 || t->frames == 0));
        MUST(exh_wire_trace_missed(t->first, t) == 0);
    } else if (r == EXH_WIRE_TRACE_ASK) {
        asked(&b->last.u.trace_ask);
    }
}

static void put(uint8_t *p, size_t len, size_t at, uint32_t v, unsigned n)
{
    for (unsigned i = 0; i < n && at + i < len; i++) { p[at + i] = (uint8_t)(v >> 8 * i & 0xFF); }
}

static void put_right(uint8_t *p, size_t len, unsigned what, const struct exh_wire_rx *rx)
{
    if (what & FIX_MAGIC) { put(p, len, 0, EXH_WIRE_MAGIC | EXH_WIRE_VERSION << 16, 3); }
    if (what & FIX_LENGTH) { put(p, len, 4, (uint32_t)(len - EXH_WIRE_OVERHEAD), 2); }
    if (what & FIX_SESSION) { put(p, len, 6, rx->session, 4); }
    if (what & FIX_SEQ) { put(p, len, 10, rx->seq + 1, 4); }
    if (what & FIX_CRC && len >= 4) { put(p, len, len - 4, exh_crc32(0, p, len - 4), 4); }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const struct exh_signal_group group[] = {{exh_material_rows, EXH_MATERIAL_ROWS, 1}};
    static const struct exh_signal_table table = {group, 1};
    static struct box b;
    struct exh_params params;
    struct exh_precontact_cfg cfg;
    const struct exh_period T = {1, 2000};

    memset(&b, 0, sizeof b); /* padding, too: boxes are compared byte by byte */
    exh_params_setup(&params, &table, b.active, b.staged);
    MUST(exh_precontact_setup(&cfg, &par, material, 2, 7516193, T) == 0);
    while (size >= 3) {
        const size_t asked = data[1] + 256u * data[2];
        const size_t len = asked < size - 3 ? asked : size - 3;
        uint8_t *packet = malloc(len + 1); /* its own piece, so that a byte too far is seen */
        MUST(packet != NULL);
        memcpy(packet, data + 3, len);
        put_right(packet, len, data[0], &b.rx);
        time_goes_by(&b.rx, data[0]);
        datagram(&b, &cfg, &params, packet, len);
        if (data[0] & TWICE) { datagram(&b, &cfg, &params, packet, len); }
        free(packet);
        data += 3 + len;
        size -= 3 + len;
    }
    if (b.rx.former != 0) { must_hear(&b.rx, b.rx.former); }
    must_hear(&b.rx, b.rx.session ? b.rx.session : 1);
    return 0;
}
