/* SPDX-License-Identifier: MIT */
#include "bilateral.h"

/* HELLO once in this many exchanges: until planes come and after a silence, and later. A world that
 * missed one receives the next. */
#define HELLO_AT_FIRST 8u
#define HELLO_THEN     128u
#define US_Q           20

void bilateral_wire_setup(
    struct bilateral_wire_cfg *cfg, struct bilateral_wire *s, uint32_t session, struct exh_period T)
{
    uint64_t rest;
    const uint64_t whole_us = exh_udiv64(UINT64_C(1000000) * T.num, T.den, &rest);
    cfg->tick_us_q20 = (whole_us << US_Q) + exh_udiv64(rest << US_Q, T.den, NULL);
    cfg->ms_per_tick_q20 = (uint32_t)exh_udiv64(cfg->tick_us_q20, 1000, NULL);
    cfg->ticks_per_us_q32 =
        (uint32_t)exh_udiv64((uint64_t)T.den << 32, UINT64_C(1000000) * T.num, NULL);
    cfg->hello = (struct exh_wire_hello){.role = EXH_WIRE_CONTROLLER,
        .lib_version = EXH_VERSION_NUMBER,
        .table_crc = exh_signal_crc(&bilateral_params)};
    s->tx.session = session;
    s->age_ticks = UINT32_MAX;
}

static uint32_t now_us(const struct bilateral_wire *s) { return (uint32_t)(s->now_us_q20 >> US_Q); }

/* --- receiving --- */

/* Planes are at most as old as the STATE they answer. Planes of a finger with unknown position or
 * faulty sensors are ignored, since the distance would be a guess. */
static void take_planes(
    struct bilateral *s, const struct bilateral_cfg *cfg, const struct exh_wire_planes *planes)
{
    struct bilateral_wire *w = &s->wire;
    uint32_t age_ticks;
    w->trip_us = exh_wire_round_trip_us(now_us(w), planes);
    w->age_ticks = 0;
    age_ticks = (uint32_t)((uint64_t)w->trip_us * cfg->wire.ticks_per_us_q32 >> 32);
    for (unsigned k = 0; k < bilateral_n(cfg); k++) {
        const unsigned f = bilateral_at(cfg, k);
        const struct exh_plane plane = exh_wire_plane_of(planes, f);
        if (bilateral_finger_age(s, cfg, k) == UINT32_MAX) { continue; }
        (void)exh_precontact_update(&s->finger[f].precontact, &cfg->finger[f].precontact, &plane,
            age_ticks); /* it counts a refused one itself */
    }
}

/* The world may only set materials (authority.h). They act at the next freeze, within the rule of
 * gains and the drive's own limits. */
static struct exh_wire_ack stage(const struct bilateral *s, const struct bilateral_cfg *cfg,
    struct exh_params *params, const struct exh_wire_packet *p)
{
    const struct exh_authority world = {EXH_FROM_WORLD, 1, !exh_safety_is_at_rest(s->safety.state)};
    const struct exh_wire_param *ask = &p->u.param;
    const int result = bilateral_gains_stage(cfg, params, world, ask);
    return (struct exh_wire_ack){*ask, (int16_t)result, p->seq};
}

void bilateral_wire_take(struct bilateral *s, const struct bilateral_cfg *cfg,
    const struct exh_scene_mail *in, uint32_t missed, struct exh_params *params)
{
    struct bilateral_wire *w = &s->wire;
    const uint32_t before_us = now_us(w);
    w->now_us_q20 += cfg->wire.tick_us_q20 * (missed + UINT64_C(1));
    if (exh_wire_poll(&w->rx, now_us(w) - before_us, 1000u * (uint32_t)cfg->par->own.quiet_ms)) {
        w->exchanges = 0; /* perhaps it has lost our session */
    }
    w->age_ticks = bilateral_later(w->age_ticks, missed);
    w->acks = 0;
    w->heard = in->packets > 0;
    for (unsigned i = 0; i < in->packets; i++) {
        struct exh_wire_packet p;
        const uint32_t session = w->rx.session;
        const int type = exh_wire_decode(&w->rx, &p, in->byte[i], in->len_B[i]);
        if (w->rx.session !=
            session) { /* a world without our session, which has requested nothing yet */
            w->exchanges = 0;
            bilateral_trace_stop(&w->trace);
            for (unsigned k = 0; k < bilateral_n(cfg); k++) {
                exh_precontact_forget(&s->finger[bilateral_at(cfg, k)].precontact);
            }
        }
        if (type == EXH_WIRE_HELLO) {
            w->differs = exh_wire_compare(&cfg->wire.hello, &p.u.hello);
            w->odd += w->differs != 0;
        } else if (type == EXH_WIRE_PLANES) {
            take_planes(s, cfg, &p.u.planes);
        } else if (type == EXH_WIRE_PARAM) {
            const struct exh_wire_ack ack = stage(s, cfg, params, &p);
            w->set += ack.result == 0;
            w->ack[w->acks++] = ack;
        } else if (type == EXH_WIRE_TRACE_ASK) {
            bilateral_trace_ask(&w->trace, &p);
        }
    }
}

/* --- sending --- */

void bilateral_wire_put(
    struct bilateral_wire *w, struct exh_scene_mail *out, struct exh_wire_packet *p)
{
    int32_t n;
    if (out->packets == EXH_SCENE_PACKETS) { return; }
    n = exh_wire_encode(&w->tx, p, now_us(w), out->byte[out->packets], EXH_SCENE_PACKET_B);
    if (n > 0) { out->len_B[out->packets++] = (uint16_t)n; }
}

