/* SPDX-License-Identifier: MIT */
/* wire: packets written, lost, late, twice, damaged and forged, and taken. */
#include "modules.h"
#include "wire_body.h"

#include "exhand/fix.h"
#include "exhand/wire.h"

#define ROOM_B 400 /* of a datagram, which may be longer than any packet */

/* --- stimuli --- */

struct datagram {
    uint8_t b[ROOM_B];
    uint32_t len;
};

static struct link {
    struct exh_wire_tx tx;
    struct exh_wire_rx rx;
    struct exh_params params;
    int32_t active[GOLDEN_VALUES], staged[GOLDEN_VALUES];
    struct datagram sent[GOLDEN_TICKS]; /* of the present set-up */
    uint32_t n;
    int begun;
} world;

static uint32_t any_u32(struct golden_rng *r) { return (uint32_t)(golden_u64(r) & UINT32_MAX); }

static void begin(struct golden_rng *r)
{
    (void)memset(&world, 0, sizeof world);
    world.tx.session = any_u32(r) | 1;
    world.tx.seq = (uint32_t)golden_draw(r, -40, 40);
    exh_params_setup(&world.params, &golden_signals, world.active, world.staged);
}

static void put_crc(struct datagram *d)
{
    struct exh_bytes c = exh_bytes_writer(d->b + d->len - 4, 4);
    uint32_t crc = exh_crc32(0, d->b, d->len - 4);
    exh_bytes_u32(&c, &crc);
}

/* Something else with a CRC that is right. */
static void forge(struct golden_rng *r, struct datagram *d)
{
    const int64_t how = golden_draw(r, 0, 6);
    if (how == 0) { d->b[2] = (uint8_t)golden_draw(r, 2, 255); }
    if (how == 1) { d->b[3] = (uint8_t)golden_draw(r, 8, 255); }
    if (how == 2) { (void)memset(d->b + 6, 0, 4); }
    if (how == 3) { golden_body_spoil(r, d->b[3], d->b + 18); }
    if (how == 4) { d->b[0] ^= (uint8_t)(INT32_C(1) << golden_draw(r, 0, 7)); }
    if (how > 4) {
        const uint32_t n = how == 5 ? d->len - 23 : 300;
        (void)memset(d->b + d->len - 4, 0, 4);
        d->b[4] = (uint8_t)(n & 0xFF);
        d->b[5] = (uint8_t)(n >> 8);
        d->len = 22 + n;
    }
    put_crc(d);
}

/* The packet with a number near an end of what is taken; the sender goes on from a newer one. */
static void number(struct golden_rng *r, struct datagram *d)
{
    static const int64_t half = INT64_C(1) << 31;
    const int64_t end[] = {-64, half, -64, half, -64, half, -64, 0, 65536};
    struct exh_bytes c = exh_bytes_writer(d->b + 10, 4);
    const int64_t near = end[golden_draw(r, 0, 8)];
    const int64_t on = near + golden_draw(r, -1, 1);
    uint32_t seq = world.rx.seq + (uint32_t)on;
    if (on > 0 && on <= 65536) { world.tx.seq = seq + 1; }
    exh_bytes_u32(&c, &seq);
    put_crc(d);
}

/* --- a tick --- */

static uint8_t any_type(struct golden_rng *r)
{
    const int usual = golden_draw(r, 0, 31) != 0;
    uint8_t type = (uint8_t)(usual ? golden_draw(r, 1, 7) : golden_draw(r, 8, 255) % 255);
    if (!world.begun && golden_draw(r, 0, 1) != 0) {
        type = EXH_WIRE_HELLO;
        world.begun = 1;
    }
    if (world.rx.open && golden_draw(r, 0, 1) != 0) { type = EXH_WIRE_HELLO; }
    return type;
}

/* The sender starts again, or many of its packets are lost. */
static void any_sender(struct golden_rng *r)
{
    if (golden_draw(r, 0, 31) == 0) {
        world.tx.session = any_u32(r) | 1;
        world.begun = 0;
    }
    if (golden_draw(r, 0, 31) == 0) { world.tx.seq += (uint32_t)golden_draw(r, 1, 200); }
}

static void put_send(struct golden *g, struct golden_rng *r, int32_t said[2])
{
    struct datagram *d = &world.sent[world.n];
    struct exh_wire_packet p;
    struct exh_wire_tx nobody = {0, 0};
    struct exh_wire_tx *tx = &world.tx;
    uint8_t body[GOLDEN_BODY_B] = {0};
    struct exh_bytes c = exh_bytes_reader(body, sizeof body);
    uint32_t stamp_us;
    uint32_t cap_B = 256;
    any_sender(r);
    (void)memset(&p, 0, sizeof p);
    p.type = any_type(r);
    golden_body_any(r, p.type, body);
    if (golden_draw(r, 0, 7) < 3) { golden_body_spoil(r, p.type, body); }
    golden_body_list(&c, &p);
    stamp_us = any_u32(r);
    if (golden_draw(r, 0, 7) == 0) { cap_B = (uint32_t)golden_draw(r, 0, 255); }
    if (golden_draw(r, 0, 63) == 0) { tx = &nobody; }
    (void)memset(d, 0, sizeof *d);
    said[0] = exh_wire_encode(tx, &p, stamp_us, d->b, cap_B);
    said[1] = 0;
    golden_put(g, p.type);
    golden_put(g, cap_B);
    if (said[0] < 0) { return; }
    d->len = (uint32_t)said[0];
    c = exh_bytes_reader(d->b + d->len - 4, 4);
    exh_bytes_i32(&c, &said[1]);
    CHECK(p.stamp_us == stamp_us && p.seq == tx->seq - 1, "what was sent is not left in p");
    world.n++;
}

