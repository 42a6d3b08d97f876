/* SPDX-License-Identifier: MIT */
/* Gains: the rule that says which stiffness k and damping b a scene may use.
 *
 * The (k, b) region that the loop keeps stable depends on the sample rate and on the device.
 * `exhand advise gains --rule` finds it by simulation and prints a rule inside it: the largest k as
 * a piecewise linear function of b, at one rate. This module checks a pair against the rule with
 * two exact products per segment. It needs no division, rounding or float. A rule holds for its
 * rate, device and finger only.
 *
 *   int err = exh_gains_setup(&rule, (struct exh_period){1, 2000});
 *   if (err == 0 && !exh_gains_ok(&rule, k_Npm_q10, b_Nspm_q20)) { err = -EXH_E_GAINS; } */
#ifndef EXHAND_GAINS_H
#define EXHAND_GAINS_H

#include "exhand/params.h"
#include "exhand/signal.h"
#include "exhand/units.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define EXH_GAINS_KNOTS 8 /* most knots of a rule */

/* The rule; rows in exh_gains_rows[], all set-up values. Ignored from element knots on. */
struct exh_gains_par {
    int32_t rate_Hz_q8;                  /* loop rate of the rule, Hz, 1 .. 20000 */
    int32_t knots;                       /* number of knots, 2 .. EXH_GAINS_KNOTS */
    int32_t k_min_Npm_q10;               /* smallest allowed k, N/m, 0 .. 10^6 */
    int32_t b_Nspm_q20[EXH_GAINS_KNOTS]; /* b at the knots, Ns/m, 0 .. 1000, strictly rising */
    int32_t k_Npm_q10[EXH_GAINS_KNOTS];  /* largest k at each knot, N/m, 0 .. 10^6 */
};
#define EXH_GAINS_ROWS (3 + 2 * EXH_GAINS_KNOTS)
extern const struct exh_signal exh_gains_rows[EXH_GAINS_ROWS];

/* Checks the rule for this period. -EXH_E_RANGE: a value outside its row, or a knot below k_min
 * between two that are not, which would split the region. -EXH_E_MONOTONE: b does not rise.
 * -EXH_E_RATE: the rate of T differs from the rule's by more than 1 %. */
int exh_gains_setup(const struct exh_gains_par *rule, struct exh_period T);

/* Converts the rule to another rate. k and k_min scale with the rate. b scales only if the new rate
 * is lower, since one count's share of the damper force grows with the rate. Divides; rounds each
 * value and saturates it at the end of its row. The result is a guess until `exhand advise gains`
 * has checked it. Accepts any T that exh_period_ok(); other errors as exh_gains_setup(). */
int exh_gains_scale(struct exh_gains_par *rule, struct exh_period T);

/* The largest allowed k at this b, N/m, q10; 0 if none is allowed. Set-up only: 31 checks. */
int32_t exh_gains_k_max(const struct exh_gains_par *rule, int32_t b_Nspm_q20);

/* 1 if the rule allows k and b, else 0; any int32_t. k = b = 0, no wall, is always allowed.
 * Otherwise k_min <= k, and k is on or below the line between the two knots around b. Nothing is
 * allowed before the first knot or beyond the last. Exact: products stay below 2^62. Requires a
 * rule that exh_gains_setup() accepted. */
int exh_gains_ok(const struct exh_gains_par *rule, int32_t k_Npm_q10, int32_t b_Nspm_q20);

/* Replaces exh_params_stage() in a scene with a rule. It stages k or b only if the rule allows it
 * together with the staged value of the other; otherwise it returns -EXH_E_GAINS. So stage b before
 * k when both rise, k before b when both fall. The rows are those of the materials, or of the
 * contact in a scene without materials. Other values are staged as by exh_params_stage(). */
int exh_gains_stage(struct exh_params *p, const struct exh_gains_par *rule, uint16_t id,
    uint16_t instance, int32_t raw);

/* The same by index of the value, for any source (exh_params_stage_by()). */
int exh_gains_stage_by(struct exh_params *p, const struct exh_gains_par *rule,
    struct exh_authority who, uint32_t i, int32_t raw);

/* Checks all staged pairs, after exh_params_load() and before exh_params_apply(). Returns 0, or
 * -EXH_E_GAINS and the first bad instance in *instance; instance may be NULL. After an error, do
 * not apply: call exh_params_discard(), which restores the active values. These obey the rule, even
 * in transit, where exh_gains_step() moves them. */
int exh_gains_validate(
    const struct exh_params *p, const struct exh_gains_par *rule, uint16_t *instance);

/* At set-up. on = 1: while locked, only exh_gains_step() moves k and b; without that call they do
 * not change. on = 0: k and b move as all slewed values. */
void exh_gains_enable(struct exh_params *p, int on);

/* Moves k and b of every instance one step of 2^-shift towards the staged pair; call it after
 * exh_params_apply() and before the tick. The active pair always obeys the rule.
 *
 * The pair moves on the straight line if the rule allows all of it. Otherwise k falls to the lowest
 * knot in between, then b moves, then k rises. Each phase takes at most the steps of
 * exh_params_slew_step(). If k = b = 0 lies apart from the region (k_min > 0, or b > 0 at the first
 * knot), one jump connects it with k_min. shift 0: in one step.
 *
 * Staged pairs outside the rule are ignored. An active pair outside it, from a damaged keyframe,
 * becomes 0 in one tick. If exh_params_apply() left nothing to move, this function moves nothing: a
 * difference is then damage, and exh_params_verify() reports it. */
void exh_gains_step(struct exh_params *p, const struct exh_gains_par *rule);

#ifdef __cplusplus
}
#endif
#endif
