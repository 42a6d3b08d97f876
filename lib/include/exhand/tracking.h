/* SPDX-License-Identifier: MIT */
/* Tracking: checks that the measured motor current follows the D/A code.
 *
 * A D/A that fails to update keeps its last current on the finger. No card reads back its outputs,
 * but the current monitor can detect it. The delay of the current is unknown, so the check uses a
 * band: all currents coded since the monitor last matched. The monitor must come within the
 * tolerance of that band in time. The band restarts at each match and so stays narrow.
 *
 * There is no false alarm if each step response settles to within tolerance - noise in time + 4
 * ticks. The check cannot detect an error below the tolerance, or a stuck current that is coded
 * again and again. Call both functions per finger; a scene without monitors names EXH_UNTRACKED
 * (safety.h).
 *
 *   raised |= exh_tracking_step(&tracking, &cfg, mon_A_q26) ? EXH_FAULT_TRACKING : 0;
 *   exh_tracking_update(&tracking, current_ledger.coded_A_q26); // after the gate */
#ifndef EXHAND_TRACKING_H
#define EXHAND_TRACKING_H

#include "exhand/bytes.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters of one axis's tracking; rows in exh_tracking_rows[]. */
struct exh_tracking_par {
    int32_t tol_A_q26; /* allowed deviation of the monitor, A, 0.1 .. 1 */
    int32_t time_ms;   /* longest deviation, ms, 1 .. 100, plus 4 ticks */
};
#define EXH_TRACKING_ROWS 2
extern const struct exh_signal exh_tracking_rows[EXH_TRACKING_ROWS];

/* Set-up of one axis. */
struct exh_tracking_cfg {
    int32_t tol_A_q26; /* the parameter */
    uint32_t ticks;    /* time_ms + 4 ticks, rounded up */
};

/* State of one axis. All zeros: drive at rest. */
struct exh_tracking {
    int32_t lo_A_q26, hi_A_q26; /* lowest and highest current coded since the last match */
    uint32_t off_ticks;         /* consecutive ticks without a match, 0 .. ticks */
};

/* Set-up (divides). -EXH_E_RANGE: a parameter outside its range above; -EXH_E_RATE: T. */
int exh_tracking_setup(
    struct exh_tracking_cfg *cfg, const struct exh_tracking_par *par, struct exh_period T);

/* First call of a tick, with the current of exh_drive_monitor_A_q26(). Returns 1 while the
 * current has not followed for cfg->ticks ticks including this one, else 0. Raise
 * EXH_FAULT_TRACKING then. */
int exh_tracking_step(
    struct exh_tracking *s, const struct exh_tracking_cfg *cfg, int32_t mon_A_q26);

/* Call it after the gate, with the coded current of the ledger. Without this call, the first
 * current raises the fault. */
void exh_tracking_update(struct exh_tracking *s, int32_t coded_A_q26);

/* State through a cursor. At worst, damaged bytes raise the fault until the monitor matches. */
void exh_tracking_serialize(struct exh_bytes *c, struct exh_tracking *s);

#ifdef __cplusplus
}
#endif
#endif
