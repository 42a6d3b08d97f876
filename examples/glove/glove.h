/* SPDX-License-Identifier: MIT */
/* The sensing half of the box as a scene: 22 codes to glove angles, to the joints of the robot
 * hand, to five fingertips. No motor runs. */
#ifndef EXAMPLES_GLOVE_H
#define EXAMPLES_GLOVE_H

#include "exhand/run/scene.h"
#include "cal.h"

#include "exhand/exhand.h"

/* All parameters, in the order of the scene's signal table. */
struct glove_par {
    struct exh_glove_par glove;
    struct exh_hand_par hand; /* the same for five fingers */
    struct glove_own_par own;
    struct glove_sensor_par sensor[EXH_GLOVE_SENSORS];
};

/* In the order of the table. They stand still between two frames but for the age. */
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

/* Configuration from parameters, for frames T apart. 0 or -EXH_E…. */
int glove_setup(struct glove_cfg *cfg, const struct glove_par *par, struct exh_period T);

/* One frame: everything of sig but its age. */
void glove_frame(struct glove *s, const struct glove_cfg *cfg, const struct exh_glove_in *in);

/* A calibration into parameters and back. */
void glove_par_of_cal(struct glove_par *par, const struct exh_glove_cal *cal);
void glove_cal_of_par(struct exh_glove_cal *cal, const struct glove_par *par);

/* Stages a calibration in the scene's parameters, between defaults() and set-up: 0, or
 * -EXH_E_RANGE with *bad (may be NULL). */
int glove_stage_cal(const struct exh_glove_cal *cal, struct exh_glove_error *bad);

extern const struct exh_scene exh_scene_glove;

#endif
