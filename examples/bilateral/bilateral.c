/* SPDX-License-Identifier: MIT */
#include "bilateral.h"

#include "exhand/board.h"

/* Places the fingers in use first, since the gate opens the first n places. */
static void place_fingers(struct bilateral_cfg *cfg, uint32_t mask)
{
    unsigned at = 0;
    cfg->n = 0;
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        if (mask >> f & 1u) {
            cfg->at[at++] = (uint8_t)f;
            cfg->n++;
        }
    }
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        if (!(mask >> f & 1u)) { cfg->at[at++] = (uint8_t)f; }
    }
}

/* Damaged memory may select unused fingers; their pointers then are not NULL. */
static void like_the_first(struct bilateral_cfg *cfg)
{
    for (unsigned k = cfg->n; k < BILATERAL_FINGERS; k++) {
        cfg->drive[k] = cfg->drive[0];
        cfg->finger[cfg->at[k]] = cfg->finger[cfg->at[0]];
    }
}

/* Sends the world each finger's bend per string, so that it predicts a finger that has not moved
 * yet. */
static void tell_pulls(struct bilateral_cfg *cfg)
{
    for (unsigned k = 0; k < cfg->n; k++) {
        const unsigned f = cfg->at[k];
        for (unsigned i = 0; i < 2; i++) {
            cfg->wire.hello.pull_radpm_q7[f][i] = (int16_t)exh_clamp32(
                cfg->finger[f].hand.pull_radpm_q20[i] >> (20 - 7), INT16_MIN, INT16_MAX);
        }
    }
}

int bilateral_setup(struct bilateral_cfg *cfg, struct bilateral *s, const struct bilateral_par *par,
    struct exh_scene_board board, struct exh_scene_calib *calib)
{
    const uint64_t num = (uint64_t)board.T.num * (uint32_t)par->glove_own.every;
    int err;
    cfg->par = par;
    place_fingers(cfg, (uint32_t)par->own.fingers);
    if (cfg->n == 0) { return -EXH_E_RANGE; }
    cfg->tested = exh_selftest_glove() == EXH_SELFTEST_OK;
    if (num > UINT32_MAX) { return -EXH_E_RATE; }
    /* All values are in range, so nothing overflows. */
    cfg->rest_ticks = (uint32_t)exh_udiv64((uint64_t)(uint32_t)par->own.f0_rest_ms * board.T.den,
                          UINT64_C(1000) * board.T.num, NULL) +
                      1;
    glove_cal_of_rows(&cfg->cal, &par->glove_own, par->sensor);
    err = exh_glove_setup(
        &cfg->glove, &par->glove, &cfg->cal, (struct exh_period){(uint32_t)num, board.T.den});
    cfg->vouches = EXH_ARM_CALIBRATION | EXH_ARM_POLARITY;
    for (unsigned k = 0; err == 0 && k < cfg->n; k++) {
        err = bilateral_finger_setup(cfg, k, board, calib);
        cfg->vouches &= cfg->finger[cfg->at[k]].calib.vouches;
    }
    like_the_first(cfg);
    if (err == 0) { bilateral_frame_setup(cfg); }
    bilateral_wire_setup(&cfg->wire, &s->wire, (uint32_t)par->own.session, board.T);
    tell_pulls(cfg);
    if (err == 0) { err = exh_safety_setup(&cfg->safety, &par->safety, board.T); }
    if (err == 0) { err = bilateral_cause_setup(cfg, board.T); }
    if (err == 0) { err = bilateral_gains_setup(&cfg->gains, par, board.T); }
    return err;
}

/* --- the tick --- */

/* Position and velocity of all fingers in use, by place. Returns the drives' inputs by place. */
static uint32_t sense(struct bilateral *s, const struct bilateral_cfg *cfg,
    const struct exh_scene_in *in, struct bilateral_paper *p, struct exh_axis_now *now)
{
    const unsigned n = bilateral_n(cfg);
    uint32_t din = in->drive.din & (EXH_DIN_DRIVE0 - 1u);
    for (unsigned k = 0; k < n; k++) {
        const unsigned f = bilateral_at(cfg, k);
        const struct exh_axis axis = bilateral_axis(s, cfg, k, f);
        now[k] = exh_axis_sense(&axis, &in->drive, f);
        p[f].q_m_q30 = now[k].pos_m_q30;
        p[f].qd_mps_q27 = now[k].vel_mps_q27;
        s->mon_A_q26[f] = now[k].mon_A_q26;
        din |= (in->drive.din / EXH_DIN_DRIVE0 >> f & 1u) * EXH_DIN_DRIVE0 << k;
        exh_precontact_advance(&s->finger[f].precontact, in->missed);
    }
    return din;
}

