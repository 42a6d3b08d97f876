/* SPDX-License-Identifier: MIT */
/* The full box a tick at a time, with packets and glove frames made here: the contact while the
 * finger's place is unknown, and the packets sent. */
#include "check.h"

#include "bilateral/bilateral.h"

#include "exhand/error.h"

#include <string.h>

#define F        EXH_INDEX
#define RATE_HZ  1000
#define STAMP_US 1000u /* a tick */

static struct bilateral_par par;
static struct bilateral_cfg cfg;
static struct bilateral box;
static struct exh_scene_mail in, out;
static struct exh_scene_in from_board;
static struct exh_drive_out drive;
static struct bilateral_signals sig;
static struct exh_wire_tx world;
static uint32_t tick_n;

static void start(void)
{
    static const struct bilateral off;
    exh_scene_bilateral.defaults();
    memcpy(&par, exh_scene_bilateral.params->active, sizeof par);
    par.calib.uncalibrated = 1;
    par.own.session = 7;
    box = off;
    memset(&from_board, 0, sizeof from_board);
    memset(&in, 0, sizeof in);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        from_board.glove.raw[i] = (int16_t)(exh_glove_cal_default.sensor[i].zero_raw_q15 >> 15);
    }
    world = (struct exh_wire_tx){3, 0};
    tick_n = 0;
    CHECK_EQ_I64(
        bilateral_setup(&cfg, &box, &par, (struct exh_scene_board){{1, RATE_HZ}, 16}, NULL), 0);
}

static void post(struct exh_wire_packet *p)
{
    const int32_t n = exh_wire_encode(&world, p, 0, in.byte[in.packets], EXH_SCENE_PACKET_B);
    CHECK(n > 0, "%d", (int)n);
    in.len_B[in.packets++] = (uint16_t)n;
}

static void hello(void)
{
    struct exh_wire_packet p = {.type = EXH_WIRE_HELLO};
    p.u.hello = (struct exh_wire_hello){
        .role = EXH_WIRE_WORLD, .lib_version = EXH_VERSION_NUMBER, .table_crc = 0};
    post(&p);
}

/* A plane 50 mm before the fingertip, across x. */
static void planes(void)
{
    struct exh_wire_packet p = {.type = EXH_WIRE_PLANES};
    struct exh_wire_plane *w = &p.u.planes.plane[F];
    p.u.planes.echo_stamp_us = tick_n * STAMP_US;
    p.u.planes.fingers = 1u << F;
    w->kind = EXH_PLANE_HIT;
    w->normal_q30[0] = 1 << 30;
    w->point_m_q30[0] =
        box.finger[F].tip_m_q30.x - par.hand[F].pad_m_q30 - EXH_Q(5, 100, EXH_Q_POS);
    post(&p);
}

/* Runs a tick. Returns the number of packets of a kind that it sends. */
static int tick(int glove_new, int type)
{
    const int codes = tick_n ? drive.dac_raw[F] - par.drive[F].dac_zero_raw : 0;
    int n = 0;
    from_board.drive.mon_raw[F] = (int16_t)(codes * 105 / 100); /* the current follows */
    from_board.glove_new = (uint8_t)glove_new;
    bilateral_tick(&box, &cfg, &from_board, &in, exh_scene_bilateral.params, &drive, &sig);
    bilateral_write(&box, &cfg, &sig, &out);
    bilateral_tell(&box, &cfg, &sig);
    in.packets = 0;
    tick_n++;
    for (unsigned i = 0; i < out.packets; i++) { n += out.byte[i][3] == type; }
    return n;
}

static int phase(void) { return box.finger[F].precontact.phase; }

