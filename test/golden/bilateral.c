/* SPDX-License-Identifier: MIT */
/* The scene bilateral: one tick from codes and packets to D/A codes and packets. */
#include "modules.h"

#include "bilateral/bilateral.h"

#include "exhand/board.h"
#include "exhand/fix.h"

#define HEALTHY 0x1F0Fu
#define FINGERS BILATERAL_FINGERS
#define VERSION \
    0x00010203u /* of the library, and of the parameters: not these, which may change \
                 */
#define TABLE   0x89ABCDEFu
#define LATE    4 /* packets held back to the next tick */
#define SIGNALS (int64_t)(sizeof(struct bilateral_signals) / sizeof(int32_t))

struct datagram {
    uint8_t b[EXH_SCENE_PACKET_B];
    uint16_t len;
};

/* The plane before a finger. */
struct object {
    struct exh_wire_plane plane;
    int there;
};

static struct rig {
    struct bilateral_par par, staged;
    struct bilateral_cfg cfg;
    struct bilateral s;
    struct bilateral_signals sig;
    struct exh_params params;
    struct exh_scene_in in;
    struct exh_scene_mail mail_in, mail_out;
    uint32_t raw[FINGERS], wrong;
    struct golden_rail rail;
    unsigned astray[FINGERS]; /* monitors */
    /* the world's end */
    struct exh_wire_tx tx;
    struct exh_wire_trace_request trace;
    struct object object[FINGERS];
    struct datagram late[LATE];
    unsigned lates;
    int begun;
} rig;

static int32_t any_size(struct golden_rng *r, int32_t most)
{
    const int64_t any = golden_draw(r, 0, most);
    return (int32_t)(any >> golden_draw(r, 0, 12));
}

static uint32_t any_u32(struct golden_rng *r) { return (uint32_t)(golden_u64(r) & UINT32_MAX); }

/* The scene refers to a board. It is not used here. */
uint32_t exh_board_cycles(void) { return 0; }

int exh_board_read_glove(struct exh_glove_in *in)
{
    (void)in;
    return 0;
}

int exh_board_link_recv(void *buf, size_t cap_B)
{
    (void)buf;
    (void)cap_B;
    return 0;
}

int exh_board_link_send(const void *buf, size_t len_B)
{
    (void)buf;
    (void)len_B;
    return 0;
}

/* --- set-up --- */

/* So many ticks in ms, 1 .. 60000. */
static int32_t any_ms(struct golden_rng *r, int64_t lo, int64_t hi, uint32_t rate_Hz)
{
    const int64_t ms = golden_draw(r, lo, hi) * 1000 / rate_Hz;
    return (int32_t)exh_clamp(ms, 1, 60000);
}

static void any_finger(unsigned f, struct golden_rng *r, uint32_t rate_Hz)
{
    struct bilateral_par *p = &rig.par;
    p->quad[f].step_m_q42 = golden_step(r);
    p->quad[f].speed_max_mps_q27 = (int32_t)golden_draw(r, 13421773, INT32_MAX);
    p->velocity[f].p = (int32_t)golden_draw(r, 0, 4);
    p->contact[f].f0_N_q20 = any_size(r, 20971520);
    p->contact[f].f0_band_m_q30 = any_size(r, 10737418);
    p->contact[f].hyst_m_q30 = any_size(r, 10737418);
    golden_drive_par(&p->drive[f], r, rate_Hz);
    golden_track_par(&p->track[f], r, rate_Hz);
    golden_watch_par(&p->watch[f], r, rate_Hz);
    p->kf_NpA_q20[f] = (int32_t)golden_draw(r, 104858, 104857600);
    golden_chatter_par(&p->chatter[f], r);
    p->hand[f].arm1_m_q30 = (int32_t)golden_draw(r, 4294968, 53687091);
    p->hand[f].arm2_m_q30 = (int32_t)golden_draw(r, 0, 53687091);
    p->hand[f].arm3_m_q30 = (int32_t)golden_draw(r, 0, 53687091);
    p->hand[f].pad_m_q30 = (int32_t)golden_draw(r, 0, 26843545);
    p->precontact[f].from_slope = (int32_t)golden_draw(r, 0, 1);
    p->precontact[f].printed_sign = (int32_t)golden_draw(r, 0, 1);
    p->precontact[f].d_lim_m_q30 = (int32_t)-golden_draw(r, INT32_C(1) << 22, INT32_C(1) << 25);
    p->precontact[f].hyst_m_q30 = (int32_t)golden_draw(r, 0, INT32_C(1) << 22);
    p->precontact[f].scale_q24 = (int32_t)golden_draw(r, INT32_C(1) << 21, INT32_C(1) << 27);
    p->precontact[f].age_max_ms = any_ms(r, 20, 120, rate_Hz);
    p->precontact[f].doubt_m_q30 = (int32_t)golden_draw(r, 0, INT32_C(1) << 23);
    p->precontact[f].doubt_ms = any_ms(r, 1, 20, rate_Hz);
    p->precontact[f].tip_age_max_ms = any_ms(r, 1, 12, rate_Hz);
    p->precontact[f].late_slew_Nps = (int32_t)golden_draw(r, 1, 100000);
}

