/* SPDX-License-Identifier: MIT */
/* The payloads of wire, listed anew from docs/WIRE.md: any that can be, and one that cannot. */
#include "wire_body.h"

static void i32s(struct exh_bytes *c, int32_t *v, int n)
{
    for (int i = 0; i < n; i++) { exh_bytes_i32(c, &v[i]); }
}

static void state_list(struct exh_bytes *c, struct exh_wire_state *s)
{
    exh_bytes_u32(c, &s->tick);
    exh_bytes_u8(c, &s->fingers);
    exh_bytes_u8(c, &s->state);
    exh_bytes_u8(c, &s->frozen);
    exh_bytes_u8(c, &s->touching);
    exh_bytes_u16(c, &s->age_ms);
    exh_bytes_u32(c, &s->faults);
    for (int f = 0; f < 5; f++) {
        i32s(c, s->joint_turn_q32[f], 3);
        i32s(c, s->tip_m_q30[f], 3);
        exh_bytes_i32(c, &s->force_N_q20[f]);
        exh_bytes_i32(c, &s->d_m_q30[f]);
        exh_bytes_i32(c, &s->q_m_q30[f]);
        exh_bytes_i32(c, &s->q_lim_m_q30[f]);
    }
}

static void planes_list(struct exh_bytes *c, struct exh_wire_planes *s)
{
    exh_bytes_u32(c, &s->echo_seq);
    exh_bytes_u32(c, &s->echo_stamp_us);
    exh_bytes_u8(c, &s->fingers);
    for (int f = 0; f < 5; f++) {
        struct exh_wire_plane *p = &s->plane[f];
        exh_bytes_u8(c, &p->kind);
        exh_bytes_u8(c, &p->material);
        exh_bytes_u16(c, &p->object);
        i32s(c, p->normal_q30, 3);
        i32s(c, p->point_m_q30, 3);
        i32s(c, p->hit_m_q30, 3);
    }
}

static void param_list(struct exh_bytes *c, struct exh_wire_param *s)
{
    exh_bytes_u16(c, &s->id);
    exh_bytes_u16(c, &s->instance);
    exh_bytes_i32(c, &s->value);
}

static void trace_list(struct exh_bytes *c, struct exh_wire_trace *s)
{
    exh_bytes_u32(c, &s->request_seq);
    exh_bytes_u32(c, &s->first);
    exh_bytes_i16(c, &s->result);
    exh_bytes_u8(c, &s->frames);
    for (int f = 0; f < s->frames && f < 11; f++) {
        exh_bytes_u32(c, &s->frame[f].tick);
        i32s(c, s->frame[f].raw, 4);
    }
}

void golden_body_list(struct exh_bytes *c, struct exh_wire_packet *p)
{
    switch (p->type) {
    case EXH_WIRE_HELLO:
        exh_bytes_u8(c, &p->u.hello.role);
        exh_bytes_u32(c, &p->u.hello.lib_version);
        exh_bytes_u32(c, &p->u.hello.table_crc);
        for (int i = 0; i < 10; i++) { exh_bytes_i16(c, &p->u.hello.pull_radpm_q7[i / 2][i % 2]); }
        break;
    case EXH_WIRE_STATE: state_list(c, &p->u.state); break;
    case EXH_WIRE_PLANES: planes_list(c, &p->u.planes); break;
    case EXH_WIRE_PARAM: param_list(c, &p->u.param); break;
    case EXH_WIRE_ACK:
        param_list(c, &p->u.ack.param);
        exh_bytes_i16(c, &p->u.ack.result);
        exh_bytes_u32(c, &p->u.ack.request_seq);
        break;
    case EXH_WIRE_TRACE_ASK:
        exh_bytes_u32(c, &p->u.trace_ask.every);
        for (int i = 0; i < 4; i++) { exh_bytes_u16(c, &p->u.trace_ask.index[i]); }
        break;
    case EXH_WIRE_TRACE: trace_list(c, &p->u.trace); break;
    default: break;
    }
}

