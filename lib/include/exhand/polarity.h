/* SPDX-License-Identifier: MIT */
/* Polarity: a small pull at each arming checks the signs of motor and encoder.
 *
 * A calibration is valid for the day of its measurement. This check detects leads exchanged since,
 * before the full force is available. Once the gate is open, the ramp waits (EXH_ARM_WAIT) and the
 * law is off. After the string has been at rest, the motor pulls a little.
 *
 * Only the motor winds a string in. Falling counts show that it pulls: SEEN. Exchanged motor leads
 * unwind the string, exchanged encoder lines reverse the count: WRONG. No movement means a dead
 * encoder, a jam or a string that is held fast: STILL; let it go and arm again. The check cannot
 * detect both exchanges together. If the finger extends during the pull, the result is WRONG, or
 * SEEN with exchanged encoder lines. The rest before the pull makes that unlikely. */
#ifndef EXHAND_POLARITY_H
#define EXHAND_POLARITY_H

#include "exhand/bytes.h"
#include "exhand/safety.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters of all fingers; rows in exh_polarity_rows[]. */
struct exh_polarity_par {
    int32_t pull_N_q20; /* force of the pull, N, 0 .. 1; 0: no pull */
    int32_t time_ms;    /* time of rest and pull, ms, 50 .. 5000 */
    int32_t move_m_q30; /* smallest movement, m, 0.05 mm .. 20 mm, and at least 2 counts */
};
#define EXH_POLARITY_ROWS 3
extern const struct exh_signal exh_polarity_rows[EXH_POLARITY_ROWS];

/* Set-up of one finger. */
struct exh_polarity_cfg {
    int32_t pull_N_q20;         /* 0: no pull */
    int32_t rise_N_q20;         /* per tick, rounded up: full force after a quarter of the time */
    uint32_t rest_ticks, ticks; /* a quarter of the time; the time; at least 4 and 16 */
    int32_t move_cnt;           /* rounded down, at least 2, since one count may be noise */
};

/* Progress or result of a pull. */
enum exh_polarity_result {
    EXH_POLARITY_BUSY,  /* not started, or in progress */
    EXH_POLARITY_SEEN,  /* the string was wound in */
    EXH_POLARITY_WRONG, /* the string was unwound */
    EXH_POLARITY_STILL  /* no movement in time */
};

/* State of one finger. All zeros: not started. */
struct exh_polarity {
    int32_t from_cnt; /* position at rest, before the pull */
    uint32_t tick;    /* ticks since the start */
    uint32_t rest;    /* ticks at rest, up to rest_ticks; then the pull starts */
    uint32_t pulled;  /* ticks of pull */
    uint8_t result;   /* enum exh_polarity_result */
};

/* Set-up (divides). -EXH_E_RANGE: a parameter outside its range, or a step <= 0. -EXH_E_RATE: T. */
int exh_polarity_setup(struct exh_polarity_cfg *cfg, const struct exh_polarity_par *par,
    int32_t step_m_q42, struct exh_period T);

/* One tick; call it before exh_safety_step(). pulls is exh_safety_pulls(); without it the check
 * restarts. cnt may wrap. Returns enum exh_polarity_result. */
uint8_t exh_polarity_step(
    struct exh_polarity *s, const struct exh_polarity_cfg *cfg, int pulls, int32_t cnt);

/* The pull force of this tick, N q20: 0 .. pull_N_q20; 0 after the end. */
int32_t exh_polarity_force_N_q20(const struct exh_polarity *s, const struct exh_polarity_cfg *cfg);

/* State through a cursor. */
void exh_polarity_serialize(struct exh_bytes *c, struct exh_polarity *s);

#ifdef __cplusplus
}
#endif
#endif
