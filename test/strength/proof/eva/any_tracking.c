/* SPDX-License-Identifier: MIT */
/* PROVES: current tracking
 * Any state, any tolerance in range, any monitor, any code.
 *
 * WP: A monitor within the band restarts the count. Any other raises it, and the fault is raised
 * at its limit. The band holds the coded current.
 *
 * PLANT: lib/src/act/tracking.c: (int64_t)s->hi_A_q26 + cfg->tol_A_q26 -> s->hi_A_q26 + cfg->tol_A_q26
 */
#include "act/tracking.c"

#include "any.h"

int main(void)
{
    static struct exh_tracking s;
    static struct exh_tracking_cfg cfg;
    int off;
    ANY(s);
    cfg.tol_A_q26 = Frama_C_interval(TOL_MIN_A_Q26, TOL_MAX_A_Q26);
    cfg.ticks = Frama_C_unsigned_int_interval(5, UINT32_MAX);
    off = exh_tracking_step(&s, &cfg, any32());
    /*@ assert says: off == 0 || off == 1; */
    exh_tracking_update(&s, any32());
    END();
    return 0;
}