static int any_crossed(unsigned i) { return i == 3 || i == 10 || i == 14 || i == 18; }

static void any_sensor(struct glove_sensor_par *s, unsigned i, struct golden_rng *r)
{
    s->low_raw = (int32_t)golden_draw(r, -24000, -8000);
    s->high_raw = (int32_t)golden_draw(r, 8000, 24000);
    s->zero_raw_q15 = (int32_t)golden_draw(r, -(INT32_C(8000) << 15), INT32_C(8000) << 15);
    s->gain_turnpraw_q38 = (int32_t)golden_draw(r, 1500000, 4000000);
    if (golden_draw(r, 0, 7) == 0) { s->gain_turnpraw_q38 = -s->gain_turnpraw_q38; }
    for (unsigned n = 0; n < 2; n++) {
        const int crossed = any_crossed(i);
        s->of[n] = !crossed ? EXH_GLOVE_NONE : (int32_t)(n == 0 ? i - 1 : i + 1);
        s->cross_q30[n] =
            crossed ? (int32_t)golden_draw(r, -(INT32_C(1) << 28), INT32_C(1) << 28) : 0;
    }
}

static void any_par(struct golden_rng *r, uint32_t rate_Hz, uint32_t k)
{
    struct bilateral_par *p = &rig.par;
    struct exh_period T = golden_period(rate_Hz, k);
    p->own.fingers = (int32_t)golden_draw(r, 1, 31);
    p->own.state_every = (int32_t)golden_draw(r, 1, 12);
    p->own.session = (int32_t)golden_draw(r, 1, INT32_MAX);
    p->own.quiet_ms = (int32_t)golden_draw(r, 100, 2000);
    p->own.f0_rest_ms = any_ms(r, 1, 12, rate_Hz);
    p->own.glove_ms = golden_draw(r, 0, 15) ? any_ms(r, 4, 10, rate_Hz) : 0;
    p->own.link_ms = golden_draw(r, 0, 15) ? any_ms(r, 10, 14, rate_Hz) : 0;
    p->calib.uncalibrated = 1;
    /* Below 0.25 Hz, no legal cutoff is left. */
    p->glove_own.every = (int32_t)golden_draw(r, 1, T.num < T.den ? 8 : 4);
    p->glove_own.present = (INT32_C(1) << EXH_GLOVE_SENSORS) - 1;
    for (unsigned f = 0; f < FINGERS; f++) { any_finger(f, r, rate_Hz); }
    for (unsigned i = 0; i < BILATERAL_MATERIALS; i++) {
        p->material[i].k_Npm_q10 = any_size(r, 1024000000);
        p->material[i].b_Nspm_q20 = any_size(r, 1048576000);
        p->material[i].f_max_N_q20 = any_size(r, 104857600);
    }
    golden_safety_par(&p->safety, r, rate_Hz);
    if (golden_draw(r, 0, 3)) { p->safety.arm_force_N_q20 = 10485760; } /* most arm */
    golden_supply_par(&p->supply, &rig.rail, r, rate_Hz, 31);
    T.num *= (uint32_t)p->glove_own.every;
    p->glove = golden_glove_par(r, T);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { any_sensor(&p->sensor[i], i, r); }
}

