/* SPDX-License-Identifier: MIT */
/* The scenes drop and guarded: one tick from an encoder's counter to a D/A code. */
#include "modules.h"

#include "guarded/guarded.h"

#include "exhand/fix.h"

#define HEALTHY 0x1F0Fu

struct scene {
    int guarded;
    struct guarded_par par;
    struct guarded_cfg cfg;
    struct guarded s;
    struct golden_rail rail;
};

static int32_t any_size(struct golden_rng *r, int32_t most)
{
    const int64_t any = golden_draw(r, 0, most);
    return (int32_t)(any >> golden_draw(r, 0, 12));
}

static void any_par(
    struct drop_par *p, struct golden_rail *rail, struct golden_rng *r, uint32_t rate_Hz)
{
    p->quad.step_m_q42 = golden_step(r);
    p->quad.speed_max_mps_q27 = (int32_t)golden_draw(r, 13421773, INT32_MAX);
    p->velocity.p = (int32_t)golden_draw(r, 0, 4);
    p->contact.k_Npm_q10 = any_size(r, 1024000000);
    p->contact.b_Nspm_q20 = any_size(r, 1048576000);
    p->contact.f0_N_q20 = (int32_t)golden_draw(r, 0, 20971520);
    p->contact.f0_band_m_q30 = any_size(r, 10737418);
    p->contact.hyst_m_q30 = any_size(r, 10737418);
    golden_drive_par(&p->drive, r, rate_Hz);
    golden_track_par(&p->track, r, rate_Hz);
    golden_watch_par(&p->watch, r, rate_Hz);
    golden_safety_par(&p->safety, r, rate_Hz);
    golden_supply_par(&p->supply, rail, r, rate_Hz, 31);
    p->own.q_lim_m_q30 = (int32_t)golden_draw(r, -(INT32_C(1) << 26), INT32_C(1) << 26);
    p->own.kf_NpA_q20 = (int32_t)golden_draw(r, 104858, 104857600);
    golden_chatter_par(&p->chatter, r);
    p->calib.uncalibrated = 1;
}

static int scene_try(struct scene *d, struct exh_scene_board board)
{
    return d->guarded ? guarded_setup(&d->cfg, &d->par, board, NULL)
                      : drop_setup(&d->cfg.drop, &d->par.drop, board, NULL);
}

static void scene_setup(struct scene *d, struct golden_rng *r, uint32_t rate_Hz, uint32_t k)
{
    struct exh_scene_board board = {golden_period(rate_Hz, k), 16};
    int err;
    const int guarded = d->guarded;
    (void)memset(d, 0, sizeof *d);
    d->guarded = guarded;
    any_par(&d->par.drop, &d->rail, r, rate_Hz);
    /* Quiet enough to run, not touching at first, and to and fro through the wall. */
    d->par.drop.drive.slew_down_Nps = 10000000;
    d->par.drop.own.q_lim_m_q30 >>= 8;
    if (d->par.drop.own.q_lim_m_q30 < 0) { d->par.drop.own.q_lim_m_q30 *= -1; }
    if (guarded) { d->par.passivity.on = (int32_t)golden_draw(r, 0, 2); }
    while ((err = scene_try(d, board)) != 0 && board.enc_bits < 32) {
        board.enc_bits = (uint8_t)(board.enc_bits + 4);
    }
    CHECK_EQ_I64(err, 0);
}

static void any_in(struct exh_scene_in *in, struct golden_rng *r, uint32_t k, struct scene *d)
{
    const uint8_t state = d->s.drop.safety.state;
    if (golden_draw(r, 0, 191) == 0) {
        in->drive.din ^= UINT32_C(1) << golden_draw(r, 0, 8);
    } else if (golden_draw(r, 0, 3) == 0) {
        in->drive.din = HEALTHY;
    }
    if (state == EXH_STATE_FAULT && golden_draw(r, 0, 3) == 0) { in->drive.din ^= 2; }
    in->missed = golden_draw(r, 0, 127) == 0 ? 1 : 0;
    in->command = k % 4 == 2 || k % GOLDEN_AGAIN == 0 ? EXH_CMD_RUN
                  : k % 8 == 5                        ? EXH_CMD_CLEAR
                                                      : EXH_CMD_NONE;
    if (golden_draw(r, 0, 255) == 0) { in->command = EXH_CMD_OFF; }
    in->drive.supply_raw = golden_rail(&d->rail, r, k);
}