/* The cards see a drive that is off by how far its code is from 0 A. */
TEST(no_current_is_each_fingers_own_code)
{
    for (uint32_t mask = 1; mask < 1u << EXH_FINGERS; mask++) {
        start();
        par.own.fingers = (int32_t)mask;
        for (unsigned f = 0; f < EXH_FINGERS; f++) { par.drive[f].dac_zero_raw = (int)f * 9000; }
        CHECK_EQ_I64(
            bilateral_setup(&cfg, &box, &par, (struct exh_scene_board){{1, RATE_HZ}, 16}, NULL), 0);
        (void)tick(0, 0);
        for (unsigned f = 0; f < EXH_FINGERS; f++) {
            CHECK(drive.dac_raw[f] == f * 9000, "fingers %u, finger %u: %u", (unsigned)mask, f,
                drive.dac_raw[f]);
        }
    }
}

TEST(a_plane_told_before_the_first_glove_frame_is_not_kept)
{
    start();
    hello();
    planes();
    for (int k = 0; k < 60000; k++) { (void)tick(0, 0); } /* a minute without a glove */
    (void)tick(1, 0);
    CHECK_EQ_I64(phase(), EXH_PRECONTACT_IDLE);
    CHECK_EQ_I64(sig.paper[F].q_lim_m_q30, EXH_PRECONTACT_NO_LIM);
    planes();
    (void)tick(1, 0);
    CHECK_EQ_I64(phase(), EXH_PRECONTACT_TRACK);
}

TEST(a_finger_whose_sensor_is_not_believed_has_no_contact)
{
    static const struct {
        int sensor, blind;
    } at[] = {{EXH_GLOVE_INDEX_MPJ, 1}, {EXH_GLOVE_LITTLE_MPJ, 0}};
    for (size_t i = 0; i < sizeof at / sizeof at[0]; i++) {
        int16_t *raw = &from_board.glove.raw[at[i].sensor];
        int16_t good;
        start();
        good = *raw;
        hello();
        (void)tick(1, 0);
        planes();
        (void)tick(1, 0);
        CHECK_EQ_I64(box.glove_faults, 0);
        CHECK_EQ_I64(phase(), EXH_PRECONTACT_TRACK);
        *raw = INT16_MAX;
        for (int k = 0; k < 20; k++) {
            planes();
            (void)tick(1, 0);
        }
        CHECK_EQ_I64(box.glove_faults, INT64_C(1) << at[i].sensor);
        CHECK_EQ_I64(phase(), at[i].blind ? EXH_PRECONTACT_IDLE : EXH_PRECONTACT_TRACK);
        CHECK_EQ_I64(sig.paper[F].q_lim_m_q30 == EXH_PRECONTACT_NO_LIM, at[i].blind);
        *raw = good;
        for (int k = 0; k < 300; k++) { (void)tick(1, 0); }
        CHECK_EQ_I64(box.glove_faults, 0);
        planes();
        (void)tick(1, 0);
        CHECK_EQ_I64(phase(), EXH_PRECONTACT_TRACK);
    }
}

TEST(a_frozen_contact_outlives_a_sensor)
{
    int32_t lim;
    start();
    hello();
    (void)tick(1, 0);
    planes();
    (void)tick(1, 0);
    par.precontact[F].d_lim_m_q30 = -EXH_Q(6, 100, EXH_Q_POS); /* nearer than that it is */
    (void)tick(1, 0);
    CHECK_EQ_I64(phase(), EXH_PRECONTACT_FROZEN);
    lim = sig.paper[F].q_lim_m_q30;
    from_board.glove.raw[EXH_GLOVE_INDEX_MPJ] = INT16_MAX;
    for (int k = 0; k < 20; k++) { (void)tick(1, 0); }
    CHECK_EQ_I64(phase(), EXH_PRECONTACT_FROZEN);
    CHECK_EQ_I64(sig.paper[F].q_lim_m_q30, lim);
    for (int k = 0; k < par.precontact[F].doubt_ms; k++) { (void)tick(1, 0); }
    CHECK(phase() == EXH_PRECONTACT_IDLE && sig.more[F].let_go == 1, "but not for ever");
}