static void set_up(struct golden_rng *r, uint32_t rate_Hz, uint32_t k)
{
    struct exh_scene_board board = {golden_period(rate_Hz, k), 16};
    int err;
    (void)memset(&rig, 0, sizeof rig);
    exh_params_setup(&rig.params, &bilateral_params, (int32_t *)&rig.par, (int32_t *)&rig.staged);
    any_par(r, rate_Hz, k);
    rig.staged = rig.par;
    while ((err = bilateral_setup(&rig.cfg, &rig.s, &rig.par, board, NULL)) != 0 &&
           board.enc_bits < 32) {
        board.enc_bits = (uint8_t)(board.enc_bits + 4);
    }
    CHECK_EQ_I64(err, 0);
    rig.cfg.wire.hello = (struct exh_wire_hello){
        .role = EXH_WIRE_CONTROLLER, .lib_version = VERSION, .table_crc = TABLE};
    rig.params.locked = 1;
    rig.in.drive.din = HEALTHY;
    rig.tx.session = any_u32(r) | 1;
    rig.tx.seq = (uint32_t)golden_draw(r, -40, 40);
    for (unsigned f = 0; f < FINGERS; f++) { rig.raw[f] = any_u32(r); }
}

/* --- the world --- */

/* Twice a run no planes come, and no sensor is believed. */
static int away(uint32_t k) { return k % 128 >= 104 && k % 128 < 124; }

/* So seldom that a trace comes to wait for a packet's worth of frames, and no longer. */
static int asks(uint32_t k) { return k % 128 < 24; }

static void arrive(const struct datagram *d)
{
    struct exh_scene_mail *m = &rig.mail_in;
    if (m->packets == EXH_SCENE_PACKETS) { return; }
    (void)memcpy(m->byte[m->packets], d->b, d->len);
    m->len_B[m->packets++] = d->len;
}

/* Lost, twice, damaged, late, or as it should. */
static void send(struct exh_wire_packet *p, struct golden_rng *r)
{
    const uint32_t stamp_us = any_u32(r);
    const int64_t how = golden_draw(r, 0, 23);
    struct datagram d;
    d.len = (uint16_t)exh_wire_encode(&rig.tx, p, stamp_us, d.b, sizeof d.b);
    if (how == 2) {
        const int64_t bit = golden_draw(r, 0, 8 * d.len - 1);
        d.b[bit >> 3] ^= (uint8_t)(INT32_C(1) << (bit & 7));
    }
    if (how == 3 && rig.lates < LATE) {
        rig.late[rig.lates++] = d;
    } else if (how != 0) {
        arrive(&d);
    }
    if (how == 1) { arrive(&d); }
}

/* So far from where the fingertip is now. */
static void put_before(struct object *o, unsigned f, int64_t way)
{
    const struct exh_vec3 *at = &rig.s.finger[f].tip_m_q30;
    const int32_t tip[3] = {at->x, at->y, at->z};
    for (int i = 0; i < 3; i++) {
        o->plane.point_m_q30[i] = exh_sat32(tip[i] - (o->plane.normal_q30[i] * way >> 30));
    }
}

static void any_object(struct object *o, unsigned f, struct golden_rng *r)
{
    const struct golden_turn t = golden_any_turn(r);
    const struct golden_turn u = golden_any_turn(r);
    const int64_t n[3] = {t.c * u.c, t.s * u.c, u.s * t.d};
    o->there = 1;
    o->plane.kind = EXH_PLANE_HIT;
    o->plane.object = (uint16_t)golden_draw(r, 0, 65535);
    o->plane.material = (uint8_t)golden_draw(r, 0, BILATERAL_MATERIALS);
    for (int i = 0; i < 3; i++) { o->plane.normal_q30[i] = golden_q30(n[i], t.d * u.d); }
    put_before(o, f, golden_draw(r, 0, INT32_C(1) << 26));
}

