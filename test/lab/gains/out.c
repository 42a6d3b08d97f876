/* SPDX-License-Identifier: MIT */
#include "lab/gains/gains.h"

#include "base/option.h"
#include "base/outfile.h"
#include "box/table2.h"

#include <string.h>

static double si(int32_t raw, int frac) { return (double)raw / (double)(INT32_C(1) << frac); }

/* Along each row from where to where k is allowed, halfway to the rows beside it. */
static void allowed(FILE *f, struct gains_rate *r, int n, const struct gains_map *map)
{
    (void)map;
    fprintf(f, "rate_hz,b_low_ns_per_m,b_high_ns_per_m,k_low_n_per_m,k_high_n_per_m\n");
    for (; n > 0; n--, r++) {
        const struct region_row *row = r->region.row;
        const double half = (row[1].b_Nspm - row[0].b_Nspm) / 2;
        for (int j = 0; j <= REGION_ROWS; j++) {
            if (row[j].high_Npm <= 0) { continue; }
            fprintf(f, "%.9g,%.9g,%.9g,%.9g,%.9g\n", r->rate_Hz,
                j ? row[j].b_Nspm - half : row[j].b_Nspm, row[j].b_Nspm + half, row[j].low_Npm,
                row[j].high_Npm);
        }
    }
}

static void rules(FILE *f, struct gains_rate *r, int n, const struct gains_map *map)
{
    (void)map;
    fprintf(f, "rate_hz,knot,b_ns_per_m,k_n_per_m,k_min_n_per_m\n");
    for (; n > 0; n--, r++) {
        for (int i = 0; i < r->rule.knots; i++) {
            fprintf(f, "%.9g,%d,%.9g,%.9g,%.9g\n", r->rate_Hz, i,
                si(r->rule.b_Nspm_q20[i], EXH_Q_B), si(r->rule.k_Npm_q10[i], EXH_Q_K),
                si(r->rule.k_min_Npm_q10, EXH_Q_K));
        }
    }
}

static void judged(FILE *f, const struct gains_share *s, int n)
{
    fprintf(f, "rate_hz,stable,at_rest,allowed_stable,allowed_at_rest,linear_stable,"
               "linear_unstable,energy_stable,energy_unstable,inside,unstable,falls,restless\n");
    for (; n > 0; n--, s++) {
        const double area[] = {s->stable, s->at_rest, s->allowed_stable, s->allowed_at_rest,
            s->linear_stable, s->linear_unstable, s->energy_stable, s->energy_unstable};
        fprintf(f, "%.9g", s->rate_Hz);
        for (size_t i = 0; i < sizeof area / sizeof area[0]; i++) {
            fprintf(f, ",%.4f", area[i] / s->all);
        }
        fprintf(f, ",%d,%d,%ld,%ld\n", s->inside, s->unstable, s->falls, s->restless);
    }
}

static void cells(FILE *f, struct gains_rate *r, int n, const struct gains_map *map)
{
    (void)r;
    (void)n;
    fprintf(f, "rate_hz,k_n_per_m,b_ns_per_m,resting_falls,falls\n");
    for (int i = 0; map != NULL && i < map->n; i++) {
        const struct cell *c = &map->at[i];
        fprintf(f, "%.9g,%.9g,%.9g,%d,%d\n", c->rate_Hz, c->k_Npm, c->b_Nspm, c->resting, c->falls);
    }
}

static double k_top(const struct region *r)
{
    double k = 0;
    for (int j = 0; j <= REGION_ROWS; j++) { k = r->row[j].high_Npm > k ? r->row[j].high_Npm : k; }
    return 1.3 * k;
}

static void picture(FILE *f, struct gains_rate *r, int n, const struct gains_map *map)
{
    fprintf(f,
        "# Made by exhand advise gains. Inside this directory, PLOTS the way to "
        "ports/posix/plot:\n#   gnuplot -c gains.gp PLOTS\nplots=ARG1\n"
        "out='gains.png'; has_map=%d\nrates='",
        map != NULL);
    for (int i = 0; i < n; i++) { fprintf(f, "%s%.6g", i ? " " : "", r[i].rate_Hz); }
    fprintf(f, "'; k_tops='");
    for (int i = 0; i < n; i++) { fprintf(f, "%s%.6g", i ? " " : "", k_top(&r[i].region)); }
    fprintf(f, "'; b_tops='");
    for (int i = 0; i < n; i++) {
        fprintf(f, "%s%.6g", i ? " " : "", 1.3 * r[i].region.row[REGION_ROWS].b_Nspm);
    }
    fprintf(f, "'; paper_ks='");
    for (int i = 0; i < n; i++) {
        const struct table2_row *row = table2_at(r[i].rate_Hz);
        fprintf(f, "%s%.6g", i ? " " : "", row ? row->k_Npm : -1);
    }
    fprintf(f, "'; paper_bs='");
    for (int i = 0; i < n; i++) {
        const struct table2_row *row = table2_at(r[i].rate_Hz);
        fprintf(f, "%s%.6g", i ? " " : "", row ? row->b_Nspm : -1);
    }
    fprintf(f, "'\nload plots.'/gains.gp'\n");
}

int gains_write(const char *dir, struct gains_rate *r, const struct gains_share *s, int n,
    const struct gains_map *map)
{
    static const struct {
        const char *name;
        int of_map;
    } file[] = {
        {"allowed.csv", 0}, {"rule.csv", 0}, {"gains.gp", 0}, {"map.csv", 1}, {"judge.csv", 1}};
    for (size_t i = 0; i < sizeof file / sizeof file[0]; i++) {
        FILE *f;
        if (file[i].of_map && map == NULL) { continue; }
        f = outfile_in(dir, file[i].name);
        if (f == NULL) { return 1; }
        switch (i) {
        case 0: allowed(f, r, n, map); break;
        case 1: rules(f, r, n, map); break;
        case 2: picture(f, r, n, map); break;
        case 3: cells(f, r, n, map); break;
        default: judged(f, s, n); break;
        }
        if (outfile_close(f)) { return 1; }
    }
    return 0;
}
