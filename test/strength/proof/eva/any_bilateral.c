/* SPDX-License-Identifier: MIT */
/* PROVES: scene bilateral
 * One tick of scene bilateral and its packets, for every number of fingers, damaged numbers and
 * places included. Any state read from bytes, frame, glove, command and trace; any packets, up to
 * as many as fit; any parameters in range. All other library functions keep contract.h and
 * contract_box.h. The tick leaves a state that the next tick accepts.
 *
 * EVA: -eva-slevel 5 -kernel-warn-key annot:missing-spec=abort
 * WITH: examples/glove/cal.c lib/src/sense/glove_cal.c examples/bilateral/finger.c examples/bilateral/gains.c examples/bilateral/frame.c examples/bilateral/cause.c examples/bilateral/wire.c examples/bilateral/trace.c examples/bilateral/tables.c lib/src/talk/trace.c
 * PLANT: examples/bilateral/bilateral.h: return f & (0u - (f < BILATERAL_FINGERS)); -> return f;
 * PLANT: examples/bilateral/bilateral.h: return n > 0 ? n : 1; -> return n;
 * PLANT: examples/bilateral/trace.c: if (t->result > 0) { t->result = 0; } -> (void)0;
 * PLANT: examples/bilateral/trace.c: n < EXH_WIRE_FRAMES ? n : EXH_WIRE_FRAMES); -> n);
 * PLANT: examples/bilateral/wire.c: if (out->packets == EXH_SCENE_PACKETS) { return; } -> (void)0;
 * PLANT: examples/bilateral/wire.c: s->differs &= EXH_WIRE_ROLE | EXH_WIRE_LIB | EXH_WIRE_TABLE; -> (void)0;
 * PLANT: examples/bilateral/bilateral.c: limits[k] = now[k].limits | -> limits[k] |= now[k].limits |
 * PLANT: examples/bilateral/finger.c: if (s->clamped & 1u << 1) { hand.pull_radpm_q20[0] = 0; } -> hand.pull_radpm_q20[0] *= 2;
 */
#define BILATERAL_KEEP_FRAMES 8
#include "bilateral/bilateral.c"

#include "called_box.h"

/* --- pre-contact --- */

int exh_precontact_update(struct exh_precontact *of, const struct exh_precontact_cfg *c,
    const struct exh_plane *p, uint32_t age_ticks)
{
    (void)age_ticks;
    /*@ assert precontact_tell: precontact(of) && precontact_cfg(c) && \initialized(p); */
    *of = any_precontact();
    return REFUSED() ? -EXH_E_RANGE : 0;
}

void exh_precontact_advance(struct exh_precontact *of, uint32_t missed)
{
    (void)missed;
    of->left_ticks = any_u32();
    of->doubt_ticks = any_u32();
}

uint32_t exh_precontact_step(struct exh_precontact *of, const struct exh_precontact_cfg *c,
    const struct exh_precontact_in *in)
{
    /*@ assert precontact_step: precontact(of) && precontact_cfg(c) && \initialized(&in->tip_m_q30) && \initialized(&in->slope_q24); */
    *of = any_precontact();
    return Frama_C_unsigned_int_interval(0, (1u << 11) - 1);
}

void exh_precontact_serialize(struct exh_bytes *c, struct exh_precontact *of)
{
    (void)c;
    *of = any_precontact();
}

/* --- link --- */

int exh_wire_poll(struct exh_wire_rx *rx, uint32_t passed_us, uint32_t limit_us)
{
    (void)passed_us;
    (void)limit_us;
    rx->quiet_us = any_u32();
    rx->open = any8() & 1u;
    rx->silences = any_u32();
    return any8() & 1;
}

int exh_wire_decode(
    struct exh_wire_rx *rx, struct exh_wire_packet *p, const void *buf, size_t len_B)
{
    /*@ assert wire_take: \valid_read((char *)buf + (0 .. len_B - 1)); */
    ANY(*rx);
    rx->open = 0;
    ANY(*p);
    return Frama_C_interval(-64, EXH_WIRE_TRACE);
}

uint32_t exh_wire_compare(const struct exh_wire_hello *ours, const struct exh_wire_hello *theirs)
{
    /*@ assert wire_differs: \valid_read(ours) && \valid_read(theirs); */
    return any8() & (EXH_WIRE_ROLE | EXH_WIRE_LIB | EXH_WIRE_TABLE);
}

struct exh_plane exh_wire_plane_of(const struct exh_wire_planes *planes, unsigned finger)
{
    struct exh_plane p;
    /*@ assert wire_plane_of: \valid_read(planes) && finger < 5; */
    ANY(p);
    return p;
}

struct exh_wire_ack exh_wire_stage(struct exh_params *to, const struct exh_wire_packet *p, int open)
{
    struct exh_wire_ack ack;
    (void)open;
    /*@ assert wire_stage: params(to) && \initialized(&p->u.param); */
    ANY(ack);
    to->pending = any8();
    return ack;
}

int32_t exh_wire_encode(
    struct exh_wire_tx *tx, struct exh_wire_packet *p, uint32_t stamp_us, void *buf, size_t cap_B)
{
    (void)stamp_us;
    /*@ assert wire_write: \valid((char *)buf + (0 .. cap_B - 1)) && cap_B <= 256 && \initialized(p); */
    tx->seq = any_u32();
    Frama_C_make_unknown((char *)buf, cap_B);
    return Frama_C_interval(-64, 256);
}