static struct exh_wire_plane any_plane(unsigned f, struct golden_rng *r)
{
    static const struct exh_wire_plane none = {.kind = EXH_PLANE_NONE};
    const int64_t how = golden_draw(r, 0, 63);
    struct object *o = &rig.object[f];
    struct exh_wire_plane p;
    int64_t i;
    if (how < 2 || !o->there) { any_object(o, f, r); }
    if (how >= 9 && how < 18) { put_before(o, f, golden_draw(r, 0, INT32_C(1) << 26)); }
    p = o->plane;
    if (how == 4) { p = none; }
    if (how == 5 || how == 6) {
        i = golden_draw(r, 0, 2);
        p.normal_q30[i] += (int32_t)golden_draw(r, -24576, 24576);
    }
    if (how == 7) { p.object ^= 1; }
    if (how == 8) {
        i = golden_draw(r, 0, 2);
        p.point_m_q30[i] += (int32_t)golden_draw(r, -(INT32_C(1) << 22), INT32_C(1) << 22);
    }
    for (i = 0; i < 3; i++) { p.hit_m_q30[i] = p.point_m_q30[i]; }
    return p;
}

static void send_planes(struct golden_rng *r, uint32_t rate_Hz)
{
    struct exh_wire_packet p = {.type = EXH_WIRE_PLANES};
    const uint32_t now_us = (uint32_t)(rig.s.wire.now_us_q20 >> 20);
    const int64_t ago_us = golden_draw(r, 0, 40) * 1000000 / rate_Hz;
    p.u.planes.echo_seq = any_u32(r);
    p.u.planes.echo_stamp_us = now_us - (uint32_t)ago_us;
    p.u.planes.fingers = 31;
    if (golden_draw(r, 0, 3) == 0) { p.u.planes.fingers = (uint8_t)golden_draw(r, 0, 31); }
    for (unsigned f = 0; f < FINGERS; f++) {
        if (p.u.planes.fingers >> f & 1) { p.u.planes.plane[f] = any_plane(f, r); }
    }
    send(&p, r);
}

/* id, instances, range of valid values, and an invalid one. */
static const struct {
    uint16_t id, n;
    int32_t lo, hi, bad;
} ask[] = {
    {0x0B01, BILATERAL_MATERIALS, 0, 1024000000, 1024000001},
    {0x0B02, BILATERAL_MATERIALS, 0, 1048576000, -1},
    {0x0B03, BILATERAL_MATERIALS, 0, 104857600, 104857601},
    {0x0C01, FINGERS, -(INT32_C(1) << 25), -(INT32_C(1) << 22), 0},
    {0x0C02, FINGERS, 0, INT32_C(1) << 22, -1},
    {0x0C03, FINGERS, INT32_C(1) << 21, INT32_C(1) << 27, (INT32_C(1) << 27) + 1},
    {0x0C04, FINGERS, 0, 1, 2},
    {0x8611, 1, 1, 12, 10001},
    {0x8612, 1, 1, 1000, -1},
    {0x0401, FINGERS, 0, 1000, -1},
    {0x0501, FINGERS, 0, 1000, -1},
    {0x7FFF, 1, 0, 1, 2},
};

static void send_param(struct golden_rng *r)
{
    struct exh_wire_packet p = {.type = EXH_WIRE_PARAM};
    const int64_t i = golden_draw(r, 0, (int64_t)(sizeof ask / sizeof ask[0]) - 1);
    p.u.param.id = ask[i].id;
    p.u.param.instance = (uint16_t)golden_draw(r, 0, ask[i].n);
    p.u.param.value = (int32_t)golden_draw(r, ask[i].lo, ask[i].hi);
    if (golden_draw(r, 0, 7) == 0) { p.u.param.value = ask[i].bad; }
    send(&p, r);
}

/* Now and then the same as before, or what is none of the signals. */
static void send_trace_ask(struct golden_rng *r)
{
    struct exh_wire_packet p = {.type = EXH_WIRE_TRACE_ASK};
    if (golden_draw(r, 0, 2) != 0) {
        const int64_t every = golden_draw(r, 0, 24);
        rig.trace.every = (uint32_t)(every >> golden_draw(r, 0, 4));
        for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) {
            rig.trace.index[i] = (uint16_t)golden_draw(r, 0, SIGNALS - 1);
        }
        if (golden_draw(r, 0, 7) == 0) {
            const int64_t i = golden_draw(r, 0, EXH_TRACE_SIGNALS - 1);
            const int64_t beyond = golden_draw(r, 0, UINT16_MAX - SIGNALS);
            rig.trace.index[i] = (uint16_t)(SIGNALS + (beyond >> golden_draw(r, 0, 16)));
        }
    }
    p.u.trace_ask = rig.trace;
    send(&p, r);
}

