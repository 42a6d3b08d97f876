/* SPDX-License-Identifier: MIT */
#include "lab/fit/winners.h"

#include "base/jobs.h"
#include "base/option.h"
#include "lab/drop/quantile.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SEED     30001 /* of no search, test or demo */
#define RUNS_MAX 200
#define FALLS    10
#define FURTHER  3

static const double further_scale[FURTHER] = {0.7, 0.9, 1.1};

/* One row of one winner. */
struct verdict {
    int failed, lines;                        /* runs that failed; that gave a line */
    double rest, swing;                       /* shares of falls, at 1 and 1.5x */
    double median[READINGS];                  /* N/m, by every reading; 0: none */
    double low, high;                         /* 5 % and 95 % of the runs, own reading */
    double over_k[FURTHER], rest_at[FURTHER]; /* own reading, at other gains */
    double b_max;                             /* largest stable b at half the row's k */
};

struct trial {
    const struct search *s;
    int runs, further;
    int reading[READINGS], readings;
};

static struct score_plan plan_of(const struct search *s)
{
    return (struct score_plan){0, 0, 5, 5, 0, s->fixed_wall};
}

/* Of n values, share 0..1; zeros are no line. */
static double of_lines(const double *v, int n, double share)
{
    double kept[RUNS_MAX];
    int lines = 0;
    for (int i = 0; i < n; i++) {
        if (v[i] > 0) { kept[lines++] = v[i]; }
    }
    return quantile(kept, lines, n, share);
}

/* Share of falls that oscillate in `runs` runs, -1 if none ran; stiffness by all readings if S is
 * there. */
static double oscillating(const struct score_plan *plan, const struct plant_point *p, int row,
    double scale, int runs, double S[READINGS][RUNS_MAX], int *failed)
{
    const struct table2_row *t = &table2_paper[row];
    int n = 0, seen = 0;
    for (int i = 0; i < runs; i++) {
        const struct score_gains at = {
            row, t->k_Npm * scale, t->b_Nspm * scale, FALLS, SEED + (uint64_t)i};
        double soft, one[READINGS];
        struct run r;
        int k = score_run(p, plan, at, &r) < 0
                    ? -1
                    : score_oscillating(&r, score_step_m(p), plan->observe_s, 0, &soft);
        if (k >= 0 && S != NULL) {
            if (reading_all(&r.log, score_step_m(p), one) != FALL_OK) { k = -1; }
            for (int x = 0; x < READINGS; x++) { S[x][i] = one[x]; }
        }
        run_free(&r);
        if (k < 0) {
            *failed += 1;
            continue;
        }
        n += k;
        seen += FALLS;
    }
    return seen ? (double)n / seen : -1;
}

static double at_rest(double oscillate) { return oscillate < 0 ? -1 : 1 - oscillate; }

/* Largest b of the ladder up to which all rest (at least 9 of 10 falls). */
static double largest_b(const struct score_plan *plan, const struct plant_point *p, int row)
{
    static const double b[] = {
        1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50, 60, 80, 100, 120, 150, 200};
    double best = 0;
    for (size_t i = 0; i < sizeof b / sizeof b[0]; i++) {
        const struct score_gains at = {row, table2_paper[row].k_Npm / 2, b[i], FALLS, SEED};
        double soft;
        struct run r;
        const int n = score_run(p, plan, at, &r) < 0
                          ? -1
                          : score_oscillating(&r, score_step_m(p), plan->observe_s, 0, &soft);
        run_free(&r);
        if (n < 0 || n > 1) { break; }
        best = b[i];
    }
    return best;
}

