/* SPDX-License-Identifier: MIT */
/* Chatter: detects a limit cycle of a contact, in which the current drives the string.
 *
 * A cycle runs from one minimum of the coded current to the next; swings below 0.25 A do not count.
 * Its energy output is exact, as in passivity.h: held current times counts moved. The last point of
 * the force table converts it to energy. Cycles longer than 50 ms (at least 8 ticks) are ignored,
 * since a hand can make them. A sum adds the energy output of the cycles, subtracts their input,
 * and decays towards 0 by power. When it reaches energy, the fault is raised.
 *
 * Taps and bounces take in more than they give out. D/A noise causes no swing. A limit cycle of one
 * count gives out less than power: it is felt, but harmless. The fault comes no sooner than energy
 * / output power. If every cycle counts, it comes by 2 * energy / (output power - power). */
#ifndef EXHAND_CHATTER_H
#define EXHAND_CHATTER_H

#include "exhand/bytes.h"
#include "exhand/drive.h"
#include "exhand/signal.h"
#include "exhand/velocity.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Parameters of one finger; rows in exh_chatter_rows[]. */
struct exh_chatter_par {
    int32_t power_W_q20;  /* continuous output power that is allowed, W, 0.01 .. 10 */
    int32_t energy_J_q24; /* energy beyond that until the fault, J, 0.001 .. 1; 0: never */
};
#define EXH_CHATTER_ROWS 2
extern const struct exh_signal exh_chatter_rows[EXH_CHATTER_ROWS];

/* Set-up of one finger. */
struct exh_chatter_cfg {
    int64_t energy_Acnt_q20; /* energy / (force per ampere * length per count); 0: never */
    int64_t leak_Acnt_q20;   /* power of one tick, in the same unit */
    uint32_t ticks;          /* length of a cycle that is ignored */
};

/* State of one finger. All zeros: at rest. */
struct exh_chatter {
    int64_t net_Acnt_q20;   /* energy output beyond power, -energy .. energy */
    int64_t cycle_Acnt_q20; /* energy output since the minimum */
    int32_t held_A_q26;     /* coded in the last tick */
    int32_t end_A_q26;      /* extreme since the current reversed */
    int32_t cnt;            /* count of the last tick */
    uint32_t ticks;         /* since the minimum, 0 .. cfg->ticks */
    uint8_t rises;          /* 1: the current reversed at a minimum and rises */
};

/* Set-up (divides); after that of the drive, whose table it uses. -EXH_E_RATE: T. -EXH_E_RANGE: a
 * parameter outside its range above, or an impossible step or table. */
int exh_chatter_setup(struct exh_chatter_cfg *cfg, const struct exh_chatter_par *par,
    const struct exh_drive_cfg *drive, struct exh_velocity_scale scale);

/* First call of a tick. Returns EXH_FAULT_CHATTER while the fault is due, else 0. */
uint32_t exh_chatter_step(const struct exh_chatter *s, const struct exh_chatter_cfg *cfg);

/* Call it after the gate, with count and coded current of this tick. Missed ticks do not decay. */
void exh_chatter_update(
    struct exh_chatter *s, const struct exh_chatter_cfg *cfg, int32_t cnt, int32_t coded_A_q26);

/* State through a cursor. */
void exh_chatter_serialize(struct exh_bytes *c, struct exh_chatter *s);

#ifdef __cplusplus
}
#endif
#endif