/* The index frozen before its wall, and then so much string out that the law touches. */
static void press(int32_t by_m_q30)
{
    start();
    par.contact[F].k_Npm_q10 = 0; /* it is the material's */
    hello();
    from_board.drive.din = UINT32_MAX;
    from_board.command = EXH_CMD_RUN;
    (void)tick(1, 0);
    planes();
    (void)tick(1, 0);
    par.precontact[F].d_lim_m_q30 = -EXH_Q(6, 100, EXH_Q_POS);
    (void)tick(1, 0);
    CHECK_EQ_I64(phase(), EXH_PRECONTACT_FROZEN);
    for (int64_t out_m_q30 = 0; out_m_q30 < sig.paper[F].q_lim_m_q30 + (int64_t)by_m_q30;) {
        from_board.drive.enc_raw[F]++;
        out_m_q30 += exh_quad_pos_m_q30(&par.quad[F], 1);
        planes();
        (void)tick(1, 0);
    }
    CHECK(sig.paper[F].c && sig.paper[F].f_des_N_q20 > EXH_Q(1, 1, EXH_Q_FORCE), "%d LSB of force",
        sig.paper[F].f_des_N_q20);
}

/* The string's zero has slipped, or the hand has let go of the glove. The string pulls for any
 * movement of the finger, until the glove has shown for long enough that there is no contact. */
TEST(a_wall_that_the_glove_denies_does_not_pull_for_ever)
{
    int n = 0;
    int32_t before;
    press(EXH_Q(1, 1000, EXH_Q_POS));
    (void)tick(1, 0);
    CHECK(!(sig.more[F].bits & EXH_PRECONTACT_DOUBT), "within the margin");
    par.precontact[F].d_lim_m_q30 = -EXH_Q(1, 100, EXH_Q_POS); /* now 50 mm are outside */
    before = sig.paper[F].f_des_N_q20;
    while (sig.paper[F].f_des_N_q20 > EXH_Q(1, 10, EXH_Q_FORCE) && n < 1000) {
        const int64_t most = (int64_t)par.drive[F].slew_down_Nps * (1 << 20) / RATE_HZ;
        planes();
        (void)tick(1, 0);
        CHECK(before - sig.paper[F].f_des_N_q20 <= most + 1, "faster than the drive may");
        before = sig.paper[F].f_des_N_q20;
        n++;
    }
    CHECK(n > par.precontact[F].doubt_ms && n < par.precontact[F].doubt_ms + 50, "%d ticks", n);
    CHECK_EQ_I64(sig.more[F].let_go, 1);
    CHECK_EQ_I64(sig.paper[F].c, 0);
}

TEST(an_old_glove_frame)
{
    const int old = 50; /* ms, the default */
    start();
    hello();
    (void)tick(1, 0);
    planes();
    (void)tick(1, 0);
    from_board.glove.age_ticks = (uint16_t)old;
    (void)tick(0, 0);
    CHECK_EQ_I64(phase(), EXH_PRECONTACT_TRACK);
    from_board.glove.age_ticks++;
    (void)tick(0, 0);
    CHECK(phase() == EXH_PRECONTACT_IDLE && sig.paper[F].q_lim_m_q30 == EXH_PRECONTACT_NO_LIM,
        "tracking: there is no contact");
    from_board.glove.age_ticks = 0;
    (void)tick(1, 0);
    CHECK_EQ_I64(phase(), EXH_PRECONTACT_TRACK);
    press(EXH_Q(1, 1000, EXH_Q_POS));
    from_board.glove.age_ticks = UINT16_MAX;
    for (int k = 0; k <= par.precontact[F].doubt_ms; k++) {
        (void)tick(0, 0);
        CHECK(sig.paper[F].c, "frozen: the string alone, tick %d", k);
    }
    (void)tick(0, 0);
    CHECK(!sig.paper[F].c && sig.more[F].let_go == 1, "but not for ever");
}

