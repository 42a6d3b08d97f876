/* SPDX-License-Identifier: MIT */
/* exhand calibrate: what its parts share. */
#ifndef BENCH_CALIBRATE_H
#define BENCH_CALIBRATE_H

#include "bench/calibration.h"

#include "calibrate/calibrate.h"

#include <stdint.h>

#define CALIBRATE_SETTINGS_MAX 64

struct calibrate_options {
    int64_t rate_Hz, seed, id, finger, day, valid_days; /* as CLI_INT writes them */
    double residual_N;
    double mass_kg[CALIBRATE_MASSES], hung_kg[CALIBRATE_MASSES];
    int masses, hung, pace, cards;
    const char *out, *check;
    struct calibration_setting setting[CALIBRATE_SETTINGS_MAX];
    int settings;
    struct sim_device device;
    unsigned wrong;
};

/* What is wrong with an image, after a line on stderr: 1. */
int calibrate_complain(const char *what, int err, const struct exh_calib_error *bad);

/* Checks and prints a result. Every mass must be a point, the tables complete, and the masses
 * consistent. Force per current must be near the device's kf and the last image in --out. 0 with
 * *l, or 1 after a line on stderr. */
int calibrate_judge(
    const struct calibrate_options *o, const struct calibration *r, struct calibration_lines *l);

/* Force over current beyond half or 3/2 of kf, N/A, at some point: 1 after a line on stderr that
 * begins with `what` and ends with `advice`. */
int calibrate_far(const char *what, const struct exh_calib *c, double kf_NpA, const char *whose,
    const char *advice);

/* --check: exit status. */
int calibrate_check(const struct calibrate_options *o);

#endif