static void any_mail(struct golden_rng *r, uint32_t rate_Hz, uint32_t k)
{
    const unsigned lates = rig.lates;
    rig.mail_in.packets = 0;
    if (golden_draw(r, 0, 127) == 0) {
        rig.tx.session = any_u32(r) | 1;
        rig.begun = 0;
    }
    if (!rig.begun && golden_draw(r, 0, 1) != 0) {
        struct exh_wire_packet p = {.type = EXH_WIRE_HELLO};
        p.u.hello.role = (uint8_t)golden_draw(r, 0, 1);
        p.u.hello.lib_version = VERSION + (uint32_t)golden_draw(r, 0, 1);
        p.u.hello.table_crc = TABLE * (uint32_t)golden_draw(r, 0, 2);
        rig.begun = 1;
        send(&p, r);
    }
    if (golden_draw(r, 0, 1) != 0 && !away(k)) { send_planes(r, rate_Hz); }
    if (golden_draw(r, 0, 7) == 0) { send_param(r); }
    if (asks(k) && golden_draw(r, 0, 3) == 0) { send_trace_ask(r); }
    for (unsigned i = 0; i < lates; i++) { arrive(&rig.late[i]); }
    for (unsigned i = lates; i < rig.lates; i++) { rig.late[i - lates] = rig.late[i]; }
    rig.lates -= lates;
}

/* --- a tick --- */

static void any_frame(struct golden_rng *r, const struct golden_wave *w, uint32_t k)
{
    struct exh_glove_in *g = &rig.in.glove;
    rig.in.glove_new = 0;
    if (g->age_ticks < UINT16_MAX) { g->age_ticks++; }
    if (golden_draw(r, 0, 47) == 0) {
        rig.wrong ^= UINT32_C(1) << golden_draw(r, 0, 21);
    } else if (golden_draw(r, 0, 7) == 0) {
        rig.wrong = 0;
    }
    if (away(k)) { rig.wrong = (UINT32_C(1) << EXH_GLOVE_SENSORS) - 1; }
    /* Now and then one is missing, or early. */
    if ((k % (uint32_t)rig.par.glove_own.every != 0) != (golden_draw(r, 0, 31) == 0)) { return; }
    rig.in.glove_new = 1;
    g->age_ticks = 0;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct glove_sensor_par *s = &rig.par.sensor[i];
        const int32_t share = w[i & 3].at[k] + 32768;
        const int32_t good =
            s->low_raw + (int32_t)((int64_t)share * (s->high_raw - s->low_raw) >> 16);
        g->raw[i] = (int16_t)(rig.wrong >> i & 1 ? (i & 1 ? -32768 : 32767) : good);
    }
}

static void any_in(struct golden_rng *r, struct golden_wave moves[FINGERS], uint32_t k)
{
    struct exh_scene_in *in = &rig.in;
    for (unsigned f = 0; f < FINGERS; f++) {
        const int32_t jump = rig.cfg.finger[f].quad.jump_cnt;
        rig.raw[f] += (uint32_t)(k >= 8 && k < 56 ? moves[f].at[k] >> 3 : moves[f].at[k]);
        if (k >= 184 && k < GOLDEN_AGAIN) {
            rig.raw[f] += (uint32_t)golden_draw(r, -2 * (int64_t)jump, 2 * (int64_t)jump);
        }
        in->drive.enc_raw[f] = rig.raw[f];
        in->drive.mon_raw[f] =
            golden_monitor(&rig.astray[f], &rig.par.drive[f], r, rig.sig.paper[f].i_des_A_q26);
    }
    if (golden_draw(r, 0, 127) == 0) {
        in->drive.din ^= UINT32_C(1) << golden_draw(r, 0, 12);
    } else if (golden_draw(r, 0, 3) == 0) {
        in->drive.din = HEALTHY;
    }
    if (rig.s.safety.state == EXH_STATE_FAULT && golden_draw(r, 0, 1) == 0) { in->drive.din ^= 2; }
    in->drive.supply_raw = golden_rail(&rig.rail, r, k);
    in->missed = golden_draw(r, 0, 127) == 0 ? 1 : 0;
    in->command = k % 4 == 2 || k % GOLDEN_AGAIN == 0 ? EXH_CMD_RUN
                  : k % 4 == 1                        ? EXH_CMD_CLEAR
                                                      : EXH_CMD_NONE;
}

