/* SPDX-License-Identifier: MIT */
/* PROVES: staging of gains
 * Any rule that set-up accepts, a table of four groups with anything in its rows and both arrays,
 * any id, instance and value. Values are staged or refused, looked up, led and dropped, and all
 * walls take a step.
 *
 * EVA: -eva-slevel 10 -eva-min-loop-unroll 8
 * PLANT: lib/src/law/gains.c: k < 0 || b < 0 || exh_gains_ok -> k < 0 || exh_gains_ok
 * PLANT: lib/src/law/gains.c: row != NULL ? p->staged[i] : 0; -> p->staged[i];
 * PLANT: lib/src/law/gains.c: if (instance != NULL) { *instance = n; } -> *instance = n;
 * PLANT: lib/src/law/gains.c: if (b < 0) { continue; } -> (void)0;
 */
#include "num/bytes.c"
#include "num/fix.c"
#include "law/gains.c"
#include "num/authority.c"
#include "num/params.c"
#include "num/signal.c" /* not that of Frama-C */

#include "table.h"

static struct exh_params p;
static int32_t active[TABLE_VALUES], staged[TABLE_VALUES];
static struct exh_gains_par rule;

static void any_params(void)
{
    any_rows();
    exh_params_setup(&p, &table, active, staged);
    ANY(active);
    ANY(staged);
    p.locked = any8();
    p.pending = any8();
    p.moving = any8();
    p.shift = any8();
    p.sum = any_u32();
    p.passed = any_u32();
    p.at = any_u32();
}

static void any_rule(void)
{
    ANY(rule);
    rule.knots = EXH_GAINS_KNOTS;
    rule.k_min_Npm_q10 = Frama_C_interval(0, EXH_K_MAX_NPM_Q10);
    for (int32_t i = 0; i < EXH_GAINS_KNOTS; i++) {
        rule.b_Nspm_q20[i] = Frama_C_interval(0, EXH_B_MAX_NSPM_Q20);
        rule.k_Npm_q10[i] = Frama_C_interval(0, EXH_K_MAX_NPM_Q10);
    }
}

/* Staged and active values of walls are within their rows, or the guard reports them. */
static void any_pairs(void)
{
    for (unsigned i = 0; i < TABLE_VALUES; i++) {
        active[i] = Frama_C_interval(0, EXH_B_MAX_NSPM_Q20);
        staged[i] = Frama_C_interval(0, EXH_B_MAX_NSPM_Q20);
    }
}

int main(void)
{
    uint16_t instance = 0;
    struct exh_authority who;
    ANY(who);
    any_rule();
    any_params();
    (void)exh_gains_stage(&p, &rule, (uint16_t)any_u32(), (uint16_t)any_u32(), any32());
    for (uint32_t i = 0; i <= TABLE_VALUES; i++) {
        (void)exh_gains_stage_by(&p, &rule, who, i, any32());
    }
    (void)exh_gains_validate(&p, &rule, &instance);
    (void)exh_gains_validate(&p, &rule, NULL);
    exh_gains_enable(&p, any32());
    any_pairs();
    exh_gains_step(&p, &rule);
    exh_params_discard(&p);
    END();
    return 0;
}