TEST(missed_ticks_make_planes_older)
{
    start();
    hello();
    (void)tick(1, 0);
    planes();
    from_board.missed = 5000;
    tick_n += 5000;
    in.packets = 0;
    planes(); /* sent after the gap: it is new */
    (void)tick(1, 0);
    CHECK(phase() == EXH_PRECONTACT_TRACK && sig.box.age == 0, "new");
    from_board.missed = (uint32_t)par.precontact[F].age_max_ms;
    (void)tick(1, 0);
    CHECK(phase() == EXH_PRECONTACT_IDLE && sig.more[F].stale == 1, "stale");
    CHECK_EQ_I64(sig.box.age, par.precontact[F].age_max_ms + 1);
}

TEST(a_world_that_has_started_anew_is_greeted_at_once)
{
    int hellos = 0;
    start();
    hello();
    for (int k = 0; k < 500; k++) {
        planes();
        (void)tick(1, 0);
    }
    for (int k = 0; k < par.own.quiet_ms; k++) { (void)tick(1, 0); }
    world = (struct exh_wire_tx){4, 0};
    hello();
    for (int k = 0; k < par.own.state_every; k++) { hellos += tick(1, EXH_WIRE_HELLO); }
    CHECK(hellos >= 1 && box.wire.rx.session == 4, "not greeted");
}

/* What is heard again after it: planes of world 3, whose HELLO comes twice a second. */
static uint32_t deaf_ticks(void)
{
    const uint32_t accepted = box.wire.rx.accepted;
    for (uint32_t k = 0; k < 5 * RATE_HZ; k++) {
        if (k % (RATE_HZ / 2) == 250) { hello(); }
        planes();
        (void)tick(1, 0);
        if (box.wire.rx.accepted > accepted + 1) { return k; }
    }
    return UINT32_MAX;
}

TEST(no_packet_makes_the_box_deaf_for_good)
{
    struct exh_wire_tx real;
    int hellos = 0;
    start();
    world.session = 2, hello(); /* its number is of long ago when it comes again */
    world = (struct exh_wire_tx){4, 0}, hello();
    world = (struct exh_wire_tx){3, 50}, hello();
    (void)tick(1, 0);
    real = world;
    world = (struct exh_wire_tx){2, 9}, hello();
    world = real;
    CHECK(deaf_ticks() <= 1500, "a HELLO of old");
    CHECK_EQ_I64(box.wire.rx.silences, 1);

    real = world;
    world.seq += 60000, planes();
    (void)tick(1, 0);
    world = real;
    CHECK(deaf_ticks() <= 1500, "a number far ahead");

    real = world;
    world.seq += 0x70000000, planes();
    (void)tick(1, 0);
    world = real;
    CHECK_EQ_I64(deaf_ticks(), 1);
    CHECK_EQ_I64(sig.box.far, 1);

    for (int k = 0; k < 1200; k++) { (void)tick(1, 0); } /* in a silence it says HELLO more often */
    for (int k = 0; k < 8 * par.own.state_every; k++) { hellos += tick(1, EXH_WIRE_HELLO); }
    CHECK_EQ_I64(hellos, 1);
}

TEST(a_world_that_differs_is_told_by_bits)
{
    struct exh_wire_packet p = {.type = EXH_WIRE_HELLO};
    start();
    p.u.hello = cfg.wire.hello;
    p.u.hello.role = EXH_WIRE_WORLD;
    post(&p);
    (void)tick(1, 0);
    CHECK(sig.box.differs == 0 && sig.box.odd == 0, "%d", sig.box.differs);
    p.u.hello.role = EXH_WIRE_CONTROLLER;
    p.u.hello.lib_version++;
    p.u.hello.table_crc ^= 1;
    post(&p);
    (void)tick(1, 0);
    CHECK_EQ_I64(sig.box.differs, EXH_WIRE_ROLE | EXH_WIRE_LIB | EXH_WIRE_TABLE);
    CHECK_EQ_I64(sig.box.odd, 1);
}

