/* SPDX-License-Identifier: MIT */
/* The estimators of estimators.h in plain floating point and in bare integers, behind the same
 * interface; arg of the bare pole: its shift. */
#ifndef BENCH_ESTIMATORS_PLAIN_H
#define BENCH_ESTIMATORS_PLAIN_H

#include "bare.h"
#include "plain.h"

#include "exhand/velocity.h"

#include <math.h>
#include <string.h>

#define ESTIMATORS(R) \
    static struct { \
        R step; \
        struct plain_window_##R window; \
        struct plain_pole_##R pole; \
        struct plain_foaw_##R foaw; \
    } in_##R; \
    static inline void R##_clear(struct exh_velocity_scale s) \
    { \
        memset(&in_##R, 0, sizeof in_##R); \
        in_##R.step = (R)(s.step_m_q42 * 0x1p-42); \
    } \
    static inline int R##_window_start(struct exh_velocity_scale s, int arg) \
    { \
        R##_clear(s); \
        in_##R.window.n = (unsigned)arg; \
        in_##R.window.gain = (R)(s.T.den / (double)s.T.num / arg); \
        return 0; \
    } \
    static inline R R##_window_raw(int32_t n) \
    { \
        return plain_window_##R(&in_##R.window, (R)n * in_##R.step); \
    } \
    static inline int R##_pole_start(struct exh_velocity_scale s, int tau_us) \
    { \
        R##_clear(s); \
        in_##R.pole.keep = (R)exp(-1e6 / tau_us * s.T.num / s.T.den); \
        in_##R.pole.gain = (1 - in_##R.pole.keep) * (R)s.T.den / (R)s.T.num; \
        return 0; \
    } \
    static inline R R##_pole_raw(int32_t n) \
    { \
        return plain_pole_##R(&in_##R.pole, (R)n * in_##R.step); \
    } \
    static inline int R##_foaw_start(struct exh_velocity_scale s, int arg) \
    { \
        R##_clear(s); \
        (void)arg; \
        in_##R.foaw.rate = (R)s.T.den / (R)s.T.num; \
        in_##R.foaw.band = in_##R.step * (R)1.0001; \
        return 0; \
    } \
    static inline R R##_foaw_raw(int32_t n) \
    { \
        return plain_foaw_##R(&in_##R.foaw, (R)n * in_##R.step); \
    } \
    static inline int32_t R##_window_step(int32_t n) \
    { \
        return (int32_t)(R##_window_raw(n) * (R)(1 << EXH_Q_VEL)); \
    } \
    static inline int32_t R##_pole_step(int32_t n) \
    { \
        return (int32_t)(R##_pole_raw(n) * (R)(1 << EXH_Q_VEL)); \
    } \
    static inline int32_t R##_foaw_step(int32_t n) \
    { \
        return (int32_t)(R##_foaw_raw(n) * (R)(1 << EXH_Q_VEL)); \
    }

ESTIMATORS(double)
ESTIMATORS(float)

static struct bare_pole bare_pole_state;
static struct bare_track bare_track_state;

static inline struct bare_scale bare_scale(struct exh_velocity_scale s)
{
    const double one = s.step_m_q42 * 0x1p-42 * s.T.den / s.T.num * (1 << EXH_Q_VEL);
    int bits;
    (void)frexp(one, &bits);
    return (struct bare_scale){(int32_t)ldexp(one, 30 - bits), (unsigned)(30 - bits)};
}

static inline int bare_pole_start(struct exh_velocity_scale s, int arg)
{
    bare_pole_state = (struct bare_pole){bare_scale(s), (unsigned)arg, 0, 0};
    return 0;
}

static inline int32_t bare_pole_step(int32_t cnt) { return bare_pole(&bare_pole_state, cnt); }

static inline int bare_track_start(struct exh_velocity_scale s, int tf_us)
{
    const double theta = tf_us / (tf_us + 1e6 * s.T.num / s.T.den), one = 1 - theta;
    bare_track_state = (struct bare_track){bare_scale(s),
        (int32_t)((1 - theta * theta) * 2147483647), (int32_t)(one * one * 2147483647), 0, 0};
    return 0;
}

static inline int32_t bare_track_step(int32_t cnt) { return bare_track(&bare_track_state, cnt); }

#endif
