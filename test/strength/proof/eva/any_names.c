/* SPDX-License-Identifier: MIT */
/* PROVES: texts
 * Names and texts for any number: states, triggers, faults, limits, steps of arming, errors, and
 * the faults of a sensor or a calibration.
 *
 * PLANT: lib/src/safe/safety_names.c: k < EXH_LIMITS ? -> k <= EXH_LIMITS ?
 * PLANT: lib/src/num/error.c: code <= -EXH_E_COUNT || -> code < -EXH_E_COUNT ||
 * PLANT: lib/src/sense/glove_cal.c: sensor < EXH_GLOVE_SENSORS ? text[sensor] -> sensor <= EXH_GLOVE_SENSORS ? text[sensor]
 */
#include "bench/calibrate.c"
#include "num/error.c"
#define limits glove_limits
#include "sense/glove.c"
#undef limits
#undef IMAGE_MAGIC
#define body_bytes cal_body_bytes /* calibrate.c has its own of these */
#define head       cal_head
#define head_bytes cal_head_bytes
#define load       cal_load
#define refuse     cal_refuse
#include "sense/glove_cal.c"
#include "safe/safety_names.c"

#include "any.h"

static char first;

static void text(const char *t) { first = t[0]; }

int main(void)
{
    text(exh_state_name(any_u32()));
    text(exh_trigger_name(any_u32()));
    text(exh_fault_name(any_u32()));
    text(exh_limit_name(any_u32()));
    text(exh_arm_name(any_u32()));
    text(exh_error_text(any32()));
    text(exh_glove_cause_text(any_u32()));
    text(exh_glove_sensor_text(any_u32()));
    text(exh_glove_error_text(any_u32()));
    text(exh_calib_error_text(any_u32()));
    END();
    return 0;
}
