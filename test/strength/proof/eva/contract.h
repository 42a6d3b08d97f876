/* SPDX-License-Identifier: MIT */
/* Inputs and results of the library's functions of a tick: any value within a predicate.
 * any_contract.c proves that the functions keep to these. For the proof of a scene, called.h
 * replaces the functions and demands the same of the scene. */
#ifndef PROOF_CONTRACT_H
#define PROOF_CONTRACT_H

#include "any.h"

#include "exhand/exhand.h"

/*@ predicate gain(struct exh_gain *g) = 0 <= g->mant && g->shift <= 62;
    predicate fall(struct exh_gain *g) = 0 <= g->mant && 31 <= g->shift <= 62;
    predicate bit(integer v) = 0 <= v <= 1;
    predicate limits(integer v) = 0 <= v < 1 << 12;
    predicate causes(integer v) = 0 <= v < 1 << 16;
    predicate table(struct exh_table *t) = 2 <= t->n && \valid_read(t->knot + (0 .. t->n - 1));
    predicate table_or_none(struct exh_table *t) = t->n == 0 || table(t); */

/*@ predicate quad_cfg(struct exh_quad_cfg *c) = 0 <= c->jump_cnt < 1 << 30 && c->unused <= 16;
    predicate velocity_cfg(struct exh_velocity_window_cfg *c) = gain(&c->gain);
    predicate velocity(struct exh_velocity_window *s) = s->at < 16; */

/*@ predicate contact_par(struct exh_contact_par *p) = 0 <= p->k_Npm_q10 <= 1024000000 && 0 <= p->b_Nspm_q20 <= 1048576000 &&
      0 <= p->f0_N_q20 <= 20971520 && 0 <= p->f0_band_m_q30 <= 10737418 && 0 <= p->hyst_m_q30 <= 10737418;
    predicate contact(struct exh_contact *s) = bit(s->inward) && bit(s->touching);
    predicate law_ledger(struct exh_force_ledger *f) = -(1 << 44) <= f->spring_N_q20 <= 1 << 44 &&
      -(1 << 44) <= f->damper_N_q20 <= 1 << 44 && 0 <= f->pullback_N_q20 <= 20971520 && f->passivity_N_q20 == 0; */

/*@ predicate drive_par(struct exh_drive_par *p) = 0 <= p->f_max_N_q20 <= 104857600 && 1 <= p->slew_up_Nps <= 10000000 &&
      1000 <= p->slew_down_Nps <= 10000000 && 6710886 <= p->i_peak_A_q26 <= 442918502 && 0 <= p->i_cont_A_q26 <= 221459251 &&
      0 <= p->dac_zero_raw <= 65535 && 0 <= p->dac_span_raw <= 32767 && -32768 <= p->mon_zero_raw <= 32767 &&
      131072 <= p->person_N_q20 <= 104857600 && 0 <= p->person_A_q26 <= 442918502;
    predicate drive_made(struct exh_drive_cfg *c) = 1 <= c->f_top_N_q20 && 0 <= c->i_top_A_q26 <= 442918502 &&
      0 <= c->i_whole_A_q26 <= 442918502 &&
      2 <= c->top_limit <= 2048 && gain(&c->tick_N_q20) && gain(&c->i2t_fold) &&
      gain(&c->dac_A_q26) && 0 <= c->i2t_budget_q32 <= 1 << 60 && c->i2t_shift <= 62;
    predicate drive_cfg(struct exh_drive_cfg *c) = \valid_read(c->par) && drive_par(c->par) && table(&c->force_to_cur) &&
      table_or_none(&c->cur_to_force) && drive_made(c);
    predicate drive(struct exh_drive *s) = 0 <= s->force_N_q20 <= 104857600 && 0 <= s->fall_N_q20 <= 104857601 &&
      0 <= s->i2t_q32 <= 4611686018427387903;
    predicate asked(struct exh_force_ledger *f) = \initialized(&f->spring_N_q20) && \initialized(&f->damper_N_q20) &&
      \initialized(&f->pullback_N_q20) && \initialized(&f->passivity_N_q20);
    predicate asked_current(struct exh_current_ledger *i) = \initialized(&i->table_A_q26) && \initialized(&i->peak_A_q26) &&
      \initialized(&i->i2t_A_q26);
    predicate force(struct exh_force_ledger *f) = 0 <= f->force_N_q20 <= 104857600; */

