/* SPDX-License-Identifier: MIT */
/* The library's functions as a scene calls them: each asks for what its own proof takes for granted, and leaves anything within what
 * that proof shows (contract.h). What a function only reads stays a pointer that must be one. */
#ifndef PROOF_CALLED_H
#define PROOF_CALLED_H

#include "contract.h"

#include "exhand/error.h"

/*@ predicate gate_cfg(struct exh_drive_cfg *c) = \valid_read(c->par) && 0 <= c->par->dac_zero_raw <= 65535 &&
      0 <= c->par->dac_span_raw <= 32767 && gain(&c->dac_A_q26); */

#define REFUSED() (any8() & 1)

static uint32_t any_limits(void)
{
    return Frama_C_unsigned_int_interval(0, (1u << EXH_LIMITS) - 1);
}

static uint32_t any_causes(void)
{
    return Frama_C_unsigned_int_interval(0, (1u << EXH_FAULTS) - 1);
}

/* --- position and velocity --- */

int exh_quad_setup(
    struct exh_quad_cfg *cfg, const struct exh_quad_par *par, struct exh_period T, unsigned bits)
{
    struct exh_quad_cfg made;
    (void)T;
    (void)bits;
    /*@ assert quad_setup: \valid_read(par); */
    if (REFUSED()) { return -EXH_E_RANGE; }
    ANY(made);
    /*@ admit quad_cfg(&made); */
    made.par = par;
    *cfg = made;
    return 0;
}

int32_t exh_quad_step(struct exh_quad *s, const struct exh_quad_cfg *cfg, uint32_t raw)
{
    (void)raw;
    /*@ assert quad_extend: quad_cfg(cfg); */
    ANY(*s);
    return s->cnt;
}

int32_t exh_quad_pos_m_q30(const struct exh_quad_par *par, int32_t cnt)
{
    (void)cnt;
    /*@ assert quad_pos: \valid_read(par); */
    return any32();
}

void exh_quad_serialize(struct exh_bytes *c, struct exh_quad *s)
{
    (void)c;
    ANY(*s);
}

int exh_velocity_window_setup(struct exh_velocity_window_cfg *cfg, struct exh_velocity_scale scale,
    const struct exh_velocity_par *par)
{
    struct exh_velocity_window_cfg made;
    (void)scale;
    /*@ assert velocity_setup: \valid_read(par); */
    if (REFUSED()) { return -EXH_E_RANGE; }
    ANY(made);
    /*@ admit velocity_cfg(&made); */
    *cfg = made;
    return 0;
}

int32_t exh_velocity_window_step(
    struct exh_velocity_window *s, const struct exh_velocity_window_cfg *cfg, int32_t cnt)
{
    (void)cnt;
    /*@ assert velocity_tick: velocity(s) && velocity_cfg(cfg); */
    *s = any_velocity();
    return any32();
}

void exh_velocity_window_serialize(struct exh_bytes *c, struct exh_velocity_window *s)
{
    (void)c;
    *s = any_velocity();
}

/* --- law and force --- */

int32_t exh_contact_wall(struct exh_contact *s, int32_t pos_m_q30, int32_t lim_m_q30)
{
    (void)pos_m_q30;
    (void)lim_m_q30;
    /*@ assert law: contact(s); */
    s->turn_m_q30 = any32();
    s->started = any8();
    return any32();
}

void exh_contact_step_free(struct exh_contact *s, const struct exh_contact_par *par,
    int32_t pos_m_q30, struct exh_force_ledger *f)
{
    (void)pos_m_q30;
    /*@ assert law_free: contact(s) && contact_par(par); */
    *s = any_contact();
    *f = any_law_ledger();
}

void exh_contact_serialize(struct exh_bytes *c, struct exh_contact *s)
{
    (void)c;
    *s = any_contact();
}

int exh_table_setup(struct exh_knot *knot, unsigned n)
{
    /*@ assert table_set: \valid(knot + (0 .. n - 1)); */
    for (unsigned k = 0; k < n; k++) { knot[k].slope = any_gain(); }
    return REFUSED() ? -EXH_E_MONOTONE : 0;
}

