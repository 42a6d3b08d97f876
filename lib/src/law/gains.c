/* SPDX-License-Identifier: MIT */
/* Rule for stiffness and damping: staging checks it, and slewed steps obey it. */
#include "exhand/gains.h"

#include "exhand/contact.h"
#include "exhand/error.h"
#include "exhand/fix.h"
#include "exhand/precontact.h"

#include <stddef.h>

#define RATE_Q8(rate_Hz) (INT32_C(1) * (rate_Hz)*256)

#define KNOT_B(i) \
    { \
        0x1210 + (i), EXH_Q_B, EXH_WHEN_SETUP, 0, EXH_B_MAX_NSPM_Q20, 0, "rule_b" #i, "ns_per_m", \
            "damping of a knot" \
    }
#define KNOT_K(i) \
    { \
        0x1220 + (i), EXH_Q_K, EXH_WHEN_SETUP, 0, EXH_K_MAX_NPM_Q10, 0, "rule_k" #i, "n_per_m", \
            "largest stiffness at it" \
    }

const struct exh_signal exh_gains_rows[EXH_GAINS_ROWS] = {
    {0x1201, 8, EXH_WHEN_SETUP, RATE_Q8(1), RATE_Q8(20000), RATE_Q8(2000), "rule_rate", "hz",
        "the loop rate that the rule of gains is for"},
    {0x1202, 0, EXH_WHEN_SETUP, 2, EXH_GAINS_KNOTS, 2, "rule_n", "", "knots of the rule of gains"},
    {0x1203, EXH_Q_K, EXH_WHEN_SETUP, 0, EXH_K_MAX_NPM_Q10, 0, "rule_k_min", "n_per_m",
        "smallest stiffness inside"},
    KNOT_B(0),
    KNOT_B(1),
    KNOT_B(2),
    KNOT_B(3),
    KNOT_B(4),
    KNOT_B(5),
    KNOT_B(6),
    KNOT_B(7),
    KNOT_K(0),
    KNOT_K(1),
    KNOT_K(2),
    KNOT_K(3),
    KNOT_K(4),
    KNOT_K(5),
    KNOT_K(6),
    KNOT_K(7),
};

/* |rate of T - rate| <= 1 % of rate: |256 den - num rate| * 100 <= num rate. Below 2^57. */
static int same_rate(int32_t rate_Hz_q8, struct exh_period T)
{
    const int64_t want = (int64_t)T.num * rate_Hz_q8;
    const int64_t off = (int64_t)T.den * 256 - want;
    return (off < 0 ? -off : off) * 100 <= want;
}

/* Checks that the allowed region is connected, apart from "no wall": k_min is not above an inner
 * knot between two higher ones. */
static int hangs_together(const struct exh_gains_par *rule)
{
    int ends = 0; /* ends of runs of knots at k_min or above */
    for (int32_t i = 1; i <= rule->knots; i++) {
        const int last = i == rule->knots || rule->k_Npm_q10[i] < rule->k_min_Npm_q10;
        ends += last && rule->k_Npm_q10[i - 1] >= rule->k_min_Npm_q10;
    }
    return ends <= 1;
}

int exh_gains_setup(const struct exh_gains_par *rule, struct exh_period T)
{
    if (!exh_inside(rule->rate_Hz_q8, RATE_Q8(1), RATE_Q8(20000)) ||
        !exh_inside(rule->knots, 2, EXH_GAINS_KNOTS) ||
        !exh_inside(rule->k_min_Npm_q10, 0, EXH_K_MAX_NPM_Q10)) {
        return -EXH_E_RANGE;
    }
    for (int32_t i = 0; i < rule->knots; i++) {
        if (!exh_inside(rule->b_Nspm_q20[i], 0, EXH_B_MAX_NSPM_Q20) ||
            !exh_inside(rule->k_Npm_q10[i], 0, EXH_K_MAX_NPM_Q10)) {
            return -EXH_E_RANGE;
        }
        if (i > 0 && rule->b_Nspm_q20[i] <= rule->b_Nspm_q20[i - 1]) { return -EXH_E_MONOTONE; }
    }
    if (!hangs_together(rule)) { return -EXH_E_RANGE; }
    return exh_period_ok(T) && same_rate(rule->rate_Hz_q8, T) ? 0 : -EXH_E_RATE;
}

