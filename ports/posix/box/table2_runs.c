/* SPDX-License-Identifier: MIT */
#include "box/table2_runs.h"

#include "falls/quantile.h"

#include <string.h>

struct values {
    double at[TABLE2_RUNS_MAX];
    int n;
};

static void add(struct values *v, double value) { v->at[v->n++] = value; }

int table2_median_rank(int n)
{
    double term = 1, below = 0;
    int rank = 0;
    for (int i = 0; i < n; i++) { term /= 2; }
    while (rank < n / 2 && below + term <= 0.025) {
        below += term;
        term *= (double)(n - rank) / (rank + 1);
        rank++;
    }
    return rank;
}

/* What did not come to rest was not seen to oscillate, if it was not seen. */
static double swing_of(const struct table2_result *r, int runs)
{
    int falls = 0, oscillating = 0;
    for (int i = 0; i < runs; i++) {
        falls += r[i].done ? r[i].falls : 0;
        oscillating += r[i].done ? r[i].oscillating : 0;
    }
    return falls ? (double)oscillating / falls : -1;
}

/* The values are sorted. */
static void interval(struct table2_runs *s, const struct values *b, const struct table2_result *r)
{
    const int rank = table2_median_rank(b->n);
    if (s->runs == 1) {
        s->low_Npm = r->ci_low_Npm;
        s->high_Npm = r->ci_bounded ? r->ci_high_Npm : 0;
    } else if (s->b_Npm > 0 && rank > 0) {
        s->low_Npm = b->at[rank - 1];
        s->high_Npm = b->at[b->n - rank];
    }
}

static void medians(struct table2_runs *s, const struct table2_result *r, int runs)
{
    static struct values b, a, r2, resting;
    const struct table2_result *first = r;
    b.n = a.n = r2.n = resting.n = 0;
    for (int i = 0; i < runs; i++) {
        if (!r[i].done) { continue; }
        if (!(r[i].b_Npm > 0)) {
            if (s->line == FALL_OK) { s->line = r[i].line; }
            continue;
        }
        first = &r[i];
        add(&b, r[i].b_Npm);
        add(&a, r[i].a_Npm);
        add(&r2, r[i].r2);
        add(&resting, r[i].resting);
    }
    s->lines = b.n;
    s->b_Npm = quantile(b.at, b.n, s->runs, 0.5);
    s->low_5_Npm = quantile(b.at, b.n, s->runs, 0.05);
    s->high_5_Npm = quantile(b.at, b.n, s->runs, 0.95);
    s->a_Npm = quantile(a.at, a.n, s->runs, 0.5);
    s->r2 = quantile(r2.at, r2.n, s->runs, 0.5);
    s->resting = s->b_Npm > 0 ? quantile(resting.at, resting.n, s->runs, 0.5) : -1;
    interval(s, &b, first);
}

struct table2_runs table2_runs(
    const struct table2_result *at_1, const struct table2_result *at_15, int runs)
{
    const int n = runs < TABLE2_RUNS_MAX ? runs : TABLE2_RUNS_MAX;
    struct table2_runs s;
    memset(&s, 0, sizeof s);
    s.rest = s.resting = -1;
    s.rate_Hz = at_1->rate_Hz;
    s.k_Npm = at_1->k_Npm;
    s.b_Nspm = at_1->b_Nspm;
    s.phase = at_1->phase;
    s.q_lim_m = at_1->q_lim_m;
    s.swing = at_15 ? swing_of(at_15, n) : -1;
    for (int i = 0; i < n; i++) {
        if (!at_1[i].done) { continue; }
        s.runs++;
        s.falls += at_1[i].falls;
        s.oscillating += at_1[i].oscillating;
        s.faults |= at_1[i].faults;
        s.incomplete += at_1[i].incomplete;
        s.places |= at_1[i].phase != s.phase;
    }
    /* These say neither that a row rests nor that it does not. */
    if (s.faults || s.incomplete) { return s; }
    if (s.falls) { s.rest = 1 - (double)s.oscillating / s.falls; }
    medians(&s, at_1, n);
    return s;
}
