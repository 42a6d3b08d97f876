/* SPDX-License-Identifier: MIT */
#include "lab/fit/winners.h"

#include "base/jobs.h"
#include "base/option.h"
#include "base/outfile.h"

#include <stdio.h>
#include <string.h>

#define FIRST 100000 /* case: none that the search has seen */
#define EACH  4      /* plants of a velocity that are judged */
#define MOST  (ESTIMATES * EACH)

/* One plant, judged. */
struct verdict {
    struct search_child c;
    struct score s;
    double b_max[2]; /* Ns/m: the largest that rests at half the row's k, 90 and 2000 Hz */
};

struct trial {
    struct score_plan plan;
    struct verdict v[MOST];
    int n;
};

/* Largest b of the ladder up to which nine of ten falls rest. */
static double largest_b(const struct search_child *c, int row)
{
    static const double b[] = {
        1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50, 60, 80, 100, 120, 150, 200};
    const struct score_plan plan = {40, 0, FIRST};
    double best = 0;
    for (size_t i = 0; i < sizeof b / sizeof b[0]; i++) {
        if (score_rest(&c->p, c->kind, row, table2_paper[row].k_Npm / 2, b[i], &plan) < 0.9) {
            break;
        }
        best = b[i];
    }
    return best;
}

static void judge(const void *ctx, int i, void *to)
{
    const struct trial *t = ctx;
    struct verdict v = t->v[i];
    v.s = score_plant(&v.c.p, v.c.kind, &t->plan, 1e9);
    v.b_max[0] = largest_b(&v.c, 0);
    v.b_max[1] = largest_b(&v.c, TABLE2_ROWS - 1);
    memcpy(to, &v, sizeof v);
}

/* A value within 2 % of its range from an end. */
static void print_bounds(FILE *f, const struct plant_point *p)
{
    int n = 0;
    for (int i = 0; i < SPACE_ROWS; i++) {
        if (space_row[i].scale == SPACE_WHOLE || (p->u[i] > 0.02 && p->u[i] < 0.98)) { continue; }
        fprintf(f, "%s%s %s", n++ ? ", " : "", space_row[i].name, p->u[i] < 0.5 ? "low" : "high");
    }
}

static void print_shares(const float *share)
{
    for (int i = 0; i < TABLE2_ROWS; i++) { printf(" %5.1f", 100 * (double)share[i]); }
}

static void print(const struct trial *t)
{
    printf("Plants of each velocity estimator, by %d and %d falls a row from places of the wall, "
           "counts and\nclocks that the search did not see. Margin: 1 if all falls do as wanted, 0 "
           "on a gate (95, 75 %%).\nLargest b: at half the row's k, 90 and 2000 Hz; the paper says "
           "\"nearly 20 times\".\n\n"
           "           margin   at rest at the gains, %%, 90 .. 2000 Hz  oscillate at 1.5 times, "
           "%%              largest b\n",
        t->plan.falls, t->plan.falls_at_15);
    for (int i = 0; i < t->n; i++) {
        const struct verdict *v = &t->v[i];
        printf("  %-7s %7.2f  ", estimate_name[v->c.kind], score_margin(&v->s));
        print_shares(v->s.rest);
        printf("  ");
        print_shares(v->s.swing);
        printf("   %3.0f %3.0f\n", v->b_max[0], v->b_max[1]);
    }
}

/* The command that judges it in the box itself; the drop scene has the window. */
static void print_command(const struct verdict *v)
{
    printf("  exhand-lab drop --gates");
    for (int i = 0; i < SPACE_ROWS; i++) {
        const double value = space_value(i, v->c.p.u[i]);
        if (space_row[i].kind == SPACE_DEVICE) {
            printf(" --device %s=%.4g", space_row[i].name, value);
        } else if (space_row[i].kind == SPACE_F0 ||
                   (space_row[i].kind == SPACE_WINDOW && v->c.kind == ESTIMATE_WINDOW)) {
            printf(" --set %s=%.4g", space_row[i].name, value);
        }
    }
    printf("\n");
}

static void print_best(const struct trial *t)
{
    const struct verdict *best = NULL, *window = NULL;
    for (int i = 0; i < t->n; i++) {
        const struct verdict *v = &t->v[i];
        if (best == NULL || score_margin(&v->s) > score_margin(&best->s)) { best = v; }
        if (v->c.kind == ESTIMATE_WINDOW &&
            (window == NULL || score_margin(&v->s) > score_margin(&window->s))) {
            window = v;
        }
    }
    printf(score_margin(&best->s) >= 0
               ? "\nThe most robust, by %s, is inside both gates at all six rates.\n"
               : "\nNo plant is inside both gates at all six rates: the table is the frontier. The "
                 "least far\noutside is by %s.\n",
        estimate_name[best->c.kind]);
    if (window) {
        printf("The most robust by window, the estimator of scene drop:\n");
        print_command(window);
    }
}

static void write_plants(FILE *f, const void *ctx)
{
    const struct trial *t = ctx;
    fprintf(f, "velocity,margin,cost");
    for (int k = 0; k < TABLE2_ROWS; k++) { fprintf(f, ",rest_%g", table2_paper[k].rate_Hz); }
    for (int k = 0; k < TABLE2_ROWS; k++) { fprintf(f, ",swing_%g", table2_paper[k].rate_Hz); }
    fprintf(f, ",b_max_90,b_max_2000");
    for (int k = 0; k < SPACE_ROWS; k++) { fprintf(f, ",%s", space_row[k].name); }
    fprintf(f, ",at_bound\n");
    for (int i = 0; i < t->n; i++) {
        const struct verdict *v = &t->v[i];
        fprintf(
            f, "%s,%.4f,%.4f", estimate_name[v->c.kind], score_margin(&v->s), (double)v->s.cost);
        for (int k = 0; k < TABLE2_ROWS; k++) { fprintf(f, ",%.4f", (double)v->s.rest[k]); }
        for (int k = 0; k < TABLE2_ROWS; k++) { fprintf(f, ",%.4f", (double)v->s.swing[k]); }
        fprintf(f, ",%g,%g", v->b_max[0], v->b_max[1]);
        for (int k = 0; k < SPACE_ROWS; k++) { fprintf(f, ",%.9g", space_value(k, v->c.p.u[k])); }
        fprintf(f, ",\"");
        print_bounds(f, &v->c.p);
        fprintf(f, "\"\n");
    }
}

int winners_judge(const struct search *s, int falls, int jobs, const char *out)
{
    static struct trial t;
    int err;
    memset(&t, 0, sizeof t);
    t.plan = (struct score_plan){falls, falls / 2, FIRST};
    for (int k = 0; k < ESTIMATES; k++) {
        for (int i = 0; i < s->of[k].members && i < EACH; i++) {
            t.v[t.n++].c = (struct search_child){s->of[k].member[i].p, (enum estimate_kind)k};
        }
    }
    if (t.n == 0) {
        cli_complain("no plant came near both gates: give a larger --budget");
        return 1;
    }
    const struct jobs all = {t.n, jobs, sizeof t.v[0], t.v, judge, &t, "plants", posix_interrupt};
    err = jobs_run(&all);
    if (err) { return err; }
    print(&t);
    print_best(&t);
    return outfile_write(out, "plants.csv", write_plants, &t);
}
