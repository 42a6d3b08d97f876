/* SPDX-License-Identifier: MIT */
/* Robot hand: joint angles from glove angles, and fingertip positions by forward kinematics. */
#include "exhand/hand.h"

#include "exhand/angle.h"
#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/units.h"

#include "../num/sincos.h"

#define ARM_MAX_M_Q30      EXH_Q(50, 1000, EXH_Q_POS)
#define ARM_MIN_M_Q30      EXH_Q(4, 1000, EXH_Q_POS)
#define LEN_MAX_M_Q34      EXH_Q(120, 1000, 34)
#define BASE_MAX_M_Q32     EXH_Q(125, 1000, 32)
#define PULL_MAX_RADPM_Q20 EXH_Q(250, 1, 20)
#define HALF_TURN_Q56      (UINT64_C(1) << 55)

/* Default arms, estimated, not measured: cables guided 20, 16 and 12 mm from the joint axes. They
 * give 61 mm of string from straight to fully bent. Exoskeletons of this kind are reported to move
 * 60 to 90 mm. */
const struct exh_signal exh_hand_rows[EXH_HAND_ROWS] = {
    {0x0A01, EXH_Q_POS, EXH_WHEN_SETUP, 0, ARM_MAX_M_Q30, EXH_Q(20, 1000, EXH_Q_POS), "arm1", "m",
        "string per radian of the knuckle"},
    {0x0A02, EXH_Q_POS, EXH_WHEN_SETUP, 0, ARM_MAX_M_Q30, EXH_Q(16, 1000, EXH_Q_POS), "arm2", "m",
        "string per radian of the joint beyond"},
    {0x0A03, EXH_Q_POS, EXH_WHEN_SETUP, 0, ARM_MAX_M_Q30, EXH_Q(12, 1000, EXH_Q_POS), "arm3", "m",
        "string per radian of the last joint"},
    {0x0A04, EXH_Q_POS, EXH_WHEN_SETUP, 0, EXH_PAD_MAX_M_Q30, EXH_Q(105, 10000, EXH_Q_POS), "pad",
        "m", "radius of the fingertip's pad"},
};

/* --- sensors to joints --- */

static int joint_ok(const struct exh_hand_joint *j)
{
    for (unsigned t = 0; t < EXH_HAND_TERMS; t++) {
        if (j->sensor[t] >= EXH_GLOVE_SENSORS || j->gain_q24[t] > EXH_HAND_GAIN_MAX_Q24 ||
            j->gain_q24[t] < -EXH_HAND_GAIN_MAX_Q24) {
            return 0;
        }
    }
    return j->lo_turn_q32 <= j->hi_turn_q32;
}

int exh_hand_map_validate(const struct exh_hand_map *map)
{
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        for (unsigned j = 0; j < EXH_HAND_JOINTS; j++) {
            if (!joint_ok(&map->joint[f][j]) || map->bent[f][j] >= EXH_GLOVE_SENSORS) {
                return -EXH_E_RANGE;
            }
        }
    }
    return 0;
}

uint32_t exh_hand_joints(const struct exh_hand_map *map, unsigned finger,
    const int32_t *sensor_turn_q32, int32_t *joint_turn_q32)
{
    uint32_t limited = 0;
    for (unsigned i = 0; i < EXH_HAND_JOINTS; i++) {
        const struct exh_hand_joint *j = &map->joint[finger][i];
        int64_t sum_q56 =
            (int64_t)j->bias_turn_q32 * (INT32_C(1) << 24) + (INT32_C(1) << 23); /* |sum| < 2^60 */
        int32_t want;
        for (unsigned t = 0; t < EXH_HAND_TERMS; t++) {
            sum_q56 += (int64_t)j->gain_q24[t] * sensor_turn_q32[j->sensor[t]];
        }
        if ((uint64_t)sum_q56 + HALF_TURN_Q56 < 2 * HALF_TURN_Q56) { /* includes half an LSB */
            want = exh_from_u32((uint32_t)((uint64_t)sum_q56 >> (56 - 32) & UINT32_MAX));
        } else {
            want = sum_q56 < 0 ? INT32_MIN : INT32_MAX;
            limited |= UINT32_C(1) << i;
        }
        joint_turn_q32[i] = exh_clamp32(want, j->lo_turn_q32, j->hi_turn_q32);
        limited |= (uint32_t)(want != joint_turn_q32[i]) << i;
    }
    return limited;
}

