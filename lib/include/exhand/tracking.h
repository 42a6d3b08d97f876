/* SPDX-License-Identifier: MIT */
/* Tracking: does the motor current follow the code that was sent?
 *
 * A D/A that says it has updated and has not leaves its last current on the finger; no
 * card reads back its outputs, the current monitor can tell. Whoever is to follow with an
 * unknown delay must come by: the monitor has to meet, within the tolerance, what was coded
 * since it last did. From then on the band of currents coded begins anew, so it
 * does not grow wide by a current that was left long ago.
 *
 * No false alarm if each step response has settled to within tolerance - noise after time + 4
 * ticks. What is not seen: a current within the tolerance of what is coded, or one that is coded
 * again and again. A scene that moves a motor calls both functions for each finger; one whose port
 * has no monitor names EXH_UNTRACKED instead (safety.h).
 */
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
    int32_t tol_A_q26; /* monitor off by no more, A, 0.1 .. 1 */
    int32_t time_ms;   /* for no longer, ms, 1 .. 100, and 4 ticks */
};
#define EXH_TRACKING_ROWS 2
extern const struct exh_signal exh_tracking_rows[EXH_TRACKING_ROWS];

/* One axis's tracking as it is set up. */
struct exh_tracking_cfg {
    int32_t tol_A_q26; /* the parameter */
    uint32_t ticks;    /* time + 4 ticks, rounded up */
};

/* One axis's tracking from tick to tick. */
struct exh_tracking {
    int32_t lo_A_q26, hi_A_q26; /* least and most that was coded since the monitor met it */
    uint32_t off_ticks;         /* since when it does not, 0 .. ticks */
};

/* Set-up (divides). -EXH_E_RANGE: a parameter outside its range above; -EXH_E_RATE: T. */
int exh_tracking_setup(
    struct exh_tracking_cfg *cfg, const struct exh_tracking_par *par, struct exh_period T);

/* First thing of a tick, with the current monitored (exh_drive_monitor_A_q26). 1 while the
 * current has not followed for cfg->ticks ticks, this one among them: to be raised as
 * EXH_FAULT_TRACKING, in every state; else 0. */
int exh_tracking_step(
    struct exh_tracking *s, const struct exh_tracking_cfg *cfg, int32_t mon_A_q26);

/* Behind the gate, with the current that the code stands for (coded of the ledger). Who forgets
 * it gets the fault with the first current. */
void exh_tracking_update(struct exh_tracking *s, int32_t coded_A_q26);

/* State through a cursor. A state of zeros is a drive at rest. Damaged bytes at worst raise
 * the fault until the monitor is met. */
void exh_tracking_serialize(struct exh_bytes *c, struct exh_tracking *s);

#ifdef __cplusplus
}
#endif
#endif
