/* SPDX-License-Identifier: MIT */
/* Tests a rule where no fall has been computed: between its rows, below its line, and along its
 * other edges. */
#include "advise/gains.h"

#include "posix.h"
#include "sim/ln.h"

#define PASSES 40   /* far more than any device took */
#define LESS   0.99 /* of a k that does not hold: a row's new end */
#define ABOUT  0.95 /* of a k that holds: a line that a cut elsewhere moved a little */
#define MORE   1.19 /* of a least k that does not hold: its new begin */
#define STEEP  0.7  /* of a line's way, of k by e */
#define NEAR   0.8  /* of the line's k: what is far below holds more easily */

#define LATE 0.25 /* of all b: what a rule holds there is near its end, however weak the wall */

/* Pairs, from the first of each kind on. Every second one of LINE is on the line, the others are
 * near it. */
enum { LINE = 0, LAST_B = 112, LEAST_K = 144, PAIRS = 154 };

struct pair {
    double b, k; /* that was proved last */
};

/* Any few of them are spread: over one axis, or over two. */
static double spread(int i, double step)
{
    const double u = i * step;
    return u - (double)(int)u;
}
#define ONE   0.61803398874989485 /* x^2 + x = 1 */
#define TWO_X 0.75487766624669276 /* 1 / x, 1 / x^2 of x^3 = x + 1 */
#define TWO_Y 0.56984029099805327

/* A line's way, from knot to knot: the share of all b that it takes, and how far k falls or rises.
 * What does not hold lies in thin stripes, which a steep line crosses. */
static double way(const struct exh_gains_par *rule, int knot)
{
    const int32_t *b = rule->b_Nspm_q20, *k = rule->k_Npm_q10;
    const double all = (double)b[rule->knots - 1] - b[0];
    const double turns = sim_ln(((double)k[knot + 1] + 1) / ((double)k[knot] + 1));
    return ((double)b[knot + 1] - b[knot]) / all + STEEP * (turns < 0 ? -turns : turns);
}

/* At this share of a line's way. */
static double b_of(const struct exh_gains_par *rule, double u)
{
    double all = 0, to = 0;
    int knot = 0;
    for (int i = 0; i + 1 < rule->knots; i++) { all += way(rule, i); }
    for (; knot + 2 < rule->knots && to + way(rule, knot) < u * all; knot++) {
        to += way(rule, knot);
    }
    const double from = (double)rule->b_Nspm_q20[knot] / 1048576;
    const double end = (double)rule->b_Nspm_q20[knot + 1] / 1048576;
    return from + (end - from) * (u * all - to) / way(rule, knot);
}

/* Whether a rule leaves out weak walls that some row has: then its least k is an edge as well. */
static int leaves_weak(const struct gains_rate *x)
{
    const double least = (double)x->rule.k_min_Npm_q10 / 1024;
    int rows = 0;
    for (int j = 0; j <= REGION_ROWS; j++) {
        const double low = x->region.row[j].low_Npm;
        rows += low > 0 && 4 * low < least;
    }
    return rows > 0;
}

/* What pair i asks of this rule. Those of LINE stay at the b that the first rule gave them: many
 * are not moved by a cut elsewhere. */
static struct pair asked(const struct exh_gains_par *first, const struct exh_gains_par *rule, int i)
{
    const double least = (double)rule->k_min_Npm_q10 / 1024;
    struct pair p;
    if (i < LAST_B) {
        p.b = b_of(first, (i + 0.5) / LAST_B);
        p.k = (i % 2 ? NEAR + (1 - NEAR) * spread(i, ONE) : 1) * gains_k_max(rule, p.b);
    } else if (i < LEAST_K) {
        const double b0 = (double)rule->b_Nspm_q20[0] / 1048576, u = spread(i, TWO_X);
        p.b = (double)rule->b_Nspm_q20[rule->knots - 1] / 1048576;
        p.b -= LATE * u * u * (p.b - b0); /* more of them at the end */
        p.k = least + spread(i, TWO_Y) * (gains_k_max(rule, p.b) - least);
    } else {
        p.b = b_of(rule, (i - LEAST_K + 0.5) / (PAIRS - LEAST_K));
        p.k = least;
    }
    return p;
}

/* Both rows beside b end below k. */
static void cut(struct region *r, double k, double b)
{
    for (int j = 0; j <= REGION_ROWS; j++) {
        struct region_row *row = &r->row[j];
        const int left = j < REGION_ROWS && row[1].b_Nspm < b;
        const int right = j > 0 && row[-1].b_Nspm > b;
        if (left || right || row->high_Npm <= k) { continue; }
        row->high_Npm = k > row->low_Npm ? k : 0;
    }
}

/* Both rows beside b begin above k. */
static void raise_least(struct region *r, double k, double b)
{
    const double step = r->row[1].b_Nspm - r->row[0].b_Nspm;
    for (int j = 0; j <= REGION_ROWS; j++) {
        struct region_row *row = &r->row[j];
        const int beside = row->b_Nspm > b - step && row->b_Nspm < b + step;
        if (beside && row->low_Npm > 0 && row->low_Npm <= k) { row->low_Npm = MORE * k; }
        if (row->low_Npm >= row->high_Npm) { row->low_Npm = row->high_Npm = 0; }
    }
}

/* Number of pairs that do not hold. A pair that was proved is not tried again, nor one whose k is
 * at least `share` of it. What is farther below is: an island may be there. */
static int pass(
    struct gains_rate *x, const struct exh_gains_par *first, struct pair *proved, double share)
{
    const int pairs = leaves_weak(x) ? PAIRS : LEAST_K;
    int failed = 0;
    for (int i = 0; i < pairs && !posix_interrupted(); i++) {
        const struct pair p = asked(first, &x->rule, i);
        const int done = p.b == proved[i].b && p.k <= proved[i].k && p.k >= share * proved[i].k;
        if (done || !gains_allows(&x->rule, p.k, p.b)) { continue; }
        if (region_holds(&x->region.o, p.k, p.b, REGION_ROWS + 1 + i)) {
            proved[i] = p;
        } else if (i >= LEAST_K) {
            raise_least(&x->region, p.k, p.b);
            failed++;
        } else {
            cut(&x->region, LESS * p.k, p.b);
            failed++;
        }
    }
    return failed;
}

int gains_proved(struct gains_rate *x)
{
    struct exh_gains_par first;
    struct pair proved[PAIRS];
    int err = gains_rule(&x->rule, &x->region), failed = 1;
    first = x->rule;
    for (int i = 0; i < PAIRS; i++) { proved[i].b = -1; }
    for (int n = 0; n < PASSES && err == 0 && failed && !posix_interrupted(); n++) {
        failed = pass(x, &first, proved, ABOUT);
        if (!failed) { failed = pass(x, &first, proved, 1); }
        if (failed) { err = gains_rule(&x->rule, &x->region); }
    }
    if (err == 0 && x->region.o.inwards > 0) { gains_rule_inwards(&x->rule, x->region.o.inwards); }
    return err;
}
