#include "exhand/angle.h"

#include "exhand/fix.h"

/* Both polynomials belong to 0 .. 1/8 turn, where u = 8x (0..1) and z = u^2:
 *   sin = u (S0 - z (S1 - z (S2 - z S3)))      misses by 1.21e-9 at most
 *   cos = 1 - z (C1 - z (C2 - z (C3 - z C4)))  misses by 5.4e-11
 * They are the polynomials of these degrees with the least largest error, by the Remez
 * exchange on 0 <= u <= 1 with 40 digits (error equal and alternating at 5 points; the sine odd, the
 * cosine even with 1 at 0), each coefficient then rounded to its format. A product keeps its high
 * word, so a format loses the two bits of z's q30 at every step: what is added to it has the
 * format of that result. */
#define S0_Q31 1686629690u /* 0.785398152542748    */
#define S1_Q33 693597423u /* 0.0807453672710303   */
#define S2_Q35 85551349u /* 0.00248987196800914  */
#define S3_Q37 4930933u /* 3.58772585030588e-5  */
#define C1_Q32 1324675872u /* 0.308425135838379    */
#define C2_Q34 272375277u /* 0.0158543277519284   */
#define C3_Q36 22398564u /* 3.25942008049486e-4  */
#define C4_Q38 970686u /* 3.53133471025078e-6  */

#define EIGHTH  (UINT32_C(1) << 29)
#define QUARTER (UINT32_C(1) << 30)
#define ONE_Q30 (UINT32_C(1) << 30)

/* All ones if bit n of x is set, else 0. */
static uint32_t mask_of(uint32_t x, unsigned n)
{
    return 0u - (x >> n & 1u);
}

void exh_sincos(int32_t x_turn_q32, struct exh_sincos *y)
{
    const uint32_t x = (uint32_t)x_turn_q32;

    /* An odd eighth is measured from its far end: 0 .. 2^29, both included. */
    const uint32_t odd = mask_of(x, 29);
    const uint32_t u_q31 = (((x ^ odd) & (EIGHTH - 1)) - odd) << 2;
    const uint32_t z_q30 = exh_umul_hi(u_q31, u_q31);

    const uint32_t s3_q35 = exh_umul_hi(z_q30, S3_Q37);
    const uint32_t s2_q33 = exh_umul_hi(z_q30, S2_Q35 - s3_q35);
    const uint32_t s1_q31 = exh_umul_hi(z_q30, S1_Q33 - s2_q33);
    const uint32_t s_q30 = exh_umul_hi(u_q31, S0_Q31 - s1_q31);

    const uint32_t c4_q36 = exh_umul_hi(z_q30, C4_Q38);
    const uint32_t c3_q34 = exh_umul_hi(z_q30, C3_Q36 - c4_q36);
    const uint32_t c2_q32 = exh_umul_hi(z_q30, C2_Q34 - c3_q34);
    const uint32_t c_q30 = ONE_Q30 - exh_umul_hi(z_q30, C1_Q32 - c2_q32);

    /* Between 1/8 and 3/8 turn, and opposite, the two change places. */
    const uint32_t swap = (s_q30 ^ c_q30) & mask_of(x + EIGHTH, 30);
    const uint32_t below = mask_of(x, 31);
    const uint32_t left = mask_of(x + QUARTER, 31);
    y->sin_q30 = exh_from_u32((s_q30 ^ swap ^ below) - below);
    y->cos_q30 = exh_from_u32((c_q30 ^ swap ^ left) - left);
}
