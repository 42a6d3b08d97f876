/* SPDX-License-Identifier: MIT */
/* The rule of gains of this scene: the materials it accepts from any source. */
#include "bilateral.h"

#define K(v) EXH_Q(v, 1, EXH_Q_K)
#define B(v) EXH_Q(v, 1, EXH_Q_B)

/* Default: a rule for 2 kHz, scaled down for slower loops. The simulated hand comes to rest at its
 * corners from 90 Hz to 5 kHz (SAFETY.md). The paper's material for 2 kHz obeys it, and nearly
 * those of its other rates from 500 Hz. With little damping only soft springs are allowed. */
const struct exh_gains_par bilateral_rule = {
    EXH_Q(2000, 1, 8), 3, 0, {B(0), B(20), B(100)}, {K(5000), K(24000), K(24000)}};

int bilateral_gains_setup(
    struct exh_gains_par *rule, const struct bilateral_par *par, struct exh_period T)
{
    *rule = par->gains;
    if (par->own.rule_on == BILATERAL_RULE_SCALED) { return exh_gains_scale(rule, T); }
    return par->own.rule_on ? exh_gains_setup(rule, T) : 0;
}

/* Defaults must not be refused, but the rows' default is for 2 kHz. Lowers the damping to the
 * rule's last knot, and the stiffness to the largest allowed there. */
void bilateral_soften(const struct exh_gains_par *rule, struct exh_material_par *m)
{
    const int32_t first = rule->b_Nspm_q20[0], last = rule->b_Nspm_q20[rule->knots - 1];
    int32_t most;
    if (m->k_Npm_q10 != exh_material_rows[0].dflt || m->b_Nspm_q20 != exh_material_rows[1].dflt ||
        exh_gains_ok(rule, m->k_Npm_q10, m->b_Nspm_q20)) {
        return;
    }
    m->b_Nspm_q20 = exh_clamp32(m->b_Nspm_q20, first, last);
    most = exh_gains_k_max(rule, m->b_Nspm_q20);
    if (m->k_Npm_q10 > most) { m->k_Npm_q10 = most; }
    if (!exh_gains_ok(rule, m->k_Npm_q10, m->b_Nspm_q20)) { m->k_Npm_q10 = m->b_Nspm_q20 = 0; }
}

int bilateral_gains_stage(const struct bilateral_cfg *cfg, struct exh_params *params,
    struct exh_authority who, const struct exh_wire_param *ask)
{
    const int32_t i = exh_signal_find(params->table, ask->id, ask->instance);
    if (i < 0) { return (int)i; }
    return cfg->par->own.rule_on
               ? exh_gains_stage_by(params, &cfg->gains, who, (uint32_t)i, ask->value)
               : exh_params_stage_by(params, who, (uint32_t)i, ask->value);
}