TEST(a_shorter_time_between_states_acts_at_once)
{
    start();
    par.own.state_every = 10000;
    CHECK_EQ_I64(tick(1, EXH_WIRE_HELLO), 1);
    CHECK_EQ_I64(tick(1, EXH_WIRE_STATE), 1);
    CHECK_EQ_I64(tick(1, EXH_WIRE_STATE), 0);
    par.own.state_every = 5;
    CHECK_EQ_I64(tick(1, EXH_WIRE_STATE), 1);
    for (int k = 0; k < 4; k++) { CHECK_EQ_I64(tick(1, EXH_WIRE_STATE), 0); }
    CHECK_EQ_I64(tick(1, EXH_WIRE_STATE), 1);
    box.wire.wait_ticks = UINT32_MAX; /* as restored from a forged state */
    CHECK_EQ_I64(tick(1, EXH_WIRE_STATE), 1);
}

/* Packets of a kind that go out, where a packet comes in too. */
static int heard(int type)
{
    hello();
    return tick(1, type);
}

/* A tick that has to read packets sends no state, unless it is the last before the next is due; a
 * hello goes out in another tick than a state. */
TEST(what_is_due_goes_out_in_ticks_that_read_nothing)
{
    start();
    CHECK_EQ_I64(heard(EXH_WIRE_HELLO), 1); /* the first packet of all does not wait */
    CHECK_EQ_I64(out.packets, 1);
    CHECK_EQ_I64(tick(1, EXH_WIRE_STATE), 1);
    CHECK_EQ_I64(out.packets, 1);
    for (int k = 2; k < 10; k++) { CHECK_EQ_I64(tick(1, EXH_WIRE_STATE), k == 5); }
    for (int k = 0; k < 4; k++) { CHECK_EQ_I64(heard(EXH_WIRE_STATE), 0); }
    CHECK_EQ_I64(heard(EXH_WIRE_STATE), 1);
    CHECK_EQ_I64(heard(EXH_WIRE_STATE), 0);
    CHECK_EQ_I64(tick(1, EXH_WIRE_STATE) + tick(1, EXH_WIRE_STATE), 1);
    for (int k = 2; k < 4; k++) { CHECK_EQ_I64(tick(1, EXH_WIRE_STATE), 0); }
    par.own.state_every = 1; /* no tick to wait in */
    for (int k = 0; k < 4; k++) { CHECK_EQ_I64(heard(EXH_WIRE_STATE), 1); }
}

/* The answer to a packet that asks for a value; what it staged: as said. */
static int asked(uint16_t id, uint16_t instance, int32_t value)
{
    struct exh_params *p = exh_scene_bilateral.params;
    struct exh_wire_packet ask = {.type = EXH_WIRE_PARAM}, answer = {.type = 0};
    struct exh_wire_rx rx = {0};
    const int32_t at = exh_signal_find(p->table, id, instance);
    const int32_t was = at < 0 ? 0 : p->staged[at];
    int32_t n;
    uint8_t buf[EXH_WIRE_MAX_B];
    ask.u.param = (struct exh_wire_param){id, instance, value};
    post(&ask);
    CHECK_EQ_I64(tick(1, EXH_WIRE_ACK), 1);
    for (unsigned i = 0; i < out.packets; i++) {
        struct exh_wire_tx tx = {(uint32_t)par.own.session, 0};
        struct exh_wire_packet hello_to = {.type = EXH_WIRE_HELLO};
        tx.seq = box.wire.tx.seq - 20;
        n = exh_wire_encode(&tx, &hello_to, 0, buf, sizeof buf);
        rx = (struct exh_wire_rx){0};
        (void)exh_wire_decode(&rx, &answer, buf, (size_t)n);
        if (out.byte[i][3] == EXH_WIRE_ACK) {
            CHECK_EQ_I64(exh_wire_decode(&rx, &answer, out.byte[i], out.len_B[i]), EXH_WIRE_ACK);
        }
    }
    CHECK(answer.u.ack.param.id == id && answer.u.ack.param.value == value, "another answer");
    if (at >= 0) {
        CHECK_EQ_I64(p->staged[at], answer.u.ack.result == 0 ? value : was);
        p->staged[at] = was;
    }
    return answer.u.ack.result;
}

