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

/* --check: exit status. */
int calibrate_check(const struct calibrate_options *o);

#endif
