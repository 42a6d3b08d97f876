/* SPDX-License-Identifier: MIT */
#include "advise/gains.h"

#include "base/option.h"

#include <string.h>

#define LEVELS 12   /* heights of a knot that are tried: down to 1 - LEVEL * LEVELS */
#define LEVEL  0.02 /* of what is allowed there */
#define MARGIN 1.0  /* N/m, more than any rounding of a knot moves the line */
#define BROAD  5    /* rows next to each other: no luck with their cases */
#define WORTH  1.1  /* of the area without it, for a second hill */

/* Rows next to each other, from the first with an end. */
struct profile {
    double k[REGION_ROWS + 1], b[REGION_ROWS + 1], low_Npm;
    int last;
};

/* Cuts a row that extends farther than both neighbours, since no falls were computed between
 * rows. */
static void cut_spikes(struct profile *p)
{
    double before = p->k[0];
    for (int j = 1; j < p->last; j++) {
        const double most = before > p->k[j + 1] ? before : p->k[j + 1];
        before = p->k[j];
        if (p->k[j] > most) { p->k[j] = most; }
    }
}

static double lower(double a, double b) { return a < b ? a : b; }

/* From the stiffest row on k only falls, both ways: what fails at some b is not believed to hold
 * again at more. */
static void one_peak(struct profile *p)
{
    int top = 0;
    for (int j = 0; j <= p->last; j++) { top = p->k[j] > p->k[top] ? j : top; }
    for (int j = top + 1; j <= p->last; j++) { p->k[j] = lower(p->k[j], p->k[j - 1]); }
    for (int j = top - 1; j >= 0; j--) { p->k[j] = lower(p->k[j], p->k[j + 1]); }
}

static double least(const struct profile *p, int from, int rows)
{
    double k = p->k[from];
    for (int j = from + 1; j < from + rows; j++) { k = lower(k, p->k[j]); }
    return k;
}

/* Beside the first hill, as far as each row is one of BROAD that all hold. */
static void hills(struct profile *p)
{
    struct profile first = *p, broad = *p;
    one_peak(&first);
    memset(broad.k, 0, sizeof broad.k);
    for (int from = 0; from + BROAD <= p->last + 1; from++) {
        const double k = least(p, from, BROAD);
        for (int j = from; j < from + BROAD; j++) { broad.k[j] = broad.k[j] > k ? broad.k[j] : k; }
    }
    for (int j = 0; j <= p->last; j++) {
        p->k[j] = first.k[j] > broad.k[j] ? first.k[j] : broad.k[j];
    }
}

/* A row that had luck with its cases ends no farther than those beside it let expect. */
static void smooth(struct profile *p)
{
    double before = p->k[0];
    for (int j = 1; j < p->last; j++) {
        const double mean = (before + p->k[j] + p->k[j + 1]) / 3;
        before = p->k[j];
        p->k[j] = lower(p->k[j], mean);
    }
}

/* With all k from low_Npm on. */
static void profile_of(struct profile *p, const struct region *r, double low_Npm, int more)
{
    memset(p, 0, sizeof *p);
    p->low_Npm = low_Npm;
    p->last = -1;
    for (int j = 0; j <= REGION_ROWS; j++) {
        const struct region_row *row = &r->row[j];
        const double k = row->high_Npm - MARGIN;
        const int has = row->high_Npm > 0 && row->low_Npm <= low_Npm && k > low_Npm;
        if (!has && p->last >= 0) { break; }
        if (!has) { continue; }
        p->last++;
        p->b[p->last] = row->b_Nspm;
        p->k[p->last] = k;
    }
    cut_spikes(p);
    if (more) {
        hills(p);
    } else {
        one_peak(p);
    }
    smooth(p);
}

/* --- the knots: of all lines through a few heights at each node, those of the largest area --- */

struct best {
    double area;
    int j, level; /* where it comes from */
};

