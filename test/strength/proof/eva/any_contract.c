/* SPDX-License-Identifier: MIT */
/* PROVES: what scenes are judged with
 * The functions of a tick keep contract.h. Their inputs are those of called.h, which the units of
 * the scenes show. Unit setup shows that set-ups make such configurations and that bytes make such
 * states.
 *
 * PLANT: lib/src/sense/velocity.c: (cfg->n - 1u) & (EXH_VELOCITY_N - 1u)); -> (cfg->n - 1u) & EXH_VELOCITY_N);
 * PLANT: lib/src/safe/safety.c: (int64_t)s->share_q30 + cfg->ramp_q30, 0, FULL_Q30) -> (int64_t)s->share_q30 + cfg->ramp_q30, 0, INT32_MAX)
 * PLANT: lib/src/sense/quad.c: if (jump >= INT64_C(1) << (bits - 2)) { return -EXH_E_RANGE; } -> (void)0;
 * PLANT: lib/src/law/passivity.c: any ? exh_clamp(held, 0, INT32_MAX) : 0; -> any ? exh_clamp(held, INT32_MIN, INT32_MAX) : 0;
 * PLANT: lib/src/safe/motion.c: exh_clamp32(*vel_mps_q27, -most, most) -> exh_clamp32(*vel_mps_q27, -most, INT32_MAX)
 * PLANT: lib/src/act/drive.c: s->fall_N_q20 = (int32_t)exh_gain_floor(permit->fall, s->force_N_q20) + 1; -> s->fall_N_q20 = s->force_N_q20 + 2;
 * PLANT: lib/include/exhand/contact.h: exh_contact_pullback(s, par, in.pos_m_q30); -> 2 * exh_contact_pullback(s, par, in.pos_m_q30);
 * PLANT: lib/src/law/contact.c: EXH_WHEN_SLEWED, 0, EXH_Q(20, 1, EXH_Q_FORCE) -> EXH_WHEN_SLEWED, 0, EXH_Q(40, 1, EXH_Q_FORCE)
 */
#include "num/bytes.c"
#define exh_udiv64 udiv64_by_steps
#include "num/fix.c"
#undef exh_udiv64
#include "quotient.h"
#include "sense/quad.c"
#undef SPEED_MIN_MPS_Q27
#include "sense/velocity.c"
#include "law/contact.c"
#include "act/table.c"
#include "act/drive.c"
#include "law/passivity.c"
#undef SPEED_MIN_MPS_Q27
#include "act/gate.c" /* its proof is any_gate.c: what it writes beside what it is given, its WP */
#include "safe/safety.c"
#include "safe/safety_open.c"
#include "act/tracking.c"
#undef CUR_MIN_A_Q26
#include "safe/motion.c"

#include "contract.h"

#define KNOTS 3

static struct exh_knot knot[KNOTS];

static void position(void)
{
    static struct exh_quad_par par;
    static struct exh_quad_cfg cfg;
    static struct exh_quad s;
    const struct exh_velocity_scale scale = {any32(), {any_u32(), any_u32()}};
    static struct exh_velocity_window_cfg velocity_cfg;
    static struct exh_velocity_window velocity;
    const struct exh_velocity_par velocity_par = {any32()};
    ANY(par);
    if (exh_quad_setup(&cfg, &par, scale.T, any8()) == 0) {
        /*@ assert quad_setup: quad_cfg(&cfg); */
    }
    ANY(cfg);
    ANY(s);
    /*@ admit quad_cfg(&cfg); */
    (void)exh_quad_step(&s, &cfg, any_u32());
    (void)exh_quad_pos_m_q30(&par, any32());
    if (exh_velocity_window_setup(&velocity_cfg, scale, &velocity_par) == 0) {
        /*@ assert velocity_setup: velocity_cfg(&velocity_cfg); */
    }
    ANY(velocity_cfg);
    /*@ admit velocity_cfg(&velocity_cfg); */
    velocity = any_velocity();
    (void)exh_velocity_window_step(&velocity, &velocity_cfg, any32());
    /*@ assert velocity_tick: velocity(&velocity); */
}

static void laws(void)
{
    struct exh_contact s = any_contact();
    struct exh_contact_par par;
    struct exh_contact_in in;
    struct exh_force_ledger f;
    int touching;
    ANY(par);
    /*@ admit contact_par(&par); */
    ANY(in);
    touching = exh_contact_step(&s, &par, in, &f);
    /*@ assert law: contact(&s) && law_ledger(&f) && bit(touching); */
    exh_contact_step_free(&s, &par, in.pos_m_q30, &f);
    /*@ assert law_free: contact(&s) && law_ledger(&f); */
}

/* Parameters that no set-up looks at: the rows' ranges are what the law takes. */
static void rows(void)
{
    struct exh_contact_par par;
    par.k_Npm_q10 = Frama_C_interval(exh_contact_rows[0].min, exh_contact_rows[0].max);
    par.b_Nspm_q20 = Frama_C_interval(exh_contact_rows[1].min, exh_contact_rows[1].max);
    par.f0_N_q20 = Frama_C_interval(exh_contact_rows[2].min, exh_contact_rows[2].max);
    par.f0_band_m_q30 = Frama_C_interval(exh_contact_rows[3].min, exh_contact_rows[3].max);
    par.hyst_m_q30 = Frama_C_interval(exh_contact_rows[4].min, exh_contact_rows[4].max);
    /*@ assert rows: contact_par(&par); */
}