/*@ predicate chatter_cfg(struct exh_chatter_cfg *c) = 0 <= c->energy_Acnt_q20 <= 1 << 58 && 0 <= c->leak_Acnt_q20 <= 1 << 58 &&
      9 <= c->ticks <= 1100;
    predicate chatter(struct exh_chatter *s) = -(1 << 58) <= s->net_Acnt_q20 <= 1 << 58 &&
      -(1 << 60) <= s->cycle_Acnt_q20 <= 1 << 60 && bit(s->rises); */

/*@ predicate track_cfg(struct exh_tracking_cfg *c) = 6710886 <= c->tol_A_q26 <= 67108864 && 5 <= c->ticks;
    predicate watch_par(struct exh_motion_par *p) = 13421772 <= p->speed_mps_q27 <= 1342177280;
    predicate watch_cfg(struct exh_motion_cfg *c) = \valid_read(c->par) && watch_par(c->par);
    predicate speed(int32_t *vel_mps_q27) = -1342177280 <= *vel_mps_q27 <= 1342177280; */

/*@ predicate safety_cfg(struct exh_safety_cfg *c) = 1 <= c->ramp_q30 <= 1 << 30 && 3 <= c->release_ticks <= 1023 && fall(&c->fall);
    predicate safety(struct exh_safety *s) = 0 <= s->share_q30 <= 1 << 30;
    predicate safety_after(struct exh_safety *s) = safety(s) && s->state < 6 && causes(s->present);
    predicate permit(struct exh_permit *p) = p->mode <= 2 && 0 <= p->share_q30 <= 1 << 30 && 1 <= p->ticks && fall(&p->fall); */

/*@ predicate passivity_made(struct exh_passivity_cfg *c) = 1 <= c->f_top_N_q20 && 1 <= c->step_m_q42 && c->shift <= 20 &&
      gain(&c->share);
    predicate passivity_cfg(struct exh_passivity_cfg *c) = \valid_read(c->par) && \valid_read(c->drive) && drive_par(c->drive) &&
      table(&c->held) && passivity_made(c);
    predicate passivity(struct exh_passivity *s) = -1152921504606846976 <= s->energy_Ncnt_q20 <= 1152921504606846976 &&
      0 <= s->held_N_q20 && 0 <= s->late_N_q20;
    predicate pullback(struct exh_force_ledger *f) = 0 <= f->pullback_N_q20 <= 20971520;
    predicate rule(struct exh_gains_par *r) = 2 <= r->knots <= 8 && 0 <= r->k_min_Npm_q10 <= 1024000000; */

/*@ predicate params(struct exh_params *p) = \valid_read(p->table) && \valid(p->active + (0 .. p->count - 1)) &&
      \valid(p->staged + (0 .. p->count - 1)) && p->shift <= 15;
    predicate guard(struct exh_integrity *g) = (g->len_B == 0 || (\valid_read(g->area + (0 .. g->len_B - 1)) && g->at < g->len_B)) &&
      (g->params == \null || params(g->params)); */

/* Any value within its predicate. Returned, not written: at a place that is one of several it joins what is there. */
static struct exh_gain any_gain(void)
{
    struct exh_gain g;
    ANY_GAIN(g);
    return g;
}

static struct exh_velocity_window any_velocity(void)
{
    struct exh_velocity_window s;
    ANY(s);
    /*@ admit velocity(&s); */
    return s;
}

static struct exh_contact any_contact(void)
{
    struct exh_contact s;
    ANY(s);
    /*@ admit contact(&s); */
    return s;
}

static struct exh_force_ledger any_law_ledger(void)
{
    struct exh_force_ledger f;
    ANY(f);
    /*@ admit law_ledger(&f); */
    return f;
}

static struct exh_drive any_drive(void)
{
    struct exh_drive s;
    ANY(s);
    /*@ admit drive(&s); */
    return s;
}

static struct exh_chatter any_chatter(void)
{
    struct exh_chatter s;
    ANY(s);
    /*@ admit chatter(&s); */
    return s;
}

static struct exh_safety any_safety(void)
{
    struct exh_safety s;
    ANY(s);
    /*@ admit safety(&s); */
    return s;
}

static struct exh_passivity any_passivity(void)
{
    struct exh_passivity s;
    ANY(s);
    /*@ admit passivity(&s); */
    return s;
}

static struct exh_permit any_permit(void)
{
    struct exh_permit p;
    ANY(p);
    /*@ admit permit(&p); */
    return p;
}

#endif
