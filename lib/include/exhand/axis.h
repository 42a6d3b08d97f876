/* SPDX-License-Identifier: MIT */
/* Axis: the tick of one finger, from the counter to the D/A code, in the required order.
 *
 *   exh_axis_sense()   counter -> count -> position -> velocity -> speed limit;
 *                      monitor -> current -> does it follow?
 *   exh_axis_permit()  faults of the fingers -> safety -> permit for the force
 *   (the scene's law)  position and velocity -> force ledger
 *   exh_axis_force()   force ledger -> force limits -> current limits
 *   exh_axis_out()     gate -> code; coded current -> checks of the next tick
 *
 * Each function needs the result of the one before, so a scene cannot omit a step. A part that a
 * scene does not have is a NULL pointer in its struct exh_axis. The functions are inline: where the
 * pointer is a constant, the compiler drops the call and the linker drops the module.
 *
 * With n fingers, call sense for each, permit once, law and force for each, exh_gate_step() once
 * and exh_axis_update() for each. exh_axis_out() combines the last two for one finger. */
#ifndef EXHAND_AXIS_H
#define EXHAND_AXIS_H

#include "exhand/chatter.h"
#include "exhand/drive.h"
#include "exhand/error.h"
#include "exhand/frame.h"
#include "exhand/quad.h"
#include "exhand/safety.h"
#include "exhand/tracking.h"
#include "exhand/velocity.h"
#include "exhand/motion.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The parts of one finger and their set-ups. All pointers are the caller's. */
struct exh_axis {
    struct exh_quad *quad;                              /* encoder */
    const struct exh_quad_cfg *quad_cfg;                /* its set-up */
    struct exh_velocity_window *velocity;               /* NULL: no velocity, 0 m/s */
    const struct exh_velocity_window_cfg *velocity_cfg; /* its set-up */
    struct exh_motion *watch;               /* NULL: no speed limit, no stuck detector */
    const struct exh_motion_cfg *watch_cfg; /* its set-up */
    struct exh_tracking *track; /* NULL: no check of monitor against code (EXH_UNTRACKED) */
    const struct exh_tracking_cfg *track_cfg; /* its set-up */
    struct exh_drive *drive;                  /* force and current limits */
    const struct exh_drive_cfg
        *drive_cfg;              /* its set-up; an element of the array for exh_gate_step() */
    struct exh_chatter *chatter; /* NULL: no detection of limit cycles */
    const struct exh_chatter_cfg *chatter_cfg; /* its set-up */
};

/* Measurements of one finger in this tick. */
struct exh_axis_now {
    int32_t cnt;         /* extended count */
    int32_t pos_m_q30;   /* string position, m, +-2 */
    int32_t vel_mps_q27; /* its velocity within the speed limit, m/s, +-16; 0 if velocity is NULL */
    int32_t mon_A_q26;   /* measured current, A, +-32; 0 if track is NULL */
    uint32_t raised;     /* enum exh_fault: causes that this finger shows now */
    uint32_t limits;     /* enum exh_limit: limits that acted on the velocity */
};

/* --- set-up --- */

/* Arguments of exh_axis_setup(). NULL omits a part. "Kept" pointers must outlive the set-ups. */
struct exh_axis_setup {
    struct exh_quad_cfg *quad;                   /* filled */
    const struct exh_quad_par *quad_par;         /* kept */
    struct exh_velocity_window_cfg *velocity;    /* filled */
    const struct exh_velocity_par *velocity_par; /* read */
    struct exh_motion_cfg *watch;                /* filled */
    const struct exh_motion_par *watch_par;      /* kept */
    struct exh_tracking_cfg *track;              /* filled */
    const struct exh_tracking_par *track_par;    /* read */
    struct exh_drive_cfg *drive;                 /* filled */
    const struct exh_drive_par *drive_par;       /* kept */
    struct exh_chatter_cfg *chatter;             /* filled */
    const struct exh_chatter_par *chatter_par;   /* read */
};

/* Sets up all parts in the order of the tick; divides. T is the period and enc_bits the counter
 * width of the board; the tables are as for exh_drive_setup(). Returns 0 or the first error. */
static inline int exh_axis_setup(const struct exh_axis_setup *of, struct exh_period T,
    unsigned enc_bits, struct exh_table force_to_cur, struct exh_table cur_to_force)
{
    const struct exh_velocity_scale scale = {of->quad_par->step_m_q42, T};
    int err = exh_quad_setup(of->quad, of->quad_par, T, enc_bits);
    if (err == 0 && of->velocity) {
        err = exh_velocity_window_setup(of->velocity, scale, of->velocity_par);
    }
    if (err == 0) {
        err = exh_drive_setup(of->drive, of->drive_par, T, force_to_cur, cur_to_force);
    }
    if (err == 0 && of->track) { err = exh_tracking_setup(of->track, of->track_par, T); }
    if (err == 0 && of->watch) { err = exh_motion_setup(of->watch, of->watch_par, T); }
    if (err == 0 && of->chatter) {
        err = exh_chatter_setup(of->chatter, of->chatter_par, of->drive, scale);
    }
    return err;
}