/* As exh_table_setup() lets them; these rise. */
static void any_table(void)
{
    for (unsigned k = 0; k < KNOTS; k++) {
        knot[k].x = Frama_C_interval(-1073741823, 1073741823);
        knot[k].slope = any_gain();
    }
    knot[0].y = Frama_C_interval(INT32_MIN, -2);
    knot[1].y = Frama_C_interval(-1, 0);
    knot[2].y = Frama_C_interval(1, INT32_MAX);
}

static struct exh_drive_par drive_par;
static struct exh_drive_cfg drive_cfg;

static void any_drive_cfg(void)
{
    ANY(drive_par);
    ANY(drive_cfg);
    /*@ admit drive_par(&drive_par) && drive_made(&drive_cfg); */
    drive_cfg.par = &drive_par;
    drive_cfg.force_to_cur.knot = drive_cfg.cur_to_force.knot = knot;
    drive_cfg.force_to_cur.n = KNOTS;
    drive_cfg.cur_to_force.n = (uint8_t)(any8() & 1 ? KNOTS : 0);
}

static void drives(void)
{
    struct exh_drive s = any_drive();
    const struct exh_permit permit = any_permit();
    struct exh_force_ledger f;
    struct exh_current_ledger i;
    uint32_t bits;
    const int16_t mon_raw = (int16_t)Frama_C_interval(INT16_MIN, INT16_MAX);
    ANY(f);
    bits = exh_drive_force_step(&s, &drive_cfg, &permit, &f);
    /*@ assert drive_force: drive(&s) && force(&f) && limits(bits); */
    bits = exh_drive_current_step(&s, &drive_cfg, &f, &i);
    /*@ assert drive_current: drive(&s) && limits(bits) && asked_current(&i); */
    (void)exh_drive_monitor_A_q26(&drive_cfg, mon_raw);
    (void)exh_drive_monitor_N_q20(&drive_cfg, any32());
}

static void passive(void)
{
    struct exh_passivity s = any_passivity();
    static struct exh_passivity_par par;
    static struct exh_passivity_cfg cfg;
    struct exh_force_ledger f = any_law_ledger();
    uint32_t bits;
    ANY(par);
    ANY(cfg);
    /*@ admit passivity_made(&cfg); */
    cfg.par = &par;
    cfg.drive = &drive_par;
    cfg.held = drive_cfg.force_to_cur;
    bits = exh_passivity_step(&s, &cfg, any32(), any32(), &f);
    /*@ assert passivity_step: passivity(&s) && limits(bits) && f.passivity_N_q20 <= 0; */
    f.force_N_q20 = any32();
    exh_passivity_update(&s, &cfg, &f, any32());
    /*@ assert passivity_held: passivity(&s); */
    (void)exh_passivity_J_q24(&s, &cfg);
}

static void watched(void)
{
    static struct exh_tracking track;
    static struct exh_tracking_cfg track_cfg;
    static struct exh_motion watch;
    static struct exh_motion_par watch_par;
    static struct exh_motion_cfg watch_cfg;
    int32_t vel_mps_q27 = any32();
    uint32_t limits = Frama_C_unsigned_int_interval(0, (1u << EXH_LIMITS) - 1), bits;
    int off;
    ANY(track_cfg);
    ANY(track);
    /*@ admit track_cfg(&track_cfg); */
    off = exh_tracking_step(&track, &track_cfg, any32());
    /*@ assert track_step: bit(off); */
    exh_tracking_update(&track, any32());
    ANY(watch_cfg);
    ANY(watch_par);
    ANY(watch);
    /*@ admit watch_par(&watch_par); */
    watch_cfg.par = &watch_par;
    bits = exh_motion_step(&watch, &watch_cfg, &vel_mps_q27, &limits);
    /*@ assert watch_step: speed(&vel_mps_q27) && limits(limits) && bits <= 192; */
    exh_motion_update(&watch, &watch_cfg, any32(), any32());
}

static struct exh_safety_cfg safety_cfg;

static void box(uint8_t fingers, uint8_t from, uint8_t to)
{
    struct exh_safety s = any_safety();
    struct exh_safety_in in;
    struct exh_permit p;
    ANY(in);
    in.fingers = fingers;
    in.raised = Frama_C_unsigned_int_interval(0, (1u << EXH_FAULTS) - 1);
    s.state = (uint8_t)Frama_C_unsigned_int_interval(from, to);
    p = exh_safety_step(&s, &safety_cfg, in);
    /*@ assert safety_step: safety_after(&s) && s.fingers == fingers && permit(&p); */
    (void)exh_safety_arm_step(&s);
}

static void boxes(void)
{
    ANY(safety_cfg);
    /*@ admit safety_cfg(&safety_cfg); */
    for (uint8_t fingers = 1; fingers <= EXH_FINGERS; fingers++) {
        box(fingers, 0, 5);
        box(fingers, 6, 255); /* no state at all */
    }
}

int main(void)
{
    position();
    laws();
    rows();
    any_table();
    any_drive_cfg();
    drives();
    passive();
    watched();
    boxes();
    END();
    return 0;
}
