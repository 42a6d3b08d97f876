/* SPDX-License-Identifier: MIT */
/* Parameters, guard, self-test and calibrations, as called.h. The table's rows are the library's; how many there are is counted. */
#ifndef PROOF_CALLED_PARAMS_H
#define PROOF_CALLED_PARAMS_H

#include "called.h"

#include "num/signal.c" /* not that of Frama-C */

#include "exhand/run/calib_set.h"

void exh_params_setup(
    struct exh_params *p, const struct exh_signal_table *t, int32_t *active, int32_t *staged)
{
    static const struct exh_params none;
    *p = none;
    p->table = t;
    p->active = active;
    p->staged = staged;
    p->count = exh_signal_count(t);
    /*@ assert params_init: params(p); */
    Frama_C_make_unknown((char *)active, p->count * sizeof *active);
    Frama_C_make_unknown((char *)staged, p->count * sizeof *staged);
}

void exh_params_slew_setup(
    struct exh_params *p, const struct exh_tune_par *par, struct exh_period T)
{
    (void)T;
    /*@ assert params_slew: params(p) && \valid_read(par); */
    p->shift = (uint8_t)Frama_C_unsigned_int_interval(0, EXH_TUNE_SHIFT_MAX);
}

/* Values stay any within what set-ups have taken: the rows' ranges are theirs. */
int exh_params_stage(struct exh_params *p, uint16_t id, uint16_t instance, int32_t raw)
{
    (void)id;
    (void)instance;
    (void)raw;
    /*@ assert params_stage: params(p); */
    p->pending = any8();
    return REFUSED() ? -EXH_E_RANGE : 0;
}

/* --- a rule of gains --- */

int exh_gains_setup(const struct exh_gains_par *r, struct exh_period T)
{
    (void)T;
    /*@ assert gains_setup: \valid_read(r); */
    if (REFUSED()) { return -EXH_E_RANGE; }
    /*@ admit rule(r); */
    return 0;
}

int exh_gains_ok(const struct exh_gains_par *r, int32_t k_Npm_q10, int32_t b_Nspm_q20)
{
    (void)k_Npm_q10;
    (void)b_Nspm_q20;
    /*@ assert gains_ok: rule(r); */
    return any8() & 1;
}

int exh_gains_stage(struct exh_params *p, const struct exh_gains_par *r, uint16_t id,
    uint16_t instance, int32_t raw)
{
    /*@ assert gains_stage: params(p) && rule(r); */
    return exh_params_stage(p, id, instance, raw);
}

int exh_gains_validate(
    const struct exh_params *p, const struct exh_gains_par *r, uint16_t *instance)
{
    /*@ assert gains_staged: params(p) && rule(r) && (instance == \null || \valid(instance)); */
    return REFUSED() ? -EXH_E_GAINS : 0;
}

void exh_gains_enable(struct exh_params *p, int on)
{
    (void)on;
    /*@ assert gains_lead: params(p); */
    ANY(p->led);
}

void exh_gains_step(struct exh_params *p, const struct exh_gains_par *r)
{
    /*@ assert gains_step: params(p) && rule(r); */
    p->moving = any8();
}

int exh_gains_scale(struct exh_gains_par *r, struct exh_period T)
{
    (void)T;
    /*@ assert gains_scale: \valid(r); */
    ANY(*r);
    if (REFUSED()) { return -EXH_E_RANGE; }
    /*@ admit scaled: rule(r); */
    return 0;
}

int32_t exh_gains_k_max(const struct exh_gains_par *r, int32_t b_Nspm_q20)
{
    (void)b_Nspm_q20;
    /*@ assert gains_k_max: rule(r); */
    return Frama_C_interval(0, 1024000000);
}

/* --- with authority --- */

int exh_params_stage_by(struct exh_params *p, struct exh_authority who, uint32_t i, int32_t raw)
{
    (void)who;
    (void)i;
    (void)raw;
    /*@ assert params_stage_by: params(p); */
    p->pending = any8();
    p->by = any8();
    return REFUSED() ? -EXH_E_STATE : 0;
}

int exh_gains_stage_by(struct exh_params *p, const struct exh_gains_par *r,
    struct exh_authority who, uint32_t i, int32_t raw)
{
    /*@ assert gains_stage_by: params(p) && rule(r); */
    return exh_params_stage_by(p, who, i, raw);
}

/* --- guard, self-test, calibrations --- */

void exh_integrity_seal(
    struct exh_integrity *g, const void *area, size_t len_B, struct exh_params *p)
{
    const struct exh_integrity sealed = {area, (uint32_t)len_B, 0, any_u32(), 0, p, 0};
    *g = sealed;
    /*@ assert guard_seal: guard(g); */
}

int exh_integrity_step(struct exh_integrity *g)
{
    /*@ assert guard_step: guard(g); */
    g->at = g->len_B > 0 ? Frama_C_unsigned_int_interval(0, g->len_B - 1) : 0;
    g->crc = any_u32();
    g->broken |= any8() & 1;
    return g->broken;
}

int exh_selftest(void) { return any8(); }

int exh_calib_set_load(struct exh_scene_calib *k, struct exh_params *p,
    const struct exh_calib_set_par *par, uint32_t fingers)
{
    (void)fingers;
    /*@ assert exh_calib_set_load: \valid(k) && params(p) && \valid_read(par); */
    return REFUSED() ? -EXH_E_VERSION : 0;
}

int exh_calib_set_tables(struct exh_calib_tables *t, struct exh_scene_calib *k,
    const struct exh_calib_set_par *par, const struct exh_calib_finger *of)
{
    (void)k;
    /*@ assert exh_calib_set_tables: \valid(t) && \valid_read(par) && of->f < 5 && \valid_read(of->drive); */
    if (REFUSED()) { return -EXH_E_STALE; }
    ANY(*t);
    t->to_cur_n = (uint8_t)Frama_C_unsigned_int_interval(2, EXH_CALIB_POINTS_MAX + 2);
    t->to_force_n = (uint8_t)Frama_C_unsigned_int_interval(2, 2 * EXH_CALIB_POINTS_MAX + 3);
    return 0;
}

#endif