void exh_wire_tx_serialize(struct exh_bytes *c, struct exh_wire_tx *tx)
{
    (void)c;
    ANY(*tx);
}

void exh_wire_rx_serialize(struct exh_bytes *c, struct exh_wire_rx *rx)
{
    (void)c;
    ANY(*rx);
    rx->open = any8() & 1u;
}

/* --- the scene --- */

/* As set-up leaves it, one finger as another; places and numbers as damaged memory has them. */
static void any_finger_cfg(struct bilateral_finger_cfg *c, unsigned f)
{
    ANY(c->quad);
    ANY(c->velocity);
    ANY(c->track);
    ANY(c->watch);
    ANY(c->chatter);
    ANY(c->polarity);
    ANY(c->precontact);
    /*@ admit chatter_cfg(&c->chatter) && quad_cfg(&c->quad) && velocity_cfg(&c->velocity) && track_cfg(&c->track) && precontact_made(&c->precontact); */
    c->quad.par = &active.quad[f];
    c->watch.par = &active.watch[f];
    c->hand = any_hand();
    c->precontact.par = &active.precontact[f];
    c->precontact.material = active.material;
    c->precontact.materials = BILATERAL_MATERIALS;
    c->sensors = any_u32();
    ANY(c->calib);
}

static void any_drive_cfg(struct exh_drive_cfg *c, unsigned f)
{
    ANY(*c);
    /*@ admit drive_made(c); */
    c->par = &active.drive[f];
    c->force_to_cur.knot = cfg.finger[f].calib.force_to_cur;
    c->force_to_cur.n = (uint8_t)Frama_C_unsigned_int_interval(2, EXH_CALIB_POINTS_MAX + 2);
    c->cur_to_force.knot = cfg.finger[f].calib.cur_to_force;
    c->cur_to_force.n = (uint8_t)Frama_C_unsigned_int_interval(2, 2 * EXH_CALIB_POINTS_MAX + 3);
}

static void any_cfg(void)
{
    ANY(cfg.wire);
    ANY(cfg.supply);
    ANY(cfg.safety);
    ANY(cfg.at);
    ANY(cfg.part);
    cfg.parts = any8();
    cfg.sensors = any_u32();
    /*@ admit safety_cfg(&cfg.safety); */
    cfg.par = &active;
    ANY(cfg.glove);
    cfg.glove.cal = &cfg.cal;
    /*@ admit glove_cfg(&cfg.glove); */
    cfg.glove_ticks = any_u32();
    cfg.link_ticks = any_u32();
    cfg.rest_ticks = any_u32();
    cfg.tested = any8() & 1;
    cfg.vouches = any8();
    ANY(cfg.gains);
    /*@ admit rule(&cfg.gains); */
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        struct exh_drive_par *const drive = &active.drive[f];
        struct exh_motion_par *const watch = &active.watch[f];
        struct exh_contact_par *const contact = &active.contact[f];
        struct exh_precontact_par *const precontact = &active.precontact[f];
        /*@ admit taken: drive_par(drive) && watch_par(watch) && contact_par(contact) && precontact_par(precontact); */
        any_finger_cfg(&cfg.finger[f], f);
        any_drive_cfg(&cfg.drive[f], f);
    }
    for (unsigned m = 0; m < BILATERAL_MATERIALS; m++) {
        struct exh_material_par *const material = &active.material[m];
        /*@ admit taken_material: material(material); */
    }
}

static void kept(void)
{
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        const struct bilateral_finger *const now = &state.finger[f];
        /*@ assert next_finger: velocity(&now->velocity) && contact(&now->contact) && drive(&now->drive) && chatter(&now->chatter) &&
              precontact(&now->precontact); */
    }
    /*@ assert next: safety(&state.safety) && state.wire.trace.result <= 0 && state.wire.trace.answer <= 1 &&
          state.frame.left <= 7; */
}

static void one_tick(uint8_t least, uint8_t most, uint8_t packets)
{
    static struct exh_scene_in in;
    static struct exh_drive_out out;
    static struct exh_bytes c;
    exh_scene_bilateral.defaults();
    any_cfg();
    cfg.n = (uint8_t)Frama_C_unsigned_int_interval(least, most);
    exh_scene_bilateral.state(&c);
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        state.finger[f].keep_frames = any8();
        state.finger[f].how = any8();
    }
    exh_integrity_seal(&guard, &cfg, sizeof cfg, &params);
    ANY(in);
    ANY(signals);
    ANY(mail_in);
    mail_in.packets = packets;
    for (unsigned i = 0; i < EXH_SCENE_PACKETS; i++) {
        mail_in.len_B[i] = (uint16_t)Frama_C_unsigned_int_interval(1, EXH_SCENE_PACKET_B);
    }
    exh_scene_bilateral.tick(&in, &out);
    exh_scene_bilateral.link->write();
    (void)exh_scene_signals(&exh_scene_bilateral);
    kept();
    END();
}

int main(void)
{
    for (uint8_t n = 0; n <= BILATERAL_FINGERS; n++) { one_tick(n, n, 0); }
    one_tick(BILATERAL_FINGERS + 1, UINT8_MAX, 0);
    one_tick(BILATERAL_FINGERS, BILATERAL_FINGERS, 1);
    one_tick(BILATERAL_FINGERS, BILATERAL_FINGERS, EXH_SCENE_PACKETS);
    return 0;
}
