/* SPDX-License-Identifier: MIT */
/* PROVES: chatter
 * Set-up with any parameters, any step and any table of three knots. A tick in any state read from
 * bytes, with any count and current. The unit assumes that the sum of a cycle stays within 2^60;
 * z3 proves that.
 *
 * EVA: -eva-slevel-function exh_chatter_setup:60
 * PLANT: lib/src/safe/chatter.c: s->net_Acnt_q20 = exh_clamp64(s->net_Acnt_q20, SUM_MAX_ACNT); -> (void)0;
 * PLANT: lib/src/safe/chatter.c: exh_clamp32(exh_wrap_diff(cnt, s->cnt), -WAY_MAX_CNT, WAY_MAX_CNT); -> cnt - s->cnt;
 * PLANT: lib/src/safe/chatter.c: t.knot[t.n - 1].x <= 0 || -> 0 ||
 */
#include "num/bytes.c"
#define exh_udiv64 udiv64_by_steps
#include "num/fix.c"
#undef exh_udiv64
#include "quotient.h"
#include "safe/chatter.c"

#include "contract.h"

static void setup(struct exh_period T)
{
    static struct exh_knot knot[3];
    static struct exh_chatter_cfg made;
    const struct exh_velocity_scale scale = {any32(), T};
    struct exh_chatter_par par;
    struct exh_drive_cfg drive;
    ANY(par);
    ANY(knot);
    ANY(drive);
    made.ticks = 9; /* set, or as it was */
    drive.force_to_cur.knot = knot;
    drive.force_to_cur.n = (uint8_t)Frama_C_unsigned_int_interval(0, 3);
    if (exh_chatter_setup(&made, &par, &drive, scale) == 0) {
        /*@ assert energy: 0 <= made.energy_Acnt_q20 <= 1 << 58; */
        /*@ assert leak: 0 <= made.leak_Acnt_q20 <= 1 << 58; */
        /*@ assert taken: chatter_cfg(&made); */
    }
}

int main(void)
{
    static struct exh_chatter s;
    static struct exh_chatter_cfg cfg;
    uint32_t due;
    setup((struct exh_period){1, Frama_C_unsigned_int_interval(1, 20020)});
    setup((struct exh_period){1000, Frama_C_unsigned_int_interval(1000, 20020000)});
    FROM_BYTES(s, exh_chatter_serialize);
    /*@ assert state: chatter(&s); */
    s = any_chatter();
    ANY(cfg);
    /*@ admit chatter_cfg(&cfg); */
    due = exh_chatter_step(&s, &cfg);
    /*@ assert cause: due == 0 || due == EXH_FAULT_CHATTER; */
    exh_chatter_update(&s, &cfg, any32(), any32());
    /*@ admit cycle: -(1 << 60) <= s.cycle_Acnt_q20 <= 1 << 60; */ /* smt: cycle_is_within_60_bits */
    /*@ assert next: chatter(&s); */
    END();
    return 0;
}
