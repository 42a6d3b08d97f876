/* SPDX-License-Identifier: MIT */
/* PROVES: self-test
 * Any value of the operands, which are volatile. No undefined behaviour, and the answer is one of
 * its enumeration. Set-up of the filter is any, and so is the sine (any_angle.c).
 *
 * EVA: -eva-slevel 100
 * PLANT: lib/src/safe/selftest.c: k < sizeof want / sizeof want[0] -> k <= sizeof want / sizeof want[0]
 */
#include "num/bytes.c"
#include "num/crc.c"
#include "num/fix.c"
#include "sense/filter.c"
#include "sense/filter_low.c"
#include "sense/filter_high.c"
#define exh_filter_setup(cfg, ...) filter_set_up(cfg)
static int filter_set_up(struct exh_filter_cfg *cfg);

/* den is a constant of the program but for damage: a divisor of 0 stops it, as documented. */
#define MAY_STOP
#include "safe/selftest.c"

#include "any.h"

static int filter_set_up(struct exh_filter_cfg *cfg)
{
    ANY(*cfg);
    cfg->kind = EXH_FILTER_LOW2;
    cfg->a = Frama_C_interval(0, (1 << 30) - 1);
    return any32();
}

void exh_sincos(int32_t x_turn_q32, struct exh_sincos *y)
{
    (void)x_turn_q32;
    ANY(*y);
}

int main(void)
{
    int first = exh_selftest_glove();
    /*@ assert one_of_them: 0 <= first <= 6; */
    END();
    return 0;
}
