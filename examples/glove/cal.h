/* SPDX-License-Identifier: MIT */
/* A calibration of the glove as parameters of a scene, so that a log contains it. */
#ifndef EXAMPLES_GLOVE_CAL_H
#define EXAMPLES_GLOVE_CAL_H

#include "exhand/glove.h"
#include "exhand/signal.h"

/* The glove in a scene; rows in glove_own_rows[]. */
struct glove_own_par {
    int32_t every;             /* ticks between glove frames */
    int32_t user_id, glove_id; /* user and glove of the calibration */
    int32_t present;           /* bit i: sensor i exists */
};
#define GLOVE_OWN_ROWS 4
extern const struct exh_signal glove_own_rows[GLOVE_OWN_ROWS];

/* One sensor; rows in glove_cal_rows[]. */
struct glove_sensor_par {
    int32_t zero_raw_q15, gain_turnpraw_q38, cross_q30[2], low_raw, high_raw, of[2];
};
#define GLOVE_CAL_ROWS 8
extern const struct exh_signal glove_cal_rows[GLOVE_CAL_ROWS];

/* A calibration into parameters and back. sensor: array of length EXH_GLOVE_SENSORS. every is
 * unchanged. */
void glove_rows_of_cal(
    struct glove_own_par *own, struct glove_sensor_par *sensor, const struct exh_glove_cal *cal);
void glove_cal_of_rows(struct exh_glove_cal *cal, const struct glove_own_par *own,
    const struct glove_sensor_par *sensor);

#endif