/* What arrives in this tick. */
static void any_arriving(struct golden_rng *r, int64_t how, struct datagram *d)
{
    const uint32_t n = world.n;
    (void)memset(d, 0, sizeof *d);
    if (n == 0) { return; }
    *d = world.sent[n - 1];
    if (world.rx.open && golden_draw(r, 0, 1) != 0) { /* of any session, from any time */
        *d = world.sent[golden_draw(r, 0, (int64_t)n - 1)];
        return;
    }
    if (how < 2 || how == 6) {
        const uint32_t back = (uint32_t)golden_draw(r, 1, how == 6 ? 6 : 80);
        *d = world.sent[n - 1 - (back < n ? back : n - 1)];
    }
    if (how == 2) {
        const int64_t i = golden_draw(r, 0, 8 * (int64_t)d->len - 1);
        d->b[i >> 3] ^= (uint8_t)(INT32_C(1) << (i & 7));
    }
    if (how == 3) { d->len = (uint32_t)golden_draw(r, 0, (int64_t)d->len - 1); }
    if (how == 4) { d->len += (uint32_t)golden_draw(r, 1, 8); }
    if (how == 5 || how == 10) { forge(r, d); }
    if (how == 9 || (how >= 11 && how <= 13)) { number(r, d); }
}

static uint32_t body_crc(struct exh_wire_packet *p)
{
    uint8_t body[GOLDEN_BODY_B];
    struct exh_bytes c = exh_bytes_writer(body, sizeof body);
    golden_body_list(&c, p);
    return exh_crc32(0, body, c.at);
}

static void vec_list(struct exh_bytes *c, struct exh_vec3 *v)
{
    exh_bytes_i32(c, &v->x);
    exh_bytes_i32(c, &v->y);
    exh_bytes_i32(c, &v->z);
}

static uint32_t plane_crc(const struct exh_wire_planes *planes, unsigned finger)
{
    struct exh_plane p = exh_wire_plane_of(planes, finger);
    uint8_t b[28];
    struct exh_bytes c = exh_bytes_writer(b, sizeof b);
    exh_bytes_u8(&c, &p.kind);
    exh_bytes_u8(&c, &p.material);
    exh_bytes_u16(&c, &p.object);
    vec_list(&c, &p.normal_q30);
    vec_list(&c, &p.point_m_q30);
    return exh_crc32(0, b, c.at);
}

/* What the receiver says and hands on; a parameter is staged. */
static void put_taken(struct golden *g, const struct datagram *d)
{
    struct exh_wire_packet p;
    struct exh_wire_ack ack = {{0, 0, 0}, 0, 0};
    int64_t v[5] = {0, 0, 0, 0, 0};
    const int got = exh_wire_decode(&world.rx, &p, d->b, d->len);
    if (got > 0) {
        v[0] = p.seq;
        v[1] = p.stamp_us;
        v[2] = body_crc(&p);
    }
    if (got == EXH_WIRE_PLANES) {
        v[3] = plane_crc(&p.u.planes, p.seq % 5);
        v[4] = exh_wire_round_trip_us(p.stamp_us, &p.u.planes);
    }
    if (got == EXH_WIRE_PARAM) {
        ack = exh_wire_stage(&world.params, &p, 1);
        CHECK(ack.param.instance == p.u.param.instance, "another instance in the answer");
    }
    golden_put(g, got);
    for (int i = 0; i < 5; i++) { golden_put(g, v[i]); }
    golden_put(g, ack.param.id);
    golden_put(g, ack.param.value);
    golden_put(g, ack.result);
    golden_put(g, ack.request_seq);
}

static uint32_t values_crc(void)
{
    uint8_t b[8 * GOLDEN_VALUES];
    struct exh_bytes c = exh_bytes_writer(b, sizeof b);
    for (int i = 0; i < GOLDEN_VALUES; i++) { exh_bytes_i32(&c, &world.active[i]); }
    for (int i = 0; i < GOLDEN_VALUES; i++) { exh_bytes_i32(&c, &world.staged[i]); }
    return exh_crc32(0, b, c.at);
}

/* Time goes by, at times more than a second of it. */
static void put_time(struct golden *g, struct golden_rng *r)
{
    static const uint32_t long_us[] = {1, 999999, 1000000, UINT32_MAX};
    const int rest = golden_draw(r, 0, 3) == 0;
    const uint32_t us = rest ? long_us[golden_draw(r, 0, 3)] : (uint32_t)golden_draw(r, 0, 2);
    golden_put(g, exh_wire_poll(&world.rx, us, 1000000));
}

void golden_wire(struct golden *g, uint32_t rate_Hz)
{
    static struct datagram d;
    struct golden_rng r = golden_rng("wire", rate_Hz, 0);
    while (g->tick < GOLDEN_TICKS) {
        struct exh_wire_packet p;
        int64_t how;
        int32_t said[2];
        if (g->tick == 0 || g->tick == GOLDEN_AGAIN) { begin(&r); }
        if (g->tick == 128) { world.params.locked = 1; }
        put_time(g, &r);
        put_send(g, &r, said);
        how = golden_draw(&r, 0, 15);
        any_arriving(&r, how, &d);
        golden_put(g, how);
        golden_put(g, d.len);
        golden_put(g, said[0]);
        golden_put(g, (uint32_t)said[1]);
        put_taken(g, &d);
        golden_put(g, how == 8 ? exh_wire_decode(&world.rx, &p, d.b, d.len) : 0);
        if (g->tick % 8 == 7) { (void)exh_params_apply(&world.params); }
        golden_put(g, values_crc());
        GOLDEN_STATE(g, exh_wire_tx_serialize, &world.tx);
        GOLDEN_STATE(g, exh_wire_rx_serialize, &world.rx);
        golden_tick(g);
    }
}
