/* SPDX-License-Identifier: MIT */
/* PROVES: set-up and bytes of the output path
 * Set-up of force and current, passivity, state of the box, tracking and speed, with any
 * parameters and rates in thousandths of Hz. Tables of up to three knots with any content, judged
 * and inverted. States of any bytes become states within the range that the tick units assume.
 * Frames of any bytes; the monitor with any accepted table.
 *
 * EVA: -eva-slevel 12 -eva-slevel-function setup_i2t:60,exh_passivity_setup:60
 * PLANT: lib/src/act/drive.c: s->i2t_q32 > INT64_MAX / 2) { s->i2t_q32 = INT64_MAX / 2; } -> 0) { s->i2t_q32 = 0; }
 * PLANT: lib/src/act/table.c: if (n < 2 || n > 255) { return -EXH_E_RANGE; } -> (void)0;
 * PLANT: lib/src/act/table.c: const int64_t dy = (int64_t)knot[i + 1].y - knot[i].y; -> const int64_t dy = knot[i + 1].y - knot[i].y;
 * PLANT: lib/src/law/passivity.c: if (way > WAY_MAX_CNT) { return -EXH_E_RANGE; } -> (void)0;
 * PLANT: lib/src/law/passivity.c: s->energy_Ncnt_q20 = exh_clamp64(s->energy_Ncnt_q20, ENERGY_MAX_NCNT_Q20); -> (void)0;
 * PLANT: lib/src/safe/safety.c: cfg->arm_ticks = exh_ticks_in(par->arm_ms, T) + 1; -> cfg->arm_ticks = exh_ticks_in(par->arm_ms, T) - 1;
 * PLANT: lib/src/law/contact.c: s->inward = s->inward != 0; -> (void)0;
 */
#include "num/bytes.c"
#include "num/crc.c"
#define exh_udiv64 udiv64_by_steps
#include "num/fix.c"
#undef exh_udiv64
#include "quotient.h"
#include "law/contact.c"
#include "act/frame.c"
#include "act/table.c"
#include "act/drive.c"
#include "law/passivity.c"
#undef SPEED_MIN_MPS_Q27
#include "act/gate.c"
#include "safe/safety.c"
#include "safe/safety_open.c"
#include "act/tracking.c"
#undef CUR_MIN_A_Q26
#include "safe/motion.c"

#include "contract.h"

#define KNOTS 3

static struct exh_knot knot[KNOTS], inverse[KNOTS];
static struct exh_drive_par par;
static struct exh_drive_cfg cfg;

static void tables(unsigned n)
{
    ANY(knot);
    (void)exh_table_setup(knot, n);
    if (n > KNOTS) { return; } /* these are all there */
    ANY(knot);
    (void)exh_table_invert(inverse, knot, n);
}

static void any_table(unsigned n)
{
    ANY(knot);
    for (unsigned k = 0; k < n; k++) {
        ANY_GAIN(knot[k].slope);
        knot[k].x = Frama_C_interval(-1073741823, 1073741823);
    }
}

static void drive(struct exh_period T, uint8_t forces, uint8_t currents)
{
    const struct exh_table force_to_cur = {knot, forces}, cur_to_force = {knot, currents};
    ANY(par);
    any_table(KNOTS);
    cfg.f_top_N_q20 = 1; /* set, or as they were */
    cfg.top_limit = EXH_LIMIT_FORCE;
    if (exh_drive_setup(&cfg, &par, T, force_to_cur, cur_to_force) == 0) {
        /*@ assert drive_taken: drive_cfg(&cfg); */
        (void)exh_drive_monitor_N_q20(&cfg, any32());
    }
    /* Set, or as they were. */
    /*@ assert budget: 0 <= cfg.i2t_budget_q32 <= 1 << 60; */
    /*@ assert shift: cfg.i2t_shift <= 62; */
}

