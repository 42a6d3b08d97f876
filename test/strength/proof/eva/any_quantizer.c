/* SPDX-License-Identifier: MIT */
/* PROVES: quantizer
 * Set-up with any parameters; a tick with accepted ones, in any state, with any input.
 *
 * PLANT: lib/src/sense/quantizer.c: par->bits > 24 -> par->bits > 32
 * PLANT: lib/src/sense/quantizer_tick.h: (uint32_t)x - (uint32_t)value : -> (uint32_t)(x - value) :
 */
#include "num/bytes.c"
#include "sense/quantizer.c"

#include "any.h"

int main(void)
{
    static struct exh_quantizer s;
    static struct exh_quantizer_cfg cfg;
    struct exh_quantizer_par par;
    par.bits = any32();
    par.hyst_raw_q16 = any32();
    if (exh_quantizer_setup(&cfg, &par) == 0) {
        /*@ assert half_a_code: 128 / 2 <= cfg.half <= 1 << 30; */
        /*@ assert kept: cfg.keep <= 1 << 31; */
        FROM_BYTES(s, exh_quantizer_serialize);
        (void)exh_quantizer_step(&s, &cfg, any32());
        END();
    }
    return 0;
}
