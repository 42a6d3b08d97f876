/* SPDX-License-Identifier: MIT */
/* Turn: sine and cosine of a binary angle to 2^-55, in integers, for oracles.
 *
 * The power series, in q60: it shares nothing with angle.c but that sine and cosine
 * repeat. prop/angle_test.c checks it by what defines the two functions. */
#ifndef TEST_TURN_H
#define TEST_TURN_H

#include "wide.h"

#include <stdint.h>

#define TURN_PI_Q60 INT64_C(3622009729038561421)

struct turn {
    int64_t sin_q60, cos_q60;
};

/* Of -1/4 .. 1/4 turn, where no term, times the angle, reaches 8. */
static inline struct turn turn_series(int32_t x_turn_q32)
{
    const struct wide pi_x = wide_mul(TURN_PI_Q60, x_turn_q32); /* half turns: q31 */
    const int64_t rad_q60 = wide_sat64(wide_shr_half_up(pi_x, 31));
    struct turn y = {0, INT64_C(1) << 60};
    int64_t term_q60 = INT64_C(1) << 60; /* x^n / n! */
    for (int n = 1; term_q60 > 0 || term_q60 < -1; n++) {
        term_q60 = wide_sat64(wide_shr_half_up(wide_mul(term_q60, rad_q60), 60)) / n;
        switch (n & 3) {
        case 0: y.cos_q60 += term_q60; break;
        case 1: y.sin_q60 += term_q60; break;
        case 2: y.cos_q60 -= term_q60; break;
        default: y.sin_q60 -= term_q60; break;
        }
    }
    return y;
}

static inline struct turn turn_of(int32_t x_turn_q32)
{
    const int64_t quarter = INT64_C(1) << 30, x = x_turn_q32;
    struct turn y;
    if (x <= quarter && x >= -quarter) { return turn_series(x_turn_q32); }
    y = turn_series((int32_t)((x > 0 ? 2 * quarter : -2 * quarter) - x));
    y.cos_q60 = -y.cos_q60;
    return y;
}

#endif