/* Moves the gate's codes from places back to fingers. The gate does not know unused drives; they
 * get their own code of 0 A. */
static void out_by_finger(
    const struct bilateral_cfg *cfg, const struct exh_drive_out *placed, struct exh_drive_out *out)
{
    const unsigned n = bilateral_n(cfg);
    out->enable = 0;
    out->alive = placed->alive;
    for (unsigned k = 0; k < BILATERAL_FINGERS; k++) {
        const unsigned f = bilateral_at(cfg, k);
        if (k < n) {
            out->dac_raw[f] = placed->dac_raw[k];
            out->enable = (uint8_t)(out->enable | (placed->enable >> k & 1u) << f);
        } else {
            out->dac_raw[f] = (uint16_t)cfg->par->drive[f].dac_zero_raw;
        }
    }
}

static void tell_finger(struct bilateral_more *m, const struct bilateral_finger *s)
{
    const struct exh_precontact *p = &s->precontact;
    for (unsigned j = 0; j < EXH_HAND_JOINTS; j++) { m->joint_turn_q32[j] = s->joint_turn_q32[j]; }
    m->clamped = s->clamped;
    m->tip_m_q30 = s->tip_m_q30;
    m->freezes = exh_from_u32(p->frozen_n);
    m->born = exh_from_u32(p->born_n);
    m->refused = exh_from_u32(p->refused_n);
    m->ignored = exh_from_u32(p->ignored_n);
    m->stale = exh_from_u32(p->stale_n);
    m->let_go = exh_from_u32(p->let_go_n);
    m->late = exh_from_u32(p->late_n);
    m->late_m_q30 = p->late_m_q30;
}

static int32_t at_most(uint32_t v) { return v < INT32_MAX ? (int32_t)v : INT32_MAX; }

static void tell_box(struct bilateral_box *b, const struct bilateral *s)
{
    const struct exh_wire_rx *rx = &s->wire.rx;
    b->state = s->safety.state;
    b->faults = exh_from_u32(s->safety.faults);
    b->present = (int32_t)s->safety.present;
    b->glove_faults = exh_from_u32(s->glove_faults);
    b->age = at_most(s->wire.age_ticks);
    b->trip_us = at_most(s->wire.trip_us);
    b->set = exh_from_u32(s->wire.set);
    b->accepted = exh_from_u32(rx->accepted);
    b->missing = exh_from_u32(rx->missing);
    b->duplicate = exh_from_u32(rx->duplicate);
    b->reordered = exh_from_u32(rx->reordered);
    b->old = exh_from_u32(rx->old);
    b->stranger = exh_from_u32(rx->stranger);
    b->corrupt = exh_from_u32(rx->corrupt);
    b->version = exh_from_u32(rx->version);
    b->unknown = exh_from_u32(rx->unknown);
    b->far = exh_from_u32(rx->far);
    b->silences = exh_from_u32(rx->silences);
    b->differs = (int32_t)s->wire.differs;
    b->odd = exh_from_u32(s->wire.odd);
    b->arm_step = exh_safety_arm_step(&s->safety);
}

/* Steps of arming that are satisfied. Set-up refuses an invalid calibration of glove or finger. If
 * arming pulls, the ramp waits until all strings have moved in. */
static uint8_t steps_held(
    struct bilateral *s, const struct bilateral_cfg *cfg, const struct exh_axis_now *now)
{
    const uint32_t held = (cfg->tested ? EXH_ARM_SELFTEST : 0u) | cfg->vouches;
    uint32_t waits = 0, failed = 0;
    if (cfg->par->polarity.pull_N_q20 == 0) { return (uint8_t)held; }
    for (unsigned k = 0; k < bilateral_n(cfg); k++) {
        const unsigned f = bilateral_at(cfg, k);
        const uint8_t r = exh_polarity_step(
            &s->polarity[f], &cfg->finger[f].polarity, exh_safety_pulls(&s->safety), now[k].cnt);
        if (r != EXH_POLARITY_SEEN) { waits = EXH_ARM_WAIT; }
        if (r > EXH_POLARITY_SEEN) { failed = EXH_ARM_POLARITY; }
    }
    return (uint8_t)((held & ~failed) | waits);
}

