/* SPDX-License-Identifier: MIT */
/* CMSIS-DSP by its plain C paths: its controllers as a law without integral, its interpolation, its
 * sines in the same fingertips. */
#include "work.h"

#include "dsp/controller_functions.h"
#include "dsp/fast_math_functions.h"
#include "dsp/interpolation_functions.h"

#include "exhand/hand.h"

#include <math.h>

/* --- the law: positions of 2^-7 m, forces of 256 N full scale --- */

#define FULL_M 0.0078125
#define FULL_N 256.0
#define KP     (WALL_K_NPM * FULL_M / FULL_N)
#define KD     (WALL_B_NSPM / WALL_T_S * FULL_M / FULL_N)

static arm_pid_instance_q31 pid_q31[WORK_FINGERS];
static arm_pid_instance_q15 pid_q15[WORK_FINGERS];
static arm_pid_instance_f32 pid_f32[WORK_FINGERS];
static q31_t x_q31[BENCH_OPS][WORK_FINGERS];
static q15_t x_q15[BENCH_OPS][WORK_FINGERS];
static float x_f32[BENCH_OPS][WORK_FINGERS];
static long double last_m;

static void law_setup(void)
{
    wall_seed();
    for (uint32_t i = 0; i < BENCH_OPS; i++) {
        for (uint32_t f = 0; f < WORK_FINGERS; f++) {
            x_f32[i][f] = (float)(wall_cnt() * WALL_STEP_M);
            x_q31[i][f] = (q31_t)(x_f32[i][f] / FULL_M * 2147483648.0);
            x_q15[i][f] = (q15_t)(x_q31[i][f] >> 16);
        }
    }
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        pid_q31[f].Kp = (q31_t)lrint(KP * 2147483648.0);
        pid_q31[f].Kd = (q31_t)lrint(KD * 2147483648.0);
        pid_q31[f].Ki = 0;
        arm_pid_init_q31(&pid_q31[f], 1);
        pid_q15[f].Kp = (q15_t)lrint(KP * 32768);
        pid_q15[f].Kd = (q15_t)lrint(KD * 32768);
        pid_q15[f].Ki = 0;
        arm_pid_init_q15(&pid_q15[f], 1);
        pid_f32[f].Kp = (float)WALL_K_NPM;
        pid_f32[f].Kd = (float)(WALL_B_NSPM / WALL_T_S);
        pid_f32[f].Ki = 0;
        arm_pid_init_f32(&pid_f32[f], 1);
    }
    wall_seed();
    last_m = 0;
}

static volatile float sink_float;

static void law_q31_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        bench_sink = arm_pid_q31(&pid_q31[f], x_q31[i][f]);
    }
}

static void law_q15_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        bench_sink = arm_pid_q15(&pid_q15[f], x_q15[i][f]);
    }
}

static void law_f32_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        sink_float = arm_pid_f32(&pid_f32[f], x_f32[i][f]);
    }
}

static long double off_by(long double force_N, long double pos_m)
{
    const long double off = force_N - wall_N(pos_m, last_m);
    last_m = pos_m;
    return off;
}

static long double law_q31_off(uint32_t i)
{
    const q31_t x = wall_cnt() * (71213 << 8);
    (void)i;
    return off_by(arm_pid_q31(&pid_q31[0], x) * FULL_N / 2147483648.0, x * FULL_M / 2147483648.0);
}

static long double law_q15_off(uint32_t i)
{
    const q15_t x = (q15_t)(wall_cnt() * (71213 << 8) >> 16);
    (void)i;
    return off_by(arm_pid_q15(&pid_q15[0], x) * FULL_N / 32768.0, x * FULL_M / 32768.0);
}

static long double law_f32_off(uint32_t i)
{
    const float x = (float)(wall_cnt() * WALL_STEP_M);
    (void)i;
    return off_by(arm_pid_f32(&pid_f32[0], x), x);
}

/* --- the table: 12.20 of the knots' distance --- */

static q31_t curve[CURVE_KNOTS];

static void curve_setup(void)
{
    curve_seed();
    for (uint32_t k = 0; k < CURVE_KNOTS; k++) { curve[k] = curve_y[k]; }
}

static void curve_op(uint32_t i)
{
    bench_sink = arm_linear_interp_q31(curve, curve_at[i] >> 6, CURVE_KNOTS);
}

static long double curve_off(uint32_t i)
{
    const int32_t x = bench_in(0, (int32_t)((CURVE_KNOTS - 1) << 26) - 1);
    (void)i;
    return 1e6L * (arm_linear_interp_q31(curve, x >> 6, CURVE_KNOTS) - curve_exact(x >> 6 << 6)) /
           1073741824;
}

/* --- fingertips: lengths and places of 0.5 m full scale; sines of 30 bits, as those of sums may
 * pass 1 --- */

static q31_t mul(q31_t a, q31_t b) { return (q31_t)((q63_t)a * b >> 30); }

static void tip_q31(const struct exh_hand_bones *b, const int32_t q[3], int32_t tip[3])
{
    q31_t sine[3], cosine[3], out, up;
    for (int k = 0; k < 3; k++) {
        sine[k] = arm_sin_q31((q31_t)((uint32_t)q[k] >> 1)) >> 1;
        cosine[k] = arm_cos_q31((q31_t)((uint32_t)q[k] >> 1)) >> 1;
    }
    const q31_t sine0 = sine[0], cosine0 = cosine[0];
    out = mul(b->len_m_q34[0] >> 2, cosine[1]);
    up = mul(b->len_m_q34[0] >> 2, sine[1]);
    for (int i = 1; i < 3; i++) {
        const q31_t turned = mul(cosine[1], cosine[2]) - mul(sine[1], sine[2]);
        sine[1] = mul(sine[1], cosine[2]) + mul(cosine[1], sine[2]);
        cosine[1] = turned;
        out += mul(b->len_m_q34[i] >> 2, cosine[1]);
        up += mul(b->len_m_q34[i] >> 2, sine[1]);
    }
    for (int i = 0; i < 3; i++) {
        const q31_t side = mul(b->rot_q30[i][0], cosine0) + mul(b->rot_q30[i][1], sine0);
        tip[i] = b->base_m_q32[i] + mul(side, out) + mul(b->rot_q30[i][2], up); /* q32 */
    }
}

static void hand_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        int32_t tip[3];
        tip_q31(&exh_hit2_bones[f], hand_joint[i][f], tip);
        bench_sink = tip[0] ^ tip[1] ^ tip[2];
    }
}

static long double hand_error(uint32_t i)
{
    int32_t q[3], tip[3];
    hand_posture(q);
    tip_q31(&exh_hit2_bones[i % WORK_FINGERS], q, tip);
    return hand_off(
        i % WORK_FINGERS, q, (double[3]){tip[0] * 0x1p-32, tip[1] * 0x1p-32, tip[2] * 0x1p-32});
}

static const struct work works[] = {
    {"law", "CMSIS pid_q31", "integer", "N", WORK_HOUR, law_setup, law_q31_op, law_q31_off},
    {"law", "CMSIS pid_q15", "integer", "N", WORK_HOUR, law_setup, law_q15_op, law_q15_off},
    {"law", "CMSIS pid_f32", "float", "N", WORK_HOUR, law_setup, law_f32_op, law_f32_off},
    {"table", "CMSIS linear_interp_q31", "integer", "ppm", 300000, curve_setup, curve_op,
        curve_off},
    {"hand", "CMSIS sine tables in Q31", "integer", "m", 200000, hand_seed, hand_op, hand_error},
};
const struct work_group cmsis_works = {works, sizeof works / sizeof works[0]};
