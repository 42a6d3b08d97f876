/* SPDX-License-Identifier: MIT */
/* PROVES: energy
 * Passivity of a finger: any state that exh_passivity_serialize() accepts, any count, ledger and
 * current, any table of three knots that exh_table_setup() accepts.
 *
 * PLANT: lib/src/law/passivity.c: = exh_clamp64(e, ENERGY_MAX_NCNT_Q20); -> = e;
 */
#include "act/table.c"
#include "act/drive.c"
#include "law/passivity.c"

#include "any.h"

static struct exh_passivity_par own;
static struct exh_drive_par par;
static struct exh_passivity_cfg cfg;
static struct exh_knot knot[3];
static struct exh_passivity s;
static struct exh_force_ledger f;

static void any_cfg(void)
{
    ANY(own);
    ANY(par);
    ANY(cfg);
    ANY(knot);
    cfg.par = &own;
    cfg.drive = &par;
    cfg.held.knot = knot;
    cfg.held.n = 3;
    for (unsigned k = 0; k < 3; k++) {
        knot[k].x = Frama_C_interval(-1073741823, 1073741823); /* spans of 2^31-1 at most */
        knot[k].slope.mant = Frama_C_interval(0, INT32_MAX);
        knot[k].slope.shift = (uint8_t)Frama_C_unsigned_int_interval(0, 62);
    }
    /* These rise. */
    knot[0].y = Frama_C_interval(INT32_MIN, -2);
    knot[1].y = Frama_C_interval(-1, 0);
    knot[2].y = Frama_C_interval(1, INT32_MAX);
    par.f_max_N_q20 = Frama_C_interval(0, EXH_FORCE_MAX_N_Q20);
    cfg.f_top_N_q20 = Frama_C_interval(1, INT32_MAX);
    cfg.step_m_q42 = Frama_C_interval(1, INT32_MAX);
    cfg.share.mant = Frama_C_interval(0, INT32_MAX);
    cfg.share.shift = (uint8_t)Frama_C_unsigned_int_interval(0, 62);
    cfg.shift = (uint8_t)Frama_C_unsigned_int_interval(0, 20);
}

static int64_t within(int64_t most) { return Frama_C_long_long_interval(-most, most); }

static void any_state(void)
{
    ANY(s);
    ANY(f);
    s.energy_Ncnt_q20 = within(ENERGY_MAX_NCNT_Q20);
    s.held_N_q20 = Frama_C_interval(0, INT32_MAX);
    s.late_N_q20 = Frama_C_interval(0, INT32_MAX);
    f.spring_N_q20 = within(INT64_C(1) << 44);
    f.damper_N_q20 = within(INT64_C(1) << 44);
    f.pullback_N_q20 = Frama_C_interval(0, 20 << EXH_Q_FORCE);
}

int main(void)
{
    any_cfg();
    any_state();
    f.passivity_N_q20 = 0;
    (void)exh_passivity_step(&s, &cfg, any32(), any32(), &f);
    /*@ assert only_takes: f.passivity_N_q20 <= 0; */
    /*@ assert energy_range: -1152921504606846976 <= s.energy_Ncnt_q20 <= 1152921504606846976; */
    f.force_N_q20 = any32();
    exh_passivity_update(&s, &cfg, &f, any32());
    /*@ assert held_range: 0 <= s.held_N_q20; */
    /*@ assert late_range: 0 <= s.late_N_q20; */
    (void)exh_passivity_J_q24(&s, &cfg);
    END();
    return 0;
}
