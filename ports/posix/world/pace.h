/* SPDX-License-Identifier: MIT */
/* How fast the fingers' joints turn, from the states that came: the newest against the oldest of
 * the last 250 ms that is not a turn of 0.2 rad away. Glove angles are coarse: of a slow finger,
 * less would say little of where it goes. */
#ifndef WORLD_PACE_H
#define WORLD_PACE_H

#include "finger.h"

#include "exhand/wire.h"

#define PACE_STATES 32

struct pace {
    struct pace_at {
        uint32_t stamp_us;
        int32_t joint_turn_q32[FINGERS][3];
    } at[PACE_STATES]; /* states, 10 ms apart, in a ring */
    unsigned n, last;
    unsigned fingers;  /* that any of them reported, one bit each; joints of others stay 0 */
    unsigned from, to; /* joints from .. to - 1 are all of theirs */
    int32_t least_turn_q32[FINGERS * 3], most_turn_q32[FINGERS * 3]; /* of these states */
    double turn_q32ps[FINGERS][3];                                   /* of each joint, a second */
    double pull_turn_q32ps[FINGERS][3]; /* the same while the string runs out at 0.05 m/s */
};

/* How a string bends the fingers, from the controller's HELLO; 0: unknown. */
void pace_pull(struct pace *p, const struct exh_wire_hello *hello);

/* Takes a state sent at stamp_us of the controller's clock. A clock that went back or stopped for
 * long restarts the estimate with zero speed. */
void pace_take(struct pace *p, const struct exh_wire_state *state, uint32_t stamp_us);

#endif
