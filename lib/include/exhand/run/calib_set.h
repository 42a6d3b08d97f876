/* SPDX-License-Identifier: MIT */
/* A scene's calibrations of fingers: images that `calibrate` made (exhand/calibrate.h), checked at
 * set-up against device, day and scales, into the tables that forces go by. A good one vouches for
 * two steps of arming: CALIBRATION, and POLARITY, since no image comes to be before a small pull
 * was seen to move the slack string in. */
#ifndef EXHAND_RUN_CALIB_SET_H
#define EXHAND_RUN_CALIB_SET_H

#include "exhand/run/scene.h"

#include "exhand/calibrate.h"
#include "exhand/params.h"
#include "exhand/signal.h"

struct exh_calib_set_par {
    int32_t device_id;    /* of this box: images are made for one */
    int32_t day;          /* today, days since 1970-01-01; 0, not known: no image of a day holds */
    int32_t uncalibrated; /* 1: fingers without an image arm without */
    int32_t far_allowed;  /* 1: force over current may be far from kf and from other fingers' */
};
#define EXH_CALIB_SET_ROWS 4
extern const struct exh_signal exh_calib_set_rows[EXH_CALIB_SET_ROWS];

/* Of one finger. */
struct exh_calib_tables {
    struct exh_knot force_to_cur[EXH_CALIB_POINTS_MAX + 2];
    struct exh_knot cur_to_force[2 * EXH_CALIB_POINTS_MAX + 3];
    uint8_t to_cur_n, to_force_n;
    uint8_t vouches; /* enum exh_arm: CALIBRATION and POLARITY, or none */
};

/* First thing of a set-up: every image must be sound, of one of these fingers (bits), of no other
 * one's finger, of this device and good today. Of three or more, each must have a force over
 * current within half of their median (exh_calib_near()), unless `far_calibration`. Then the zero
 * of each finger's monitor becomes the parameter, which a log's header has, as DRIVE parameters of
 * instance `finger`. 0, or -EXH_E_… with *k saying of which image and what, and nothing taken. */
int exh_calib_set_load(struct exh_scene_calib *k, struct exh_params *params,
    const struct exh_calib_set_par *par, uint32_t fingers);

/* Then tables of a finger: those of its image, made with the scales in use (else -EXH_E_STALE, and
 * *k says so) and within half of kf (else -EXH_E_RANGE, unless `far_calibration`); or, of a finger
 * without one, straight lines by kf, N/A, to the peak current, vouched for only where
 * `uncalibrated` waives it. k may be NULL: there are no images. 0 or -EXH_E_…. Divides. */
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