int exh_gains_scale(struct exh_gains_par *rule, struct exh_period T)
{
    struct exh_gain by;
    const int err = exh_gains_setup(rule, (struct exh_period){256, (uint32_t)rule->rate_Hz_q8});
    if (err < 0) { return err; }
    if (!exh_period_ok(T) || exh_gain_set(&by, (uint64_t)T.den * 256,
                                 (uint64_t)T.num * (uint32_t)rule->rate_Hz_q8) < 0) {
        return -EXH_E_RATE;
    }
    rule->k_min_Npm_q10 = exh_clamp(exh_gain_mul(by, rule->k_min_Npm_q10), 0, EXH_K_MAX_NPM_Q10);
    for (int32_t i = 0; i < rule->knots; i++) {
        const int64_t b = exh_gain_mul(by, rule->b_Nspm_q20[i]);
        rule->k_Npm_q10[i] = exh_clamp(exh_gain_mul(by, rule->k_Npm_q10[i]), 0, EXH_K_MAX_NPM_Q10);
        if (b < rule->b_Nspm_q20[i]) { rule->b_Nspm_q20[i] = (int32_t)b; }
    }
    rule->rate_Hz_q8 = exh_clamp(exh_gain_mul(by, rule->rate_Hz_q8), RATE_Q8(1), RATE_Q8(20000));
    return exh_gains_setup(rule, T);
}

/* --- inside --- */

struct pair {
    int32_t k, b; /* N/m q10, Ns/m q20 */
};

static int is_none(struct pair at) { return at.k == 0 && at.b == 0; }

/* (a - b) times (c - d) of values within 0 .. 2^30, exact. Other values wrap; they lie outside
 * anyway. */
static inline int64_t area(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return (int64_t)exh_wrap_diff(a, b) * exh_wrap_diff(c, d);
}

/* On or below the segments. "No wall" only if it lies there, too. */
static int is_under(const struct exh_gains_par *rule, struct pair at)
{
    int under = 0;
    for (int32_t i = 1; i < rule->knots; i++) {
        const int32_t b0 = rule->b_Nspm_q20[i - 1], b1 = rule->b_Nspm_q20[i];
        const int32_t k0 = rule->k_Npm_q10[i - 1], k1 = rule->k_Npm_q10[i];
        under |= at.b >= b0 && at.b <= b1 && area(at.k, k0, b1, b0) <= area(k1, k0, at.b, b0);
    }
    return under && at.k >= rule->k_min_Npm_q10;
}

int exh_gains_ok(const struct exh_gains_par *rule, int32_t k_Npm_q10, int32_t b_Nspm_q20)
{
    const struct pair at = {k_Npm_q10, b_Nspm_q20};
    return is_under(rule, at) || is_none(at);
}

int32_t exh_gains_k_max(const struct exh_gains_par *rule, int32_t b_Nspm_q20)
{
    struct pair at = {rule->k_min_Npm_q10, b_Nspm_q20};
    if (!is_under(rule, at)) { return 0; }
    for (int32_t more = INT32_C(1) << 30; more > 0; more >>= 1) {
        const struct pair up = {at.k > EXH_K_MAX_NPM_Q10 - more ? at.k : at.k + more, at.b};
        if (is_under(rule, up)) { at = up; }
    }
    return at.k;
}

/* --- staged --- */

/* A scene with materials does not use the contact's rows. The row of b follows. */
static uint16_t k_id(const struct exh_params *p)
{
    const int has = exh_signal_find(p->table, EXH_MATERIAL_K_ID, 0) >= 0;
    return has ? EXH_MATERIAL_K_ID : EXH_CONTACT_K_ID;
}

/* Checks k and b of an instance; an instance without them has no wall. */
static int pair_ok(const struct exh_params *p, const struct exh_gains_par *rule, uint16_t instance)
{
    const uint16_t id = k_id(p);
    const int32_t k = exh_signal_find(p->table, id, instance);
    const int32_t b = exh_signal_find(p->table, id + 1, instance);
    return k < 0 || b < 0 || exh_gains_ok(rule, p->staged[k], p->staged[b]);
}

int exh_gains_stage_by(struct exh_params *p, const struct exh_gains_par *rule,
    struct exh_authority who, uint32_t i, int32_t raw)
{
    uint16_t instance = 0;
    const struct exh_signal *row = exh_signal_at(p->table, i, &instance);
    const int32_t was = row != NULL ? p->staged[i] : 0;
    const uint8_t pending = p->pending, by = p->by;
    const int err = exh_params_stage_by(p, who, i, raw);
    if (err < 0 || (row->id != k_id(p) && row->id != k_id(p) + 1) || pair_ok(p, rule, instance)) {
        return err;
    }
    (void)exh_params_stage_at(p, i, was);
    p->pending = pending;
    p->by = by;
    return -EXH_E_GAINS;
}

