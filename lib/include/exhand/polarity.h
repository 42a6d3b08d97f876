/* SPDX-License-Identifier: MIT */
/* Polarity: a small pull at each arming shows that motor and encoder agree.
 *
 * A calibration vouches for the day it was made. Leads that were exchanged since are seen here,
 * before there is strength: once the gate is open, the ramp waits (EXH_ARM_WAIT), the law is not
 * asked, and the string is pulled with a little, after it has been at rest.
 *
 * Only the motor winds a string in, so counts that fall are a motor that pulls: SEEN. Exchanged
 * leads unwind it, exchanged encoder lines count it the wrong way: WRONG. Nothing at all is a dead
 * encoder, a jam or a string that is held fast: STILL, and whoever holds it lets go and arms anew.
 * Not told: both exchanged together. A finger that stretches in these ticks is WRONG, or with
 * exchanged encoder lines SEEN: hence the rest before.
 */
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

/* Parameters, of all fingers; rows in exh_polarity_rows[]. */
struct exh_polarity_par {
    int32_t pull_N_q20; /* of this force, N, 0 .. 1; 0: no pull */
    int32_t time_ms;    /* of rest and pull, ms, 50 .. 5000 */
    int32_t move_m_q30; /* so far is movement, m, 0.05 mm .. 20 mm, and 2 counts */
};
#define EXH_POLARITY_ROWS 3
extern const struct exh_signal exh_polarity_rows[EXH_POLARITY_ROWS];

/* One finger as it is set up. */
struct exh_polarity_cfg {
    int32_t pull_N_q20;         /* 0: no pull */
    int32_t rise_N_q20;         /* a tick, rounded up: the force is there after a quarter of time */
    uint32_t rest_ticks, ticks; /* a quarter of time; time; at least 4 and 16 */
    int32_t move_cnt;           /* rounded down, at least 2: one may be noise */
};

/* How a pull stands or ended. */
enum exh_polarity_result {
    EXH_POLARITY_BUSY,  /* not begun, or goes on */
    EXH_POLARITY_SEEN,  /* the string went in */
    EXH_POLARITY_WRONG, /* it went out */
    EXH_POLARITY_STILL  /* neither, in time */
};

/* One finger from tick to tick. All zeros: not begun. */
struct exh_polarity {
    int32_t from_cnt; /* where it was when it came to rest */
    uint32_t tick;    /* of it all */
    uint32_t rest;    /* at rest since, up to rest_ticks: then it is pulled */
    uint32_t pulled;  /* ticks of pull */
    uint8_t result;   /* enum exh_polarity_result */
};

/* Set-up (divides). -EXH_E_RANGE: a parameter outside its range, or a step that is none;
 * -EXH_E_RATE: T. */
int exh_polarity_setup(struct exh_polarity_cfg *cfg, const struct exh_polarity_par *par,
    int32_t step_m_q42, struct exh_period T);

/* One tick, before exh_safety_step(): pulls is exh_safety_pulls(), without it the pull begins anew.
 * cnt may wrap. Returns enum exh_polarity_result. */
uint8_t exh_polarity_step(
    struct exh_polarity *s, const struct exh_polarity_cfg *cfg, int pulls, int32_t cnt);

/* What is to be pulled with in this tick, N q20: 0 .. pull_N_q20; 0 once it has ended. */
int32_t exh_polarity_force_N_q20(const struct exh_polarity *s, const struct exh_polarity_cfg *cfg);

/* State through a cursor. */
void exh_polarity_serialize(struct exh_bytes *c, struct exh_polarity *s);

#ifdef __cplusplus
}
#endif
#endif