/* --- joints to the fingertip --- */

/* For a rotation matrix: the third row is the product of the first two, not its mirror image. */
static int right_handed(const int32_t rot_q30[3][3])
{
    const int32_t *x = rot_q30[0], *y = rot_q30[1];
    const int64_t z0 = exh_mul_shr(x[1], y[2], 30) - exh_mul_shr(x[2], y[1], 30);
    const int64_t z1 = exh_mul_shr(x[2], y[0], 30) - exh_mul_shr(x[0], y[2], 30);
    const int64_t z2 = exh_mul_shr(x[0], y[1], 30) - exh_mul_shr(x[1], y[0], 30);
    return z0 * rot_q30[2][0] + z1 * rot_q30[2][1] + z2 * rot_q30[2][2] > 0;
}

/* Rows of length 1, orthogonal to 1e-6 (2^-20), right-handed. */
static int is_rotation(const int32_t rot_q30[3][3])
{
    const int64_t tol_q60 = INT64_C(1) << 40;
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned k = i; k < 3; k++) {
            int64_t dot_q60 = i == k ? -(INT64_C(1) << 60) : 0;
            for (unsigned c = 0; c < 3; c++) {
                if (!exh_inside(rot_q30[i][c], -(INT32_C(1) << 30), INT32_C(1) << 30)) { return 0; }
                dot_q60 += (int64_t)rot_q30[i][c] * rot_q30[k][c];
            }
            if (dot_q60 > tol_q60 || dot_q60 < -tol_q60) { return 0; }
        }
    }
    return right_handed(rot_q30);
}

static int bones_ok(const struct exh_hand_bones *b)
{
    int64_t sum = 0;
    for (unsigned i = 0; i < 3; i++) {
        if (b->len_m_q34[i] <= 0 || b->base_m_q32[i] > BASE_MAX_M_Q32 ||
            b->base_m_q32[i] < -BASE_MAX_M_Q32) {
            return 0;
        }
        sum += b->len_m_q34[i];
    }
    return sum <= LEN_MAX_M_Q34 && is_rotation(b->rot_q30);
}

static int arm_ok(int32_t arm_m_q30) { return arm_m_q30 >= 0 && arm_m_q30 <= ARM_MAX_M_Q30; }

int exh_hand_setup(
    struct exh_hand_finger *f, const struct exh_hand_bones *bones, const struct exh_hand_par *par)
{
    uint64_t arm_m_q30[2], square_q60;
    if (!arm_ok(par->arm1_m_q30) || !arm_ok(par->arm2_m_q30) || !arm_ok(par->arm3_m_q30) ||
        par->pad_m_q30 < 0 || par->pad_m_q30 > EXH_PAD_MAX_M_Q30 || !bones_ok(bones)) {
        return -EXH_E_RANGE;
    }
    arm_m_q30[0] = (uint64_t)par->arm1_m_q30;
    arm_m_q30[1] = (uint64_t)par->arm2_m_q30 + (uint64_t)par->arm3_m_q30;
    square_q60 = arm_m_q30[0] * arm_m_q30[0] + arm_m_q30[1] * arm_m_q30[1];
    if (square_q60 < (uint64_t)ARM_MIN_M_Q30 * ARM_MIN_M_Q30) { return -EXH_E_RANGE; }
    f->bones = bones;
    for (unsigned i = 0; i < 2; i++) {
        /* arm / square: q30 + 36 over q60 - 14 is q20 */
        const uint64_t den = square_q60 >> 14;
        f->pull_radpm_q20[i] = (int32_t)exh_udiv64((arm_m_q30[i] << 36) + den / 2, den, NULL);
    }
    return 0;
}

