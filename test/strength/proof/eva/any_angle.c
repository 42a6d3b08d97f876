/* SPDX-License-Identifier: MIT */
/* PROVES: sine and cosine
 * Every angle, split into eighths of a turn; the exact eighths separately.
 *
 * PLANT: lib/src/num/sincos.h: exh_from_u32(x << 2) -> x_turn_q32 << 2
 * PLANT: lib/src/num/sincos.h: #define C1_Q32  1324675872 -> #define C1_Q32  (-1324675872)
 * PLANT: lib/src/num/sincos.h: high(z_q30, c1_q32) - ONE_Q30 -> high(z_q30, c1_q32) + ONE_Q30
 */
#include "num/angle.c"

#include "any.h"

static void within(uint32_t from, uint32_t to)
{
    struct exh_sincos y;
    exh_sincos(exh_from_u32(Frama_C_unsigned_int_interval(from, to)), &y);
    /*@ assert sine: -(1 << 30) <= y.sin_q30 <= 1 << 30; */
    /*@ assert cosine: -(1 << 30) <= y.cos_q30 <= 1 << 30; */
}

int main(void)
{
    for (uint32_t k = 0; k < 8; k++) {
        const uint32_t x = k << 29;
        within(x, x);
        within(x + 1u, x + ((1u << 29) - 1u));
    }
    END();
    return 0;
}
