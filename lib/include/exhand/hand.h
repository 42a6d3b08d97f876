/* SPDX-License-Identifier: MIT */
/* Hand: from the glove's 22 angles to the joints of a robot hand, to its fingertips.
 *
 * Data describe the hand: a map from sensors to joints, and bones, which are the lengths and base
 * frames of the fingers. hand_hit2.c holds those of the right DLR/HIT Hand II. Calls are per
 * finger.
 *
 * A finger has four joints. q0 turns it sideways about the z axis of its base. q1, q2 and q3 bend
 * it; q3 follows q2. q0, q1 and q2 are driven. At angle 0 the finger points along x of its base;
 * bending moves the tip towards z.
 *
 *   uint32_t limited = exh_hand_joints(&exh_hit2_map, EXH_INDEX, angle_turn_q32, joint_turn_q32);
 *   exh_hand_tip(&finger, joint_turn_q32, &tip_m_q30); */
#ifndef EXHAND_HAND_H
#define EXHAND_HAND_H

#include "exhand/glove.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_HAND_JOINTS 3 /* driven joints of one finger: q0, q1, q2 */
#define EXH_HAND_TERMS  2 /* most sensors that move one joint */

/* --- sensors to joints --- */

#define EXH_HAND_GAIN_MAX_Q24 \
    (8 * (INT32_C(1) << 24)) /* 8: no gain of a joint is larger in magnitude */

/* How one joint follows the sensors. */
struct exh_hand_joint {
    int32_t bias_turn_q32;            /* angle of the joint when all sensors are at 0 */
    int32_t gain_q24[EXH_HAND_TERMS]; /* -8 .. 8; 0: no term */
    uint8_t sensor[EXH_HAND_TERMS];   /* below EXH_GLOVE_SENSORS */
    int32_t lo_turn_q32, hi_turn_q32; /* the joint's limits, lo <= hi */
};
/* How all joints of a hand follow the sensors; in ROM or owned by the caller. */
struct exh_hand_map {
    struct exh_hand_joint joint[EXH_FINGERS][EXH_HAND_JOINTS]; /* q0, q1, q2 of each finger */
    /* Sensors of the wearer's joints that the string bends: of arm1, arm2 and arm3. */
    uint8_t bent[EXH_FINGERS][3]; /* below EXH_GLOVE_SENSORS; a thumb repeats its last */
};
extern const struct exh_hand_map exh_hit2_map; /* of the DLR/HIT Hand II, right */

/* Checks a map from outside: every sensor, also of bent, gain and pair of limits against the ranges
 * above. Returns 0 or -EXH_E_RANGE. Set-up only. */
int exh_hand_map_validate(const struct exh_hand_map *map);

/* The three driven joints of one finger (0 .. 4) from all 22 sensors. Each is bias + sum of gain
 * times sensor, computed exactly, rounded once and limited to lo .. hi. Nothing wraps; the error is
 * at most 1/2 LSB. Returns bit j if joint j was limited. */
uint32_t exh_hand_joints(const struct exh_hand_map *map, unsigned finger,
    const int32_t *sensor_turn_q32, int32_t *joint_turn_q32);

/* --- joints to the fingertip --- */

/* The geometry of one finger in the frame of the palm. */
struct exh_hand_bones {
    int32_t len_m_q34[3];  /* q1 to q2, q2 to q3, q3 to the pad's centre; each > 0, sum <= 0.12 m */
    int32_t rot_q30[3][3]; /* rows x, y, z of the palm; columns: axes of the base frame */
    int32_t base_m_q32[3]; /* position of q0 and q1; within +-0.125 m */
};
extern const struct exh_hand_bones exh_hit2_bones[EXH_FINGERS];

/* Parameters of one finger; rows in exh_hand_rows[]. */
struct exh_hand_par {
    int32_t arm1_m_q30; /* string per radian of the wearer's knuckle, m, 0 .. 50 mm; estimated */
    int32_t arm2_m_q30; /* the same of the next joint, q2 */
    int32_t arm3_m_q30; /* the same of the last joint, q3 */
    int32_t pad_m_q30;  /* radius of the pad, m, 0 .. 25 mm: distance from P_F to the skin */
};
#define EXH_HAND_ROWS 4
extern const struct exh_signal exh_hand_rows[EXH_HAND_ROWS];

/* Set-up of one finger; constant in the tick. */
struct exh_hand_finger {
    const struct exh_hand_bones *bones; /* the caller's */
    int32_t pull_radpm_q20[2];          /* turn of q1 and q2 per metre of string, +-250 rad/m */
};

/* Set-up (divides); bones must outlive f. -EXH_E_RANGE: a parameter or a bone outside its range
 * above, or rot is no rotation: axes not of unit length or not orthogonal within 1e-6, or
 * left-handed. Also -EXH_E_RANGE: arm1^2 + (arm2 + arm3)^2 below (4 mm)^2, where a metre of string
 * would turn a joint by more than 250 rad. */
int exh_hand_setup(
    struct exh_hand_finger *f, const struct exh_hand_bones *bones, const struct exh_hand_par *par);

/* Set-up, after exh_hand_setup(). The string bends the wearer's joints. The robot's joints follow
 * by the gains of the map. A joint at its limit does not turn; the caller then sets its
 * pull_radpm_q20 to 0. Adds an error of at most 1/2 LSB and that of the gains. -EXH_E_RANGE: above
 * 250 rad/m; f is unchanged. */
int exh_hand_couple(struct exh_hand_finger *f, const struct exh_hand_map *map, unsigned finger);

/* The centre of the pad, P_F, in the palm's frame, m, q30, from the joints q0, q1, q2 (q3 = q2) at
 * any angles. The error against exact kinematics is at most 2.15 LSB (0.002 um) for exh_hit2_bones
 * and 3 LSB for any bones. Rounding of the bones' constants adds less than 0.3 LSB. Nothing can
 * overflow or saturate: |P_F| < 0.5 m. */
void exh_hand_tip(
    const struct exh_hand_finger *f, const int32_t *joint_turn_q32, struct exh_vec3 *tip_m_q30);

/* P_F as above and its slope: metres of tip movement per metre of string, q24. The string over the
 * back of the finger turns q1, and q2 with q3. It does not turn q0. Many turns satisfy
 * arm1*dq1 + (arm2 + arm3)*dq2 = 1. The function uses that of least dq1^2 + dq2^2.
 * - Error for the pulls in f: 4 LSB (2.4e-7) if each joint turns <= 40 rad/m (defaults: 17, 24).
 *   Otherwise 16 LSB. Rounding of the pulls to q20 adds up to 4 LSB (5.5 in all found).
 * - The slope cannot saturate: it is below 68. */
void exh_hand_tip_slope(const struct exh_hand_finger *f, const int32_t *joint_turn_q32,
    struct exh_vec3 *tip_m_q30, struct exh_vec3 *slope_q24);

#ifdef __cplusplus
}
#endif
#endif
