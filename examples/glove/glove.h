/* SPDX-License-Identifier: MIT */
/* The sensing half of the device as a scene: 22 codes to glove angles, joints of the robot hand and
 * five fingertips. No motor runs. */
#ifndef EXAMPLES_GLOVE_H
#define EXAMPLES_GLOVE_H

#include "exhand/run/scene.h"
#include "cal.h"

#include "exhand/exhand.h"

/* All parameters, in the order of the scene's signal table. */
struct glove_par {
    struct exh_glove_par glove;
    struct exh_hand_par hand; /* common to five fingers */
    struct glove_own_par own;
    struct glove_sensor_par sensor[EXH_GLOVE_SENSORS];
};

/* In the order of the table. Constant between two frames, except age. */
struct glove_signals {
    int32_t angle_turn_q32[EXH_GLOVE_SENSORS];
    int32_t faults; /* bit i: sensor i */
    int32_t joint_turn_q32[EXH_FINGERS][EXH_HAND_JOINTS];
    int32_t clamped; /* bit 3 f + j: joint j of finger f */
    struct exh_vec3 tip_m_q30[EXH_FINGERS];
    int32_t age_ticks;
};

struct glove_cfg {
    struct exh_glove_cal cal;
    struct exh_glove_cfg glove;
    struct exh_hand_finger finger[EXH_FINGERS];
};

struct glove {
    struct exh_glove glove;
    struct glove_signals sig;
};

/* Makes the configuration from parameters; T is the time between frames. 0 or -EXH_E_.... */
int glove_setup(struct glove_cfg *cfg, const struct glove_par *par, struct exh_period T);

/* Processes one frame: sets all of sig except age. */
void glove_frame(struct glove *s, const struct glove_cfg *cfg, const struct exh_glove_in *in);

/* A calibration into parameters and back. */
void glove_par_of_cal(struct glove_par *par, const struct exh_glove_cal *cal);
void glove_cal_of_par(struct exh_glove_cal *cal, const struct glove_par *par);

/* Stages a calibration in the scene's parameters, between defaults() and set-up. Returns 0, or
 * -EXH_E_RANGE with the reason in *bad (may be NULL). */
int glove_stage_cal(const struct exh_glove_cal *cal, struct exh_glove_error *bad);

extern const struct exh_scene exh_scene_glove;

#endif
