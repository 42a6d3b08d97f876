/* SPDX-License-Identifier: MIT */
/* Angles, joints, fingertips: long double kinematics of the same integer angles and bones. */
#include "bench.h"

#include "exhand/exhand.h"

#include <math.h>

#define CASES   1000000
#define LSB_RAD (3.14159265358979323846264338327950288L / 2147483648.0L)

static struct exh_hand_finger finger[EXH_FINGERS];
static int32_t joint[BENCH_OPS][EXH_FINGERS][EXH_HAND_JOINTS];
static int32_t sensor[BENCH_OPS][EXH_GLOVE_SENSORS];

/* Every second posture within a hand's limits, the others any angles at all. */
static void any_posture(int32_t q[EXH_HAND_JOINTS])
{
    const int bounded = (int)(bench_u64() & 1);
    q[0] = bounded ? bench_in(EXH_DEG(-15, 1), EXH_DEG(15, 1)) : bench_i32();
    q[1] = bounded ? bench_in(0, EXH_DEG(85, 1)) : bench_i32();
    q[2] = bounded ? bench_in(0, EXH_DEG(65, 1)) : bench_i32();
}

static void setup(void)
{
    const struct exh_hand_par par = {
        exh_hand_rows[0].dflt, exh_hand_rows[1].dflt, exh_hand_rows[2].dflt, exh_hand_rows[3].dflt};
    bench_seed();
    for (uint32_t f = 0; f < EXH_FINGERS; f++) {
        EXH_ASSERT(exh_hand_setup(&finger[f], &exh_hit2_bones[f], &par) == 0);
        for (uint32_t i = 0; i < BENCH_OPS; i++) { any_posture(joint[i][f]); }
    }
    for (uint32_t i = 0; i < BENCH_OPS * EXH_GLOVE_SENSORS; i++) {
        sensor[i / EXH_GLOVE_SENSORS][i % EXH_GLOVE_SENSORS] = bench_in(-(1 << 29), 1 << 30);
    }
}

/* --- sine and cosine --- */

static void sincos_op(uint32_t i)
{
    struct exh_sincos y;
    exh_sincos(joint[i][0][1], &y);
    bench_sink = y.sin_q30 ^ y.cos_q30;
}

static void sincos_error(struct error *e)
{
    bench_seed();
    for (int i = 0; i < CASES; i++) {
        const int32_t x = bench_i32();
        const long double rad = LSB_RAD * (long double)x;
        struct exh_sincos y;
        exh_sincos(x, &y);
        error_add(e, y.sin_q30 - sinl(rad) * 0x1p30L);
        error_add(e, y.cos_q30 - cosl(rad) * 0x1p30L);
    }
}

/* --- joints --- */

static void joints_op(uint32_t i)
{
    int32_t q[EXH_HAND_JOINTS];
    for (uint32_t f = 0; f < EXH_FINGERS; f++) {
        bench_sink = (int64_t)exh_hand_joints(&exh_hit2_map, f, sensor[i], q) + q[0] + q[1] + q[2];
    }
}

static void joints_error(struct error *e)
{
    setup();
    for (uint32_t i = 0; i < BENCH_OPS * EXH_FINGERS; i++) {
        const int32_t *in = sensor[i / EXH_FINGERS];
        int32_t q[EXH_HAND_JOINTS];
        exh_hand_joints(&exh_hit2_map, i % EXH_FINGERS, in, q);
        for (uint32_t k = 0; k < EXH_HAND_JOINTS; k++) {
            const struct exh_hand_joint *j = &exh_hit2_map.joint[i % EXH_FINGERS][k];
            long double sum = j->bias_turn_q32;
            for (uint32_t t = 0; t < EXH_HAND_TERMS; t++) {
                sum += bench_q((long double)j->gain_q24[t] * in[j->sensor[t]], 24);
            }
            error_add(e, q[k] - bench_clamp(sum, j->lo_turn_q32, j->hi_turn_q32));
        }
    }
}

/* --- fingertips --- */

struct exact {
    long double tip[3], slope[3];
};

