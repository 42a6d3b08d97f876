/* SPDX-License-Identifier: MIT */
/* PROVES: supply
 * Set-up with any parameters and period. A tick with any limits, code and missed ticks, in any
 * state.
 *
 * PLANT: lib/src/act/supply.c: most >= INT16_MAX || least > most -> least > most
 * PLANT: lib/src/act/supply.c: if (!exh_period_ok(T)) { return -EXH_E_RATE; } -> (void)0;
 * PLANT: lib/src/act/supply.c: par->scale_V_q30 < 1 || par->time_ms < 1 || -> par->time_ms < 1 ||
 */
#include "num/bytes.c"
#include "num/fix.c"
#include "act/supply.c"

#include "any.h"

static struct exh_supply s;
static struct exh_supply_cfg cfg;
static struct exh_supply_par par;

static void set_up(uint32_t least, uint32_t most)
{
    const struct exh_period T = {Frama_C_unsigned_int_interval(least, most), any_u32()};
    ANY(par);
    (void)exh_supply_setup(&cfg, &par, T);
}

int main(void)
{
    int off;
    set_up(0, 0);
    set_up(1, UINT32_MAX);
    ANY(cfg);
    FROM_BYTES(s, exh_supply_serialize);
    off = exh_supply_step(&s, &cfg, (int16_t)Frama_C_interval(INT16_MIN, INT16_MAX), any_u32());
    /*@ assert says: off == 0 || off == 1; */
    END();
    return 0;
}