static void no_packet_sets(uint32_t *tried)
{
    const struct exh_signal_table *t = &bilateral_params;
    for (uint32_t k = 0; k < exh_signal_count(t); k++) {
        uint16_t instance;
        const struct exh_signal *row = exh_signal_at(t, k, &instance);
        const int32_t now = exh_scene_bilateral.params->staged[k];
        if (row->id >> 8 == exh_material_rows[0].id >> 8) { continue; }
        CHECK(asked(row->id, instance, now == row->max ? row->min : row->max) == -EXH_E_STATE,
            "%s %d", row->name, instance);
        ++*tried;
    }
}

/* Nothing but materials: not what pulls without a contact or limits a pull, not where a contact is,
 * while a finger is frozen or not. */
TEST(no_packet_sets_what_is_the_boxs_own)
{
    uint32_t tried = 0;
    start();
    hello();
    (void)tick(1, 0);
    no_packet_sets(&tried);
    planes();
    (void)tick(1, 0);
    par.precontact[F].d_lim_m_q30 = -EXH_Q(6, 100, EXH_Q_POS);
    (void)tick(1, 0);
    CHECK_EQ_I64(phase(), EXH_PRECONTACT_FROZEN);
    no_packet_sets(&tried);
    CHECK_EQ_I64(phase(), EXH_PRECONTACT_FROZEN);
    CHECK(tried > 200, "%d", (int)tried);
    CHECK_EQ_I64(box.wire.set, 0);
    /* As a set-up at 1 kHz softens it: 12 kN/m are the most there. */
    CHECK_EQ_I64(exh_params_stage(
                     exh_scene_bilateral.params, exh_material_rows[1].id, 3, EXH_Q(50, 1, EXH_Q_B)),
        0);
    CHECK_EQ_I64(asked(exh_material_rows[0].id, 3, EXH_Q(12000, 1, EXH_Q_K) + 1), -EXH_E_GAINS);
    CHECK_EQ_I64(asked(exh_material_rows[0].id, 3, EXH_Q(12000, 1, EXH_Q_K)), 0);
    CHECK_EQ_I64(asked(exh_material_rows[0].id, BILATERAL_MATERIALS, 1000), -EXH_E_UNKNOWN);
    CHECK_EQ_I64(asked(exh_material_rows[1].id, 0, exh_material_rows[1].max + 1), -EXH_E_RANGE);
    CHECK_EQ_I64(asked(0x9999, 0, 1), -EXH_E_UNKNOWN);
    CHECK_EQ_I64(box.wire.set, 1);
}

/* ---- Traces ------------------------------------------------------------------------------------
 */

#define TICK_SIGNAL 0u /* q of the thumb: any will do */

static struct exh_wire_rx far_end;

static void ask_trace(uint32_t every, uint16_t last)
{
    struct exh_wire_packet p = {.type = EXH_WIRE_TRACE_ASK};
    p.u.trace_ask = (struct exh_wire_trace_request){every, {TICK_SIGNAL, 8, 16, last}};
    post(&p);
}

static uint16_t signals(void) { return (uint16_t)exh_signal_count(&bilateral_outputs); }

/* A tick, seen from the world's end; the trace in what went out, of which there is one at most. */
static int traced(struct exh_wire_trace *t)
{
    struct exh_wire_packet p;
    int n = 0;
    (void)tick(1, 0);
    for (unsigned i = 0; i < out.packets; i++) {
        const int type = exh_wire_decode(&far_end, &p, out.byte[i], out.len_B[i]);
        CHECK(type > 0, "%d", type);
        if (type != EXH_WIRE_TRACE) { continue; }
        CHECK(++n == 1 && i == out.packets - 1u, "not one, or not behind all else");
        *t = p.u.trace;
    }
    return n;
}

static void meet_world(void)
{
    start();
    far_end = (struct exh_wire_rx){0};
    hello();
    (void)tick(1, 0);
    for (unsigned i = 0; i < out.packets; i++) {
        struct exh_wire_packet p;
        (void)exh_wire_decode(&far_end, &p, out.byte[i], out.len_B[i]);
    }
}