/* The chain of the joints, in doubles of 64 bits. */
static struct exact exact_of(const struct exh_hand_finger *f, const int32_t q[EXH_HAND_JOINTS])
{
    const struct exh_hand_bones *b = f->bones;
    const long double q0 = LSB_RAD * q[0], q1 = LSB_RAD * q[1], q2 = LSB_RAD * q[2];
    const long double w1 = bench_q(f->pull_radpm_q20[0], 20),
                      w2 = bench_q(f->pull_radpm_q20[1], 20);
    long double out = 0, up = 0, d_out = 0, d_up = 0;
    struct exact y;
    for (int i = 0; i < 3; i++) { /* bone i is turned by q1 + i*q2 */
        const long double len = bench_q(b->len_m_q34[i], 34), at = q1 + i * q2, rate = w1 + i * w2;
        out += len * cosl(at);
        up += len * sinl(at);
        d_out -= len * sinl(at) * rate;
        d_up += len * cosl(at) * rate;
    }
    for (int i = 0; i < 3; i++) {
        const long double x = bench_q(b->rot_q30[i][0], 30), y_ = bench_q(b->rot_q30[i][1], 30);
        const long double z = bench_q(b->rot_q30[i][2], 30), side = x * cosl(q0) + y_ * sinl(q0);
        y.tip[i] = bench_q(b->base_m_q32[i], 32) + side * out + z * up;
        y.slope[i] = side * d_out + z * d_up;
    }
    return y;
}

static void add_vec(
    struct error *e, const struct exh_vec3 *got, const long double want[3], long double one)
{
    error_add(e, got->x - want[0] * one);
    error_add(e, got->y - want[1] * one);
    error_add(e, got->z - want[2] * one);
}

static void tip_op(uint32_t i)
{
    struct exh_vec3 tip;
    exh_hand_tip(&finger[0], joint[i][0], &tip);
    bench_sink = tip.x ^ tip.y ^ tip.z;
}

static void tips_op(uint32_t i)
{
    struct exh_vec3 tip;
    for (uint32_t f = 0; f < EXH_FINGERS; f++) {
        exh_hand_tip(&finger[f], joint[i][f], &tip);
        bench_sink = tip.x ^ tip.y ^ tip.z;
    }
}

static void slope_op(uint32_t i)
{
    struct exh_vec3 tip, slope;
    exh_hand_tip_slope(&finger[0], joint[i][0], &tip, &slope);
    bench_sink = tip.x ^ tip.y ^ tip.z ^ slope.x ^ slope.y ^ slope.z;
}

static void tip_error(struct error *e)
{
    setup();
    for (uint32_t i = 0; i < CASES; i++) {
        const struct exh_hand_finger *f = &finger[i % EXH_FINGERS];
        int32_t q[EXH_HAND_JOINTS];
        struct exh_vec3 tip;
        struct exact want;
        any_posture(q);
        exh_hand_tip(f, q, &tip);
        want = exact_of(f, q);
        add_vec(e, &tip, want.tip, 0x1p30L);
    }
}

static void slope_error(struct error *e)
{
    setup();
    for (uint32_t i = 0; i < CASES / 4; i++) {
        const struct exh_hand_finger *f = &finger[i % EXH_FINGERS];
        int32_t q[EXH_HAND_JOINTS];
        struct exh_vec3 tip, slope;
        struct exact want;
        any_posture(q);
        exh_hand_tip_slope(f, q, &tip, &slope);
        want = exact_of(f, q);
        add_vec(e, &slope, want.slope, 0x1p24L);
    }
}

#define SCALED(q) (1.0 / (double)(UINT64_C(1) << (q)))

static const struct kernel kernels[] = {
    {"sincos", "", SCALED(30), 2.25, 1, setup, sincos_op, sincos_error,
        "angle.h; both of 10^6 angles (all 2^32 in make stress)", 56,
        "both, glibc sincosf, 0.032 ppm; 51 idsp cossin, 8.9 ppm; 90 on i686 by two probes"},
    {"hand_joints_x5", "turn", SCALED(32), 0.5, 1, setup, joints_op, joints_error,
        "one rounding; random sensors, five fingers", 0, NULL},
    {"hand_tip", "m", SCALED(30), 2.15, 1, setup, tip_op, tip_error,
        "hand.h; 10^6 postures, half within a hand's limits, half any angles", 0, NULL},
    {"hand_tip_x5", "m", SCALED(30), 2.15, 1, setup, tips_op, tip_error,
        "hand.h; as above, five fingers an op", 1281,
        "tips of five fingers in Q31 by CMSIS sine tables, 3.7 um; float 955, 0.023 um; on i686 "
        "2474, "
        "1401"},
    {"hand_tip_slope", "m/m", SCALED(24), 4, 1, setup, slope_op, slope_error,
        "hand.h; 250000 postures as above, default arms", 0, NULL},
};
const struct kernel_group hand_group = {kernels, sizeof kernels / sizeof kernels[0]};
