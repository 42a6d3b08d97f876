/* SPDX-License-Identifier: MIT */
#include "drop.h"

const struct exh_signal drop_own_rows[DROP_OWN_ROWS] = {
    {0x8001, EXH_Q_POS, EXH_WHEN_WALL, -EXH_Q(1, 1, EXH_Q_POS), EXH_Q(1, 1, EXH_Q_POS),
        EXH_Q(7, 100, EXH_Q_POS), "q_lim", "m", "virtual contact, from where the string starts"},
    {0x8002, EXH_Q_FORCE, EXH_WHEN_PERSON, EXH_Q(1, 10, EXH_Q_FORCE), EXH_Q(100, 1, EXH_Q_FORCE),
        EXH_Q(3339, 1000, EXH_Q_FORCE), "kf", "n_per_a",
        "string force per motor current, without a calibration"},
};

const struct exh_signal drop_paper_rows[DROP_PAPER_ROWS] = {
    {0x8101, EXH_Q_POS, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "q", "m", "position"},
    {0x8102, EXH_Q_VEL, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "qd", "m_per_s", "velocity"},
    {0x8103, EXH_Q_FORCE, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "f_des", "n", "force commanded"},
    {0x8104, EXH_Q_CUR, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "i_des", "a", "current coded"},
    {0x8105, 0, EXH_WHEN_OUTPUT, 0, 1, 0, "c", "", "contact condition applies"},
    {0x8106, EXH_Q_FORCE, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "f_mon", "n",
        "force by the current monitor"},
};

const struct exh_signal drop_more_rows[DROP_MORE_ROWS] = {
    {0x8107, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "limits", "", "limits acting, bits"},
    {0x8108, 0, EXH_WHEN_OUTPUT, 0, 5, 0, "state", "",
        "0 off, 1 arm, 2 run, 3 limit, 4 release, 5 fault"},
    {0x8109, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "faults", "", "fault causes latched, bits"},
    {0x810A, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "present", "", "fault causes now, bits"},
    {0x810B, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "arm_step", "",
        "arming is at, or was refused by"},
};

static const struct exh_signal_group param_groups[] = {DROP_PARAM_GROUPS};
static const struct exh_signal_table param_table = {param_groups, DROP_PARAM_N};

static const struct exh_signal_group signal_groups[] = {DROP_SIGNAL_GROUPS};
static const struct exh_signal_table signal_table = {signal_groups, DROP_SIGNAL_N};

#define PARAMS (sizeof(struct drop_par) / sizeof(int32_t))
EXH_STATIC_ASSERT(drop_par_matches_rows,
    PARAMS == EXH_QUAD_ROWS + EXH_VELOCITY_ROWS + EXH_CONTACT_ROWS + EXH_DRIVE_ROWS +
                  EXH_TRACKING_ROWS + EXH_MOTION_ROWS + EXH_CHATTER_ROWS + EXH_SAFETY_ROWS +
                  EXH_SUPPLY_ROWS + DROP_OWN_ROWS + EXH_CALIB_SET_ROWS + EXH_TUNE_ROWS);

int drop_setup(struct drop_cfg *cfg, const struct drop_par *par, struct exh_scene_board board,
    struct exh_scene_calib *calib)
{
    const struct exh_calib_finger finger = {0, &par->drive, par->own.kf_NpA_q20};
    const struct exh_axis_setup parts = {&cfg->quad, &par->quad, &cfg->velocity, &par->velocity,
        &cfg->watch, &par->watch, &cfg->track, &par->track, &cfg->drive, &par->drive, &cfg->chatter,
        &par->chatter};
    int err;

    cfg->par = par;
    cfg->tested = exh_selftest() == EXH_SELFTEST_OK;
    err = exh_calib_set_tables(&cfg->calib, calib, &par->calib, &finger);
    if (err == 0) {
        err = exh_axis_setup(&parts, board.T, board.enc_bits, exh_calib_to_cur(&cfg->calib),
            exh_calib_to_force(&cfg->calib));
    }
    if (err == 0) { err = exh_safety_setup(&cfg->safety, &par->safety, board.T); }
    if (err == 0) { err = exh_supply_setup(&cfg->supply, &par->supply, board.T); }
    return err;
}

static struct exh_axis axis_of(struct drop *s, const struct drop_cfg *cfg)
{
    return (struct exh_axis){&s->quad, &cfg->quad, &s->velocity, &cfg->velocity, &s->watch,
        &cfg->watch, &s->track, &cfg->track, &s->drive, &cfg->drive, &s->chatter, &cfg->chatter};
}

/* Causes of the device, not of the finger. */
static uint32_t causes(struct drop *s, const struct drop_cfg *cfg, const struct exh_scene_in *in)
{
    const int starved = exh_supply_step(&s->supply, &cfg->supply, in->drive.supply_raw, in->missed);
    return (starved ? EXH_FAULT_SUPPLY : 0u) | (s->broken ? EXH_FAULT_CONFIG : 0u) | s->more;
}