/* Every frame of 500 ticks has come, once, each with its tick's values. */
static void gapless(uint32_t every)
{
    static int32_t was[600][EXH_TRACE_SIGNALS];
    struct exh_wire_trace t;
    const int32_t *value = (const int32_t *)(const void *)&sig;
    uint32_t next = 0, frames = 0, from = 0;
    meet_world();
    ask_trace(every, (uint16_t)(signals() - 1));
    for (uint32_t k = 0; k < 500; k++) {
        const int n = traced(&t);
        const uint32_t now = box.safety.tick;
        if (k == 0) {
            CHECK(n == 1 && t.result == 0 && t.request_seq == world.seq - 1, "no answer at once");
            next = t.first;
            from = now;
        }
        was[k][0] = value[TICK_SIGNAL], was[k][1] = value[8], was[k][2] = value[16];
        was[k][3] = value[signals() - 1];
        if (n == 0) { continue; }
        CHECK_EQ_I64(exh_wire_trace_missed(next, &t), 0);
        for (unsigned i = 0; i < t.frames; i++, frames++) {
            CHECK_EQ_I64(t.frame[i].tick, from + frames * every);
            CHECK(t.frame[i].tick - from <= k &&
                      memcmp(t.frame[i].raw, was[t.frame[i].tick - from], sizeof was[0]) == 0,
                "every %d: other values", (int)every);
        }
        next = t.first + t.frames;
        CHECK(now - t.frame[0].tick < 100, "a frame has waited for %d ticks",
            (int)(now - t.frame[0].tick));
    }
    CHECK(frames * every + 100 > 500 - every, "every %d: %d frames", (int)every, (int)frames);
}

TEST(a_trace_that_is_asked_for_comes_whole)
{
    static const uint32_t every[] = {1, 2, 7, 20, 99, 100, 250};
    for (size_t i = 0; i < sizeof every / sizeof every[0]; i++) { gapless(every[i]); }
}

TEST(a_trace_asked_for_again_goes_on_and_ends_as_asked)
{
    struct exh_wire_trace t;
    uint32_t next, runs;
    meet_world();
    ask_trace(5, signals()); /* one beyond the last */
    CHECK(traced(&t) == 1 && t.result == -EXH_E_RANGE && t.frames == 0, "%d", t.result);
    for (int k = 0; k < 300; k++) { CHECK_EQ_I64(traced(&t), 0); }
    ask_trace(5, 0);
    CHECK(traced(&t) == 1 && t.result == 0 && t.frames == 1 && t.request_seq == world.seq - 1, "%d",
        t.result);
    next = t.first + 1;
    runs = box.wire.trace.of.run;
    for (int k = 0; k < 7; k++) { CHECK_EQ_I64(traced(&t), 0); }
    ask_trace(5, 0); /* it did not hear the answer */
    CHECK(traced(&t) == 1 && t.first == next && t.frames == 1 && t.request_seq == world.seq - 1,
        "begun anew");
    CHECK_EQ_I64(box.wire.trace.of.run, runs);
    next = t.first + t.frames;
    for (int k = 0; k < 11; k++) { CHECK_EQ_I64(traced(&t), 0); }
    ask_trace(3, 0); /* another: the two frames that waited do not come, and that is seen */
    CHECK(traced(&t) == 1 && exh_wire_trace_missed(next, &t) == 2 && t.frames == 1, "%d missed",
        (int)exh_wire_trace_missed(next, &t));
    ask_trace(0, 0);
    CHECK(traced(&t) == 1 && t.result == 0 && t.frames == 0, "not ended");
    for (int k = 0; k < 300; k++) { CHECK_EQ_I64(traced(&t), 0); }
    ask_trace(3, 0);
    (void)traced(&t);
    (void)exh_wire_poll(&box.wire.rx, UINT32_MAX, 1);
    world = (struct exh_wire_tx){4, 0}; /* another world has requested nothing */
    hello();
    for (int k = 0; k < 300; k++) { CHECK_EQ_I64(traced(&t), 0); }
}

