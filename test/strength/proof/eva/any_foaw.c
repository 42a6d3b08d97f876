/* SPDX-License-Identifier: MIT */
/* PROVES: velocity, foaw
 * Set-up of the adaptive window with any parameters. A tick with any gains that set-up can make,
 * any longest window and tolerance, damaged ones included, in any state read from bytes, with any
 * count.
 *
 * EVA: -eva-slevel 20
 * PLANT: lib/src/sense/velocity.c: s->cnt[at & (EXH_VELOCITY_N - 1u)] -> s->cnt[at]
 * PLANT: lib/src/sense/velocity.c: ((s->at + 1u) & (EXH_VELOCITY_N - 1u)); -> (s->at + 1u);
 * PLANT: lib/src/sense/velocity.c: (int64_t)(n + 1) * d -> (int32_t)(n + 1) * (int32_t)d
 * PLANT: lib/src/sense/velocity.c: slope = m * part[n].fit -> slope = m * m
 */
#include "num/bytes.c"
#include "num/fix.c"
#include "sense/velocity.c"

#include "any.h"

static struct exh_velocity_scale any_scale(void)
{
    struct exh_velocity_scale s;
    s.step_m_q42 = any32();
    s.T.num = any_u32();
    s.T.den = any_u32();
    return s;
}

static void step(void)
{
    static struct exh_velocity_foaw s;
    static struct exh_velocity_foaw_cfg cfg;
    if (exh_velocity_foaw_setup(&cfg, any_scale(), any_u32(), any_u32()) < 0) { return; }
    /*@ assert foaw_n: 1 <= cfg.n <= 16; */
    ANY(cfg);
    for (unsigned i = 0; i < EXH_VELOCITY_N; i++) { ANY_GAIN(cfg.gain[i]); }
    FROM_BYTES(s, exh_velocity_foaw_serialize);
    (void)exh_velocity_foaw_step(&s, &cfg, any32());
    /*@ assert foaw_at: s.at < 16; */
}

int main(void)
{
    step();
    END();
    return 0;
}