static void put_hello(
    struct bilateral_wire *w, const struct bilateral_wire_cfg *cfg, struct exh_scene_mail *out)
{
    struct exh_wire_packet p = {.type = EXH_WIRE_HELLO};
    p.u.hello = cfg->hello;
    bilateral_wire_put(w, out, &p);
}

static void finger_of(struct exh_wire_state *to, const struct bilateral *s,
    const struct bilateral_paper *p, unsigned f)
{
    const struct bilateral_finger *now = &s->finger[f];
    for (unsigned j = 0; j < EXH_HAND_JOINTS; j++) {
        to->joint_turn_q32[f][j] = now->joint_turn_q32[j];
    }
    to->tip_m_q30[f][0] = now->tip_m_q30.x;
    to->tip_m_q30[f][1] = now->tip_m_q30.y;
    to->tip_m_q30[f][2] = now->tip_m_q30.z;
    to->force_N_q20[f] = p->f_des_N_q20;
    to->d_m_q30[f] = p->d_m_q30;
    to->q_m_q30[f] = p->q_m_q30;
    to->q_lim_m_q30[f] = p->q_lim_m_q30;
    to->fingers = (uint8_t)(to->fingers | 1u << f);
    if (now->precontact.phase == EXH_PRECONTACT_FROZEN) {
        to->frozen = (uint8_t)(to->frozen | 1u << f);
    }
    if (p->c) { to->touching = (uint8_t)(to->touching | 1u << f); }
}

static uint16_t age_ms(const struct bilateral_wire *w, const struct bilateral_wire_cfg *cfg)
{
    const uint64_t ms = (uint64_t)w->age_ticks * cfg->ms_per_tick_q20 >> US_Q;
    return (uint16_t)(ms < EXH_WIRE_NEVER_MS ? ms : EXH_WIRE_NEVER_MS);
}

static void put_state(struct bilateral *s, const struct bilateral_cfg *cfg,
    const struct bilateral_signals *sig, struct exh_scene_mail *out)
{
    struct exh_wire_packet p = {.type = EXH_WIRE_STATE};
    p.u.state.tick = s->safety.tick;
    p.u.state.state = s->safety.state;
    p.u.state.faults = s->safety.faults;
    p.u.state.age_ms = age_ms(&s->wire, &cfg->wire);
    for (unsigned k = 0; k < bilateral_n(cfg); k++) {
        finger_of(&p.u.state, s, &sig->paper[bilateral_at(cfg, k)], bilateral_at(cfg, k));
    }
    bilateral_wire_put(&s->wire, out, &p);
}

/* Sends one of the two per tick, and none in a tick that reads packets, so that no tick pays for
 * both. They wait at most until the last tick before the next state is due. */
static void put_due(struct bilateral *s, const struct bilateral_cfg *cfg,
    const struct bilateral_signals *sig, struct exh_scene_mail *out)
{
    struct bilateral_wire *w = &s->wire;
    const int last = w->wait_ticks == 1;
    if (w->heard && !last && w->tx.seq > 0) { return; } /* a HELLO has priority */
    if (w->due & BILATERAL_HELLO) {
        put_hello(w, &cfg->wire, out);
        w->due &= (uint8_t)~BILATERAL_HELLO;
        if (!last) { return; }
    }
    put_state(s, cfg, sig, out);
    w->due = 0;
}

void bilateral_write(struct bilateral *s, const struct bilateral_cfg *cfg,
    struct bilateral_signals *sig, struct exh_scene_mail *out)
{
    struct bilateral_wire *w = &s->wire;
    const uint32_t state_every = (uint32_t)cfg->par->own.state_every;
    out->packets = 0;
    if (w->wait_ticks == 0 || w->wait_ticks >= state_every) { /* interval was shortened */
        const int alone = w->age_ticks == UINT32_MAX || w->rx.open;
        const uint32_t every = alone ? HELLO_AT_FIRST : HELLO_THEN;
        w->wait_ticks = state_every;
        w->due |= BILATERAL_STATE;
        if ((w->exchanges++ & (every - 1)) == 0) { w->due |= BILATERAL_HELLO; }
    }
    if (w->due) { put_due(s, cfg, sig, out); }
    w->wait_ticks--;
    for (unsigned i = 0; i < w->acks; i++) { /* an answer without room is requested again */
        struct exh_wire_packet p = {.type = EXH_WIRE_ACK};
        p.u.ack = w->ack[i];
        bilateral_wire_put(w, out, &p);
    }
    w->acks = 0;
    bilateral_trace_write(s, cfg, sig, out);
}

/* --- state --- */

void bilateral_wire_bytes(struct exh_bytes *c, struct bilateral_wire *s)
{
    int64_t now_us_q20 = exh_from_u64(s->now_us_q20);
    exh_wire_tx_serialize(c, &s->tx);
    exh_wire_rx_serialize(c, &s->rx);
    exh_bytes_i64(c, &now_us_q20);
    s->now_us_q20 = (uint64_t)now_us_q20;
    exh_bytes_u32(c, &s->age_ticks);
    exh_bytes_u32(c, &s->trip_us);
    exh_bytes_u32(c, &s->exchanges);
    exh_bytes_u32(c, &s->set);
    exh_bytes_u32(c, &s->wait_ticks);
    exh_bytes_u32(c, &s->differs);
    s->differs &= EXH_WIRE_ROLE | EXH_WIRE_LIB | EXH_WIRE_TABLE;
    exh_bytes_u32(c, &s->odd);
    exh_bytes_u8(c, &s->due);
    s->due &= BILATERAL_HELLO | BILATERAL_STATE;
    s->acks = s->heard = 0; /* always 0 between two ticks */
    bilateral_trace_bytes(c, &s->trace);
}
