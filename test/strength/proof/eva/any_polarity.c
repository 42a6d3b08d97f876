/* SPDX-License-Identifier: MIT */
/* PROVES: arming's pull
 * The small pull of arming: any state, any constants, any count: no force above what was asked for.
 *
 * PLANT: lib/src/safe/polarity.c: exh_clamp(force, 0, cfg->pull_N_q20) -> (int32_t)force
 */
#include "safe/polarity.c"

#include "any.h"

int main(void)
{
    static struct exh_polarity s;
    static struct exh_polarity_cfg cfg;
    int32_t force;
    ANY(s);
    ANY(cfg);
    cfg.pull_N_q20 = Frama_C_interval(0, PULL_MAX_N_Q20);
    (void)exh_polarity_step(&s, &cfg, any8(), any32());
    force = exh_polarity_force_N_q20(&s, &cfg);
    /*@ assert little: 0 <= force <= 1048576; */
    END();
    return 0;
}
