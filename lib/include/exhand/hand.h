/* SPDX-License-Identifier: MIT */
/* Hand: from the glove's 22 angles to the joints of a robot hand, to its fingertips.
 *
 * What a hand is made of is data: a map (which sensors move which joint) and bones
 * (lengths and place of each finger). Those of the DLR/HIT Hand II, right, are in
 * hand_hit2.c. Every call works on one finger and costs one finger.
 *
 * A finger has four joints: q0 turns it sideways about the z axis of its base, q1, q2 and q3
 * bend it, and q3 follows q2. Driven are q0, q1, q2. At 0 it points along x of its base;
 * bending moves the tip towards z.
 */
#ifndef EXHAND_HAND_H
#define EXHAND_HAND_H

#include "exhand/glove.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_HAND_JOINTS 3 /* driven, of one finger: q0, q1, q2 */
#define EXH_HAND_TERMS  2 /* sensors that move one joint, at most */

/* --- sensors to joints --- */

#define EXH_HAND_GAIN_MAX_Q24 \
    (8 * (INT32_C(1) << 24)) /* 8: no gain of a joint is larger, either way */

/* How one joint follows the sensors. */
struct exh_hand_joint {
    int32_t bias_turn_q32;            /* the joint's angle when all sensors are at 0 */
    int32_t gain_q24[EXH_HAND_TERMS]; /* -8 .. 8; 0: no term */
    uint8_t sensor[EXH_HAND_TERMS];   /* below EXH_GLOVE_SENSORS */
    int32_t lo_turn_q32, hi_turn_q32; /* the joint's limits, lo <= hi */
};
/* How all of a hand's joints follow them; data, in ROM or the caller's. */
struct exh_hand_map {
    struct exh_hand_joint joint[EXH_FINGERS][EXH_HAND_JOINTS]; /* q0, q1, q2 of each */
    /* Sensors of the wearer's own joints that the string bends: arm1's, and the two beyond it. */
    uint8_t bent[EXH_FINGERS][3]; /* below EXH_GLOVE_SENSORS; a thumb has one beyond, twice */
};
extern const struct exh_hand_map exh_hit2_map; /* of the DLR/HIT Hand II, right */

/* 0 if every sensor, also those bent, gain and pair of limits is as said above, -EXH_E_RANGE
 * otherwise: for maps that come from outside. Set-up. */
int exh_hand_map_validate(const struct exh_hand_map *map);

/* The three driven joints of one finger (0 .. 4) from all 22 sensors: bias + sum of gain times
 * sensor, exact, rounded once, limited to lo .. hi. Nothing wraps. Error <= 1/2 LSB.
 * Bit j of the result: joint j was limited. */
uint32_t exh_hand_joints(const struct exh_hand_map *map, unsigned finger,
    const int32_t *sensor_turn_q32, int32_t *joint_turn_q32);

/* --- joints to the fingertip --- */

/* One finger as it is built, in the frame of the palm. */
struct exh_hand_bones {
    int32_t len_m_q34[3];  /* q1 to q2, to q3, to the pad's middle; each > 0, sum <= 0.12 m */
    int32_t rot_q30[3][3]; /* rows x, y, z of the palm: the base frame's axes are the columns */
    int32_t base_m_q32[3]; /* where q0 and q1 are; within +-0.125 m */
};
extern const struct exh_hand_bones exh_hit2_bones[EXH_FINGERS];

/* Parameters of one finger; rows in exh_hand_rows[]. */
struct exh_hand_par {
    int32_t arm1_m_q30; /* string per radian of the wearer's knuckle, m, 0 .. 50 mm; ours, not
                           measured. With exh_hand_setup() alone q1 is that knuckle */
    int32_t arm2_m_q30; /* of the joint beyond it; q2 */
    int32_t arm3_m_q30; /* of the last; q3 */
    int32_t pad_m_q30;  /* radius of the pad, m, 0 .. 25 mm: so far from P_F is the skin */
};
#define EXH_HAND_ROWS 4
extern const struct exh_signal exh_hand_rows[EXH_HAND_ROWS];

/* One finger as it is set up; constant in the tick. */
struct exh_hand_finger {
    const struct exh_hand_bones *bones; /* the caller's */
    int32_t pull_radpm_q20[2]; /* turning of q1 and of q2 per metre of string, +-250 rad/m */
};

/* Set-up (divides); bones must outlive f. -EXH_E_RANGE: a parameter or a bone outside its range
 * above, rot no rotation (axes not of length 1 or not square to each other, within 1e-6, or
 * left-handed), or both arm1 and arm2 + arm3 so small that a metre of string would turn them by
 * more than 250 rad: arm1^2 + (arm2 + arm3)^2 below (4 mm)^2. */
int exh_hand_setup(
    struct exh_hand_finger *f, const struct exh_hand_bones *bones, const struct exh_hand_par *par);

/* Set-up, behind it: the string bends the wearer's joints, and the robot's follow them as the map
 * has it, each by gain times as much. A joint at its limit does not turn: the caller makes its pull
 * 0. Error
 * <= 1/2 LSB more, and that of the gains. -EXH_E_RANGE: above 250 rad/m; f is as it was. */
int exh_hand_couple(struct exh_hand_finger *f, const struct exh_hand_map *map, unsigned finger);

/* The middle of the pad, P_F, in the palm's frame, m, q30, of the joints q0, q1, q2 (q3 = q2),
 * which may be any angles. Error against exact kinematics of these angles and bones <= 2.15 LSB
 * (0.002 um) for exh_hit2_bones, 3 LSB for any; what their constants miss, by rounding to their
 * formats, is below 0.3 LSB. Nothing can overflow or saturate: |P_F| < 0.5 m. */
void exh_hand_tip(
    const struct exh_hand_finger *f, const int32_t *joint_turn_q32, struct exh_vec3 *tip_m_q30);

/* The same P_F, and how it moves as string runs out: metres per metre of string, q24. String over
 * the back of the finger turns q1, and q2 with q3: of all turnings that pay out a metre,
 * arm1*dq1 + (arm2 + arm3)*dq2 = 1, the one with the least dq1^2 + dq2^2. q0 moves no string.
 * Error <= 4 LSB (2.4e-7) for arms that turn no joint by more than 40 rad per metre (defaults:
 * 17 and 24), 16 LSB for any, of the pulls in f; that these are rounded to q20 adds up to 4 LSB
 * with the longest bones (5.5 in all found). It cannot saturate: below 68. */
void exh_hand_tip_slope(const struct exh_hand_finger *f, const int32_t *joint_turn_q32,
    struct exh_vec3 *tip_m_q30, struct exh_vec3 *slope_q24);

#ifdef __cplusplus
}
#endif
#endif