/* Turn of a sensor's joint per metre of string. */
static int64_t rate_radpm_q20(const struct exh_hand_finger *f, const uint8_t *bent, uint8_t sensor)
{
    if (sensor == bent[0]) { return f->pull_radpm_q20[0]; }
    return sensor == bent[1] || sensor == bent[2] ? f->pull_radpm_q20[1] : 0;
}

int exh_hand_couple(struct exh_hand_finger *f, const struct exh_hand_map *map, unsigned finger)
{
    int32_t pull_radpm_q20[2];
    for (unsigned i = 0; i < 2; i++) {
        const struct exh_hand_joint *j = &map->joint[finger][1 + i];
        int64_t sum_q44 = 0; /* below 2^54 */
        for (unsigned t = 0; t < EXH_HAND_TERMS; t++) {
            sum_q44 += j->gain_q24[t] * rate_radpm_q20(f, map->bent[finger], j->sensor[t]);
        }
        sum_q44 = exh_shr_round(sum_q44, 44 - 20);
        if (sum_q44 > PULL_MAX_RADPM_Q20 || sum_q44 < -PULL_MAX_RADPM_Q20) { return -EXH_E_RANGE; }
        pull_radpm_q20[i] = (int32_t)sum_q44;
    }
    f->pull_radpm_q20[0] = pull_radpm_q20[0];
    f->pull_radpm_q20[1] = pull_radpm_q20[1];
    return 0;
}

/* With lengths l0, l1, l2 and q3 = q2, the tip lies along and across the first bone at
 *
 *   along  = l0 + l1 cos q2 + l2 cos 2 q2 = l0 - l2 + M cos q2
 *   across =      l1 sin q2 + l2 sin 2 q2 =           M sin q2,    M = l1 + 2 l2 cos q2.
 *
 * This avoids sine and cosine of every sum of joints. */
struct pose {
    struct exh_sincos q0, q1, q2;
    int_fast32_t fold_m_q33; /* M */
    int_fast32_t along_m_q34, across_m_q34;
};

/* floor(a*b / 2^n) of 32-bit values with a 32-bit result, in the fastest type. */
static inline int_fast32_t part(int_fast32_t a, int_fast32_t b, unsigned n)
{
    return (int_fast32_t)((int64_t)a * b >> n);
}

/* part() + c, where the sum has 32 bits, but the product of long bones more. */
static inline int_fast32_t part_and(int_fast32_t a, int_fast32_t b, unsigned n, int_fast32_t c)
{
    return (int_fast32_t)(((int64_t)a * b >> n) + c);
}

static inline struct pose pose_of(const int32_t len_m_q34[3], const int32_t *joint_turn_q32)
{
    const int_fast32_t l0 = len_m_q34[0], l1 = len_m_q34[1], l2 = len_m_q34[2];
    struct pose p;
    p.q2 = sincos_in_place(joint_turn_q32[2]);
    p.fold_m_q33 = (l1 >> (34 - 33)) + part(l2, p.q2.cos_q30, 34 + 30 - 33 - 1);
    p.along_m_q34 = part_and(p.fold_m_q33, p.q2.cos_q30, 33 + 30 - 34, l0 - l2);
    p.across_m_q34 = part(p.fold_m_q33, p.q2.sin_q30, 33 + 30 - 34);
    p.q1 = sincos_in_place(joint_turn_q32[1]);
    p.q0 = sincos_in_place(joint_turn_q32[0]);
    return p;
}

/* A vector in the base frame of the finger. */
struct base3 {
    int_fast32_t x, y, z;
};

/* (along, across) rotated by q1, then by q0 about z; same format. */
static inline struct base3 turned(const struct pose *p, int_fast32_t along, int_fast32_t across)
{
    const int64_t out = (int64_t)along * p->q1.cos_q30 - (int64_t)across * p->q1.sin_q30;
    const int64_t up = (int64_t)along * p->q1.sin_q30 + (int64_t)across * p->q1.cos_q30;
    const int_fast32_t far = (int_fast32_t)(out >> 30);
    const struct base3 v = {
        part(p->q0.cos_q30, far, 30), part(p->q0.sin_q30, far, 30), (int_fast32_t)(up >> 30)};
    return v;
}

