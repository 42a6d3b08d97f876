/* SPDX-License-Identifier: MIT */
#include "advise/gains.h"

#include "base/option.h"

#include <string.h>

#define LEVELS 12   /* heights of a knot that are tried: down to 1 - LEVEL * LEVELS */
#define LEVEL  0.04 /* of what is allowed there */
#define MARGIN 1.0  /* N/m, more than any rounding of a knot moves the line */

/* Nodes 0..last of the rows: the largest k allowed on both sides of each. */
struct profile {
    double k[REGION_MAX + 1], b[REGION_MAX + 1];
    int last;
};

/* How far row j is allowed from column i0 up, N/m; 0: not at all. */
static double row_top(struct region *r, int i0, int j)
{
    int i = i0;
    while (region_piece(r, i, j)) { i++; }
    return i > i0 ? region_k(r, i) : 0;
}

static void profile_of(struct profile *p, struct region *r, int i0)
{
    double below = row_top(r, i0, 0);
    memset(p, 0, sizeof *p);
    p->last = -1;
    for (int j = 0; j <= r->o.rows && below > 0; j++) {
        const double above = j < r->o.rows ? row_top(r, i0, j) : 0;
        const double least = above > 0 && above < below ? above : below;
        p->b[j] = region_b(r, j);
        p->k[j] = least > MARGIN ? least - MARGIN : 0;
        p->last = j;
        below = above;
    }
}

/* --- the knots: of all lines through a few heights at each node, those of the largest area --- */

struct best {
    double area;
    int j, level; /* where it comes from */
};

static struct best best[EXH_GAINS_KNOTS][REGION_MAX + 1][LEVELS];

static double height(const struct profile *p, int j, int level)
{
    return p->k[j] * (1 - LEVEL * level);
}

/* Whether the line between two knots stays on or below the profile. */
static int below(const struct profile *p, int j0, double k0, int j1, double k1)
{
    for (int j = j0 + 1; j < j1; j++) {
        if (k0 + (k1 - k0) * (p->b[j] - p->b[j0]) / (p->b[j1] - p->b[j0]) > p->k[j]) { return 0; }
    }
    return 1;
}

static void extend(const struct profile *p, int n, int j0, int l0)
{
    const double k0 = height(p, j0, l0), area = best[n - 1][j0][l0].area;
    if (area < 0) { return; }
    for (int j = j0 + 1; j <= p->last; j++) {
        for (int l = 0; l < LEVELS; l++) {
            const double k = height(p, j, l), more = (k0 + k) / 2 * (p->b[j] - p->b[j0]);
            if (area + more <= best[n][j][l].area || !below(p, j0, k0, j, k)) { continue; }
            best[n][j][l] = (struct best){area + more, j0, l0};
        }
    }
}

static double search(const struct profile *p, int *knots, int *end, int *level)
{
    double most = -1;
    memset(best, 0, sizeof best);
    for (int n = 0; n < EXH_GAINS_KNOTS; n++) {
        for (int j = 0; j <= p->last; j++) {
            for (int l = 0; l < LEVELS; l++) { best[n][j][l].area = n == 0 && j == 0 ? 0 : -1; }
        }
        for (int j = 0; n > 0 && j < p->last; j++) {
            for (int l = 0; l < LEVELS; l++) { extend(p, n, j, l); }
        }
        for (int j = 1; j <= p->last; j++) {
            for (int l = 0; l < LEVELS; l++) {
                if (best[n][j][l].area <= most * 1.005) {
                    continue;
                } /* a knot has to be worth it */
                most = best[n][j][l].area;
                *knots = n + 1;
                *end = j;
                *level = l;
            }
        }
    }
    return most;
}

/* --- in the library's formats --- */

static int32_t down(double v, int frac) { return (int32_t)(v * (double)(INT32_C(1) << frac)); }

static void take(struct exh_gains_par *rule, const struct profile *p, int knots, int j, int level)
{
    rule->knots = knots;
    for (int n = knots - 1; n >= 0; n--) {
        const struct best from = best[n][j][level];
        rule->b_Nspm_q20[n] = down(p->b[j], EXH_Q_B) - (n == knots - 1); /* not on the last edge */
        rule->k_Npm_q10[n] = down(height(p, j, level), EXH_Q_K);
        j = from.j;
        level = from.level;
    }
}

int gains_rule(struct exh_gains_par *rule, struct region *r)
{
    const int starts = r->o.columns / 8 + 1;
    double most = 0;
    memset(rule, 0, sizeof *rule);
    rule->rate_Hz_q8 = (int32_t)(256 / r->o.wall.T_s + 0.5);
    for (int i0 = 0; i0 < starts; i0++) {
        struct profile p;
        int knots = 0, end = 0, level = 0;
        double area;
        profile_of(&p, r, i0);
        if (p.last < 1) { continue; }
        area = search(&p, &knots, &end, &level) - region_k(r, i0) * p.b[end];
        if (area <= most * 1.01) { continue; } /* nor is a least k without its worth */
        most = area;
        rule->k_min_Npm_q10 = down(region_k(r, i0), EXH_Q_K) + 1;
        take(rule, &p, knots, end, level);
    }
    if (most > 0) { return 0; }
    cli_complain("%.6g Hz: too little is allowed for a rule: a finer --grid", 1 / r->o.wall.T_s);
    return 1;
}

static double si(int32_t raw, int frac) { return (double)raw / (double)(INT32_C(1) << frac); }

void gains_rule_print(FILE *f, const struct exh_gains_par *rule)
{
    fprintf(f, "--set rule_on=1 --set rule_rate=%.10g --set rule_n=%ld --set rule_k_min=%.10g",
        si(rule->rate_Hz_q8, 8), (long)rule->knots, si(rule->k_min_Npm_q10, EXH_Q_K));
    for (int i = 0; i < rule->knots; i++) {
        fprintf(f, " --set rule_b%d=%.10g --set rule_k%d=%.10g", i,
            si(rule->b_Nspm_q20[i], EXH_Q_B), i, si(rule->k_Npm_q10[i], EXH_Q_K));
    }
    fprintf(f, "\n{%ld, %ld, %ld, {", (long)rule->rate_Hz_q8, (long)rule->knots,
        (long)rule->k_min_Npm_q10);
    for (int i = 0; i < EXH_GAINS_KNOTS; i++) {
        fprintf(f, "%s%ld", i ? ", " : "", (long)rule->b_Nspm_q20[i]);
    }
    fprintf(f, "}, {");
    for (int i = 0; i < EXH_GAINS_KNOTS; i++) {
        fprintf(f, "%s%ld", i ? ", " : "", (long)rule->k_Npm_q10[i]);
    }
    fprintf(f, "}}, /* %.6g Hz */\n", si(rule->rate_Hz_q8, 8));
}