int exh_gains_stage(struct exh_params *p, const struct exh_gains_par *rule, uint16_t id,
    uint16_t instance, int32_t raw)
{
    const struct exh_authority person = {EXH_FROM_PERSON, 1, 1};
    const int32_t i = exh_signal_find(p->table, id, instance);
    return i < 0 ? (int)i : exh_gains_stage_by(p, rule, person, (uint32_t)i, raw);
}

int exh_gains_validate(
    const struct exh_params *p, const struct exh_gains_par *rule, uint16_t *instance)
{
    for (uint16_t n = 0; exh_signal_find(p->table, k_id(p), n) >= 0; n++) {
        if (!pair_ok(p, rule, n)) {
            if (instance != NULL) { *instance = n; }
            return -EXH_E_GAINS;
        }
    }
    return 0;
}

/* --- one step of the way --- */

void exh_gains_enable(struct exh_params *p, int on)
{
    p->led[0] = on ? EXH_CONTACT_K_ID : 0;
    p->led[1] = on ? EXH_CONTACT_B_ID : 0;
}

/* The k to move to: the goal's, if no knot between lies below the straight line. Otherwise the
 * highest k that passes below all of them. Both pairs obey the rule. */
static int32_t aim(const struct exh_gains_par *rule, struct pair at, struct pair goal)
{
    int32_t low = at.k;
    int straight = 1;
    for (int32_t i = 0; i < rule->knots; i++) {
        const int32_t b = rule->b_Nspm_q20[i], k = rule->k_Npm_q10[i];
        const int64_t line = area(goal.k, at.k, b, at.b); /* line above at, times b's distance */
        const int64_t knot = area(k, at.k, goal.b, at.b);
        if (at.b < goal.b ? b <= at.b || b >= goal.b : b >= at.b || b <= goal.b) { continue; }
        straight &= at.b < goal.b ? line <= knot : line >= knot;
        low = k < low ? k : low;
    }
    return straight ? goal.k : low;
}

/* One step from an allowed pair to an allowed pair. k falls alone, since a lower stiffness is
 * allowed. b moves alone where k rises, since the line there is above k. */
static struct pair slewed(
    const struct exh_gains_par *rule, struct pair at, struct pair goal, unsigned shift)
{
    struct pair next;
    next.k = exh_params_slew_step(at.k, aim(rule, at, goal), shift);
    next.b = exh_params_slew_step(at.b, goal.b, shift);
    if (is_under(rule, next)) { return next; }
    if (next.k < at.k) {
        next.b = at.b;
    } else {
        next.k = at.k;
    }
    return next;
}

static struct pair stepped(
    const struct exh_gains_par *rule, struct pair at, struct pair goal, unsigned shift)
{
    static const struct pair none = {0, 0};
    const int under = is_under(rule, at), goal_under = is_under(rule, goal);
    if (!goal_under && !is_none(goal)) { return under ? at : none; }
    if (shift == 0) { return goal; }
    if (under && goal_under) { return slewed(rule, at, goal, shift); }
    if (under) { /* "no wall" is separate */
        if (at.k <= rule->k_min_Npm_q10) { return none; }
        at.k = exh_params_slew_step(at.k, rule->k_min_Npm_q10, shift);
        return at;
    }
    if (!goal_under || !is_none(at)) { return none; }
    goal.k = rule->k_min_Npm_q10;
    return goal;
}

/* While nothing moves, staged and active values are equal or damaged. Then change nothing, so that
 * the guard reports the damage. */
void exh_gains_step(struct exh_params *p, const struct exh_gains_par *rule)
{
    const int moves = p->moving;
    int32_t k;
    for (uint16_t n = 0; (k = exh_signal_find(p->table, EXH_CONTACT_K_ID, n)) >= 0; n++) {
        const int32_t b = exh_signal_find(p->table, EXH_CONTACT_B_ID, n);
        const struct pair none = {0, 0};
        struct pair at, next;
        if (b < 0) { continue; }
        at = (struct pair){p->active[k], p->active[b]};
        if (moves) {
            next = stepped(rule, at, (struct pair){p->staged[k], p->staged[b]}, p->shift & 31u);
        } else if (exh_gains_ok(rule, at.k, at.b)) {
            continue;
        } else {
            next = none;
        }
        exh_params_set_active(p, (uint32_t)k, next.k);
        exh_params_set_active(p, (uint32_t)b, next.b);
    }
}
