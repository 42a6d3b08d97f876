/* SPDX-License-Identifier: MIT */
/* Gains: which stiffness and damping a scene takes. A rule made outside, asked here in integers.
 *
 * What k and b the loop holds at rest depends on the rate and on the device; `exhand advise gains
 * --rule` finds out by simulation and prints a rule that lies inside of what it found: the largest
 * k as straight pieces over b, between knots, at one rate. Here is only the question whether a pair
 * is inside, by two exact products a piece: no division, no rounding, no float.
 *
 * A rule says nothing of another rate, another device or another finger than those it was made for.
 */
#ifndef EXHAND_GAINS_H
#define EXHAND_GAINS_H

#include "exhand/params.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_GAINS_KNOTS 8 /* of a rule, at most */

/* The rule; rows in exh_gains_rows[], all set-up values. Knots from `knots` on are not looked at.
 */
struct exh_gains_par {
    int32_t rate_Hz_q8;                  /* the loop rate it was made for, Hz, 1 .. 20000 */
    int32_t knots;                       /* 2 .. EXH_GAINS_KNOTS */
    int32_t k_min_Npm_q10;               /* smallest k inside, N/m, 0 .. 10^6 */
    int32_t b_Nspm_q20[EXH_GAINS_KNOTS]; /* of the knots, Ns/m, 0 .. 1000, rising strictly */
    int32_t k_Npm_q10[EXH_GAINS_KNOTS];  /* the largest k at it, N/m, 0 .. 10^6 */
};
#define EXH_GAINS_ROWS (3 + 2 * EXH_GAINS_KNOTS)
extern const struct exh_signal exh_gains_rows[EXH_GAINS_ROWS];

/* Whether the rule can be asked at this period. -EXH_E_RANGE: a value outside its row, or a knot
 * below k_min between two that are not: what is inside must hang together; -EXH_E_MONOTONE: b does
 * not rise; -EXH_E_RATE: the period's rate is more than 1 % off the rule's. */
int exh_gains_setup(const struct exh_gains_par *rule, struct exh_period T);

/* For another rate: k of all knots and k_min go with the rate, b where the loop is slower alone, as
 * a count's share of the damper grows with the rate. Divides; rounds and saturates each value at
 * the end of its row. A guess, where nobody asked `exhand advise gains` at that rate. Errors as
 * exh_gains_setup(), but for the rate: any that exh_period_ok(). */
int exh_gains_scale(struct exh_gains_par *rule, struct exh_period T);

/* The largest k inside at this b, N/m, q10; 0 where nothing is. At set-up: it asks 31 times. */
int32_t exh_gains_k_max(const struct exh_gains_par *rule, int32_t b_Nspm_q20);

/* 1 if the rule allows k and b, else 0; any int32_t. k = b = 0, no wall, is always allowed. Inside
 * means k_min <= k and k on or below the straight line between the two knots around b; nothing is
 * inside before the first knot or behind the last. Exact: products below 2^62. Needs a rule that
 * set-up took. */
int exh_gains_ok(const struct exh_gains_par *rule, int32_t k_Npm_q10, int32_t b_Nspm_q20);

/* In place of exh_params_stage() where a scene has a rule: stages k or b (the materials' rows, or
 * the contact's of a scene without materials, by id) of an instance only if it is inside together
 * with what is staged of the other. -EXH_E_GAINS if not: nothing is staged then. So b before k when
 * both rise, k before b when both fall. Any other value as exh_params_stage(). */
int exh_gains_stage(struct exh_params *p, const struct exh_gains_par *rule, uint16_t id,
    uint16_t instance, int32_t raw);

/* The same by index of the value, for whom authority.h may refuse it: as exh_params_stage_by(). */
int exh_gains_stage_by(struct exh_params *p, const struct exh_gains_par *rule,
    struct exh_authority who, uint32_t i, int32_t raw);

/* Of a whole image, behind exh_params_load() and before exh_params_apply(): 0, or -EXH_E_GAINS with
 * *instance (may be NULL) the first whose staged k and b are outside. Then what is staged must not
 * be applied: exh_params_discard() puts the active values back in its place. They are inside, in
 * mid-way too, where exh_gains_step() moves them. */
int exh_gains_validate(
    const struct exh_params *p, const struct exh_gains_par *rule, uint16_t *instance);

/* At set-up of a scene with a rule: on 1, k and b stand still in exh_params_apply() while locked
 * and are moved by exh_gains_step() alone; 0: as all slewed values. Without exh_gains_step() k and
 * b do not change. */
void exh_gains_enable(struct exh_params *p, int on);

/* Behind exh_params_apply(), before the tick: k and b of every instance go one step of 2^-shift
 * towards what is staged, so that the active pair is inside in every tick, whatever rule set-up
 * took and whenever something else is staged. Moves along the straight line if all of it is inside
 * the rule. Otherwise k first falls to the lowest knot in between, then b moves, then k rises: k
 * never alternates. Each takes at most the ticks of
 * exh_params_slew_step() for falling, for b and for rising, one behind the other. To and from k = b
 * = 0 where that lies apart from the rest of the rule (k_min > 0, or the first knot's b > 0): one
 * jump between it and k_min. shift 0: at once. Staged pairs outside, which exh_gains_stage()
 * refuses, are not gone to; an active pair outside, from a damaged keyframe, becomes 0 at once.
 * Where apply left nothing on its way, nothing is gone to: what differs then is damaged, and
 * exh_params_verify() tells. */
void exh_gains_step(struct exh_params *p, const struct exh_gains_par *rule);

#ifdef __cplusplus
}
#endif
#endif
