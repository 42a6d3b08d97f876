/* SPDX-License-Identifier: MIT */
/* Passivity of one finger: a contact gives back no more energy than it was given.
 *
 * The observer is exact: between two ticks the force stands still, so the energy that the
 * finger gives is the force held times the counts that the string moved, in integers,
 * with no rounding, whatever happens between two samples. The force is the one that
 * the D/A code stands for, not the one asked for.
 *
 * The controller takes force away only while energy is owed, that is while more came out
 * of a contact than went in: then force is held below f_max - owed / way, way being what a
 * string can move in a tick at the speed limit. So what the next tick can give out at most is
 * never more than what may still be owed, and that alone is the proof (docs/NUMERICS.md):
 *
 *   owed <= way * (f_max + half a code), always: the work of one tick at the speed limit.
 *
 * It holds from the beginning of a contact to any later tick, for every law, every gain and every
 * movement that keeps the speed limit; m ticks missed on end make it m + 1 times that. Where energy
 * goes in first, as in any spring that is pressed, nothing is taken.
 *
 * Outputs that act late: with on = 2 the force may stand up to one tick after it was commanded;
 * of the two forces that may have been held over a tick the worse one counts. What is owed by any
 * such output then stays below twice that bound, and what is owed by one in time below the bound
 * itself.
 *
 * Not counted as the contact's: the pull-back force, which is meant to draw the string in; and
 * what the finger does within one count: in true position up to half a count times the
 * sum of all changes of force may be added.
 *
 * Order: law, exh_passivity_step(), exh_drive_force_step(), exh_drive_current_step(),
 * exh_gate_step(), exh_passivity_update().
 */
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
    int32_t on; /* 0: observes only; 1: outputs act in their tick; 2: or up to one tick later */
};
#define EXH_PASSIVITY_ROWS 1
extern const struct exh_signal exh_passivity_rows[EXH_PASSIVITY_ROWS];

/* One finger as it is set up. */
struct exh_passivity_cfg {
    const struct exh_passivity_par *par; /* read at every tick */
    const struct exh_drive_par *drive;   /* likewise: f_max */
    int32_t f_top_N_q20;                 /* end of the force table */
    struct exh_table held;               /* what a coded current holds: A q26 -> N q20 */
    int32_t step_m_q42;                  /* string per count, for energy in J */
    int32_t way_cnt;                     /* of one tick at the speed limit, rounded up */
    uint8_t shift;                       /* f_max 100 N * way >> shift fits a word */
    struct exh_gain share;               /* 2^shift / way */
};

/* One finger from tick to tick. */
struct exh_passivity {
    int64_t energy_Ncnt_q20; /* taken up since the contact began; negative: owed */
    int32_t held_N_q20;      /* held since the last tick, the pull-back aside */
    int32_t late_N_q20;      /* held before that, where it may still act */
    int32_t cnt;             /* position at the last tick */
    uint8_t touching;        /* the contact condition then */
    uint8_t started;         /* 1: cnt is of a tick that was */
};

/* Set-up (divides). `held` is the inverse of the drive's force_to_cur (exh_table_invert), gives 0 N
 * at 0 A and outlives cfg, as must par and what `drive` points to. speed: the fastest movement, m/s
 * q27, 0.1 or more: what is faster is not covered. -EXH_E_RANGE: a table or a value that is not so,
 * a way of more than 2^24 counts, or slew_down so low that force could not fall from its highest to
 * none in one tick (lowered later, it adds the work of its fall to the bound); -EXH_E_RATE: T. */
int exh_passivity_setup(struct exh_passivity_cfg *cfg, const struct exh_passivity_par *par,
    const struct exh_drive_cfg *drive, struct exh_table held, struct exh_velocity_scale scale,
    int32_t speed_mps_q27);

/* Behind the law, with the count that it saw and what it returned. Fills f->passivity: what of
 * spring + damper is above the limit, negative. Returns EXH_LIMIT_PASSIVITY or 0. The limit is at
 * most 3 LSB (3 uN) below exact, never above. */
uint32_t exh_passivity_step(struct exh_passivity *s, const struct exh_passivity_cfg *cfg,
    int32_t cnt, int touching, struct exh_force_ledger *f);

/* Behind the gate, with the same ledger and the current that the code stands for (coded of the
 * current ledger). */
void exh_passivity_update(struct exh_passivity *s, const struct exh_passivity_cfg *cfg,
    const struct exh_force_ledger *f, int32_t coded_A_q26);

/* Energy taken up by the present contact, J, q24 (60 nJ, within 1/2 LSB, saturates at +-128 J). */
int32_t exh_passivity_J_q24(const struct exh_passivity *s, const struct exh_passivity_cfg *cfg);

/* State through a cursor. A state of zeros is a string out of contact. */
void exh_passivity_serialize(struct exh_bytes *c, struct exh_passivity *s);

#ifdef __cplusplus
}
#endif
#endif
