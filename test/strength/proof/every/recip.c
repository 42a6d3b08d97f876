/* SPDX-License-Identifier: MIT */
/* PROVES: reciprocal
 * exh_recip_q24() of each of its arguments, 1/8 .. 8. The result is within 1/8 .. 8 again.
 *
 * PLANT: lib/include/exhand/fix.h: i < 3 -> i < 1
 * PLANT: lib/include/exhand/fix.h: unsigned shift = 3; -> unsigned shift = 4;
 */
#include "exhand/fix.h"

int main(void)
{
    for (int32_t x = INT32_C(1) << 21; x <= INT32_C(1) << 27; x++) {
        const int32_t y_q24 = exh_recip_q24(x);
        if (y_q24 < INT32_C(1) << 21 || y_q24 > INT32_C(1) << 27) { return 1; }
    }
    return 0;
}
