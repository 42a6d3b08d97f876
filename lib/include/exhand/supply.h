/* SPDX-License-Identifier: MIT */
/* Supply: checks the supply voltage of the drives.
 *
 *   if (exh_supply_step(&supply, &cfg, in.supply_raw, missed)) { raised |= EXH_FAULT_SUPPLY; } */
#ifndef EXHAND_SUPPLY_H
#define EXHAND_SUPPLY_H

#include "exhand/bytes.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters of the supply; rows in exh_supply_rows[]. */
struct exh_supply_par {
    int32_t min_V_q20;   /* lower limit, V, 0 .. 100; 0: no monitor, no check */
    int32_t max_V_q20;   /* upper limit, V, min .. 100 */
    int32_t scale_V_q30; /* volt per code of supply_raw, > 0 .. 2 */
    int32_t time_ms;     /* longest time outside, ms, 1 .. 1000 */
};
#define EXH_SUPPLY_ROWS 4
extern const struct exh_signal exh_supply_rows[EXH_SUPPLY_ROWS];

/* Set-up, with limits in codes so that the tick needs no product. */
struct exh_supply_cfg {
    int16_t min_raw, max_raw; /* lowest and highest allowed code */
    uint32_t ticks;           /* time_ms in ticks, rounded down, plus 1 */
};

/* State of the supply. All zeros: voltage never outside. */
struct exh_supply {
    uint32_t off_ticks; /* consecutive ticks outside, 0 .. ticks */
};

/* Set-up (divides). -EXH_E_RANGE: a parameter outside its range above, no code between the limits,
 * or an upper limit not below the highest code. -EXH_E_RATE: T. */
int exh_supply_setup(
    struct exh_supply_cfg *cfg, const struct exh_supply_par *par, struct exh_period T);

/* Checks the code of one tick; missed ticks before it count as this one. Returns 1 while the
 * voltage has been outside for cfg->ticks consecutive ticks, else 0. Raise EXH_FAULT_SUPPLY
 * then. */
int exh_supply_step(
    struct exh_supply *s, const struct exh_supply_cfg *cfg, int16_t raw, uint32_t missed);

/* State through a cursor. At worst, damaged bytes raise the fault until the voltage is valid. */
void exh_supply_serialize(struct exh_bytes *c, struct exh_supply *s);

#ifdef __cplusplus
}
#endif
#endif
