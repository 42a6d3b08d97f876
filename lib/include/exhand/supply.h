/* SPDX-License-Identifier: MIT */
/* Supply: is the voltage that feeds the drives within its limits? */
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
    int32_t min_V_q20;   /* V, 0 .. 100; 0: the box has no monitor of it, it is not judged */
    int32_t max_V_q20;   /* V, min .. 100 */
    int32_t scale_V_q30; /* volt per code of supply_raw, > 0 .. 2 */
    int32_t time_ms;     /* ms, 1 .. 1000 */
};
#define EXH_SUPPLY_ROWS 4
extern const struct exh_signal exh_supply_rows[EXH_SUPPLY_ROWS];

/* The supply's limits as they are set up, in codes: no product in the tick. */
struct exh_supply_cfg {
    int16_t min_raw, max_raw; /* codes within the limits, both included */
    uint32_t ticks;           /* the time, rounded down, and one more */
};

/* The supply from tick to tick. */
struct exh_supply {
    uint32_t off_ticks; /* outside on end, 0 .. ticks */
};

/* Set-up (divides). -EXH_E_RANGE: a parameter outside its range above, or limits between which
 * there is no code, or of which the upper is not below the highest code; -EXH_E_RATE: T. */
int exh_supply_setup(
    struct exh_supply_cfg *cfg, const struct exh_supply_par *par, struct exh_period T);

/* A tick's code, after so many that were missed, which count as this one. 1 while the voltage is
 * outside its limits for cfg->ticks ticks on end: to be raised as EXH_FAULT_SUPPLY; else 0. */
int exh_supply_step(
    struct exh_supply *s, const struct exh_supply_cfg *cfg, int16_t raw, uint32_t missed);

/* State through a cursor. A state of zeros is a supply that was never outside. Damaged bytes at
 * worst raise the fault until a voltage within the limits is seen. */
void exh_supply_serialize(struct exh_bytes *c, struct exh_supply *s);

#ifdef __cplusplus
}
#endif
#endif
