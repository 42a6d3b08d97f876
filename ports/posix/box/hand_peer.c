/* SPDX-License-Identifier: MIT */
#include "box/hand_peer.h"

#include "world/world.h"

#include "exhand/exhand.h"

#include <math.h>
#include <string.h>

#define HELLO_EVERY_S 0.5
#define PARAM_EVERY_S 0.02
#define TRACE_EVERY_S \
    0.5              /* longer than the way there and back: an answer is of the newest request */
#define HOLDS_S  1.0 /* planes wait so long for the answers to parameters */
#define QUIET_US 1000000 /* silence after which any HELLO starts a session */

double peer_gap_m(const struct exh_wire_plane *p, const int32_t tip_m_q30[3])
{
    double sum = 0;
    if (p->kind != EXH_PLANE_HIT) { return -1e3; }
    for (int i = 0; i < 3; i++) {
        sum += ((double)p->point_m_q30[i] - tip_m_q30[i]) * p->normal_q30[i];
    }
    return (sum / 1073741824.0 + exh_hand_rows[3].dflt) / 1073741824.0;
}

void peer_look(const struct peer_world *w, const struct exh_wire_state *in, const struct pace *pace,
    double t_s, struct exh_wire_planes *out)
{
    if (w->scene) {
        world_frame(w->scene, in, pace, t_s, out, NULL);
        return;
    }
    out->fingers = w->wall.fingers & in->fingers;
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        static const struct exh_wire_plane untold;
        struct exh_wire_plane *p = &out->plane[f];
        if (!(out->fingers >> f & 1)) {
            *p = untold;
            continue;
        }
        *p = w->wall.plane[f];
        for (int i = 0; w->jump_s > 0 && t_s >= w->jump_s && i < 3; i++) {
            p->point_m_q30[i] += (int32_t)(w->jump_m * p->normal_q30[i]);
        }
        if (w->ray_m > 0 && peer_gap_m(p, in->tip_m_q30[f]) < -w->ray_m) {
            *p = untold;
            p->kind = EXH_PLANE_NONE;
        }
    }
}

void peer_start(struct peer *p, const struct peer_cfg *cfg, uint32_t session)
{
    memset(p, 0, sizeof *p);
    p->cfg = *cfg;
    p->tx.session = session;
    p->hello_s = p->param_s = p->trace_s = p->met_s = -1;
}

/* Frames of another request than ours are of a world before. */
static void take_trace(struct peer *p, const struct exh_wire_trace *t)
{
    struct peer_trace *s = &p->trace;
    if (p->trace_s < 0 || t->result < 0) { return; }
    if (!s->answered && t->request_seq != s->request_seq) { return; }
    if (!s->answered) { s->next = t->first; }
    s->answered = 1;
    s->missed += exh_wire_trace_missed(s->next, t);
    for (unsigned i = 0; i < t->frames; i++) {
        const uint32_t ahead = t->first + i - s->next + 1; /* frames on from the last */
        if (s->frames == 0) { s->first_tick = t->frame[i].tick; }
        s->unruly += s->frames > 0 && t->frame[i].tick - s->last_tick != ahead * p->cfg.trace.every;
        s->last_tick = t->frame[i].tick;
        s->next = t->first + i + 1;
        s->frames++;
    }
    s->next = t->first + t->frames;
}

static void take(struct peer *p, const void *buf, size_t len_B)
{
    struct exh_wire_packet *in = &p->in[p->at ^ 1u];
    const int type = exh_wire_decode(&p->rx, in, buf, len_B);
    if (type == EXH_WIRE_HELLO) {
        p->hello_s = -1; /* a new peer: answer in this tick */
        pace_pull(&p->pace, &in->u.hello);
    }
    if (type == EXH_WIRE_TRACE) { take_trace(p, &in->u.trace); }
    if (type == EXH_WIRE_STATE) {
        p->at ^= 1u;
        if (p->cfg.world->scene) { pace_take(&p->pace, &in->u.state, in->stamp_us); }
        p->echo_seq = in->seq;
        p->echo_stamp_us = in->stamp_us;
        p->told = 1;
    }
    for (int i = 0; type == EXH_WIRE_ACK && i < p->cfg.params; i++) {
        const struct exh_wire_param *a = &in->u.ack.param, *b = &p->cfg.param[i];
        if (a->id == b->id && a->instance == b->instance && a->value == b->value) {
            p->acked |= 1u << i;
            if (in->u.ack.result < 0) { p->refused |= 1u << i; }
        }
    }
}

static void put_spoiled(
    struct peer *p, struct sim_link *link, const uint8_t *good, size_t len_B, double t_s)
{
    uint8_t buf[EXH_WIRE_MAX_B + 1];
    for (int k = 0; k < p->cfg.hostile; k++) {
        const uint32_t n = p->spoiled++;
        const size_t bit = (size_t)(n * UINT32_C(2654435761)) % (8 * len_B);
        size_t send_B = len_B;
        memcpy(buf, good, len_B);
        buf[len_B] = 0;
        if (n % 3 == 0) {
            send_B = 1 + bit / 8;
        } else if (n % 3 == 1) {
            send_B++;
        }
        if (n % 3 == 2 || send_B == len_B) { buf[bit / 8] ^= (uint8_t)(1u << bit % 8); }
        (void)sim_link_send(&link->way[SIM_LINK_IN], t_s, buf, send_B);
    }
}