int exh_drive_setup(struct exh_drive_cfg *cfg, const struct exh_drive_par *par, struct exh_period T,
    struct exh_table force_to_cur, struct exh_table cur_to_force)
{
    struct exh_drive_cfg made;
    (void)T;
    /*@ assert drive_setup: \valid_read(par) && table(&force_to_cur) && table_or_none(&cur_to_force); */
    if (REFUSED()) { return -EXH_E_RANGE; }
    /*@ admit drive_par(par); */
    ANY(made);
    /*@ admit drive_made(&made); */
    made.par = par;
    made.force_to_cur = force_to_cur;
    made.cur_to_force = cur_to_force;
    *cfg = made;
    return 0;
}

uint32_t exh_drive_force_within(struct exh_drive *s, const struct exh_drive_cfg *cfg,
    const struct exh_permit *p, struct exh_drive_most own, struct exh_force_ledger *f)
{
    struct exh_force_ledger out = *f;
    /*@ assert drive_force: drive(s) && drive_cfg(cfg) && permit(p) && asked(f); */
    /*@ assert drive_most: 0 <= own.f_max_N_q20 <= 104857600 && 1 <= own.slew_up_Nps <= 10000000; */
    *s = any_drive();
    out.clamp_N_q20 = any64();
    out.slew_N_q20 = any64();
    out.release_N_q20 = any64();
    out.force_N_q20 = Frama_C_interval(0, 104857600);
    *f = out;
    return any_limits();
}

uint32_t exh_drive_current_step(struct exh_drive *s, const struct exh_drive_cfg *cfg,
    const struct exh_force_ledger *f, struct exh_current_ledger *i)
{
    /*@ assert drive_current: drive(s) && drive_cfg(cfg) && force(f); */
    *s = any_drive();
    ANY(*i);
    return any_limits();
}

int32_t exh_drive_monitor_A_q26(const struct exh_drive_cfg *cfg, int16_t mon_raw)
{
    (void)mon_raw;
    /*@ assert drive_monitor_A: drive_cfg(cfg); */
    return any32();
}

int32_t exh_drive_monitor_N_q20(const struct exh_drive_cfg *cfg, int32_t mon_A_q26)
{
    (void)mon_A_q26;
    /*@ assert drive_monitor_N: drive_cfg(cfg); */
    return any32();
}

void exh_drive_serialize(struct exh_bytes *c, struct exh_drive *s)
{
    (void)c;
    *s = any_drive();
}

/* --- energy --- */

int exh_table_invert(struct exh_knot *dst, const struct exh_knot *src, unsigned n)
{
    /*@ assert table_invert: \valid(dst + (0 .. n - 1)) && \valid_read(src + (0 .. n - 1)); */
    Frama_C_make_unknown((char *)dst, n * sizeof *dst);
    return REFUSED() ? -EXH_E_RANGE : 0;
}

int exh_passivity_setup(struct exh_passivity_cfg *cfg, const struct exh_passivity_par *par,
    const struct exh_drive_cfg *drive, struct exh_table held, struct exh_velocity_scale scale,
    int32_t speed_mps_q27)
{
    struct exh_passivity_cfg made;
    (void)scale;
    (void)speed_mps_q27;
    /*@ assert passivity_setup: \valid_read(par) && drive_cfg(drive) && table(&held); */
    if (REFUSED()) { return -EXH_E_RANGE; }
    ANY(made);
    /*@ admit passivity_made(&made); */
    made.par = par;
    made.drive = drive->par;
    made.held = held;
    *cfg = made;
    return 0;
}

uint32_t exh_passivity_step(struct exh_passivity *s, const struct exh_passivity_cfg *cfg,
    int32_t cnt, int touching, struct exh_force_ledger *f)
{
    (void)cnt;
    (void)touching;
    /*@ assert passivity_step: passivity(s) && passivity_cfg(cfg) && law_ledger(f); */
    *s = any_passivity();
    f->passivity_N_q20 = Frama_C_long_long_interval(INT64_MIN, 0);
    return any_limits();
}

