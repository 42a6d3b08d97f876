/* SPDX-License-Identifier: MIT */
/* Chatter: a contact that buzzes. Its current swings to and fro, and each cycle drives the string.
 *
 * A cycle goes from one valley of the coded current to the next, of swings above 0.25 A. What it
 * gives out is exact, as passivity.h has it: the current held times the counts moved, by the force
 * that the table's last point has per ampere. A cycle of more than 50 ms (8 ticks at least) does
 * not count, since a hand may do that. A sum takes what counting cycles give out, less what they
 * take in, and goes towards 0 by `power` at any time. At `energy` it is the fault.
 *
 * A tap and its bounces take in more than they give. Noise of a code is no swing. A limit cycle of
 * one count gives out less than `power`, and is felt but does not harm. The fault comes no sooner
 * than energy over what is given out, and no later than twice `energy` over what goes beyond
 * `power`, where each cycle counts.
 */
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
    int32_t power_W_q20;  /* given out without end, W, 0.01 .. 10 */
    int32_t energy_J_q24; /* given out beyond that: fault, J, 0.001 .. 1; 0: never */
};
#define EXH_CHATTER_ROWS 2
extern const struct exh_signal exh_chatter_rows[EXH_CHATTER_ROWS];

/* One finger as it is set up. */
struct exh_chatter_cfg {
    int64_t energy_Acnt_q20; /* energy by force per ampere and way per count; 0: never */
    int64_t leak_Acnt_q20;   /* power in a tick, likewise */
    uint32_t ticks;          /* a cycle so long does not count */
};

/* One finger from tick to tick. */
struct exh_chatter {
    int64_t net_Acnt_q20;   /* given out beyond power, -energy .. energy */
    int64_t cycle_Acnt_q20; /* given out since the valley */
    int32_t held_A_q26;     /* coded in the last tick */
    int32_t end_A_q26;      /* farthest since the current turned */
    int32_t cnt;            /* of the last tick */
    uint32_t ticks;         /* since the valley, 0 .. cfg's */
    uint8_t rises;          /* 1: it turned at a valley */
};

/* Set-up (divides), behind the drive's, for its table. -EXH_E_RATE: T; -EXH_E_RANGE: a parameter
 * outside its range above, or a step or table that no device has. */
int exh_chatter_setup(struct exh_chatter_cfg *cfg, const struct exh_chatter_par *par,
    const struct exh_drive_cfg *drive, struct exh_velocity_scale scale);

/* First thing of a tick: EXH_FAULT_CHATTER while due, else 0. */
uint32_t exh_chatter_step(const struct exh_chatter *s, const struct exh_chatter_cfg *cfg);

/* Behind the gate, with the count of this tick and the current coded. Ticks missed leak nothing. */
void exh_chatter_update(
    struct exh_chatter *s, const struct exh_chatter_cfg *cfg, int32_t cnt, int32_t coded_A_q26);

/* State through a cursor. A state of zeros is a finger at rest. */
void exh_chatter_serialize(struct exh_bytes *c, struct exh_chatter *s);

#ifdef __cplusplus
}
#endif
#endif