static void put(struct peer *p, struct sim_link *link, struct exh_wire_packet *out, double t_s)
{
    uint8_t buf[EXH_WIRE_MAX_B];
    const int32_t n =
        exh_wire_encode(&p->tx, out, (uint32_t)(uint64_t)(t_s * 1e6), buf, sizeof buf);
    if (n <= 0) { return; }
    put_spoiled(p, link, buf, (size_t)n, t_s);
    (void)sim_link_send(&link->way[SIM_LINK_IN], t_s, buf, (size_t)n);
}

static void put_hello(struct peer *p, struct sim_link *link, double t_s)
{
    struct exh_wire_packet out = {.type = EXH_WIRE_HELLO};
    out.u.hello = (struct exh_wire_hello){
        .role = EXH_WIRE_WORLD, .lib_version = EXH_VERSION_NUMBER, .table_crc = 0};
    put(p, link, &out, t_s);
    p->hello_s = t_s;
}

static void put_params(struct peer *p, struct sim_link *link, double t_s)
{
    p->param_s = t_s;
    for (int i = 0; i < p->cfg.params; i++) {
        struct exh_wire_packet out = {.type = EXH_WIRE_PARAM};
        if (p->acked >> i & 1) { continue; }
        out.u.param = p->cfg.param[i];
        put(p, link, &out, t_s);
    }
}

static void put_trace_ask(struct peer *p, struct sim_link *link, double t_s)
{
    struct exh_wire_packet out = {.type = EXH_WIRE_TRACE_ASK};
    out.u.trace_ask = p->cfg.trace;
    put(p, link, &out, t_s);
    p->trace.request_seq = out.seq;
    p->trace_s = t_s;
}

/* So that the first contact has its material, planes wait for the answers, but not for long. */
static void hide(const struct peer *p, struct exh_wire_planes *planes, double t_s)
{
    if (t_s < p->cfg.param_from_s || t_s - p->met_s >= HOLDS_S) { return; }
    for (int i = 0; i < p->cfg.params; i++) {
        const struct exh_wire_param *ask = &p->cfg.param[i];
        if (p->acked >> i & 1 || ask->id >> 8 != exh_material_rows[0].id >> 8) { continue; }
        for (unsigned f = 0; f < EXH_FINGERS; f++) {
            if (planes->plane[f].material == ask->instance) {
                planes->plane[f].kind = EXH_PLANE_UNTOLD;
            }
        }
    }
}

static void answer(struct peer *p, struct sim_link *link, double t_s)
{
    struct exh_wire_packet out; /* planes are set whole */
    out.type = EXH_WIRE_PLANES;
    peer_look(p->cfg.world, &p->in[p->at].u.state, &p->pace, t_s, &out.u.planes);
    hide(p, &out.u.planes, t_s);
    out.u.planes.echo_seq = p->echo_seq;
    out.u.planes.echo_stamp_us = p->echo_stamp_us;
    put(p, link, &out, t_s);
    p->answers++;
}

/* Another process of the same world: it knows nothing of what was before. */
static void start_anew(struct peer *p)
{
    const struct peer_cfg cfg = p->cfg;
    peer_start(p, &cfg, p->tx.session + 1);
    p->cfg.from_s = cfg.again_s;
    p->cfg.until_s = 1e30;
    p->born_again = 1;
}

void peer_frame(void *ctx, struct sim_link *link, double t_s)
{
    struct peer *p = ctx;
    const struct sim_link_packet *got;
    int there;
    if (p->cfg.again_s > 0 && t_s >= p->cfg.again_s && !p->born_again) { start_anew(p); }
    there = t_s >= p->cfg.from_s && t_s < p->cfg.until_s;
    (void)exh_wire_poll(&p->rx, (uint32_t)fmin(1e6 * (t_s - p->heard_s), 4e9), QUIET_US);
    p->heard_s = t_s;
    while ((got = sim_link_take(&link->way[SIM_LINK_OUT], t_s, sizeof got->byte)) != NULL) {
        if (there) { take(p, got->byte, got->len_B); }
    }
    if (!there) { return; }
    p->frames++;
    if (p->hello_s < 0 || t_s - p->hello_s >= HELLO_EVERY_S) { put_hello(p, link, t_s); }
    if (p->rx.session == 0) { return; }
    if (t_s >= p->cfg.param_from_s && (p->param_s < 0 || t_s - p->param_s >= PARAM_EVERY_S)) {
        put_params(p, link, t_s);
    }
    if (p->cfg.trace.every && !p->trace.answered &&
        (p->trace_s < 0 || t_s - p->trace_s >= TRACE_EVERY_S)) {
        put_trace_ask(p, link, t_s);
    }
    if (p->met_s < 0) { p->met_s = t_s; }
    if (p->told) { answer(p, link, t_s); }
}
