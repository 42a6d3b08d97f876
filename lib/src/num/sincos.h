/* SPDX-License-Identifier: MIT */
/* Inline sine and cosine, for angle.c, and for hand.c, which needs three in one call. */
#ifndef EXHAND_SINCOS_H
#define EXHAND_SINCOS_H

#include "exhand/angle.h"
#include "exhand/fix.h"

/* Both polynomials cover 0 .. 1/8 turn, with u = 8x (0..1) and z = u^2:
 *
 *   sin = u (S0 + z (S1 + z (S2 + z S3)))       error at most 1.21e-9
 *   cos = 1 - z (C1 + z (C2 + z (C3 + z C4)))   error at most 5.4e-11
 *
 * They have the least maximum error of these degrees, by the Remez exchange on 0 <= u <= 1 with 40
 * digits. The error is equal and alternating at 5 points. sin is odd; cos is even, 1 at 0.
 * Coefficients are rounded. S0 is lowered by one to offset the floors of the products. A product
 * keeps its high word, so each step loses the two bits of z's q30. An addend has the result's
 * format. The code computes -u, -sin and -cos: these fit 32 bits at both ends. */
#define S0_Q31  1686629689   /*  0.785398152542748 */
#define S1_Q33  (-693597423) /* -0.0807453672710303 */
#define S2_Q35  85551349     /*  0.00248987196800914 */
#define S3_Q37  (-4930933)   /* -3.58772585030588e-5 */
#define C1_Q32  1324675872   /*  0.308425135838379 */
#define C2_Q34  (-272375277) /* -0.0158543277519284 */
#define C3_Q36  22398564     /*  3.25942008049486e-4 */
#define C4_Q38  (-970686)    /* -3.53133471025078e-6 */
#define ONE_Q30 (INT32_C(1) << 30)

#define EIGHTH  (UINT32_C(1) << 29)
#define QUARTER (UINT32_C(1) << 30)

/* -1 if the top bit of x is set, else 0. */
static inline int32_t top_mask(uint32_t x) { return exh_from_u32(x) >> 31; }

/* floor(a*b / 2^32) of 32-bit values, in the fastest type of at least 32 bits. */
static inline int_fast32_t high(int_fast32_t a, int_fast32_t b)
{
    return (int_fast32_t)((int64_t)a * b >> 32);
}

static inline struct exh_sincos sincos_in_place(int32_t x_turn_q32)
{
    const uint32_t x = (uint32_t)x_turn_q32;

    /* Minus the distance to the nearest multiple of a quarter, at most an eighth: -2^31 .. 0. */
    const int32_t v_q31 = exh_from_u32(x << 2);
    const int32_t odd = v_q31 >> 31;
    const int_fast32_t u_q31 = odd - (v_q31 ^ odd);
    const int_fast32_t z_q30 = high(u_q31, u_q31);

    const int_fast32_t s2_q35 = high(z_q30, S3_Q37) + S2_Q35;
    const int_fast32_t s1_q33 = high(z_q30, s2_q35) + S1_Q33;
    const int_fast32_t s0_q31 = high(z_q30, s1_q33) + S0_Q31;
    const int32_t s_q30 = (int32_t)high(u_q31, s0_q31);

    const int_fast32_t c3_q36 = high(z_q30, C4_Q38) + C3_Q36;
    const int_fast32_t c2_q34 = high(z_q30, c3_q36) + C2_Q34;
    const int_fast32_t c1_q32 = high(z_q30, c2_q34) + C1_Q32;
    const int32_t c_q30 = (int32_t)high(z_q30, c1_q32) - ONE_Q30;

    /* Between 1/8 and 3/8 turn, and in the opposite range, sine and cosine swap. */
    const int32_t swap = (s_q30 ^ c_q30) & top_mask((x + EIGHTH) << 1);
    const int32_t below = top_mask(x);
    const int32_t left = top_mask(x + QUARTER);
    const struct exh_sincos y = {below - (s_q30 ^ swap ^ below), left - (c_q30 ^ swap ^ left)};
    return y;
}

#endif