static void put_out(struct golden *g, const struct guarded_signals *all, int guarded,
    const struct exh_drive_out *out)
{
    const struct drop_signals *sig = &all->drop;
    golden_put(g, sig->q_m_q30);
    golden_put(g, sig->qd_mps_q27);
    golden_put(g, sig->f_des_N_q20);
    golden_put(g, sig->i_des_A_q26);
    golden_put(g, sig->c);
    golden_put(g, sig->f_mon_N_q20);
    golden_put(g, sig->limits);
    golden_put(g, sig->state);
    golden_put(g, sig->faults);
    golden_put(g, sig->present);
    golden_put(g, sig->arm_step);
    if (guarded) {
        golden_put(g, all->energy_J_q24);
        golden_put(g, all->passivity_N_q20);
    }
    golden_put(g, out->dac_raw[0]);
    golden_put(g, out->enable);
    golden_put(g, out->alive);
}

static void put_state(struct golden *g, struct drop *s)
{
    GOLDEN_STATE(g, exh_quad_serialize, &s->quad);
    GOLDEN_STATE(g, exh_velocity_window_serialize, &s->velocity);
    GOLDEN_STATE(g, exh_contact_serialize, &s->contact);
    GOLDEN_STATE(g, exh_drive_serialize, &s->drive);
    GOLDEN_STATE(g, exh_tracking_serialize, &s->track);
    GOLDEN_STATE(g, exh_motion_serialize, &s->watch);
    GOLDEN_STATE(g, exh_chatter_serialize, &s->chatter);
    GOLDEN_STATE(g, exh_safety_serialize, &s->safety);
    GOLDEN_STATE(g, exh_supply_serialize, &s->supply);
}

/* What the string moves in a tick at most. */
static int32_t most_cnt(const struct scene *d)
{
    return d->guarded ? d->cfg.passivity.way_cnt : d->cfg.drop.quad.jump_cnt;
}

static void play(struct golden *g, uint32_t rate_Hz, const char *name, int guarded)
{
    static struct golden_wave moves;
    static struct scene d;
    struct golden_rng r = golden_rng(name, rate_Hz, 0);
    struct exh_scene_in in = {.missed = 0};
    struct guarded_signals sig = {.energy_J_q24 = 0};
    uint32_t raw = 0;
    unsigned astray = 0;
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t k = g->tick;
        int32_t jump;
        struct exh_drive_out out;
        if (k == 0 || k == GOLDEN_AGAIN) {
            d.guarded = guarded;
            scene_setup(&d, &r, rate_Hz, k);
            golden_wave(&moves, name, rate_Hz, 1 + (k > 0), -most_cnt(&d), most_cnt(&d),
                most_cnt(&d) < 1024 ? 1 : most_cnt(&d) >> 10);
            raw = (uint32_t)(golden_u64(&r) & UINT32_MAX);
            in.drive.din = HEALTHY;
            sig.drop.i_des_A_q26 = 0;
        }
        jump = most_cnt(&d);
        raw += (uint32_t)(k >= 8 && k < 56 ? moves.at[k] >> 3 : moves.at[k]);
        if (k >= 180 && k < GOLDEN_AGAIN) {
            raw += (uint32_t)golden_draw(&r, -2 * (int64_t)jump, 2 * (int64_t)jump);
        }
        in.drive.enc_raw[0] = raw;
        any_in(&in, &r, k, &d);
        in.drive.mon_raw[0] = golden_monitor(&astray, &d.par.drop.drive, &r, sig.drop.i_des_A_q26);
        golden_put(g, raw);
        golden_put(g, in.drive.mon_raw[0]);
        golden_put(g, in.drive.din);
        golden_put(g, in.drive.supply_raw);
        golden_put(g, in.missed);
        golden_put(g, in.command);
        if (guarded) {
            guarded_tick(&d.s, &d.cfg, &in, &out, &sig);
        } else {
            drop_tick(&d.s.drop, &d.cfg.drop, &in, &out, &sig.drop);
        }
        put_out(g, &sig, guarded, &out);
        put_state(g, &d.s.drop);
        if (guarded) { GOLDEN_STATE(g, exh_passivity_serialize, &d.s.passivity); }
        golden_tick(g);
    }
}

void golden_drop(struct golden *g, uint32_t rate_Hz) { play(g, rate_Hz, "drop", 0); }

void golden_guarded(struct golden *g, uint32_t rate_Hz) { play(g, rate_Hz, "guarded", 1); }
