/* SPDX-License-Identifier: MIT */
/* Fingertips of five fingers from their joints. */
#include "plain.h"
#include "work.h"

#include "exhand/error.h"
#include "exhand/exhand.h"

#include <math.h>

#define CASES   200000u
#define LSB_RAD (3.14159265358979323846264338327950288L / 2147483648.0L)

int32_t hand_joint[BENCH_OPS][WORK_FINGERS][3];
static struct exh_hand_finger finger[WORK_FINGERS];
static struct plain_bones_double in_double[WORK_FINGERS];
static struct plain_bones_float in_float[WORK_FINGERS];
static double joint[BENCH_OPS][WORK_FINGERS][3];
static float joint_f[BENCH_OPS][WORK_FINGERS][3];

/* Every second posture within a hand's limits, the others any angles at all. */
void hand_posture(int32_t q[3])
{
    const int bounded = (int)(bench_u64() & 1);
    q[0] = bounded ? bench_in(EXH_DEG(-15, 1), EXH_DEG(15, 1)) : bench_i32();
    q[1] = bounded ? bench_in(0, EXH_DEG(85, 1)) : bench_i32();
    q[2] = bounded ? bench_in(0, EXH_DEG(65, 1)) : bench_i32();
}

void hand_seed(void)
{
    bench_seed();
    for (uint32_t i = 0; i < BENCH_OPS; i++) {
        for (uint32_t f = 0; f < WORK_FINGERS; f++) { hand_posture(hand_joint[i][f]); }
    }
}

static void setup(void)
{
    const struct exh_hand_par par = {
        exh_hand_rows[0].dflt, exh_hand_rows[1].dflt, exh_hand_rows[2].dflt, exh_hand_rows[3].dflt};
    hand_seed();
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        const struct exh_hand_bones *b = &exh_hit2_bones[f];
        EXH_ASSERT(exh_hand_setup(&finger[f], b, &par) == 0);
        for (int k = 0; k < 3; k++) {
            in_float[f].len[k] =
                (float)(in_double[f].len[k] = (double)bench_q(b->len_m_q34[k], 34));
            in_float[f].base[k] =
                (float)(in_double[f].base[k] = (double)bench_q(b->base_m_q32[k], 32));
            for (int j = 0; j < 3; j++) {
                in_float[f].rot[k][j] =
                    (float)(in_double[f].rot[k][j] = (double)bench_q(b->rot_q30[k][j], 30));
            }
            for (uint32_t i = 0; i < BENCH_OPS; i++) {
                joint_f[i][f][k] =
                    (float)(joint[i][f][k] = (double)(LSB_RAD * hand_joint[i][f][k]));
            }
        }
    }
}

/* How far the point lies from the exact one, m. */
long double hand_off(uint32_t f, const int32_t q[3], const double got[3])
{
    const struct exh_hand_bones *b = &exh_hit2_bones[f];
    const long double q0 = LSB_RAD * q[0], q1 = LSB_RAD * q[1], q2 = LSB_RAD * q[2];
    long double out = 0, up = 0, square = 0;
    for (int i = 0; i < 3; i++) {
        out += bench_q(b->len_m_q34[i], 34) * cosl(q1 + i * q2);
        up += bench_q(b->len_m_q34[i], 34) * sinl(q1 + i * q2);
    }
    for (int i = 0; i < 3; i++) {
        const long double side =
            bench_q(b->rot_q30[i][0], 30) * cosl(q0) + bench_q(b->rot_q30[i][1], 30) * sinl(q0);
        const long double off = got[i] - (bench_q(b->base_m_q32[i], 32) + side * out +
                                             bench_q(b->rot_q30[i][2], 30) * up);
        square += off * off;
    }
    return sqrtl(square);
}

static void ours_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        struct exh_vec3 tip;
        exh_hand_tip(&finger[f], hand_joint[i][f], &tip);
        bench_sink = tip.x ^ tip.y ^ tip.z;
    }
}

static volatile double sink_double;
static volatile float sink_float;

static void double_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        double tip[3];
        plain_tip_double(&in_double[f], joint[i][f], tip);
        sink_double = tip[0] + tip[1] + tip[2];
    }
}

static void float_op(uint32_t i)
{
    for (uint32_t f = 0; f < WORK_FINGERS; f++) {
        float tip[3];
        plain_tip_float(&in_float[f], joint_f[i][f], tip);
        sink_float = tip[0] + tip[1] + tip[2];
    }
}

static long double ours_off(uint32_t i)
{
    struct exh_vec3 tip;
    int32_t q[3];
    hand_posture(q);
    exh_hand_tip(&finger[i % WORK_FINGERS], q, &tip);
    return hand_off(
        i % WORK_FINGERS, q, (double[3]){tip.x * 0x1p-30, tip.y * 0x1p-30, tip.z * 0x1p-30});
}

static long double double_off(uint32_t i)
{
    double rad[3], tip[3];
    int32_t q[3];
    hand_posture(q);
    for (int k = 0; k < 3; k++) { rad[k] = (double)(LSB_RAD * q[k]); }
    plain_tip_double(&in_double[i % WORK_FINGERS], rad, tip);
    return hand_off(i % WORK_FINGERS, q, tip);
}

static long double float_off(uint32_t i)
{
    float rad[3], tip[3];
    int32_t q[3];
    hand_posture(q);
    for (int k = 0; k < 3; k++) { rad[k] = (float)(LSB_RAD * q[k]); }
    plain_tip_float(&in_float[i % WORK_FINGERS], rad, tip);
    return hand_off(i % WORK_FINGERS, q, (double[3]){tip[0], tip[1], tip[2]});
}

static const struct work works[] = {
    {"hand", "exhand fingertips", "ours", "m", CASES, setup, ours_op, ours_off},
    {"hand", "plain double fingertips", "float", "m", CASES, setup, double_op, double_off},
    {"hand", "plain float fingertips", "float", "m", CASES, setup, float_op, float_off},
};
const struct work_group hand_works = {works, sizeof works / sizeof works[0]};
