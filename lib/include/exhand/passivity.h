/* SPDX-License-Identifier: MIT */
/* Passivity of one finger: a contact never returns more energy than it received.
 *
 * The observer computes the energy exactly. Between two ticks the force is constant, so the energy
 * is the held force times the counts moved: an integer without rounding, whatever happens between
 * the samples. It uses the force of the D/A code, not the force requested.
 *
 * The controller reduces the force only while energy is owed, which means that more came out of a
 * contact than went in. It then limits the force to f_max - owed / way. way is the string movement
 * in one tick at the speed limit. So the next tick can return at most what keeps this bound
 * (docs/NUMERICS.md has the proof):
 *
 *   owed <= way * (f_max + half a code), always: the work of one tick at the speed limit.
 *
 * The bound holds from the start of a contact to any later tick, for every law, gain and movement
 * within the speed limit. m consecutive missed ticks multiply it by m + 1. Where energy enters
 * first, as into a spring that is pressed, the controller does nothing.
 *
 * Late outputs: with on = 2 the force may remain up to one tick after its command. Of the two
 * forces that may have acted in a tick, the worse counts. The energy owed then stays below twice
 * the bound, and below the bound itself if the outputs act in time.
 *
 * Two parts are not counted: the pull-back force, which is meant to wind the string in, and
 * movement within one count. The latter adds at most half a count times all force changes.
 *
 * Related: time-domain passivity control (Hannaford and Ryu, 2002). Order of the calls: law,
 * exh_passivity_step(), exh_drive_force_step(), exh_drive_current_step(), exh_gate_step(),
 * exh_passivity_update(). */
#ifndef EXHAND_PASSIVITY_H
#define EXHAND_PASSIVITY_H

#include "exhand/bytes.h"
#include "exhand/contact.h"
#include "exhand/drive.h"
#include "exhand/signal.h"
#include "exhand/table.h"
#include "exhand/velocity.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Parameter of one finger; row in exh_passivity_rows[]. */
struct exh_passivity_par {
    int32_t on; /* 0: observes only; 1: outputs act in their tick; 2: up to one tick later */
};
#define EXH_PASSIVITY_ROWS 1
extern const struct exh_signal exh_passivity_rows[EXH_PASSIVITY_ROWS];

/* Set-up of one finger. */
struct exh_passivity_cfg {
    const struct exh_passivity_par *par; /* read at every tick */
    const struct exh_drive_par *drive;   /* f_max of it is read at every tick */
    int32_t f_top_N_q20;                 /* force at the end of the force table */
    struct exh_table held;               /* force of a coded current: A q26 -> N q20 */
    int32_t step_m_q42;                  /* string per count, for energy in J */
    int32_t way_cnt;                     /* counts per tick at the speed limit, rounded up */
    uint8_t shift;                       /* f_max 100 N * way >> shift fits a word */
    struct exh_gain share;               /* 2^shift / way */
};

/* State of one finger. */
struct exh_passivity {
    int64_t energy_Ncnt_q20; /* received since the contact began; negative: owed */
    int32_t held_N_q20;      /* force since the last tick, without pull-back */
    int32_t late_N_q20;      /* the force before it, which may still act */
    int32_t cnt;             /* position in the last tick */
    uint8_t touching;        /* the contact condition in that tick */
    uint8_t started;         /* 1: cnt holds a measured position */
};

/* Set-up (divides). held is the inverse of the drive's force_to_cur (exh_table_invert) with 0 N at
 * 0 A. held, par and the parameters of drive must outlive cfg. The bound does not cover movement
 * faster than speed_mps_q27, >= 0.1 m/s. A lower slew_down later adds the fall's work to the bound.
 * - -EXH_E_RATE: T. -EXH_E_RANGE: an invalid table or value, or way is above 2^24 counts, or
 *   slew_down is too low: the highest force must fall to 0 in one tick. */
int exh_passivity_setup(struct exh_passivity_cfg *cfg, const struct exh_passivity_par *par,
    const struct exh_drive_cfg *drive, struct exh_table held, struct exh_velocity_scale scale,
    int32_t speed_mps_q27);

/* Call it after the law, with the count that the law used and the value that it returned. Sets
 * f->passivity to minus the part of spring + damper above the limit. Returns EXH_LIMIT_PASSIVITY or
 * 0. The limit is at most 3 LSB (3 uN) below the exact one, never above. */
uint32_t exh_passivity_step(struct exh_passivity *s, const struct exh_passivity_cfg *cfg,
    int32_t cnt, int touching, struct exh_force_ledger *f);

/* Call it after the gate, with the same ledger and the coded current of the current ledger. */
void exh_passivity_update(struct exh_passivity *s, const struct exh_passivity_cfg *cfg,
    const struct exh_force_ledger *f, int32_t coded_A_q26);

/* Energy that the present contact has received, J, q24 (LSB 60 nJ). Error 1/2 LSB; +-128 J. */
int32_t exh_passivity_J_q24(const struct exh_passivity *s, const struct exh_passivity_cfg *cfg);

/* State through a cursor. All zeros: not in contact. */
void exh_passivity_serialize(struct exh_bytes *c, struct exh_passivity *s);

#ifdef __cplusplus
}
#endif
#endif
