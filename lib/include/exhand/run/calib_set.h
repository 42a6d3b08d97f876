/* SPDX-License-Identifier: MIT */
/* The calibrations of a scene's fingers (exhand/calibrate.h). Set-up checks the images that
 * `calibrate` made against device, day and scales, and makes the force tables from them. A valid
 * image confirms two steps of arming: CALIBRATION, and POLARITY, since every image was made after a
 * small pull that moved the slack string in. */
#ifndef EXHAND_RUN_CALIB_SET_H
#define EXHAND_RUN_CALIB_SET_H

#include "exhand/run/scene.h"

#include "exhand/calibrate.h"
#include "exhand/params.h"
#include "exhand/signal.h"

struct exh_calib_set_par {
    int32_t device_id;    /* id of this device; an image is for one device */
    int32_t day;          /* today, days since 1970-01-01; 0: unknown, every image is refused */
    int32_t uncalibrated; /* 1: fingers without an image may arm */
    int32_t far_allowed;  /* 1: force per current may be far from kf and from the other fingers */
};
#define EXH_CALIB_SET_ROWS 4
extern const struct exh_signal exh_calib_set_rows[EXH_CALIB_SET_ROWS];

/* Tables of one finger. */
struct exh_calib_tables {
    struct exh_knot force_to_cur[EXH_CALIB_POINTS_MAX + 2];
    struct exh_knot cur_to_force[2 * EXH_CALIB_POINTS_MAX + 3];
    uint8_t to_cur_n, to_force_n;
    uint8_t vouches; /* enum exh_arm: CALIBRATION and POLARITY, or none */
};

/* First call of a set-up: checks every image. Each must be undamaged, of a different finger of the
 * mask, of this device and valid today. With three or more, force per current must be within half
 * of their median (exh_calib_near()), unless far_calibration is set. Then sets the monitor zero of
 * each finger as DRIVE parameter of instance `finger`; a log's header contains it. Returns 0, or
 * -EXH_E_... with image and reason in *k, and takes nothing. */
int exh_calib_set_load(struct exh_scene_calib *k, struct exh_params *params,
    const struct exh_calib_set_par *par, uint32_t fingers);

/* Makes the tables of one finger, with an image from the image. -EXH_E_STALE, with the reason in
 * *k: its scales are not those in use. -EXH_E_RANGE: it is not within half of kf, and
 * far_calibration is not set. Without an image (k may be NULL), tables are straight lines by kf,
 * N/A, to the peak current, confirmed only if `uncalibrated` is set. Returns 0 or an error. */
struct exh_calib_finger {
    unsigned f;
    const struct exh_drive_par *drive;
    int32_t kf_NpA_q20;
};
int exh_calib_set_tables(struct exh_calib_tables *t, struct exh_scene_calib *k,
    const struct exh_calib_set_par *par, const struct exh_calib_finger *of);

static inline struct exh_table exh_calib_to_cur(const struct exh_calib_tables *t)
{
    return (struct exh_table){t->force_to_cur, t->to_cur_n};
}

static inline struct exh_table exh_calib_to_force(const struct exh_calib_tables *t)
{
    return (struct exh_table){t->cur_to_force, t->to_force_n};
}

#endif
