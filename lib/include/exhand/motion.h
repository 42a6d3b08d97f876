/* SPDX-License-Identifier: MIT */
/* Motion: detects a finger that is too fast, or that does not move although it is pulled.
 *
 * The velocity is limited before it enters the law. Exceeding the limit for too long is a fault.
 * The stuck check is off by default (0 ms): a string that is held fast looks like a dead encoder.
 * Enable it only if the load always moves a little, as a living finger trembles. */
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
    int32_t speed_mps_q27;   /* limit of the velocity into the law, m/s, 0.1 .. 10 */
    int32_t speed_ms;        /* time above it until the fault, ms, 1 .. 1000 */
    int32_t stuck_ms;        /* time without a count until the fault, ms, 100 .. 60000; 0: never */
    int32_t stuck_cur_A_q26; /* coded current above which stuck_ms counts, A, 0.05 .. 6.6 */
};
#define EXH_MOTION_ROWS 4
extern const struct exh_signal exh_motion_rows[EXH_MOTION_ROWS];

/* Set-up of one finger. */
struct exh_motion_cfg {
    const struct exh_motion_par *par; /* read at every tick */
    uint32_t speed_ticks;             /* times, rounded up */
    uint32_t stuck_ticks;             /* 0: never */
};

/* State of one finger. All zeros: at rest. */
struct exh_motion {
    uint32_t fast_ticks;  /* ticks above the limit, 0 .. speed_ticks */
    uint32_t stuck_ticks; /* ticks pulled without a count, 0 .. stuck_ticks */
    int32_t cnt;          /* count of the last tick */
};

/* Set-up (divides). -EXH_E_RANGE: a parameter outside its range above; -EXH_E_RATE: T. */
int exh_motion_setup(
    struct exh_motion_cfg *cfg, const struct exh_motion_par *par, struct exh_period T);

/* First call of a tick, with the measured velocity. Limits *vel_mps_q27, and adds EXH_LIMIT_SPEED
 * to *limits if that changed it. Returns faults: SPEED, STUCK. Missed ticks do not count. */
uint32_t exh_motion_step(
    struct exh_motion *s, const struct exh_motion_cfg *cfg, int32_t *vel_mps_q27, uint32_t *limits);

/* Call it after the gate, with the count and the coded current of this tick. */
void exh_motion_update(
    struct exh_motion *s, const struct exh_motion_cfg *cfg, int32_t cnt, int32_t coded_A_q26);

/* State through a cursor. */
void exh_motion_serialize(struct exh_bytes *c, struct exh_motion *s);

#ifdef __cplusplus
}
#endif
#endif
