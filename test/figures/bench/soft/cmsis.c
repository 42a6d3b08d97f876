/* SPDX-License-Identifier: MIT */
/* CMSIS-DSP as its functions are called; on a Cortex-M4 with its intrinsics. Its sources are
 * included, because they are system headers then, and warn of nothing. */
#include "soft.h"

#include <dsp/controller_functions.h>
#include <dsp/fast_math_functions.h>
#include <dsp/filtering_functions.h>
#include <dsp/interpolation_functions.h>

#include <CommonTables/arm_common_tables.c>
#include <ControllerFunctions/arm_pid_init_q15.c>
#include <ControllerFunctions/arm_pid_init_q31.c>
#include <ControllerFunctions/arm_pid_reset_q15.c>
#include <ControllerFunctions/arm_pid_reset_q31.c>
#include <FastMathFunctions/arm_cos_q31.c>
#include <FastMathFunctions/arm_sin_q31.c>
#include <FilteringFunctions/arm_biquad_cascade_df1_32x64_init_q31.c>
#include <FilteringFunctions/arm_biquad_cascade_df1_32x64_q31.c>
#include <FilteringFunctions/arm_biquad_cascade_df1_fast_q31.c>
#include <FilteringFunctions/arm_biquad_cascade_df1_init_q15.c>
#include <FilteringFunctions/arm_biquad_cascade_df1_init_q31.c>
#include <FilteringFunctions/arm_biquad_cascade_df1_q15.c>
#include <FilteringFunctions/arm_biquad_cascade_df1_q31.c>
#include <InterpolationFunctions/arm_linear_interp_q31.c>

/* fc/fs = 0.01 */
static const q31_t coeff_q31[5] = {1014355, 2028711, 1014355, 2052132225, -982447822};
static const q15_t coeff_q15[6] = {15, 0, 31, 15, 31313, -14991};

#define FILTER(name, inst, words, coeff, start, run, type, in) \
    static inst name[CHANNELS]; \
    static words name##_state[CHANNELS][4]; \
    static void name##_start(void) \
    { \
        for (uint32_t k = 0; k < CHANNELS; k++) { start(&name[k], 1, coeff, name##_state[k], 1); } \
    } \
    static void name##_op(uint32_t i) \
    { \
        for (uint32_t k = 0; k < CHANNELS; k++) { \
            const type x = (type)(in); \
            type y; \
            run(&name[k], &x, &y, 1); \
            soft_y[k] = y; \
        } \
    }
FILTER(df1, arm_biquad_casd_df1_inst_q31, q31_t, coeff_q31, arm_biquad_cascade_df1_init_q31,
    arm_biquad_cascade_df1_q31, q31_t, soft_x[i + k])
FILTER(fast, arm_biquad_casd_df1_inst_q31, q31_t, coeff_q31, arm_biquad_cascade_df1_init_q31,
    arm_biquad_cascade_df1_fast_q31, q31_t, soft_x[i + k])
FILTER(wide, arm_biquad_cas_df1_32x64_ins_q31, q63_t, coeff_q31, arm_biquad_cas_df1_32x64_init_q31,
    arm_biquad_cas_df1_32x64_q31, q31_t, soft_x[i + k])
FILTER(narrow, arm_biquad_casd_df1_inst_q15, q15_t, coeff_q15, arm_biquad_cascade_df1_init_q15,
    arm_biquad_cascade_df1_q15, q15_t, soft_x[i + k] >> 16)

static arm_pid_instance_q31 pid_q31[FINGERS];
static arm_pid_instance_q15 pid_q15[FINGERS];

static void pid_q31_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) { soft_sink = arm_pid_q31(&pid_q31[f], soft_x[i + f]); }
}

static void pid_q15_op(uint32_t i)
{
    for (uint32_t f = 0; f < FINGERS; f++) {
        soft_sink = arm_pid_q15(&pid_q15[f], (q15_t)(soft_x[i + f] >> 16));
    }
}

static q31_t curve[16];

static void interp_op(uint32_t i)
{
    soft_sink = arm_linear_interp_q31(curve, (q31_t)(i << 14), 16);
}

static void sine_op(uint32_t i)
{
    const q31_t turn = soft_x[i] & INT32_MAX;
    soft_sink = arm_sin_q31(turn) + (int64_t)arm_cos_q31(turn);
}

static void start(void)
{
    df1_start();
    fast_start();
    wide_start();
    narrow_start();
    for (uint32_t f = 0; f < FINGERS; f++) {
        pid_q31[f] = (arm_pid_instance_q31){.Kp = 130891776, .Kd = 808960000};
        pid_q15[f] = (arm_pid_instance_q15){.Kp = 1997, .Kd = 12344};
        arm_pid_init_q31(&pid_q31[f], 1);
        arm_pid_init_q15(&pid_q15[f], 1);
    }
    for (int k = 0; k < 16; k++) { curve[k] = k * (1 << 25) + k * k * 1000003; }
}

static const struct soft_op cmsis[] = {
    {"filter,CMSIS df1_q31", df1_op},
    {"filter,CMSIS df1_fast_q31", fast_op},
    {"filter,CMSIS df1_32x64_q31", wide_op},
    {"filter,CMSIS df1_q15", narrow_op},
    {"sine,CMSIS sin_q31 + cos_q31", sine_op},
    {"law,CMSIS pid_q31", pid_q31_op},
    {"law,CMSIS pid_q15", pid_q15_op},
    {"table,CMSIS linear_interp_q31", interp_op},
};
const struct soft_group soft_cmsis = {cmsis, sizeof cmsis / sizeof cmsis[0], start};