/* --- the tick --- */

/* First: processes the board's readings of finger f, 0 .. EXH_FINGERS-1. */
static inline struct exh_axis_now exh_axis_sense(
    const struct exh_axis *a, const struct exh_drive_in *in, unsigned f)
{
    const int32_t cnt = exh_quad_step(a->quad, a->quad_cfg, in->enc_raw[f]);
    const int32_t pos_m_q30 = exh_quad_pos_m_q30(a->quad_cfg->par, cnt);
    int32_t vel_mps_q27 = 0, mon_A_q26 = 0;
    uint32_t raised = 0, limits = 0;

    if (a->velocity) { vel_mps_q27 = exh_velocity_window_step(a->velocity, a->velocity_cfg, cnt); }
    if (a->watch) { raised = exh_motion_step(a->watch, a->watch_cfg, &vel_mps_q27, &limits); }
    if (a->chatter) { raised |= exh_chatter_step(a->chatter, a->chatter_cfg); }
    if (a->quad->lost) { raised |= EXH_FAULT_ENCODER; }
    if (a->track) {
        mon_A_q26 = exh_drive_monitor_A_q26(a->drive_cfg, in->mon_raw[f]);
        if (exh_tracking_step(a->track, a->track_cfg, mon_A_q26)) { raised |= EXH_FAULT_TRACKING; }
    }
    {
        const struct exh_axis_now now = {cnt, pos_m_q30, vel_mps_q27, mon_A_q26, raised, limits};
        return now;
    }
}

/* The arming step ENCODER and the fault ENCODER have the same bit, so the tick needs no branch. */
EXH_STATIC_ASSERT(
    axis_encoder_is_one_bit, (unsigned)EXH_ARM_ENCODER == (unsigned)EXH_FAULT_ENCODER);

/* Second, once: safety. box holds what the fingers do not know. This function adds the causes of
 * fingers 0..n-1 to box.raised and sets box.fingers to n. If no encoder is lost, it confirms the
 * arming step ENCODER in box.ready. */
static inline struct exh_permit exh_axis_permit(struct exh_safety *s,
    const struct exh_safety_cfg *cfg, const struct exh_axis_now *now, unsigned n,
    struct exh_safety_in box)
{
    uint32_t raised = 0;
    for (unsigned k = 0; k < n; k++) { raised |= now[k].raised; }
    box.raised |= raised;
    box.fingers = (uint8_t)n;
    box.ready = (uint8_t)(box.ready | (~raised & EXH_FAULT_ENCODER));
    return exh_safety_step(s, cfg, box);
}

/* exh_axis_force() with force limits for this tick. */
static inline uint32_t exh_axis_force_within(const struct exh_axis *a,
    const struct exh_permit *permit, struct exh_drive_most own, struct exh_force_ledger *f,
    struct exh_current_ledger *i)
{
    const uint32_t limits = exh_drive_force_within(a->drive, a->drive_cfg, permit, own, f);
    return limits | exh_drive_current_step(a->drive, a->drive_cfg, f, i);
}

/* After the law has filled the force ledger: force limits, then current limits. Returns limit bits;
 * combine them with those of exh_axis_sense() for the gate. */
static inline uint32_t exh_axis_force(const struct exh_axis *a, const struct exh_permit *permit,
    struct exh_force_ledger *f, struct exh_current_ledger *i)
{
    const struct exh_drive_par *par = a->drive_cfg->par;
    const struct exh_drive_most own = {par->f_max_N_q20, par->slew_up_Nps};
    return exh_axis_force_within(a, permit, own, f, i);
}

/* After exh_gate_step(): stores the coded current for the checks of the next tick. */
static inline void exh_axis_update(const struct exh_axis *a, int32_t cnt, int32_t coded_A_q26)
{
    if (a->track) { exh_tracking_update(a->track, coded_A_q26); }
    if (a->watch) { exh_motion_update(a->watch, a->watch_cfg, cnt, coded_A_q26); }
    if (a->chatter) { exh_chatter_update(a->chatter, a->chatter_cfg, cnt, coded_A_q26); }
}

/* Last, in a scene with one finger: the gate, then exh_axis_update(). cnt comes from
 * exh_axis_sense(). *limits holds the limits of sense and force; the gate adds its own. */
static inline void exh_axis_out(const struct exh_axis *a, struct exh_safety *s, int32_t cnt,
    struct exh_current_ledger *i, uint32_t *limits, struct exh_drive_out *out)
{
    exh_gate_step(s, a->drive_cfg, 1, i, limits, out);
    exh_axis_update(a, cnt, i->coded_A_q26);
}

#ifdef __cplusplus
}
#endif
#endif
