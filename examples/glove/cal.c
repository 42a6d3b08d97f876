/* SPDX-License-Identifier: MIT */
#include "cal.h"

#include "exhand/fix.h"

#define ALL_SENSORS ((1 << EXH_GLOVE_SENSORS) - 1)

const struct exh_signal glove_own_rows[GLOVE_OWN_ROWS] = {
    {0x8401, 0, EXH_WHEN_SETUP, 1, 1000, 1, "every", "", "ticks from one glove frame to the next"},
    {0x8402, 0, EXH_WHEN_SETUP, INT32_MIN, INT32_MAX, 0, "user", "", "whose calibration it is"},
    {0x8403, 0, EXH_WHEN_SETUP, INT32_MIN, INT32_MAX, 0, "glove", "", "and of which glove"},
    {0x8404, 0, EXH_WHEN_SETUP, 1, ALL_SENSORS, ALL_SENSORS, "present", "",
        "sensors that are there, bits"},
};

/* Instances: the sensors. glove.h defines valid combinations; set-up checks them. */
const struct exh_signal glove_cal_rows[GLOVE_CAL_ROWS] = {
    {0x8410, 15, EXH_WHEN_SETUP, INT32_MIN, INT32_MAX, 0, "cal_zero", "", "code of angle 0"},
    {0x8411, 38, EXH_WHEN_SETUP, INT32_MIN, INT32_MAX, 0, "cal_gain", "turn", "angle per code"},
    {0x8412, 30, EXH_WHEN_SETUP, INT32_MIN, INT32_MAX, 0, "cal_cross0", "",
        "of the angle of cal_of0"},
    {0x8413, 30, EXH_WHEN_SETUP, INT32_MIN, INT32_MAX, 0, "cal_cross1", "",
        "of the angle of cal_of1"},
    {0x8414, 0, EXH_WHEN_SETUP, INT16_MIN, INT16_MAX, 0, "cal_low", "", "lowest code calibrated"},
    {0x8415, 0, EXH_WHEN_SETUP, INT16_MIN, INT16_MAX, 0, "cal_high", "", "highest code calibrated"},
    {0x8416, 0, EXH_WHEN_SETUP, 0, 255, 255, "cal_of0", "",
        "sensor that pulls this one along, 255 none"},
    {0x8417, 0, EXH_WHEN_SETUP, 0, 255, 255, "cal_of1", "", "another"},
};

void glove_rows_of_cal(
    struct glove_own_par *own, struct glove_sensor_par *sensor, const struct exh_glove_cal *cal)
{
    own->user_id = exh_from_u32(cal->user_id);
    own->glove_id = exh_from_u32(cal->glove_id);
    own->present = (int32_t)cal->present;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct exh_glove_sensor *s = &cal->sensor[i];
        sensor[i] = (struct glove_sensor_par){s->zero_raw_q15, s->gain_turnpraw_q38,
            {s->cross_q30[0], s->cross_q30[1]}, s->low_raw, s->high_raw, {s->of[0], s->of[1]}};
    }
}

void glove_cal_of_rows(struct exh_glove_cal *cal, const struct glove_own_par *own,
    const struct glove_sensor_par *sensor)
{
    *cal = (struct exh_glove_cal){.user_id = (uint32_t)own->user_id,
        .glove_id = (uint32_t)own->glove_id,
        .present = (uint32_t)own->present};
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct glove_sensor_par *s = &sensor[i];
        cal->sensor[i] = (struct exh_glove_sensor){s->zero_raw_q15, s->gain_turnpraw_q38,
            {s->cross_q30[0], s->cross_q30[1]}, (int16_t)s->low_raw, (int16_t)s->high_raw,
            {(uint8_t)s->of[0], (uint8_t)s->of[1]}};
    }
}