void bilateral_tick(struct bilateral *s, const struct bilateral_cfg *cfg,
    const struct exh_scene_in *in, const struct exh_scene_mail *mail, struct exh_params *params,
    struct exh_drive_out *out, struct bilateral_signals *sig)
{
    const unsigned n = bilateral_n(cfg);
    struct exh_axis_now now[BILATERAL_FINGERS];
    struct exh_safety_in box = {0, 0, in->missed, in->command, (uint8_t)n, 0};
    struct exh_permit permit;
    struct exh_current_ledger i[BILATERAL_FINGERS];
    uint32_t limits[BILATERAL_FINGERS];
    struct exh_drive_out placed;

    box.din = sense(s, cfg, in, sig->paper, now);
    bilateral_age(s, cfg, in);
    bilateral_wire_take(s, cfg, mail, in->missed, params);
    bilateral_see(s, cfg, in);
    box.raised = bilateral_causes(s, cfg, in);
    box.ready = steps_held(s, cfg, now);
    permit = exh_axis_permit(&s->safety, &cfg->safety, now, n, box);
    s->pulls = box.ready & EXH_ARM_WAIT && exh_safety_pulls(&s->safety);
    for (unsigned k = 0; k < n; k++) {
        const unsigned f = bilateral_at(cfg, k);
        limits[k] = now[k].limits | bilateral_finger_feel(s, cfg, k, &permit, &i[k], &sig->paper[f],
                                        &sig->more[f].bits);
    }
    exh_gate_step(&s->safety, cfg->drive, n, i, limits, &placed);
    out_by_finger(cfg, &placed, out);
    for (unsigned k = 0; k < n; k++) {
        const unsigned f = bilateral_at(cfg, k);
        const struct exh_axis axis = bilateral_axis(s, cfg, k, f);
        sig->paper[f].i_des_A_q26 = i[k].coded_A_q26;
        exh_axis_update(&axis, now[k].cnt, i[k].coded_A_q26);
        sig->more[f].limits = (int32_t)limits[k];
    }
    sig->box.glove_age = in->glove.age_ticks;
}

void bilateral_tell(
    const struct bilateral *s, const struct bilateral_cfg *cfg, struct bilateral_signals *sig)
{
    for (unsigned k = 0; k < bilateral_n(cfg); k++) {
        const unsigned f = bilateral_at(cfg, k);
        sig->paper[f].f_mon_N_q20 = exh_drive_monitor_N_q20(&cfg->drive[k], s->mon_A_q26[f]);
        tell_finger(&sig->more[f], &s->finger[f]);
    }
    tell_box(&sig->box, s);
}

static void rest_bytes(struct exh_bytes *c, struct bilateral *s)
{
    exh_bytes_u8(c, &s->worn);
    exh_bytes_u32(c, &s->glove_faults);
    exh_supply_serialize(c, &s->supply);
    exh_bytes_u32(c, &s->unsure_ticks);
}

/* In parts, of which none is much larger than a finger. */
static void part_of(struct exh_bytes *c, struct bilateral *s, unsigned part)
{
    if (part < BILATERAL_FINGERS) { bilateral_finger_bytes(c, &s->finger[part]); }
    switch (part) {
    case BILATERAL_FINGERS: exh_safety_serialize(c, &s->safety); break;
    case BILATERAL_FINGERS + 1: exh_glove_serialize(c, &s->glove); break;
    case BILATERAL_FINGERS + 2: bilateral_frame_bytes(c, &s->frame); break;
    case BILATERAL_FINGERS + 3: bilateral_wire_bytes(c, &s->wire); break;
    case BILATERAL_FINGERS + 4: rest_bytes(c, s); break;
    default: break;
    }
}
#define PARTS (BILATERAL_FINGERS + 5)

void bilateral_bytes(struct exh_bytes *c, struct bilateral *s)
{
    for (unsigned i = 0; i < PARTS; i++) { part_of(c, s, i); }
}

/* --- the one instance of this image --- */

static struct bilateral_par active, staged;
static struct exh_params params;
static struct bilateral_signals signals;
static uint8_t untold; /* 1: signals of the last tick are incomplete */
static struct bilateral_cfg cfg;
static struct bilateral state;
static struct exh_integrity guard;
static struct exh_scene_calib calib;
static struct exh_scene_mail mail_in, mail_out;

