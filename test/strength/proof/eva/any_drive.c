/* SPDX-License-Identifier: MIT */
/* PROVES: force and current
 * Force and current of a finger. Any ledger, any permit of exh_safety_step(), any state that
 * exh_drive_serialize() accepts, any table of three knots that exh_table_setup() accepts.
 *
 * WP: Closed: force 0. Open: no force rises above `f_max` or the end of the table. Release: the
 * force falls in every tick until 0, by at most `fall` a tick. |current asked| <= `i_peak` for
 * every state and force.
 *
 * PLANT: lib/src/act/drive.c: exh_wrap_add64(f->spring_N_q20, f->damper_N_q20) -> f->spring_N_q20 + f->damper_N_q20
 */
#include "act/table.c"
#include "act/drive.c"

#include "any.h"

static struct exh_drive_par par;
static struct exh_drive_cfg cfg;
static struct exh_knot knot[3];
static struct exh_drive s;
static struct exh_force_ledger f;
static struct exh_current_ledger i;
static struct exh_permit permit;

static void any_cfg(void)
{
    ANY(par);
    ANY(cfg);
    ANY(knot);
    cfg.par = &par;
    cfg.force_to_cur.knot = cfg.cur_to_force.knot = knot;
    cfg.force_to_cur.n = 3;
    cfg.cur_to_force.n = (uint8_t)Frama_C_unsigned_int_interval(0, 3);
    if (cfg.cur_to_force.n == 1) { cfg.cur_to_force.n = 0; }
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
    par.slew_up_Nps = Frama_C_interval(1, SLEW_MAX_NPS);
    par.slew_down_Nps = Frama_C_interval(SLEW_DOWN_MIN_NPS, SLEW_MAX_NPS);
    par.i_peak_A_q26 = Frama_C_interval(I_CONT_MAX_A_Q26, I_PEAK_MAX_A_Q26);
    par.i_cont_A_q26 = Frama_C_interval(0, I_CONT_MAX_A_Q26);
    par.mon_zero_raw = Frama_C_interval(INT16_MIN, INT16_MAX);
    par.dac_rawpA_q16 = Frama_C_interval(65536, INT32_MAX);
    cfg.f_top_N_q20 = Frama_C_interval(1, INT32_MAX);
    cfg.i_top_A_q26 = Frama_C_interval(0, I_PEAK_MAX_A_Q26);
    cfg.i_whole_A_q26 = Frama_C_interval(0, I_PEAK_MAX_A_Q26);
    cfg.top_limit = any8() & 1 ? EXH_LIMIT_FORCE : EXH_LIMIT_PERSON;
    cfg.tick_N_q20.mant = Frama_C_interval(0, INT32_MAX);
    cfg.tick_N_q20.shift = (uint8_t)Frama_C_unsigned_int_interval(0, 62);
    /* 6.6 A squared at 20 kHz for 2.7 s is less than 2^54. */
    cfg.i2t_budget_q32 = Frama_C_unsigned_long_long_interval(0, UINT64_C(1) << 54);
    cfg.i2t_fold.mant = Frama_C_interval(0, INT32_MAX);
    cfg.i2t_fold.shift = (uint8_t)Frama_C_unsigned_int_interval(0, 62);
    cfg.i2t_shift = (uint8_t)Frama_C_unsigned_int_interval(0, 62);
    cfg.dac_A_q26.mant = Frama_C_interval(0, INT32_MAX);
    cfg.dac_A_q26.shift = (uint8_t)Frama_C_unsigned_int_interval(0, 62);
}

static void any_state(void)
{
    ANY(s);
    ANY(f);
    ANY(i);
    ANY(permit);
    s.force_N_q20 = Frama_C_interval(0, EXH_FORCE_MAX_N_Q20);
    s.fall_N_q20 = Frama_C_interval(0, EXH_FORCE_MAX_N_Q20 + 1);
    s.i2t_q32 = (int64_t)Frama_C_unsigned_long_long_interval(0, INT64_MAX / 2);
    permit.share_q30 = Frama_C_interval(0, 1 << 30);
    permit.fall.mant = Frama_C_interval(0, INT32_MAX);
    permit.fall.shift = (uint8_t)Frama_C_unsigned_int_interval(31, 62);
}

int main(void)
{
    any_cfg();
    any_state();
    (void)exh_drive_force_step(&s, &cfg, &permit, &f);
    /*@ assert force_range: 0 <= f.force_N_q20 <= 104857600; */
    /*@ assert state_range: 0 <= s.force_N_q20 <= 104857600; */
    f.force_N_q20 = any32(); /* and of a force out of range none is made either */
    (void)exh_drive_current_step(&s, &cfg, &f, &i);
    /*@ assert heat_range: s.i2t_q32 >= 0; */
    (void)exh_drive_monitor_A_q26(&cfg, (int16_t)Frama_C_interval(INT16_MIN, INT16_MAX));
    END();
    return 0;
}