static void judge(const void *ctx, int i, void *to)
{
    static double S[READINGS][RUNS_MAX], other[READINGS][RUNS_MAX];
    const struct trial *t = ctx;
    const int reading = t->reading[i / TABLE2_ROWS], row = i % TABLE2_ROWS;
    const struct plant_point *p = &search_best(t->s, reading)->p;
    const struct score_plan plan = plan_of(t->s);
    struct verdict v;
    memset(&v, 0, sizeof v);
    memset(S, 0, sizeof S);
    v.rest = at_rest(oscillating(&plan, p, row, 1, t->runs, S, &v.failed));
    v.swing = oscillating(&plan, p, row, 1.5, t->runs, NULL, &v.failed);
    for (int k = 0; k < READINGS; k++) { v.median[k] = of_lines(S[k], t->runs, 0.5); }
    v.low = of_lines(S[reading], t->runs, 0.05);
    v.high = of_lines(S[reading], t->runs, 0.95);
    for (int k = 0; k < FURTHER && t->further > 0; k++) {
        memset(other, 0, sizeof other);
        v.rest_at[k] =
            at_rest(oscillating(&plan, p, row, further_scale[k], t->further, other, &v.failed));
        v.over_k[k] = of_lines(other[reading], t->further, 0.5) /
                      (table2_paper[row].k_Npm * further_scale[k]);
    }
    if (row == 0 || row == TABLE2_ROWS - 1) { v.b_max = largest_b(&plan, p, row); }
    memcpy(to, &v, sizeof v);
}

static double off_percent(const struct verdict *v, int row, int reading)
{
    return 100 * (v->median[reading] / table2_paper[row].stiffness_Npm - 1);
}

/* A value within 2 % of its range from an end. */
static void print_bounds(FILE *f, const struct search *s, const struct plant_point *p)
{
    int n = 0;
    for (int i = 0; i < SPACE_ROWS; i++) {
        if (s->pinned[i] || space_row[i].scale == SPACE_WHOLE) { continue; }
        if (p->u[i] > 0.02 && p->u[i] < 0.98) { continue; }
        fprintf(f, "%s%s %s", n++ ? ", " : "", space_row[i].name, p->u[i] < 0.5 ? "low" : "high");
    }
    if (n == 0) { fprintf(f, "none"); }
}

/* Table and both files in one go over the readings. */
static void print(const struct trial *t, const struct verdict *v, FILE *csv, FILE *plants)
{
    printf("The best plant of each reading, by the whole experiment and %d seeds it was not fitted "
           "to\n"
           "(median of %d runs; off the paper's stiffness in %%; shares of falls in %%; b: the "
           "largest\n"
           "that rests at half the row's k, 90 and 2000 Hz, the paper's \"nearly 20 times\"; the "
           "wall lies\n"
           "%s between two encoder counts)\n\n"
           "                     off the paper, 90 .. 2000 Hz    within    at rest               "
           " oscillates at 1.5x      largest b\n"
           "  reading                                             25 10\n",
        t->runs, t->runs, t->s->fixed_wall ? "at one place" : "anywhere");
    for (int i = 0; i < t->readings; i++, v += TABLE2_ROWS) {
        const int x = t->reading[i];
        const struct plant_point *p = &search_best(t->s, x)->p;
        int in25 = 0, in10 = 0;
        printf("  %-16s", reading_table[x].name);
        for (int row = 0; row < TABLE2_ROWS; row++) {
            const double off = off_percent(&v[row], row, x);
            in25 += off >= -25 && off <= 25;
            in10 += off >= -10 && off <= 10;
            printf(" %+5.0f", off);
        }
        printf("  %2d %2d  ", in25, in10);
        for (int row = 0; row < TABLE2_ROWS; row++) { printf(" %3.0f", 100 * v[row].rest); }
        printf("  ");
        for (int row = 0; row < TABLE2_ROWS; row++) { printf(" %3.0f", 100 * v[row].swing); }
        printf("  %3.0f %3.0f\n", v[0].b_max, v[TABLE2_ROWS - 1].b_max);
        for (int row = 0; row < TABLE2_ROWS; row++) {
            const struct table2_row *paper = &table2_paper[row];
            fprintf(csv, "%s,%.9g,%.9g,%.9g,%.9g", reading_table[x].name, paper->rate_Hz,
                paper->k_Npm, paper->b_Nspm, paper->stiffness_Npm);
            fprintf(csv, ",%.9g,%.9g,%.9g,%.4f,%.4f", v[row].median[x], v[row].low, v[row].high,
                v[row].rest, v[row].swing);
            for (int k = 0; k < FURTHER; k++) {
                fprintf(csv, ",%.4f,%.4f", v[row].over_k[k], v[row].rest_at[k]);
            }
            fprintf(csv, ",%.9g", v[row].b_max);
            for (int k = 0; k < READINGS; k++) { fprintf(csv, ",%.9g", v[row].median[k]); }
            fprintf(csv, "\n");
        }
        fprintf(plants, "%s,%.6f", reading_table[x].name, search_best(t->s, x)->cost);
        for (int k = 0; k < SPACE_ROWS; k++) { fprintf(plants, ",%.9g", space_value(k, p->u[k])); }
        fprintf(plants, ",\"");
        print_bounds(plants, t->s, p);
        fprintf(plants, "\"\n");
    }
}

