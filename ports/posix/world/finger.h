/* SPDX-License-Identifier: MIT */
/* The virtual hand: DLR/HIT Hand II, right, in doubles. {R} is its palm: z along the fingers,
 * x out of the palm (the way the fingers close), y towards the thumb's side; metres.
 *
 * A finger has four joints: q0 sideways, then q1, q2 and q3 = q2, which bend. P_F is the middle
 * of the pad's sphere, FINGER_PAD_M its radius.
 */
#ifndef WORLD_FINGER_H
#define WORLD_FINGER_H

#include "vec.h"

#include <stdint.h>

#define FINGERS       5
#define FINGER_PAD_M  0.0105
#define FINGER_SPAN_M 0.105 /* from q1 to P_F, straight: P_F is never further from its base */

extern const char *const finger_name[FINGERS];

/* Radii of the three links as capsules, and the limits of q0, q1, q2. */
extern const double finger_radius_m[3];
extern const double finger_lo_rad[3], finger_hi_rad[3];

/* Positions of the fingers in the palm. */
struct hand {
    struct pose base[FINGERS];
};
void hand_hit2(struct hand *h);

struct finger {
    struct v3 joint[3]; /* where q1, q2, q3 are */
    struct v3 tip;      /* P_F */
};

/* One finger (0 thumb .. 4 little) at the angles q0, q1, q2; P_F within 1e-15 m. */
void finger_at(
    struct finger *f, const struct hand *h, unsigned which, const int32_t joint_turn_q32[3]);

#endif
