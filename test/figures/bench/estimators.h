/* SPDX-License-Identifier: MIT */
/* One of each velocity estimator, behind one interface: start, 0 or why not, and step. arg:
 * window p, of 2^p ticks; pole tau and track T_f in us; foaw the longest window in ticks. */
#ifndef BENCH_ESTIMATORS_H
#define BENCH_ESTIMATORS_H

#include "exhand/exhand.h"

static struct exh_velocity_window_cfg window_cfg;
static struct exh_velocity_window window;
static struct exh_velocity_pole_cfg pole_cfg;
static struct exh_velocity_pole pole;
static struct exh_velocity_foaw_cfg foaw_cfg;
static struct exh_velocity_foaw foaw;
static struct exh_velocity_track_cfg track_cfg;
static struct exh_velocity_track track;

static inline int window_start(struct exh_velocity_scale s, int arg)
{
    const struct exh_velocity_par par = {arg};
    window = (struct exh_velocity_window){.started = 0};
    return exh_velocity_window_setup(&window_cfg, s, &par);
}

static inline int32_t window_step(int32_t cnt)
{
    return exh_velocity_window_step(&window, &window_cfg, cnt);
}

static inline int pole_start(struct exh_velocity_scale s, int arg)
{
    pole = (struct exh_velocity_pole){.started = 0};
    return exh_velocity_pole_setup(&pole_cfg, s, (uint32_t)arg);
}

static inline int32_t pole_step(int32_t cnt)
{
    return exh_velocity_pole_step(&pole, &pole_cfg, cnt);
}

static inline int foaw_start(struct exh_velocity_scale s, int arg)
{
    foaw = (struct exh_velocity_foaw){.have = 0};
    return exh_velocity_foaw_setup(&foaw_cfg, s, (unsigned)arg, 1);
}

static inline int32_t foaw_step(int32_t cnt)
{
    return exh_velocity_foaw_step(&foaw, &foaw_cfg, cnt);
}

static inline int track_start(struct exh_velocity_scale s, int arg)
{
    track = (struct exh_velocity_track){.started = 0};
    return exh_velocity_track_setup(&track_cfg, s, (uint32_t)arg);
}

static inline int32_t track_step(int32_t cnt)
{
    return exh_velocity_track_step(&track, &track_cfg, cnt);
}

#endif
