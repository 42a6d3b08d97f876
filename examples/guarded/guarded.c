/* SPDX-License-Identifier: MIT */
#include "guarded.h"

static const struct exh_signal rows[] = {
    {0x8201, 24, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "energy", "j",
        "taken up by the present contact, as coded"},
    {0x8202, EXH_Q_FORCE, EXH_WHEN_OUTPUT, INT32_MIN, 0, 0, "f_pas", "n",
        "what passivity takes from the law's force"},
};

static const struct exh_signal own_rows[] = {
    {0x8203, 0, EXH_WHEN_SETUP, 0, 1, 0, "rule_on", "",
        "1: k and b outside the rule of gains are refused"},
};

static const struct exh_signal_group param_groups[] = {DROP_PARAM_GROUPS,
    {exh_passivity_rows, EXH_PASSIVITY_ROWS, 1}, {own_rows, 1, 1},
    {exh_gains_rows, EXH_GAINS_ROWS, 1}};
static const struct exh_signal_table param_table = {param_groups, DROP_PARAM_N + 3};

static const struct exh_signal_group signal_groups[] = {DROP_SIGNAL_GROUPS, {rows, 2, 1}};
static const struct exh_signal_table signal_table = {signal_groups, DROP_SIGNAL_N + 1};

EXH_STATIC_ASSERT(guarded_par_matches_rows,
    sizeof(struct guarded_par) ==
        sizeof(struct drop_par) + (EXH_PASSIVITY_ROWS + 1 + EXH_GAINS_ROWS) * sizeof(int32_t));

/* 0, or an error: of the rule, or k and b are outside it. */
static int ask_rule(const struct guarded_par *par, struct exh_period T)
{
    const struct exh_contact_par *wall = &par->drop.contact;
    const int err = par->own.rule_on ? exh_gains_setup(&par->gains, T) : 0;
    if (err < 0 || !par->own.rule_on) { return err; }
    return exh_gains_ok(&par->gains, wall->k_Npm_q10, wall->b_Nspm_q20) ? 0 : -EXH_E_GAINS;
}

int guarded_setup(struct guarded_cfg *cfg, const struct guarded_par *par,
    struct exh_scene_board board, struct exh_scene_calib *calib)
{
    const struct exh_velocity_scale scale = {par->drop.quad.step_m_q42, board.T};
    const struct exh_calib_tables *t = &cfg->drop.calib;
    struct exh_table held = {cfg->held, 0};
    int err = drop_setup(&cfg->drop, &par->drop, board, calib);
    held.n = t->to_cur_n;
    if (err == 0) { err = exh_table_invert(cfg->held, t->force_to_cur, t->to_cur_n); }
    if (err == 0) {
        err = exh_passivity_setup(&cfg->passivity, &par->passivity, &cfg->drop.drive, held, scale,
            par->drop.watch.speed_mps_q27);
    }
    return err == 0 ? ask_rule(par, board.T) : err;
}

void guarded_tick(struct guarded *s, const struct guarded_cfg *cfg, const struct exh_scene_in *in,
    struct exh_drive_out *out, struct guarded_signals *sig)
{
    struct drop_now now;
    drop_law(&s->drop, &cfg->drop, in, &now, &sig->drop);
    now.limits |= exh_passivity_step(&s->passivity, &cfg->passivity, now.cnt, sig->drop.c, &now.f);
    drop_out(&s->drop, &cfg->drop, &now, out, &sig->drop);
    exh_passivity_update(&s->passivity, &cfg->passivity, &now.f, now.i.coded_A_q26);
    sig->energy_J_q24 = exh_passivity_J_q24(&s->passivity, &cfg->passivity);
    sig->passivity_N_q20 = exh_sat32(now.f.passivity_N_q20);
}

void guarded_bytes(struct exh_bytes *c, struct guarded *s)
{
    drop_bytes(c, &s->drop);
    exh_passivity_serialize(c, &s->passivity);
}

/* --- the one instance of this image --- */

static struct guarded_par active, staged;
static struct exh_params params;
static struct guarded_signals signals;
static struct guarded_cfg cfg;
static struct guarded state;
static struct exh_scene_calib calib;
static struct exh_integrity guard;

static void defaults(void)
{
    exh_params_setup(&params, &param_table, (int32_t *)&active, (int32_t *)&staged);
}

static int setup(struct exh_scene_board board)
{
    int err;
    state = (struct guarded){0};
    exh_params_slew_setup(&params, &active.drop.tune, board.T);
    exh_gains_enable(&params, active.own.rule_on);
    err = exh_calib_set_load(&calib, &params, &active.drop.calib, 1u);
    if (err == 0) { err = guarded_setup(&cfg, &active, board, &calib); }
    exh_integrity_seal(&guard, &cfg, sizeof cfg, &params);
    return err;
}

int guarded_stage(uint16_t id, uint16_t instance, int32_t raw)
{
    return active.own.rule_on ? exh_gains_stage(&params, &active.gains, id, instance, raw)
                              : exh_params_stage(&params, id, instance, raw);
}

static int allowed(void)
{
    return active.own.rule_on ? exh_gains_validate(&params, &active.gains, NULL) : 0;
}

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    if (active.own.rule_on) { exh_gains_step(&params, &active.gains); }
    state.drop.broken = (uint8_t)exh_integrity_step(&guard);
    guarded_tick(&state, &cfg, in, out, &signals);
}

static void state_bytes(struct exh_bytes *c) { guarded_bytes(c, &state); }

static void part_bytes(struct exh_bytes *c, void *copy, unsigned part)
{
    (void)part;
    guarded_bytes(c, copy);
}

struct guarded *guarded_memory(struct guarded_cfg **c)
{
    *c = &cfg;
    return &state;
}

const struct exh_scene exh_scene_guarded = {
    .name = "guarded",
    .rate_Hz = 2000,
    .fingers = 1,
    .safety = &state.drop.safety,
    .params = &params,
    .apply = exh_params_apply,
    .signals = &signal_table,
    .values = (int32_t *)&signals,
    .calib = &calib,
    .defaults = defaults,
    .setup = setup,
    .tick = tick,
    .state = state_bytes,
    .later = {&state, sizeof state, 1, part_bytes},
    .allowed = allowed,
};
