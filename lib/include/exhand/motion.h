/* SPDX-License-Identifier: MIT */
/* Motion: what a finger's own movement tells: it is too fast, or it stands although pulled.
 *
 * The speed limit acts on the velocity that goes into the law; who is beyond it for too long has a
 * fault. That a string held fast, or drawn by a rigid finger, stands just as a dead encoder does is
 * not to be told by the movement alone: `stuck` is off (0 ms) unless the scene knows that what
 * hangs on the string moves by itself, as a living finger trembles. */
#ifndef EXHAND_MOTION_H
#define EXHAND_MOTION_H

#include "exhand/bytes.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters of one finger; rows in exh_motion_rows[]. */
struct exh_motion_par {
    int32_t speed_mps_q27;   /* velocity into the law is no more, m/s, 0.1 .. 10 */
    int32_t speed_ms;        /* beyond it for longer: fault, ms, 1 .. 1000 */
    int32_t stuck_ms;        /* not one count for longer: fault, ms, 100 .. 60000; 0: never */
    int32_t stuck_cur_A_q26; /* while more than this is coded, A, 0.05 .. 6.6 */
};
#define EXH_MOTION_ROWS 4
extern const struct exh_signal exh_motion_rows[EXH_MOTION_ROWS];

/* One finger as it is set up. */
struct exh_motion_cfg {
    const struct exh_motion_par *par; /* read at every tick */
    uint32_t speed_ticks;             /* times, rounded up */
    uint32_t stuck_ticks;             /* 0: never */
};

/* One finger from tick to tick. */
struct exh_motion {
    uint32_t fast_ticks;  /* beyond the limit since, 0 .. speed_ticks */
    uint32_t stuck_ticks; /* pulled, and not a count since, 0 .. stuck_ticks */
    int32_t cnt;          /* of the last tick */
};

/* Set-up (divides). -EXH_E_RANGE: a parameter outside its range above; -EXH_E_RATE: T. */
int exh_motion_setup(
    struct exh_motion_cfg *cfg, const struct exh_motion_par *par, struct exh_period T);

/* First thing of a tick, with the velocity measured: brings it within the limit, adds
 * EXH_LIMIT_SPEED to limits where it was not, and returns the faults that are due
 * (EXH_FAULT_SPEED, EXH_FAULT_STUCK). Ticks missed are no evidence and do not count. */
uint32_t exh_motion_step(
    struct exh_motion *s, const struct exh_motion_cfg *cfg, int32_t *vel_mps_q27, uint32_t *limits);

/* Behind the gate, with the count of this tick and the current coded. */
void exh_motion_update(
    struct exh_motion *s, const struct exh_motion_cfg *cfg, int32_t cnt, int32_t coded_A_q26);

/* State through a cursor. A state of zeros is a finger at rest. */
void exh_motion_serialize(struct exh_bytes *c, struct exh_motion *s);

#ifdef __cplusplus
}
#endif
#endif