void drop_law(struct drop *s, const struct drop_cfg *cfg, const struct exh_scene_in *in,
    struct drop_now *now, struct drop_signals *sig)
{
    const struct exh_axis axis = axis_of(s, cfg);
    const struct exh_axis_now of = exh_axis_sense(&axis, &in->drive, 0);
    const uint8_t ready = (uint8_t)((cfg->tested ? EXH_ARM_SELFTEST : 0u) | cfg->calib.vouches);
    const struct exh_safety_in box = {
        in->drive.din, causes(s, cfg, in), in->missed, in->command, 1, ready};
    const struct exh_contact_in q = {of.pos_m_q30, of.vel_mps_q27, cfg->par->own.q_lim_m_q30};

    now->permit = exh_axis_permit(&s->safety, &cfg->safety, &of, 1, box);
    now->cnt = of.cnt;
    now->limits = of.limits;
    sig->c = exh_contact_step(&s->contact, &cfg->par->contact, q, &now->f);
    sig->q_m_q30 = of.pos_m_q30;
    sig->qd_mps_q27 = of.vel_mps_q27;
    sig->f_mon_N_q20 = exh_drive_monitor_N_q20(&cfg->drive, of.mon_A_q26);
}

void drop_out(struct drop *s, const struct drop_cfg *cfg, struct drop_now *now,
    struct exh_drive_out *out, struct drop_signals *sig)
{
    const struct exh_axis axis = axis_of(s, cfg);
    now->limits |= exh_axis_force(&axis, &now->permit, &now->f, &now->i);
    exh_axis_out(&axis, &s->safety, now->cnt, &now->i, &now->limits, out);

    sig->f_des_N_q20 = now->f.force_N_q20;
    sig->i_des_A_q26 = now->i.coded_A_q26;
    sig->limits = (int32_t)now->limits;
    sig->state = s->safety.state;
    sig->faults = exh_from_u32(s->safety.faults);
    sig->present = (int32_t)s->safety.present;
    sig->arm_step = exh_safety_arm_step(&s->safety);
}

void drop_tick(struct drop *s, const struct drop_cfg *cfg, const struct exh_scene_in *in,
    struct exh_drive_out *out, struct drop_signals *sig)
{
    struct drop_now now;
    drop_law(s, cfg, in, &now, sig);
    drop_out(s, cfg, &now, out, sig);
}

void drop_bytes(struct exh_bytes *c, struct drop *s)
{
    exh_quad_serialize(c, &s->quad);
    exh_velocity_window_serialize(c, &s->velocity);
    exh_contact_serialize(c, &s->contact);
    exh_drive_serialize(c, &s->drive);
    exh_tracking_serialize(c, &s->track);
    exh_motion_serialize(c, &s->watch);
    exh_chatter_serialize(c, &s->chatter);
    exh_safety_serialize(c, &s->safety);
    exh_supply_serialize(c, &s->supply);
}

/* --- the one instance of this image --- */

static struct drop_par active, staged;
static struct exh_params params;
static struct drop_signals signals;
static struct drop_cfg cfg;
static struct drop state;
static struct exh_integrity guard;
static struct exh_scene_calib calib;

static void defaults(void)
{
    exh_params_setup(&params, &param_table, (int32_t *)&active, (int32_t *)&staged);
}

static int setup(struct exh_scene_board board)
{
    int err;
    state = (struct drop){0};
    err = exh_calib_set_load(&calib, &params, &active.calib, 1u);
    if (err == 0) { err = drop_setup(&cfg, &active, board, &calib); }
    exh_params_slew_setup(&params, &active.tune, board.T);
    exh_integrity_seal(&guard, &cfg, sizeof cfg, &params);
    return err;
}

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    state.broken = (uint8_t)exh_integrity_step(&guard);
    drop_tick(&state, &cfg, in, out, &signals);
}

static void state_bytes(struct exh_bytes *c) { drop_bytes(c, &state); }

static void part_bytes(struct exh_bytes *c, void *copy, unsigned part)
{
    (void)part;
    drop_bytes(c, copy);
}

struct drop *drop_memory(struct drop_cfg **c)
{
    *c = &cfg;
    return &state;
}

struct exh_integrity *drop_guard(void) { return &guard; }

const struct exh_scene exh_scene_drop = {
    .name = "drop",
    .rate_Hz = 2000,
    .fingers = 1,
    .params = &params,
    .apply = exh_params_apply,
    .safety = &state.safety,
    .signals = &signal_table,
    .values = (int32_t *)&signals,
    .calib = &calib,
    .defaults = defaults,
    .setup = setup,
    .tick = tick,
    .state = state_bytes,
    .later = {&state, sizeof state, 1, part_bytes},
};
