/* SPDX-License-Identifier: MIT */
/* Velocity from an encoder count: five estimators, of which a scene links one.
 *
 * Each takes the extended count once per tick and returns m/s in q27, saturated at +-16 m/s. In the
 * table, y is the position, T the loop period, D the encoder step. Lag is the steady velocity error
 * divided by the acceleration. `make bench` measures noise, lag and instructions (docs/TABLES.md).
 * Source: Janabi-Sharifi et al. and Kikuuwe for FOAW; textbooks for the others.
 *
 *   difference  (y[k]-y[k-1])/T              error < D/T       lag T/2
 *   window      (y[k]-y[k-n])/(nT), n = 2^p  error < D/(nT)    lag nT/2
 *   pole        difference through 1 pole    lag T/2 + tau
 *   foaw        longest line that fits       adaptive window, n <= 16
 *   track       critically damped observer   lag T(alpha/beta - 1/2)
 *
 * The first call sets the position and returns 0. Count differences are exact across the wrap.
 *
 *   struct exh_velocity_scale scale = {quad_par.step_m_q42, {1, 2000}};
 *   struct exh_velocity_par par = {2}; // window of 4 ticks
 *   int err = exh_velocity_window_setup(&cfg, scale, &par);
 *   int32_t vel_mps_q27 = exh_velocity_window_step(&window, &cfg, cnt); */
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

/* Input of the set-up of every estimator. */
struct exh_velocity_scale {
    int32_t step_m_q42;  /* m per count, > 0 */
    struct exh_period T; /* period of the loop */
};

/* --- difference and window: n = 2^p; p = 0 is the plain backward difference --- */
/* Parameter of the window; row in exh_velocity_rows[]. */
struct exh_velocity_par {
    int32_t p; /* 0 .. 4: log2 of the window in ticks */
};
#define EXH_VELOCITY_ROWS 1
extern const struct exh_signal exh_velocity_rows[EXH_VELOCITY_ROWS];

/* Set-up of the window, shared by any number of fingers of one scale. */
struct exh_velocity_window_cfg {
    struct exh_gain gain; /* m/s q27 per count over the window */
    uint8_t n;            /* 1, 2, 4, 8 or 16 */
};

/* The window of one finger. All zeros: no count yet. The same holds for the states below. */
struct exh_velocity_window {
    int32_t cnt[EXH_VELOCITY_N]; /* the last n counts */
    uint8_t at;                  /* index of the oldest */
    uint8_t started;             /* 1 after the first call */
};

/* Set-up (divides). Step: the velocity, m/s, q27, of the tick with this count. Serialize: the state
 * through a cursor. -EXH_E_RATE: T; -EXH_E_RANGE: p > 4, or the step is not above 0. */
int exh_velocity_window_setup(struct exh_velocity_window_cfg *cfg, struct exh_velocity_scale s,
    const struct exh_velocity_par *par);
int32_t exh_velocity_window_step(
    struct exh_velocity_window *s, const struct exh_velocity_window_cfg *cfg, int32_t cnt);
void exh_velocity_window_serialize(struct exh_bytes *c, struct exh_velocity_window *s);

/* --- pole: v += (diff - v) * T/(T + tau) --- */
/* Set-up of the pole, shared as the window's. */
struct exh_velocity_pole_cfg {
    struct exh_gain gain; /* m/s q27 per count */
    int32_t a_q31;        /* T/(T + tau), > 0 .. 1-2^-31 */
};

/* The pole of one finger. */
struct exh_velocity_pole {
    int64_t v_mps_q55; /* q27 plus 28 bits, so that it settles exactly */
    int32_t cnt;       /* count of the last tick */
    uint8_t started;   /* 1 after the first call */
};

/* As the window's functions. tau_us is 0 .. 10^6, else -EXH_E_RANGE. */
int exh_velocity_pole_setup(
    struct exh_velocity_pole_cfg *cfg, struct exh_velocity_scale s, uint32_t tau_us);
int32_t exh_velocity_pole_step(
    struct exh_velocity_pole *s, const struct exh_velocity_pole_cfg *cfg, int32_t cnt);
void exh_velocity_pole_serialize(struct exh_bytes *c, struct exh_velocity_pole *s);

/* --- foaw: least-squares fit over the longest window in which all samples stay within tol counts
 * of the fitted slope through the newest sample; at least n = 1. The test is exact in integers.
 * The first window that does not fit ends the search. So the cost depends on the signal, and is
 * highest where all windows fit. --- */
/* Set-up of FOAW, shared as the window's. */
struct exh_velocity_foaw_cfg {
    struct exh_gain gain[EXH_VELOCITY_N]; /* [n-1]: m/s q27 per unit of n*S0-2*S1 */
    uint8_t n;                            /* longest window, 1 .. 16 */
    uint8_t tol_cnt;                      /* 1 .. 255, usually 1 */
};

/* The FOAW of one finger. */
struct exh_velocity_foaw {
    int32_t cnt[EXH_VELOCITY_N]; /* the last counts, a ring */
    uint8_t at;                  /* index of the newest */
    uint8_t have;                /* number of samples held */
};

/* As the window's functions. n is 1 .. 16 and tol_cnt 1 .. 255, else -EXH_E_RANGE. */
int exh_velocity_foaw_setup(
    struct exh_velocity_foaw_cfg *cfg, struct exh_velocity_scale s, unsigned n, unsigned tol_cnt);
int32_t exh_velocity_foaw_step(
    struct exh_velocity_foaw *s, const struct exh_velocity_foaw_cfg *cfg, int32_t cnt);
void exh_velocity_foaw_serialize(struct exh_bytes *c, struct exh_velocity_foaw *s);

/* --- track: alpha-beta observer with a double pole theta = T_f/(T_f + T): alpha = 1-theta^2,
 * beta = (1-theta)^2. At rest the velocity ends within (T_f/T + 1) * 2^-32 counts a tick of 0.
 * Movements beyond 2^28 counts a tick saturate. --- */
/* Set-up of the observer, shared as the window's. */
struct exh_velocity_track_cfg {
    struct exh_gain gain; /* m/s q27 per count and tick */
    int32_t alpha_q31;    /* share of the error added to the position, > 0 .. 1 */
    int32_t beta_q31;     /* share of the error added to the velocity per tick, > 0 .. 1 */
};

/* The observer of one finger. */
struct exh_velocity_track {
    int64_t err_cnt_q32; /* estimated position minus the last count */
    int64_t vel_cnt_q32; /* counts per tick; both saturate at +-2^28 counts */
    int32_t cnt;         /* count of the last tick */
    uint8_t started;     /* 1 after the first call */
};

/* As the window's functions. tf_us, the time constant T_f of each pole, is 0 .. 10^6, else
 * -EXH_E_RANGE. */
int exh_velocity_track_setup(
    struct exh_velocity_track_cfg *cfg, struct exh_velocity_scale s, uint32_t tf_us);
int32_t exh_velocity_track_step(
    struct exh_velocity_track *s, const struct exh_velocity_track_cfg *cfg, int32_t cnt);
void exh_velocity_track_serialize(struct exh_bytes *c, struct exh_velocity_track *s);

#ifdef __cplusplus
}
#endif
#endif
