/* SPDX-License-Identifier: MIT */
/* PROVES: rule of gains
 * Set-up with any rule and any period. With each accepted rule and anything in its unused knots:
 * any k and b requested, and a step between any two pairs in range, with any shift.
 *
 * PLANT: lib/src/law/gains.c: for (int32_t i = 1; i < rule->knots; i++) -> for (int32_t i = 1; i <= rule->knots; i++)
 * PLANT: lib/src/law/gains.c: !exh_inside(rule->knots, 2, EXH_GAINS_KNOTS) -> !exh_inside(rule->knots, 2, EXH_GAINS_KNOTS + 1)
 * PLANT: lib/src/law/gains.c: (off < 0 ? -off : off) * 100 <= want -> (off < 0 ? -off : off) * 10000000 <= want
 * PLANT: lib/src/law/gains.c: return (int64_t)exh_wrap_diff(a, b) * exh_wrap_diff(c, d); -> return exh_wrap_diff(a, b) * exh_wrap_diff(c, d);
 */
#include "num/bytes.c"
#include "law/gains.c"
#include "num/authority.c"
#include "num/params.c"
#include "num/signal.c"

#include "any.h"

static struct exh_gains_par rule;

/* Unit fix shows what it leaves. */
int exh_gain_set(struct exh_gain *g, uint64_t num, uint64_t den)
{
    (void)num;
    (void)den;
    ANY_GAIN(*g);
    return Frama_C_interval(-1, 0);
}

static struct pair any_pair(void)
{
    struct pair p;
    p.k = Frama_C_interval(0, EXH_K_MAX_NPM_Q10);
    p.b = Frama_C_interval(0, EXH_B_MAX_NSPM_Q20);
    return p;
}

static void setup(void)
{
    const struct exh_period T = {any_u32(), any_u32()};
    ANY(rule);
    (void)exh_gains_setup(&rule, T);
}

static void ask(int32_t knots)
{
    struct exh_gains_par scaled;
    struct pair at;
    int ok;
    ANY(rule);
    rule.knots = knots;
    rule.k_min_Npm_q10 = Frama_C_interval(0, EXH_K_MAX_NPM_Q10);
    for (int32_t i = 0; i < knots; i++) {
        rule.b_Nspm_q20[i] = Frama_C_interval(0, EXH_B_MAX_NSPM_Q20);
        rule.k_Npm_q10[i] = Frama_C_interval(0, EXH_K_MAX_NPM_Q10);
    }
    (void)exh_gains_k_max(&rule, any32());
    ok = exh_gains_ok(&rule, any32(), any32());
    /*@ assert says: ok == 0 || ok == 1; */
    scaled = rule;
    scaled.rate_Hz_q8 = any32();
    (void)exh_gains_scale(&scaled, (struct exh_period){any_u32(), any_u32()});
    at = stepped(&rule, any_pair(), any_pair(), Frama_C_unsigned_int_interval(0, 31));
}

int main(void)
{
    setup();
    for (int32_t knots = 2; knots <= EXH_GAINS_KNOTS; knots++) { ask(knots); }
    END();
    return 0;
}
