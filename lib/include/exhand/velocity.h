/* SPDX-License-Identifier: MIT */
/* Velocity of a counted position: five estimators, of which a scene links one.
 *
 * All take the extended count and return m/s in q27, saturated at +-16 m/s.
 * T is the loop period, D the encoder step. Lag is the steady velocity error per
 * acceleration. Table of noise, lag and instructions: docs/REPORT.md, made by
 * `make bench`; formulas: Kikuuwe/Janabi-Sharifi for FOAW, the rest textbook.
 *
 *   difference  (y[k]-y[k-1])/T              error < D/T       lag T/2
 *   window      (y[k]-y[k-n])/(nT), n = 2^p  error < D/(nT)    lag nT/2
 *   pole        difference through 1 pole    lag T/2 + tau
 *   foaw        longest line that fits       adaptive window, n <= 16
 *   track       critically damped observer   lag T(alpha/beta - 1/2)
 *
 * The first call of each sets the position and returns 0. Count differences
 * are exact across the wrap of the count.
 */
#ifndef EXHAND_VELOCITY_H
#define EXHAND_VELOCITY_H

#include "exhand/bytes.h"
#include "exhand/fix.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_VELOCITY_N 16 /* longest window, ticks */

/* What every estimator's set-up needs. */
struct exh_velocity_scale {
    int32_t step_m_q42;  /* m per count, > 0 */
    struct exh_period T; /* of the loop */
};

/* --- difference and window: n = 2^p, p = 0 is the plain backward difference --- */
/* The window's parameter; row in exh_velocity_rows[]. */
struct exh_velocity_par {
    int32_t p; /* 0 .. 4 */
};
#define EXH_VELOCITY_ROWS 1
extern const struct exh_signal exh_velocity_rows[EXH_VELOCITY_ROWS];

/* The window as it is set up; one for any number of fingers of one scale. */
struct exh_velocity_window_cfg {
    struct exh_gain gain; /* m/s q27 per count over the window */
    uint8_t n;            /* 1, 2, 4, 8 or 16 */
};

/* One finger's window. A state of zeros has seen no count, of this and of the estimators below. */
struct exh_velocity_window {
    int32_t cnt[EXH_VELOCITY_N]; /* the last n counts */
    uint8_t at;                  /* oldest of them */
    uint8_t started;             /* 1: behind the first call */
};

/* Set-up (divides); the velocity, m/s, q27, in a tick of this count; state through a cursor.
 * -EXH_E_RATE: T; -EXH_E_RANGE when p > 4 or the step is not above 0. */
int exh_velocity_window_setup(struct exh_velocity_window_cfg *cfg, struct exh_velocity_scale s,
    const struct exh_velocity_par *par);
int32_t exh_velocity_window_step(
    struct exh_velocity_window *s, const struct exh_velocity_window_cfg *cfg, int32_t cnt);
void exh_velocity_window_serialize(struct exh_bytes *c, struct exh_velocity_window *s);

/* --- pole: v += (diff - v) * T/(T + tau) --- */
/* The pole as it is set up, likewise. */
struct exh_velocity_pole_cfg {
    struct exh_gain gain; /* m/s q27 per count */
    int32_t a_q31;        /* T/(T + tau), > 0 .. 1-2^-31 */
};

/* One finger's pole. */
struct exh_velocity_pole {
    int64_t v_mps_q55; /* q27 plus 28 bits, so that it settles exactly */
    int32_t cnt;       /* of the last tick */
    uint8_t started;   /* 1: behind the first call */
};

/* As those of the window; tau_us: 0 .. 10^6, else -EXH_E_RANGE too. */
int exh_velocity_pole_setup(
    struct exh_velocity_pole_cfg *cfg, struct exh_velocity_scale s, uint32_t tau_us);
int32_t exh_velocity_pole_step(
    struct exh_velocity_pole *s, const struct exh_velocity_pole_cfg *cfg, int32_t cnt);
void exh_velocity_pole_serialize(struct exh_bytes *c, struct exh_velocity_pole *s);

/* --- foaw: best fit (least squares) over the longest window whose samples all
 * stay within tol counts of the line of that slope through the newest one; at
 * least n = 1. The test is exact in integers; all windows are always tried, so the
 * cost does not depend on the signal. --- */
/* FOAW as it is set up, likewise. */
struct exh_velocity_foaw_cfg {
    struct exh_gain gain[EXH_VELOCITY_N]; /* [n-1]: m/s q27 per unit of n*S0-2*S1 */
    uint8_t n;                            /* longest window, 1 .. 16 */
    uint8_t tol_cnt;                      /* 1 .. 255, usually 1 */
};

/* One finger's FOAW. */
struct exh_velocity_foaw {
    int32_t cnt[EXH_VELOCITY_N + 1]; /* the last n + 1 counts, a ring */
    uint8_t at;                      /* newest */
    uint8_t have;                    /* samples held */
};

/* As those of the window; n: 1 .. 16, tol_cnt: 1 .. 255, else -EXH_E_RANGE too. */
int exh_velocity_foaw_setup(
    struct exh_velocity_foaw_cfg *cfg, struct exh_velocity_scale s, unsigned n, unsigned tol_cnt);
int32_t exh_velocity_foaw_step(
    struct exh_velocity_foaw *s, const struct exh_velocity_foaw_cfg *cfg, int32_t cnt);
void exh_velocity_foaw_serialize(struct exh_bytes *c, struct exh_velocity_foaw *s);

/* --- track: alpha-beta observer with a double pole theta = T_f/(T_f + T):
 * alpha = 1-theta^2, beta = (1-theta)^2. At rest it ends within (T_f/T + 1) * 2^-32
 * counts a tick of 0; movements beyond 2^28 counts a tick read as that. --- */
/* The observer as it is set up, likewise. */
struct exh_velocity_track_cfg {
    struct exh_gain gain; /* m/s q27 per count and tick */
    int32_t alpha_q31;    /* share of the error that position takes, > 0 .. 1 */
    int32_t beta_q31;     /* that velocity takes a tick, likewise */
};

/* One finger's observer. */
struct exh_velocity_track {
    int64_t err_cnt_q32; /* estimated position minus the last count */
    int64_t vel_cnt_q32; /* counts per tick; both saturate at +-2^28 counts */
    int32_t cnt;         /* of the last tick */
    uint8_t started;     /* 1: behind the first call */
};

/* As those of the window; tf_us: time constant T_f of each pole, 0 .. 10^6, else -EXH_E_RANGE too.
 */
int exh_velocity_track_setup(
    struct exh_velocity_track_cfg *cfg, struct exh_velocity_scale s, uint32_t tf_us);
int32_t exh_velocity_track_step(
    struct exh_velocity_track *s, const struct exh_velocity_track_cfg *cfg, int32_t cnt);
void exh_velocity_track_serialize(struct exh_bytes *c, struct exh_velocity_track *s);

#ifdef __cplusplus
}
#endif
#endif