/* One coordinate in the palm. Three products lose half an LSB of q32 each. Adding 3 compensates
 * that (1.5) and rounds (2). */
static inline int32_t place_m_q30(
    int32_t base_m_q32, const int32_t row_q30[3], struct base3 v_m_q34)
{
    return (int32_t)(base_m_q32 + part(row_q30[0], v_m_q34.x, 32) +
                     part(row_q30[1], v_m_q34.y, 32) + part(row_q30[2], v_m_q34.z, 32) + 3) >>
           (32 - 30);
}

static inline void tip_of(
    const struct pose *p, const struct exh_hand_bones *b, struct exh_vec3 *tip_m_q30)
{
    const struct base3 v_m_q34 = turned(p, p->along_m_q34, p->across_m_q34);
    tip_m_q30->x = place_m_q30(b->base_m_q32[0], b->rot_q30[0], v_m_q34);
    tip_m_q30->y = place_m_q30(b->base_m_q32[1], b->rot_q30[1], v_m_q34);
    tip_m_q30->z = place_m_q30(b->base_m_q32[2], b->rot_q30[2], v_m_q34);
}

void exh_hand_tip(
    const struct exh_hand_finger *f, const int32_t *joint_turn_q32, struct exh_vec3 *tip_m_q30)
{
    const struct pose p = pose_of(f->bones->len_m_q34, joint_turn_q32);
    tip_of(&p, f->bones, tip_m_q30);
}

static inline int32_t turned_q24(const int32_t row_q30[3], struct base3 v_q24)
{
    const int64_t sum_q54 = (int64_t)row_q30[0] * v_q24.x + (int64_t)row_q30[1] * v_q24.y +
                            (int64_t)row_q30[2] * v_q24.z;
    return (int32_t)exh_shr_round(sum_q54, 54 - 24);
}

/* When q1 turns, the tip moves by (-across, along). When q2 and q3 turn, it moves by (-K sin q2, K
 * cos q2 - 2 l2), K = 2 M - l1. */
void exh_hand_tip_slope(const struct exh_hand_finger *f, const int32_t *joint_turn_q32,
    struct exh_vec3 *tip_m_q30, struct exh_vec3 *slope_q24)
{
    const struct exh_hand_bones *b = f->bones;
    const struct pose p = pose_of(b->len_m_q34, joint_turn_q32);
    const int_fast32_t k_m_q32 = p.fold_m_q33 - (b->len_m_q34[1] >> (34 - 32));
    const int_fast32_t along_m_q33 = -part(k_m_q32, p.q2.sin_q30, 32 + 30 - 33);
    const int_fast32_t across_m_q33 =
        part_and(k_m_q32, p.q2.cos_q30, 32 + 30 - 33, -b->len_m_q34[2]);
    const int64_t w1_radpm_q20 = f->pull_radpm_q20[0], w2_radpm_q20 = f->pull_radpm_q20[1];
    const int64_t along_q54 = 2 * w2_radpm_q20 * along_m_q33 - w1_radpm_q20 * p.across_m_q34;
    const int64_t across_q54 = 2 * w2_radpm_q20 * across_m_q33 + w1_radpm_q20 * p.along_m_q34;
    const struct base3 v_q24 = turned(&p, (int_fast32_t)exh_shr_round(along_q54, 54 - 24),
        (int_fast32_t)exh_shr_round(across_q54, 54 - 24));

    tip_of(&p, b, tip_m_q30);
    slope_q24->x = turned_q24(b->rot_q30[0], v_q24);
    slope_q24->y = turned_q24(b->rot_q30[1], v_q24);
    slope_q24->z = turned_q24(b->rot_q30[2], v_q24);
}