/* No room for 40 ticks: the newest 16 frames are held, the 25 before them are seen to be missing.
 */
TEST(frames_that_had_no_room_are_missed_by_number)
{
    struct exh_wire_trace t;
    uint32_t next;
    meet_world();
    ask_trace(1, 0);
    CHECK_EQ_I64(traced(&t), 1);
    next = t.first + t.frames;
    for (int k = 0; k < 40; k++) {
        out.packets = EXH_SCENE_PACKETS;
        bilateral_trace_write(&box, &cfg, &sig, &out);
    }
    CHECK_EQ_I64(traced(&t), 1);
    CHECK_EQ_I64(exh_wire_trace_missed(next, &t), 25);
    CHECK_EQ_I64(t.frames, EXH_WIRE_FRAMES);
    next = t.first + t.frames;
    for (int k = 0; k < 5; k++) { CHECK_EQ_I64(traced(&t), 0); }
    CHECK_EQ_I64(traced(&t), 1);
    CHECK_EQ_I64(exh_wire_trace_missed(next, &t), 0);
}

/* From the bytes of its state it goes on as it would have, to the bit; and of any bytes, and of
 * memory that says anything, without harm. */
TEST(a_trace_goes_on_from_bytes)
{
    static uint8_t b[8192], again[8192];
    static struct exh_scene_mail sent;
    struct exh_wire_trace t;
    struct exh_bytes c = exh_bytes_writer(b, sizeof b);
    meet_world();
    ask_trace(3, 0);
    for (int k = 0; k < 20; k++) { (void)traced(&t); }
    bilateral_bytes(&c, &box);
    CHECK(exh_bytes_ok(&c), "longer");
    for (int k = 0; k < 40 && !traced(&t); k++) {}
    sent = out;
    memset(&box.wire.trace, 0xFF, sizeof box.wire.trace);
    c = exh_bytes_reader(b, sizeof b);
    bilateral_bytes(&c, &box);
    c = exh_bytes_writer(again, sizeof again);
    bilateral_bytes(&c, &box);
    CHECK(memcmp(b, again, c.at) == 0, "other bytes");
    far_end = (struct exh_wire_rx){0};
    hello();
    world.seq--;
    in.packets = 0;
    for (int k = 0; k < 40; k++) {
        (void)tick(1, 0);
        if (out.packets && out.byte[out.packets - 1][3] == EXH_WIRE_TRACE) { break; }
    }
    CHECK(out.packets > 0 && out.len_B[out.packets - 1] == sent.len_B[sent.packets - 1] &&
              memcmp(out.byte[out.packets - 1], sent.byte[sent.packets - 1],
                  out.len_B[out.packets - 1]) == 0,
        "another packet");
    memset(&box.wire.trace, 0xFF, sizeof box.wire.trace);
    for (int k = 0; k < 300; k++) { (void)tick(1, 0); }
}

TEST_MAIN("bilateral, tick by tick", no_current_is_each_fingers_own_code,
    a_plane_told_before_the_first_glove_frame_is_not_kept,
    a_finger_whose_sensor_is_not_believed_has_no_contact, a_frozen_contact_outlives_a_sensor,
    a_wall_that_the_glove_denies_does_not_pull_for_ever, an_old_glove_frame,
    missed_ticks_make_planes_older, a_world_that_has_started_anew_is_greeted_at_once,
    no_packet_makes_the_box_deaf_for_good, a_world_that_differs_is_told_by_bits,
    a_shorter_time_between_states_acts_at_once, what_is_due_goes_out_in_ticks_that_read_nothing,
    no_packet_sets_what_is_the_boxs_own, a_trace_that_is_asked_for_comes_whole,
    a_trace_asked_for_again_goes_on_and_ends_as_asked, frames_that_had_no_room_are_missed_by_number,
    a_trace_goes_on_from_bytes);
