/* SPDX-License-Identifier: MIT */
/* PROVES: length of (sin, cos)
 * Each distance from a whole quarter, up to an eighth of a turn, on either side. The square of the
 * length is 1 within 2^-27. -x has -sin and cos, except at the eighth itself, where the two change
 * places. All other angles swap or negate these two (test/module/prop/angle_test.c).
 *
 * PLANT: lib/src/num/sincos.h: #define S3_Q37  (-4930933) -> #define S3_Q37  (-4930033)
 * PLANT: lib/src/num/sincos.h: #define C1_Q32  1324675872 -> #define C1_Q32  1324675972
 */
#include "num/sincos.h"

int main(void)
{
    const int64_t one_q60 = INT64_C(1) << 60, off_q60 = INT64_C(1) << 33;
    for (uint32_t x = 0; x <= EIGHTH; x++) {
        const struct exh_sincos y = sincos_in_place(exh_from_u32(x));
        const struct exh_sincos z = sincos_in_place(exh_from_u32(0u - x));
        const int64_t square_q60 = (int64_t)y.sin_q30 * y.sin_q30 + (int64_t)y.cos_q30 * y.cos_q30;
        if (square_q60 - one_q60 > off_q60 || one_q60 - square_q60 > off_q60) { return 1; }
        if (z.sin_q30 != -(x < EIGHTH ? y.sin_q30 : y.cos_q30)) { return 1; }
        if (z.cos_q30 != (x < EIGHTH ? y.cos_q30 : y.sin_q30)) { return 1; }
    }
    return 0;
}