void exh_passivity_update(struct exh_passivity *s, const struct exh_passivity_cfg *cfg,
    const struct exh_force_ledger *f, int32_t coded_A_q26)
{
    (void)coded_A_q26;
    /*@ assert passivity_held: passivity(s) && passivity_cfg(cfg) && pullback(f) && \initialized(&f->force_N_q20); */
    *s = any_passivity();
}

int32_t exh_passivity_J_q24(const struct exh_passivity *s, const struct exh_passivity_cfg *cfg)
{
    /*@ assert passivity_J: passivity(s) && passivity_cfg(cfg); */
    return any32();
}

void exh_passivity_serialize(struct exh_bytes *c, struct exh_passivity *s)
{
    (void)c;
    *s = any_passivity();
}

/* --- what watches --- */

int exh_motion_setup(
    struct exh_motion_cfg *cfg, const struct exh_motion_par *par, struct exh_period T)
{
    struct exh_motion_cfg made;
    (void)T;
    /*@ assert watch_setup: \valid_read(par); */
    if (REFUSED()) { return -EXH_E_RANGE; }
    /*@ admit watch_par(par); */
    ANY(made);
    made.par = par;
    *cfg = made;
    return 0;
}

uint32_t exh_motion_step(
    struct exh_motion *s, const struct exh_motion_cfg *cfg, int32_t *vel_mps_q27, uint32_t *limits)
{
    /*@ assert watch_step: watch_cfg(cfg) && limits(*limits) && \initialized(vel_mps_q27); */
    ANY(*s);
    *vel_mps_q27 = Frama_C_interval(-1342177280, 1342177280);
    *limits = any_limits();
    return Frama_C_unsigned_int_interval(0, EXH_FAULT_SPEED | EXH_FAULT_STUCK);
}

void exh_motion_update(
    struct exh_motion *s, const struct exh_motion_cfg *cfg, int32_t cnt, int32_t coded_A_q26)
{
    (void)cnt;
    (void)coded_A_q26;
    /*@ assert watch_coded: watch_cfg(cfg); */
    ANY(*s);
}

void exh_motion_serialize(struct exh_bytes *c, struct exh_motion *s)
{
    (void)c;
    ANY(*s);
}

int exh_chatter_setup(struct exh_chatter_cfg *cfg, const struct exh_chatter_par *par,
    const struct exh_drive_cfg *drive, struct exh_velocity_scale scale)
{
    struct exh_chatter_cfg made;
    (void)scale;
    /*@ assert chatter_setup: \valid_read(par) && table(&drive->force_to_cur); */
    if (REFUSED()) { return -EXH_E_RANGE; }
    ANY(made);
    /*@ admit chatter_cfg(&made); */
    *cfg = made;
    return 0;
}

uint32_t exh_chatter_step(const struct exh_chatter *s, const struct exh_chatter_cfg *cfg)
{
    /*@ assert chatter_step: chatter(s) && chatter_cfg(cfg); */
    return any8() & 1 ? EXH_FAULT_CHATTER : 0u;
}

void exh_chatter_update(
    struct exh_chatter *s, const struct exh_chatter_cfg *cfg, int32_t cnt, int32_t coded_A_q26)
{
    (void)cnt;
    (void)coded_A_q26;
    /*@ assert chatter_update: chatter(s) && chatter_cfg(cfg); */
    *s = any_chatter();
}

void exh_chatter_serialize(struct exh_bytes *c, struct exh_chatter *s)
{
    (void)c;
    *s = any_chatter();
}

int exh_polarity_setup(struct exh_polarity_cfg *cfg, const struct exh_polarity_par *par,
    int32_t step_m_q42, struct exh_period T)
{
    (void)step_m_q42;
    (void)T;
    /*@ assert polarity_setup: \valid_read(par); */
    ANY(*cfg);
    return REFUSED() ? -EXH_E_RANGE : 0;
}

uint8_t exh_polarity_step(
    struct exh_polarity *s, const struct exh_polarity_cfg *cfg, int pulls, int32_t cnt)
{
    (void)pulls;
    (void)cnt;
    /*@ assert polarity_step: \valid_read(cfg); */
    ANY(*s);
    return any8();
}

int32_t exh_polarity_force_N_q20(const struct exh_polarity *s, const struct exh_polarity_cfg *cfg)
{
    /*@ assert polarity_force: \valid_read(s) && \valid_read(cfg); */
    return any32();
}