static void defaults(void)
{
    exh_params_setup(&params, &bilateral_params, (int32_t *)&active, (int32_t *)&staged);
    glove_rows_of_cal(&active.glove_own, active.sensor, &exh_glove_cal_default);
    active.glove.fc_Hz_q16 = EXH_Q(200, 1, EXH_Q_RAW); /* short delay: 1.1 ms */
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        active.precontact[f].from_slope = 1;
        active.watch[f].stuck_ms =
            10000; /* against a stiff wall, a finger may stay at rest for seconds */
        active.chatter[f].energy_J_q24 = EXH_Q(3, 100, 24);
        active.precontact[f].d_lim_m_q30 = -EXH_Q(8, 1000, EXH_Q_POS);
    }
    active.gains = bilateral_rule;
    active.own.rule_on = BILATERAL_RULE_SCALED;
    staged = active;
}

int bilateral_stage_cal(const struct exh_glove_cal *cal, struct exh_glove_error *bad)
{
    const int err = exh_glove_cal_validate(cal, bad);
    if (err == 0) {
        glove_rows_of_cal(&staged.glove_own, staged.sensor, cal);
        params.pending = 1;
    }
    return err;
}

/* As parameters, like the session, so that registers and the log's header show them. */
static int soften(struct exh_period T)
{
    struct exh_gains_par rule;
    const int err = bilateral_gains_setup(&rule, &active, T);
    for (unsigned n = 0; err == 0 && active.own.rule_on && n < BILATERAL_MATERIALS; n++) {
        bilateral_soften(&rule, &active.material[n]);
        bilateral_soften(&rule, &staged.material[n]);
    }
    return err;
}

static int allowed(void)
{
    return active.own.rule_on ? exh_gains_validate(&params, &cfg.gains, NULL) : 0;
}

static int setup(struct exh_scene_board board)
{
    static const struct bilateral_signals silence;
    int err;
    state = (struct bilateral){0};
    signals = silence;
    untold = 0;
    mail_in.packets = mail_out.packets = 0;
    /* As a parameter, so that the log's header has it; a replay needs the same session. */
    if (active.own.session == 0) {
        active.own.session = staged.own.session = (int32_t)(exh_board_cycles() >> 1 | 1u);
    }
    err = exh_calib_set_load(&calib, &params, &active.calib, (1u << BILATERAL_FINGERS) - 1u);
    if (err == 0) { err = soften(board.T); }
    if (err == 0) { err = bilateral_setup(&cfg, &state, &active, board, &calib); }
    if (err == 0) { err = allowed(); }
    exh_params_slew_setup(&params, &active.tune, board.T);
    exh_integrity_seal(&guard, &cfg, sizeof cfg, &params);
    return err;
}

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    state.broken = (uint8_t)exh_integrity_step(&guard);
    bilateral_tick(&state, &cfg, in, &mail_in, &params, out, &signals);
    untold = 1;
}

static void show(void)
{
    if (untold) { bilateral_tell(&state, &cfg, &signals); }
    untold = 0;
}

static void write_mail(void) { bilateral_write(&state, &cfg, &signals, &mail_out); }

/* The polarity is this instance's alone. */
static void part_bytes(struct exh_bytes *c, void *copy, unsigned part)
{
    struct bilateral *const s = copy;
    part_of(c, s, part);
    for (unsigned f = 0; part == PARTS && f < BILATERAL_FINGERS; f++) {
        exh_polarity_serialize(c, &s->polarity[f]);
    }
}

static void state_bytes(struct exh_bytes *c)
{
    for (unsigned i = 0; i <= PARTS; i++) { part_bytes(c, &state, i); }
}

struct bilateral *bilateral_memory(struct bilateral_cfg **c)
{
    *c = &cfg;
    return &state;
}

struct exh_integrity *bilateral_guard(void) { return &guard; }

static const struct exh_scene_link wire = {
    exh_board_link_recv, exh_board_link_send, &mail_in, &mail_out, write_mail};

const struct exh_scene exh_scene_bilateral = {
    .name = "bilateral",
    .rate_Hz = 2000,
    .fingers = BILATERAL_FINGERS,
    .params = &params,
    .apply = exh_params_apply,
    .safety = &state.safety,
    .signals = &bilateral_outputs,
    .values = (int32_t *)&signals,
    .read_glove = exh_board_read_glove,
    .glove_every = &active.glove_own.every,
    .link = &wire,
    .calib = &calib,
    .defaults = defaults,
    .setup = setup,
    .tick = tick,
    .show = show,
    .state = state_bytes,
    .allowed = allowed,
    .later = {&state, sizeof state, PARTS + 1, part_bytes},
};