/* Of TRACE: the longest. */
static uint32_t length_of(int64_t type)
{
    static const uint8_t length[] = {0, 29, 214, 209, 8, 14, 12, 231};
    return type <= 7 ? length[type] : 0;
}

static void any_param(struct golden_rng *r, uint8_t *b)
{
    struct exh_bytes c = exh_bytes_writer(b, 8);
    struct exh_wire_param p;
    p.id =
        exh_signal_at(&golden_signals, (uint32_t)golden_draw(r, 0, GOLDEN_VALUES - 1), &p.instance)
            ->id;
    if (golden_draw(r, 0, 7) == 0) { p.id++; }
    p.value = (int32_t)golden_draw(r, -6, 6);
    param_list(&c, &p);
}

/* A payload that can be. */
void golden_body_any(struct golden_rng *r, int64_t type, uint8_t *b)
{
    const uint32_t n = length_of(type);
    if (type == EXH_WIRE_PARAM) {
        any_param(r, b);
        return;
    }
    for (uint32_t i = 0; i < n; i += 8) {
        const uint64_t u = golden_u64(r);
        for (uint32_t k = 0; k < 8 && i + k < n; k++) { b[i + k] = (uint8_t)(u >> 8 * k); }
    }
    if (type == EXH_WIRE_HELLO) { b[0] &= 1; }
    if (type == EXH_WIRE_STATE) {
        b[4] &= 31;
        b[5] %= 3;
        b[6] &= 31;
        b[7] &= 31;
    }
    if (type == EXH_WIRE_TRACE) {
        b[8] = b[9] = 0;
        b[10] = (uint8_t)golden_draw(r, 0, 11);
        if (b[10] == 0) { b[9] = (uint8_t)golden_draw(r, 128, 255); }
    }
    if (type != EXH_WIRE_PLANES) { return; }
    b[8] &= 31;
    for (int f = 0; f < 5; f++) {
        const uint8_t told = (uint8_t)golden_draw(r, 0, 2);
        b[9 + 40 * f] = b[8] >> f & 1 ? told : 0;
    }
}

static void spoil_planes(struct golden_rng *r, uint8_t *b)
{
    const int64_t how = golden_draw(r, 0, 2);
    const int64_t f = golden_draw(r, 0, 4);
    if (how == 0) { b[8] |= (uint8_t)(32 << golden_draw(r, 0, 2)); }
    if (how == 1) {
        b[8] |= (uint8_t)(INT32_C(1) << f);
        b[9 + 40 * f] = (uint8_t)golden_draw(r, 3, 255);
    }
    if (how == 2) {
        b[8] &= (uint8_t) ~(INT32_C(1) << f);
        b[9 + 40 * f] = (uint8_t)golden_draw(r, 1, 2);
    }
}

/* One value that cannot be. */
void golden_body_spoil(struct golden_rng *r, int64_t type, uint8_t *b)
{
    static const uint8_t mask[] = {4, 6, 7, 5, 5};
    if (type == EXH_WIRE_HELLO) { b[0] = (uint8_t)golden_draw(r, 2, 255); }
    if (type == EXH_WIRE_STATE) {
        const uint8_t i = mask[golden_draw(r, 0, 4)];
        if (i == 5) {
            b[i] = (uint8_t)golden_draw(r, 3, 255);
        } else {
            b[i] |= (uint8_t)(32 << golden_draw(r, 0, 2));
        }
    }
    if (type == EXH_WIRE_PLANES) { spoil_planes(r, b); }
    if (type != EXH_WIRE_TRACE) { return; }
    switch (golden_draw(r, 0, 2)) {
    case 0: b[10] = (uint8_t)golden_draw(r, 12, 255); break; /* more than fit */
    case 1: b[9] = 1; break;                                 /* a positive result */
    default: b[9] = 255, b[10] = (uint8_t)(b[10] | 1);       /* refused, and frames */
    }
}