/* Stiffness over k at gains that are in no table: a peak at 1 says that the search tuned
 * the bounces to the six points. */
static void print_further(const struct trial *t, const struct verdict *v)
{
    printf(
        "\nStiffness over k at 0.7, 0.9, 1 and 1.1 times both gains (%d runs), 200 .. 2000 Hz\n\n",
        t->further);
    for (int i = 0; i < t->readings; i++, v += TABLE2_ROWS) {
        const int x = t->reading[i];
        printf("  %-16s", reading_table[x].name);
        for (int row = 2; row < TABLE2_ROWS; row++) {
            printf("  %5.2f %5.2f [%5.2f] %5.2f", v[row].over_k[0], v[row].over_k[1],
                v[row].median[x] / table2_paper[row].k_Npm, v[row].over_k[2]);
        }
        printf("\n");
    }
    printf("\nValues at a bound of what was searched\n\n");
    for (int i = 0; i < t->readings; i++) {
        printf("  %-16s ", reading_table[t->reading[i]].name);
        print_bounds(stdout, t->s, &search_best(t->s, t->reading[i])->p);
        printf("\n");
    }
}

static FILE *create(const char *out, const char *name)
{
    char path[1024];
    FILE *f;
    snprintf(path, sizeof path, "%s/%s", out, name);
    f = fopen(path, "w");
    if (f == NULL) { cli_complain("%s: %s", path, strerror(errno)); }
    return f;
}

static int write_all(const struct trial *t, const struct verdict *v, const char *out)
{
    FILE *csv = create(out, "fit.csv"), *plants = create(out, "plants.csv");
    int err = csv == NULL || plants == NULL;
    if (err == 0) {
        fprintf(csv,
            "reading,rate_hz,k_n_per_m,b_ns_per_m,paper_n_per_m,median_n_per_m,low_n_per_m,"
            "high_n_per_m,rest_share,oscillating_share_at_1_5x");
        for (int k = 0; k < FURTHER; k++) {
            fprintf(csv, ",over_k_at_%g,rest_share_at_%g", further_scale[k], further_scale[k]);
        }
        fprintf(csv, ",b_max_ns_per_m");
        for (int k = 0; k < READINGS; k++) { fprintf(csv, ",%s_n_per_m", reading_table[k].name); }
        fprintf(csv, "\n");
        fprintf(plants, "reading,cost");
        for (int k = 0; k < SPACE_ROWS; k++) { fprintf(plants, ",%s", space_row[k].name); }
        fprintf(plants, ",at_bound\n");
        print(t, v, csv, plants);
        print_further(t, v);
    }
    if (csv != NULL) { err |= fclose(csv) != 0; }
    if (plants != NULL) { err |= fclose(plants) != 0; }
    return err;
}

int winners_judge(const struct search *s, int runs, int further, int jobs, const char *out)
{
    struct trial t = {s, runs, further, {0}, 0};
    struct verdict *v = calloc(READINGS * TABLE2_ROWS, sizeof *v);
    int err, failed = 0;
    for (int i = 0; i < READINGS; i++) {
        if (s->used[i] && search_best(s, i) != NULL) { t.reading[t.readings++] = i; }
    }
    if (v == NULL || t.readings == 0) {
        cli_complain(v ? "no plant ran through: give a larger --budget" : "out of memory");
        free(v);
        return 1;
    }
    const struct jobs all = {
        t.readings * TABLE2_ROWS, jobs, sizeof *v, v, judge, &t, "rows", posix_interrupt};
    err = jobs_run(&all);
    for (int i = 0; i < all.n; i++) { failed += v[i].failed; }
    if (err == 0) { err = write_all(&t, v, out); }
    if (err == 0 && failed) { cli_complain("%d runs failed", failed); }
    free(v);
    return err ? err : failed != 0;
}
