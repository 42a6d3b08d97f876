/* SPDX-License-Identifier: MIT */
#include "box/hand_rule.h"

#include "box/hand.h"
#include "base/option.h"

int hand_rule_complain(uint32_t rate_Hz, int err)
{
    struct bilateral_cfg *cfg;
    (void)bilateral_memory(&cfg);
    for (unsigned n = 0; err == -EXH_E_GAINS && n < BILATERAL_MATERIALS; n++) {
        const struct exh_material_par *m = &cfg->par->material[n];
        const struct exh_gains_par *rule = &cfg->gains;
        if (exh_gains_ok(rule, m->k_Npm_q10, m->b_Nspm_q20)) { continue; }
        cli_complain("material %u: mat_k %.6g, mat_b %.6g: outside the rule of gains at %.6g Hz "
                     "(mat_b %.6g .. %.6g; mat_k up to %.6g at this one): `exhand advise gains "
                     "--rule` makes another, --set rule_on=0 waives it",
            n, m->k_Npm_q10 / 1024.0, m->b_Nspm_q20 / 1048576.0, (double)rate_Hz,
            rule->b_Nspm_q20[0] / 1048576.0, rule->b_Nspm_q20[rule->knots - 1] / 1048576.0,
            exh_gains_k_max(rule, m->b_Nspm_q20) / 1024.0);
        return 1;
    }
    return 0;
}
