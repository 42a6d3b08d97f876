/* SPDX-License-Identifier: MIT */
/* PROVES: arming's pull
 * The small pull of arming: any state, constants and count. No force exceeds the requested one.
 * Set-up with any parameters.
 *
 * PLANT: lib/src/safe/polarity.c: exh_clamp(force, 0, cfg->pull_N_q20) -> (int32_t)force
 */
#include "num/bytes.c"
#define exh_udiv64 udiv64_by_steps
#include "num/fix.c"
#undef exh_udiv64
#include "quotient.h"
#include "safe/polarity.c"

#include "any.h"

static void setup(struct exh_period T)
{
    static struct exh_polarity_cfg made;
    struct exh_polarity_par par;
    ANY(par);
    made.rest_ticks = REST_MIN_TICKS; /* set, or as it was */
    if (exh_polarity_setup(&made, &par, any32(), T) == 0) {
        /*@ assert taken: 0 <= made.pull_N_q20 <= 1048576 && 4 <= made.rest_ticks; */
    }
}

int main(void)
{
    static struct exh_polarity s;
    static struct exh_polarity_cfg cfg;
    int32_t force;
    setup((struct exh_period){1, Frama_C_unsigned_int_interval(1, 20020)});
    setup((struct exh_period){1000, Frama_C_unsigned_int_interval(1000, 20020000)});
    FROM_BYTES(s, exh_polarity_serialize);
    ANY(cfg);
    cfg.pull_N_q20 = Frama_C_interval(0, PULL_MAX_N_Q20);
    (void)exh_polarity_step(&s, &cfg, any8(), any32());
    force = exh_polarity_force_N_q20(&s, &cfg);
    /*@ assert little: 0 <= force <= 1048576; */
    END();
    return 0;
}