static struct best best[EXH_GAINS_KNOTS][REGION_ROWS + 1][LEVELS];

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
    if (area < 0 || k0 <= p->low_Npm) { return; }
    for (int j = j0 + 1; j <= p->last; j++) {
        for (int l = 0; l < LEVELS; l++) {
            const double k = height(p, j, l), more = (k0 + k) / 2 * (p->b[j] - p->b[j0]);
            if (k <= p->low_Npm) { break; }
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
static double si(int32_t raw, int frac) { return (double)raw / (double)(INT32_C(1) << frac); }

static void take(struct exh_gains_par *rule, const struct profile *p, int knots, int j, int level)
{
    rule->knots = knots;
    for (int n = knots - 1; n >= 0; n--) {
        const struct best from = best[n][j][level];
        const int inwards = n == knots - 1 ? -1 : n == 0 && p->b[0] > 0; /* not on an edge */
        rule->b_Nspm_q20[n] = down(p->b[j], EXH_Q_B) + inwards;
        rule->k_Npm_q10[n] = down(height(p, j, level), EXH_Q_K);
        j = from.j;
        level = from.level;
    }
}

/* With all k from this row's least on, where that is worth more than `most`. */
static double from_row(
    struct exh_gains_par *rule, const struct region *r, int row, int more, double most)
{
    const double low = r->row[row].low_Npm;
    int knots = 0, end = 0, level = 0;
    struct profile p;
    double area;
    for (int j = 0; j < row; j++) {
        if (r->row[j].low_Npm == low) { return 0; } /* done */
    }
    if (r->row[row].high_Npm <= 0) { return 0; }
    profile_of(&p, r, low, more);
    if (p.last < 1) { return 0; }
    area = search(&p, &knots, &end, &level) - low * (p.b[end] - p.b[0]);
    if (area <= most) { return 0; }
    rule->k_min_Npm_q10 = down(low, EXH_Q_K) + 1;
    take(rule, &p, knots, end, level);
    return area;
}

int gains_rule(struct exh_gains_par *rule, const struct region *r)
{
    double most = 0;
    memset(rule, 0, sizeof *rule);
    rule->rate_Hz_q8 = (int32_t)(256 / r->o.wall.T_s + 0.5);
    for (int more = 0; more < 2; more++) {
        double least = (more ? WORTH : 1) * most;
        for (int i = 0; i <= REGION_ROWS; i++) {
            const double area = from_row(rule, r, i, more, least);
            if (area > 0) { least = 1.01 * (most = area); } /* a larger least k, too */
        }
    }
    if (most > 0) { return 0; }
    cli_complain("%.6g Hz: too little is allowed for a rule", 1 / r->o.wall.T_s);
    return 1;
}

/* --- and inside of it --- */

/* The right end of each piece falls until the line is on or below each knot of the other. */
static void keep_below(double *k, const double *b, int knots, const double *k0, const double *b0)
{
    for (int n = 0; n + 1 < knots; n++) {
        for (int i = 0; i < knots; i++) {
            const double t = (b0[i] - b[n]) / (b[n + 1] - b[n]);
            if (!(t > 0 && t < 1)) { continue; }
            k[n + 1] = lower(k[n + 1], (k0[i] - k[n] * (1 - t)) / t);
        }
    }
}

void gains_rule_inwards(struct exh_gains_par *rule, double by)
{
    double k0[EXH_GAINS_KNOTS], b0[EXH_GAINS_KNOTS], k[EXH_GAINS_KNOTS], b[EXH_GAINS_KNOTS];
    for (int i = 0; i < rule->knots; i++) {
        b0[i] = si(rule->b_Nspm_q20[i], EXH_Q_B);
        k0[i] = (1 - by) * si(rule->k_Npm_q10[i], EXH_Q_K);
        b[i] = b0[0] + (b0[i] - b0[0]) * (1 - by); /* the first knot stays */
    }
    for (int i = 0; i < rule->knots; i++) {
        k[i] = lower(k0[i], (1 - by) * gains_k_max(rule, b[i]));
    }
    keep_below(k, b, rule->knots, k0, b0);
    for (int i = 0; i < rule->knots; i++) {
        rule->b_Nspm_q20[i] = down(b[i], EXH_Q_B);
        rule->k_Npm_q10[i] = down(k[i], EXH_Q_K);
    }
}

int gains_allows(const struct exh_gains_par *rule, double k_Npm, double b_Nspm)
{
    if (!(k_Npm >= 0 && k_Npm <= 1e6 && b_Nspm >= 0 && b_Nspm <= 1e3)) { return 0; }
    return exh_gains_ok(rule, down(k_Npm, EXH_Q_K), down(b_Nspm, EXH_Q_B));
}

double gains_k_max(const struct exh_gains_par *rule, double b_Nspm)
{
    const double k_min = si(rule->k_min_Npm_q10, EXH_Q_K);
    for (int i = 0; i + 1 < rule->knots; i++) {
        const double b0 = si(rule->b_Nspm_q20[i], EXH_Q_B);
        const double b1 = si(rule->b_Nspm_q20[i + 1], EXH_Q_B);
        const double k0 = si(rule->k_Npm_q10[i], EXH_Q_K), k1 = si(rule->k_Npm_q10[i + 1], EXH_Q_K);
        if (b_Nspm < b0 || b_Nspm > b1) { continue; }
        const double k = k0 + (k1 - k0) * (b_Nspm - b0) / (b1 - b0);
        return k >= k_min ? k : 0;
    }
    return 0;
}

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