void exh_polarity_serialize(struct exh_bytes *c, struct exh_polarity *s)
{
    (void)c;
    ANY(*s);
}

int exh_supply_setup(
    struct exh_supply_cfg *cfg, const struct exh_supply_par *par, struct exh_period T)
{
    (void)T;
    /*@ assert supply_setup: \valid_read(par); */
    ANY(*cfg);
    return REFUSED() ? -EXH_E_RANGE : 0;
}

int exh_supply_step(
    struct exh_supply *s, const struct exh_supply_cfg *cfg, int16_t raw, uint32_t missed)
{
    (void)raw;
    (void)missed;
    /*@ assert supply_step: \valid_read(cfg); */
    ANY(*s);
    return any8() & 1;
}

void exh_supply_serialize(struct exh_bytes *c, struct exh_supply *s)
{
    (void)c;
    ANY(*s);
}

int exh_tracking_setup(
    struct exh_tracking_cfg *cfg, const struct exh_tracking_par *par, struct exh_period T)
{
    struct exh_tracking_cfg made;
    (void)T;
    /*@ assert track_setup: \valid_read(par); */
    if (REFUSED()) { return -EXH_E_RANGE; }
    ANY(made);
    /*@ admit track_cfg(&made); */
    *cfg = made;
    return 0;
}

int exh_tracking_step(struct exh_tracking *s, const struct exh_tracking_cfg *cfg, int32_t mon_A_q26)
{
    (void)mon_A_q26;
    /*@ assert track_step: track_cfg(cfg); */
    ANY(*s);
    return any8() & 1;
}

void exh_tracking_update(struct exh_tracking *s, int32_t coded_A_q26)
{
    (void)coded_A_q26;
    ANY(*s);
}

void exh_tracking_serialize(struct exh_bytes *c, struct exh_tracking *s)
{
    (void)c;
    ANY(*s);
}

int exh_safety_setup(
    struct exh_safety_cfg *cfg, const struct exh_safety_par *par, struct exh_period T)
{
    struct exh_safety_cfg made;
    (void)T;
    /*@ assert safety_setup: \valid_read(par); */
    if (REFUSED()) { return -EXH_E_RANGE; }
    ANY(made);
    /*@ admit safety_cfg(&made); */
    *cfg = made;
    return 0;
}

struct exh_permit exh_safety_step(
    struct exh_safety *s, const struct exh_safety_cfg *cfg, struct exh_safety_in in)
{
    /*@ assert safety_step: safety(s) && safety_cfg(cfg) && 1 <= in.fingers <= 5 && causes(in.raised); */
    *s = any_safety();
    s->state = (uint8_t)Frama_C_unsigned_int_interval(0, 5);
    s->fingers = in.fingers;
    s->present = any_causes();
    return any_permit();
}

uint8_t exh_safety_arm_step(const struct exh_safety *s)
{
    /*@ assert safety_arm: \valid_read(s); */
    return any8();
}

void exh_gate_shut(struct exh_safety *s, uint16_t dac_zero_raw, struct exh_drive_out *out)
{
    (void)dac_zero_raw;
    s->alive = any8();
    ANY(*out);
    out->enable = 0;
}

void exh_gate_step(struct exh_safety *s, const struct exh_drive_cfg *cfg, unsigned n,
    struct exh_current_ledger *i, uint32_t *limits, struct exh_drive_out *out)
{
    /*@ assert gate_fingers: 1 <= n <= 5 && n <= s->fingers; */
    for (unsigned k = 0; k < n; k++) {
        /*@ assert gate_cfg: gate_cfg(&cfg[k]) && limits(limits[k]) && asked_current(&i[k]); */
        ANY(i[k]);
        limits[k] = any_limits();
    }
    ANY(*out);
    out->enable = (uint8_t)(any8() & ((1u << n) - 1u));
    s->alive = any8();
    s->limits = any_u32();
    ANY(s->off_raw);
}

void exh_safety_serialize(struct exh_bytes *c, struct exh_safety *s)
{
    (void)c;
    *s = any_safety();
}

#endif
