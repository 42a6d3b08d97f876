/* SPDX-License-Identifier: MIT */
/* Many runs of one row of Table II, and how far they are apart. */
#include "lab/drop/spread.h"

#include "lab/drop/quantile.h"

#include <string.h>

#define RUNS_MAX 1000

struct values {
    double at[RUNS_MAX];
    int n;
};

static void add(struct values *v, double value) { v->at[v->n++] = value; }

/* What was not seen to come to rest has not come to rest, nor was it seen to
 * oscillate: incomplete falls count against us on either side. */
static double share_of(const struct table2_result *r, int runs, int with_incomplete)
{
    int falls = 0, oscillating = 0;
    for (int i = 0; i < runs; i++) {
        if (!r[i].done) { continue; }
        falls += r[i].falls;
        oscillating += r[i].oscillating + (with_incomplete ? r[i].incomplete : 0);
    }
    return falls ? (double)oscillating / falls : -1;
}

struct table2_spread table2_spread(
    const struct table2_result *at_1, const struct table2_result *at_15, int runs)
{
    static struct values b, a, b_same, a_same;
    const int n = runs < RUNS_MAX ? runs : RUNS_MAX;
    const double restless = share_of(at_1, n, 1);
    struct table2_spread s;

    memset(&s, 0, sizeof s);
    b.n = a.n = b_same.n = a_same.n = 0;
    for (int i = 0; i < n; i++) {
        if (!at_1[i].done) { continue; }
        s.runs++;
        if (at_1[i].b_Npm > 0) {
            add(&b, at_1[i].b_Npm);
            add(&a, at_1[i].a_Npm);
        }
        if (at_1[i].b_same_Npm > 0) {
            add(&b_same, at_1[i].b_same_Npm);
            add(&a_same, at_1[i].a_same_Npm);
        }
    }
    s.lines = b.n;
    s.lines_same = b_same.n;
    s.b_Npm = quantile(b.at, b.n, s.runs, 0.5);
    s.b_low_Npm = quantile(b.at, b.n, s.runs, 0.05);
    s.b_high_Npm = quantile(b.at, b.n, s.runs, 0.95);
    s.a_Npm = quantile(a.at, a.n, s.runs, 0.5);
    s.b_same_Npm = quantile(b_same.at, b_same.n, s.runs, 0.5);
    s.a_same_Npm = quantile(a_same.at, a_same.n, s.runs, 0.5);
    s.rest = restless < 0 ? -1 : 1 - restless;
    s.oscillates = share_of(at_15, n, 0);
    return s;
}

/* --- for programs --- */

/* Fields: empty where there is no value. */
static void positive(FILE *f, double v)
{
    fputc(',', f);
    if (v > 0) { fprintf(f, "%.6g", v); }
}

static void share(FILE *f, int known, double v)
{
    fputc(',', f);
    if (known) { fprintf(f, "%.4f", v); }
}

void table2_spread_csv_header(FILE *f)
{
    fprintf(f, "rate_hz,k_n_per_m,b_ns_per_m,runs,median_b_n_per_m,low_b_n_per_m,high_b_n_per_m,"
               "median_a_n_per_m,median_b_same_tick_n_per_m,median_a_same_tick_n_per_m,rest_share,"
               "oscillating_share_at_1_5x,runs_with_line,runs_with_line_same_tick\n");
}

void table2_spread_csv_line(FILE *f, const struct table2_result *r, const struct table2_spread *s)
{
    const double value[] = {
        s->b_Npm, s->b_low_Npm, s->b_high_Npm, s->a_Npm, s->b_same_Npm, s->a_same_Npm};
    fprintf(f, "%.9g,%.9g,%.9g,%d", r->rate_Hz, r->k_Npm, r->b_Nspm, s->runs);
    for (size_t i = 0; i < sizeof value / sizeof value[0]; i++) { positive(f, value[i]); }
    share(f, s->rest >= 0, s->rest);
    share(f, s->oscillates >= 0, s->oscillates);
    fprintf(f, ",%d,%d\n", s->lines, s->lines_same);
}

/* --- for people --- */

struct text {
    char s[32];
};

/* A dash where there is no value. */
static const char *text(struct text *t, int known, int decimals, double v)
{
    if (known) {
        snprintf(t->s, sizeof t->s, "%.*f", decimals, v);
    } else {
        strcpy(t->s, "-");
    }
    return t->s;
}

static const char *percent(struct text *t, double share)
{
    if (share < 0) { return text(t, 0, 0, 0); }
    snprintf(t->s, sizeof t->s, "%.1f %%", 100 * share);
    return t->s;
}

/* "lo..hi", "lo.." without an upper end, "-" without either. */
static const char *range(struct text *t, double lo, double hi)
{
    if (lo <= 0) { return text(t, 0, 0, 0); }
    if (hi > 0) {
        snprintf(t->s, sizeof t->s, "%.0f..%.0f", lo, hi);
    } else {
        snprintf(t->s, sizeof t->s, "%.0f..", lo);
    }
    return t->s;
}

static void print_spread_row(FILE *f, const struct table2_result *r, const struct table2_spread *s)
{
    const int line = s->b_Npm > 0;
    struct text b, interval, per_k, a, b_same, a_same, rest, oscillates;
    fprintf(f, "%6.6g %10s %18s %5s |%9s %13s %13s |%8s %19s\n", r->rate_Hz,
        text(&b, line, 0, s->b_Npm), range(&interval, s->b_low_Npm, s->b_high_Npm),
        text(&per_k, line && r->k_Npm > 0, 2, s->b_Npm / r->k_Npm), text(&a, line, 0, s->a_Npm),
        text(&b_same, s->b_same_Npm > 0, 0, s->b_same_Npm),
        text(&a_same, s->a_same_Npm > 0, 0, s->a_same_Npm), percent(&rest, s->rest),
        percent(&oscillates, s->oscillates));
}

void table2_spread_print(
    FILE *f, const struct table2_result *r, const struct table2_spread *s, int rows)
{
    int runs = 0;
    for (int i = 0; i < rows; i++) { runs = s[i].runs > runs ? s[i].runs : runs; }
    if (runs == 0) { return; }
    fprintf(f,
        "\n%d further runs a rate: one run is one draw of this\n\n"
        "  rate   median B  5 %%..95 %% of runs  B/k | median A   B same tick   A same tick |"
        " at rest   1.5x gains oscillate\n",
        runs);
    for (int i = 0; i < rows; i++) {
        if (s[i].runs > 0) { print_spread_row(f, &r[i], &s[i]); }
    }
    for (int i = 0; i < rows; i++) {
        if (s[i].runs > 0 && (s[i].lines < runs || s[i].lines_same < runs)) {
            fprintf(f,
                "%6.6g Hz: of %d runs %d gave a line, %d at the same tick: medians are of these, "
                "if they are most.\n",
                r[i].rate_Hz, s[i].runs, s[i].lines, s[i].lines_same);
        }
    }
}