static void passivity(struct exh_period T)
{
    struct exh_passivity_par own;
    static struct exh_passivity_cfg taken;
    struct exh_drive_cfg drives;
    const struct exh_table held = {knot, KNOTS};
    const struct exh_velocity_scale scale = {any32(), T};
    ANY(own);
    ANY(par);
    ANY(drives);
    any_table(KNOTS);
    drives.par = &par;
    drives.f_top_N_q20 = Frama_C_interval(1, INT32_MAX);
    ANY_GAIN(drives.tick_N_q20);
    if (exh_passivity_setup(&taken, &own, &drives, held, scale, any32()) == 0) {
        /*@ assert passivity_taken: passivity_made(&taken) && table(&taken.held); */
    }
}

static void rest(struct exh_period T)
{
    static struct exh_safety_cfg safety;
    static struct exh_tracking_cfg track;
    struct exh_safety_par safety_par;
    struct exh_tracking_par track_par;
    struct exh_motion_par watch_par;
    struct exh_motion_cfg watch;
    ANY(safety_par);
    ANY(track_par);
    ANY(watch_par);
    safety.release_ticks = 3; /* set, or as they were */
    safety.arm_ticks = 2;
    safety.ramp_q30 = 1;
    track.ticks = 5;
    if (exh_safety_setup(&safety, &safety_par, T) == 0) {
        /*@ assert safety_taken: safety_cfg(&safety); */
    }
    /*@ assert release: 3 <= safety.release_ticks <= 1023 && 2 <= safety.arm_ticks <= 65536; */
    /*@ assert ramp: 1 <= safety.ramp_q30 <= 1 << 30; */
    if (exh_tracking_setup(&track, &track_par, T) == 0) {
        /*@ assert track_taken: track_cfg(&track); */
    }
    /*@ assert track: 5 <= track.ticks <= 4100; */
    if (exh_motion_setup(&watch, &watch_par, T) == 0) {
        /*@ assert watch_taken: watch_cfg(&watch); */
    }
}

static void states(void)
{
    static struct exh_contact contact;
    static struct exh_drive drives;
    static struct exh_passivity passive;
    static struct exh_safety safety;
    static struct exh_tracking track;
    static struct exh_motion watch;
    FROM_BYTES(contact, exh_contact_serialize);
    /*@ assert factors: contact(&contact); */
    FROM_BYTES(drives, exh_drive_serialize);
    /*@ assert force: drive(&drives); */
    FROM_BYTES(passive, exh_passivity_serialize);
    /*@ assert energy: passivity(&passive); */
    FROM_BYTES(safety, exh_safety_serialize);
    /*@ assert share: safety(&safety); */
    (void)exh_safety_arm_step(&safety);
    FROM_BYTES(track, exh_tracking_serialize);
    FROM_BYTES(watch, exh_motion_serialize);
}

static void frames(void)
{
    static uint8_t frame_B[64];
    struct exh_drive_in in;
    struct exh_drive_out out;
    struct exh_bytes c;
    for (unsigned n = 1; n <= EXH_FINGERS; n++) {
        ANY(frame_B);
        c = exh_bytes_reader(frame_B, Frama_C_unsigned_int_interval(0, sizeof frame_B));
        ANY(in);
        ANY(out);
        exh_drive_in_serialize(&c, &in, n);
        exh_drive_out_serialize(&c, &out, n);
    }
}

int main(void)
{
    const struct exh_period whole = {1, Frama_C_unsigned_int_interval(1, 20020)};
    const struct exh_period fine = {1000, Frama_C_unsigned_int_interval(1000, 20020000)};
    states();
    frames();
    for (unsigned n = 0; n <= KNOTS; n++) { tables(n); }
    tables(Frama_C_unsigned_int_interval(256, UINT32_MAX));
    rest(whole);
    rest(fine);
    drive(fine, 1, 0);
    drive(fine, KNOTS, KNOTS);
    passivity(fine);
    END();
    return 0;
}