static uint32_t signals_crc(void)
{
    static uint8_t b[sizeof(struct bilateral_signals)];
    int32_t *v = (int32_t *)&rig.sig;
    struct exh_bytes c = exh_bytes_writer(b, sizeof b);
    for (size_t i = 0; i < sizeof rig.sig / sizeof *v; i++) { exh_bytes_i32(&c, &v[i]); }
    return exh_crc32(0, b, c.at);
}

static uint32_t out_crc(struct exh_drive_out *out)
{
    uint8_t b[32];
    struct exh_bytes c = exh_bytes_writer(b, sizeof b);
    for (unsigned f = 0; f < FINGERS; f++) { exh_bytes_u16(&c, &out->dac_raw[f]); }
    exh_bytes_u8(&c, &out->enable);
    exh_bytes_u8(&c, &out->alive);
    return exh_crc32(0, b, c.at);
}

static uint32_t mail_crc(const struct exh_scene_mail *m)
{
    uint32_t crc = 0;
    for (unsigned i = 0; i < m->packets; i++) { crc = exh_crc32(crc, m->byte[i], m->len_B[i]); }
    return crc;
}

static void put_in(struct golden *g)
{
    golden_put(g, rig.mail_in.packets);
    golden_put(g, mail_crc(&rig.mail_in));
    golden_put(g, rig.in.glove_new);
    golden_put(g, rig.in.drive.din);
    golden_put(g, rig.in.missed);
    golden_put(g, rig.in.command);
}

static void put_out(struct golden *g, struct exh_drive_out *out)
{
    const struct bilateral_box *b = &rig.sig.box;
    for (unsigned f = 0; f < FINGERS; f++) {
        golden_put(g, rig.sig.more[f].bits);
        golden_put(g, rig.sig.paper[f].d_m_q30);
        golden_put(g, rig.sig.paper[f].q_lim_m_q30);
        golden_put(g, rig.sig.paper[f].f_des_N_q20);
    }
    golden_put(g, b->state);
    golden_put(g, b->faults);
    golden_put(g, b->glove_faults);
    golden_put(g, b->age);
    golden_put(g, b->set);
    golden_put(g, b->accepted);
    golden_put(g, signals_crc());
    golden_put(g, out_crc(out));
    golden_put(g, rig.mail_out.packets);
    golden_put(g, mail_crc(&rig.mail_out));
}

void golden_bilateral(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave moves[FINGERS], codes[4];
    struct golden_rng r = golden_rng("bilateral", rate_Hz, 0);
    for (uint32_t i = 0; i < 4; i++) {
        golden_wave(&codes[i], "bilateral", rate_Hz, 20 + i, -32768, 32767,
            INT32_C(1) << golden_draw(&r, 4, 9));
    }
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t k = g->tick;
        struct exh_drive_out out;
        if (k == 0 || k == GOLDEN_AGAIN) {
            set_up(&r, rate_Hz, k);
            for (uint32_t f = 0; f < FINGERS; f++) {
                const int32_t jump = rig.cfg.finger[f].quad.jump_cnt;
                golden_wave(&moves[f], "bilateral", rate_Hz, 1 + f + (k > 0 ? 8 : 0), -jump, jump,
                    jump < 1024 ? 1 : jump >> 10);
            }
        }
        any_mail(&r, rate_Hz, k);
        any_frame(&r, codes, k);
        any_in(&r, moves, k);
        bilateral_tick(&rig.s, &rig.cfg, &rig.in, &rig.mail_in, &rig.params, &out, &rig.sig);
        bilateral_write(&rig.s, &rig.cfg, &rig.sig, &rig.mail_out);
        bilateral_tell(&rig.s, &rig.cfg, &rig.sig);
        if (k % 8 == 7) { (void)exh_params_apply(&rig.params); }
        put_in(g);
        put_out(g, &out);
        GOLDEN_STATE(g, bilateral_bytes, &rig.s);
        golden_tick(g);
    }
}
