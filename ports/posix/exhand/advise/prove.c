/* SPDX-License-Identifier: MIT */
/* A rule is asked where nobody has looked: between the rows that made it, and below its line. */
#include "advise/gains.h"

#include "posix.h"

#define PAIRS  96
#define PASSES 40   /* far more than any device took */
#define LESS   0.99 /* of a k that does not hold: a row's new end */
#define NEAR   0.8  /* of the line's k: what is far below holds more easily */

struct pair {
    double b, share, proved_k; /* share: of the line's k */
};

/* Every second pair is on the line, the others are near it. */
static double share_of(int i)
{
    const double u = i * 0.61803398874989485, part = u - (double)(int)u;
    return i % 2 ? NEAR + (1 - NEAR) * part : 1;
}

static double b_of(const struct exh_gains_par *rule, double u)
{
    const double first = (double)rule->b_Nspm_q20[0] / 1048576;
    const double last = (double)rule->b_Nspm_q20[rule->knots - 1] / 1048576;
    return first + (last - first) * u;
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

/* Number of pairs that do not hold. A pair that was proved is not tried again; one below it is: an
 * island may be there. */
static int pass(struct gains_rate *x, struct pair *pair)
{
    int failed = 0;
    for (int i = 0; i < PAIRS && !posix_interrupted(); i++) {
        const double b = pair[i].b, k = pair[i].share * gains_k_max(&x->rule, b);
        if (!gains_allows(&x->rule, k, b) || k == pair[i].proved_k) { continue; }
        if (region_holds(&x->region.o, k, b, REGION_ROWS + 1 + i)) {
            pair[i].proved_k = k;
        } else {
            cut(&x->region, LESS * k, b);
            failed++;
        }
    }
    return failed;
}

int gains_proved(struct gains_rate *x)
{
    struct pair pair[PAIRS];
    int err = gains_rule(&x->rule, &x->region), failed = 1;
    for (int i = 0; i < PAIRS; i++) {
        pair[i].b = b_of(&x->rule, (i + 0.5) / PAIRS);
        pair[i].share = share_of(i);
        pair[i].proved_k = -1;
    }
    for (int n = 0; n < PASSES && err == 0 && failed && !posix_interrupted(); n++) {
        failed = pass(x, pair);
        if (failed) { err = gains_rule(&x->rule, &x->region); }
    }
    if (err == 0 && x->region.o.inwards > 0) { gains_rule_inwards(&x->rule, x->region.o.inwards); }
    return err;
}
