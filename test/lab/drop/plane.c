/* SPDX-License-Identifier: MIT */
#include "lab/drop/plane.h"

#include "base/option.h"
#include "box/table2.h"

#include "sim/linear.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define K_MAX_NPM  1e6 /* what the scene takes */
#define B_MAX_NSPM 1e3
#define HALVINGS   4   /* of the step between a stable cell and the next */
#define FALL_HZ    500 /* a fall at no rate would take as long as so much of a rate */

/* --- wanting --- */

struct wants {
    const struct cells *cells;
    struct plane_want *at;
    int n, cap, no_memory;
};

/* The cell, or NULL: then it is wanted, perhaps not for the first time. */
static const struct cell *need(struct wants *w, double rate_Hz, double k_Npm, double b_Nspm)
{
    const struct cell *c = cells_find(w->cells, rate_Hz, k_Npm, b_Nspm);
    if (c != NULL) { return c; }
    if (w->n == w->cap) {
        const int cap = w->cap ? 2 * w->cap : 1024;
        struct plane_want *more = realloc(w->at, (size_t)cap * sizeof *more);
        if (more == NULL) {
            w->no_memory = 1;
            return NULL;
        }
        w->at = more;
        w->cap = cap;
    }
    w->at[w->n++] = (struct plane_want){rate_Hz, k_Npm, b_Nspm};
    return NULL;
}

static int compare(const void *a, const void *b)
{
    const struct plane_want *x = a, *y = b;
    if (x->rate_Hz != y->rate_Hz) { return x->rate_Hz < y->rate_Hz ? -1 : 1; }
    if (x->k_Npm != y->k_Npm) { return x->k_Npm < y->k_Npm ? -1 : 1; }
    return x->b_Nspm == y->b_Nspm ? 0 : x->b_Nspm < y->b_Nspm ? -1 : 1;
}

/* Sorted, each once. */
static void tidy(struct wants *w)
{
    int n = 0;
    if (w->n > 1) { qsort(w->at, (size_t)w->n, sizeof *w->at, compare); }
    for (int i = 0; i < w->n; i++) {
        if (n == 0 || compare(&w->at[n - 1], &w->at[i]) != 0) { w->at[n++] = w->at[i]; }
    }
    w->n = n;
}

/* --- octaves: how far the grid must reach --- */

static double octave(double first, double most, int i)
{
    double v = first;
    for (; i > 0 && v < most; i--) { v *= 2; }
    return v < most ? v : most;
}

#define OCTAVES 4 /* tried at least, in k and in b */
#define K_FIRST 250

/* What a tick leaves stable goes with the rate squared: so many octaves lower begins k. */
static int octaves_below(double rate_Hz)
{
    int n = 0;
    for (double r = rate_Hz; r < 90 && n < 16; r *= 2) { n += 2; }
    return n;
}

static double octave_k(double rate_Hz, int i)
{
    double first = K_FIRST;
    for (int n = octaves_below(rate_Hz); n > 0; n--) { first /= 2; }
    return octave(first, K_MAX_NPM, i);
}

static double octave_b(int j) { return j == 0 ? 0 : octave(2, B_MAX_NSPM, j - 1); }

struct reach {
    double k_Npm, b_Nspm; /* a column and a row of octaves in which nothing is stable */
};

/* 0: octaves are still wanted. */
static int reach_of(struct wants *w, double rate_Hz, struct reach *reach)
{
    int columns = OCTAVES + octaves_below(rate_Hz), rows = OCTAVES;
    for (;;) {
        int column = -1, row = -1, known = 1; /* the last in which one is stable */
        for (int i = 0; i < columns; i++) {
            for (int j = 0; j < rows; j++) {
                const struct cell *c = need(w, rate_Hz, octave_k(rate_Hz, i), octave_b(j));
                known &= c != NULL;
                if (c == NULL || !cell_stable(c)) { continue; }
                column = i;
                row = j > row ? j : row;
            }
        }
        if (!known) { return 0; }
        *reach = (struct reach){octave_k(rate_Hz, column + 1), octave_b(row + 1)};
        if (reach->b_Nspm == 0) { reach->b_Nspm = octave_b(1); }
        if (column + 1 >= columns && octave_k(rate_Hz, column) < K_MAX_NPM) {
            columns++;
        } else if (row + 1 >= rows && octave_b(row) < B_MAX_NSPM) {
            rows++;
        } else {
            return 1;
        }
    }
}

/* --- rows and columns of the grid --- */

/* A row is b fixed and k from one step up; a column is k fixed and b from 0 up. */
struct line {
    double rate_Hz, fixed, step, first;
    int cells, is_row;
};

static struct line row_of(const struct sweep_opt *o, double rate_Hz, struct reach r, int j)
{
    const double step = r.k_Npm / o->columns;
    return (struct line){rate_Hz, r.b_Nspm * j / (o->rows - 1), step, step, o->columns, 1};
}

static struct line column_of(const struct sweep_opt *o, double rate_Hz, struct reach r, int i)
{
    return (struct line){
        rate_Hz, r.k_Npm * (i + 1) / o->columns, r.b_Nspm / (o->rows - 1), 0, o->rows, 0};
}

static const struct cell *at(struct wants *w, const struct line *l, double v)
{
    return l->is_row ? need(w, l->rate_Hz, v, l->fixed) : need(w, l->rate_Hz, l->fixed, v);
}

static double value(const struct line *l, int i) { return l->first + l->step * i; }

/* k, or b, is raised on a line until it is unstable: the border is where the stable
 * cells from the first one on end. 1: known, *below the highest value still found stable
 * and *above the lowest found not; 2: open, *below the line's end, which is still stable; -1:
 * no cell is stable; 0: cells are still wanted. */
static int border(struct wants *w, const struct line *l, double *below, double *above)
{
    int first = -1, i = 0;
    for (; i < l->cells; i++) {
        const struct cell *c = at(w, l, value(l, i));
        if (c == NULL) { return 0; }
        if (first < 0 && cell_stable(c)) { first = i; }
        if (first >= 0 && !cell_stable(c)) { break; }
    }
    if (first < 0) { return -1; }
    *below = *above = value(l, i - 1);
    if (i == l->cells) { return 2; }
    *above = value(l, i);
    for (int n = 0; n < HALVINGS; n++) {
        const double mid = (*below + *above) / 2;
        const struct cell *c = at(w, l, mid);
        if (c == NULL) { return 0; }
        if (cell_stable(c)) {
            *below = mid;
        } else {
            *above = mid;
        }
    }
    return 1;
}

/* What the n-th row or column of a rate still wants. */
static void want_line(struct wants *w, const struct line *l)
{
    double below, above;
    if (l->is_row) { /* the grid: its cells for their own sake */
        int known = 1;
        for (int i = 0; i < l->cells; i++) { known &= at(w, l, value(l, i)) != NULL; }
        if (!known) { return; }
    }
    border(w, l, &below, &above);
}

/* From 0: rows in their order make blocks that take about as long, so that few rates have their
 * octaves found by more than one. */
static int shard_of(const struct sweep_opt *o, int rate, int row)
{
    double all_Hz = 0, before_Hz = 0;
    for (int r = 0; r < o->rates; r++) {
        before_Hz += r < rate ? o->rate_Hz[r] + FALL_HZ : 0;
        all_Hz += o->rate_Hz[r] + FALL_HZ;
    }
    return (int)(o->shards * (before_Hz + (o->rate_Hz[rate] + FALL_HZ) * (row + 0.5) / o->rows) /
                 all_Hz);
}

/* Columns ask for cells of all rows: who has these, at the end, runs what halving a column's border
 * takes. */
static int ours(const struct sweep_opt *o, int rate, int line)
{
    return o->shards == 1 || (line < o->rows && shard_of(o, rate, line) == o->shard - 1);
}

static int any_ours(const struct sweep_opt *o, int rate)
{
    int any = 0;
    for (int j = 0; j < o->rows; j++) { any |= ours(o, rate, j); }
    return any;
}

int plane_wants(const struct cells *cells, const struct sweep_opt *o, struct plane_want **want)
{
    struct wants w = {cells, NULL, 0, 0, 0};
    for (int r = 0; r < o->rates; r++) {
        const double rate_Hz = o->rate_Hz[r];
        struct reach reach;
        if (!any_ours(o, r) || !reach_of(&w, rate_Hz, &reach)) { continue; }
        for (int i = 0; i < o->rows + o->columns && !posix_interrupted(); i++) {
            const struct line l = i < o->rows ? row_of(o, rate_Hz, reach, i)
                                              : column_of(o, rate_Hz, reach, i - o->rows);
            if (ours(o, r, i)) { want_line(&w, &l); }
        }
    }
    tidy(&w);
    *want = w.at;
    if (!w.no_memory) { return w.n; }
    cli_complain("out of memory: a smaller --grid");
    return -1;
}

/* --- what was found --- */

struct peak {
    double k_Npm, k_at_b; /* the largest stable k, and where */
    double b_Nspm, b_at_k;
    int k_open, b_open; /* stable up to where the grid ends: so much or more */
};

struct found {
    double rate_Hz;
    struct reach reach;
    struct peak sim, linear;
    double stiffness_Npm;
    int cells, stable, stable_rho; /* of the grid */
};

static void raise_peak(struct peak *p, const struct line *l, double v, int open)
{
    if (l->is_row && v > p->k_Npm) {
        p->k_Npm = v;
        p->k_at_b = l->fixed;
        p->k_open = open;
    } else if (!l->is_row && v > p->b_Nspm) {
        p->b_Nspm = v;
        p->b_at_k = l->fixed;
        p->b_open = open;
    }
}

static double rho_on(const struct sweep_opt *o, const struct line *l, double v)
{
    const double k = l->is_row ? v : l->fixed, b = l->is_row ? l->fixed : v;
    return linear_rho(&o->base.board.device, 1 / l->rate_Hz, k, b, sweep_window(&o->base));
}

/* --- how far the linear test reaches: the same whatever the grid --- */

struct linear {
    const struct sweep_opt *o;
    double rate_Hz, from, across; /* where the other gain is scanned */
    double at;                    /* where it was found stable */
};

static int linear_stable(struct linear *x, double k, double b)
{
    const double rho =
        linear_rho(&x->o->base.board.device, 1 / x->rate_Hz, k, b, sweep_window(&x->o->base));
    return rho >= 0 && rho < 1;
}

#define ACROSS 100 /* values of the other gain: b in equal steps, k in equal ratios from 1 up */

static int any_b(struct linear *x, double k)
{
    for (int i = 0; i <= ACROSS; i++) {
        const double b = x->from + (x->across - x->from) * i / ACROSS;
        if (!linear_stable(x, k, b)) { continue; }
        x->at = b;
        return 1;
    }
    return 0;
}

static int any_k(struct linear *x, double b)
{
    double ratio = 2, k = 1;
    for (double low = 1, high = 2;
         high - low > 1e-9;) { /* ratio^ACROSS = across, without a library */
        double v = 1;
        ratio = (low + high) / 2;
        for (int i = 0; i < ACROSS; i++) { v *= ratio; }
        if (v < x->across) {
            low = ratio;
        } else {
            high = ratio;
        }
    }
    for (int i = 0; i <= ACROSS; i++, k *= ratio) {
        if (linear_stable(x, k, b)) { return 1; }
    }
    return 0;
}

static double halve(
    struct linear *x, int (*any)(struct linear *x, double v), double v, double above, double most)
{
    for (int n = 0; n < 7 && above <= most; n++) {
        const double mid = (v + above) / 2;
        if (any(x, mid)) {
            v = mid;
        } else {
            above = mid;
        }
    }
    return v;
}

/* From a value that is stable: 3 % steps, looking eight of them ahead, then halves. */
static double climb(struct linear *x, int (*any)(struct linear *x, double v), double v, double most)
{
    for (int ahead = 8; v > 0 && ahead > 0; ahead--) {
        double next = v;
        for (int i = 0; i < ahead; i++) { next *= 1.03; }
        if (next > most) { next = most; }
        if (next > v && any(x, next)) {
            v = next;
            ahead = 9;
        }
    }
    return halve(x, any, v, v > 0 ? 1.03 * v : 0.5, most);
}

/* The largest k and the largest b with rho < 1; zeros: nowhere. */
static struct peak linear_peak(const struct sweep_opt *o, double rate_Hz)
{
    struct linear x = {o, rate_Hz, 0, 0, 0};
    struct peak p;
    memset(&p, 0, sizeof p);
    for (double k = 1; k <= K_MAX_NPM; k *= 1.25) {
        for (double b = 0; b <= B_MAX_NSPM; b = b > 0 ? 1.4 * b : 0.5) {
            if (!linear_stable(&x, k, b)) { continue; }
            p.k_Npm = k;
            p.b_Nspm = b > p.b_Nspm ? b : p.b_Nspm;
        }
    }
    if (p.k_Npm > 0) {
        x.across = 1.4 * p.b_Nspm + 0.5;
        p.k_Npm = climb(&x, any_b, p.k_Npm, K_MAX_NPM);
        x.from = x.at - x.across / ACROSS; /* the tip lies between two b */
        x.from = x.from > 0 ? x.from : 0;
        x.across = x.at + x.across / ACROSS;
        p.k_Npm = halve(&x, any_b, p.k_Npm, 1.01 * p.k_Npm, K_MAX_NPM);
        x.across = 1.03 * p.k_Npm;
        p.b_Nspm = climb(&x, any_k, p.b_Nspm, B_MAX_NSPM);
    }
    return p;
}

/* --- what a rate has --- */

static struct found find(
    const struct cells *cells, const struct sweep_opt *o, double rate_Hz, FILE *f)
{
    struct wants w = {cells, NULL, 0, 0, 0};
    struct found x;
    memset(&x, 0, sizeof x);
    x.rate_Hz = rate_Hz;
    reach_of(&w, rate_Hz, &x.reach);
    x.linear = linear_peak(o, rate_Hz);
    for (int i = 0; i < o->rows + o->columns; i++) {
        const struct line l = i < o->rows ? row_of(o, rate_Hz, x.reach, i)
                                          : column_of(o, rate_Hz, x.reach, i - o->rows);
        double below, above;
        int known;
        for (int n = 0; l.is_row && n < l.cells; n++) {
            const struct cell *c = at(&w, &l, value(&l, n));
            x.cells++;
            x.stable += c != NULL && cell_stable(c);
            x.stable_rho += c != NULL && c->rho >= 0 && c->rho < 1;
            if (c != NULL && cell_stable(c) && c->stiffness_Npm > x.stiffness_Npm) {
                x.stiffness_Npm = c->stiffness_Npm;
            }
        }
        known = border(&w, &l, &below, &above);
        if (known <= 0) { continue; }
        raise_peak(&x.sim, &l, below, known == 2);
        if (known == 2) { continue; }
        fprintf(f, "%.9g,%s,%.9g,%.9g\n", rate_Hz, l.is_row ? "k" : "b",
            l.is_row ? (below + above) / 2 : l.fixed, l.is_row ? l.fixed : (below + above) / 2);
    }
    free(w.at);
    return x;
}

/* rho over the plane of a rate, for the contour of rho = 1. */
static void write_rho(FILE *f, const struct sweep_opt *o, const struct found *x)
{
    enum { STEPS = 60 };
    for (int j = 0; j <= STEPS; j++) {
        struct line l = {x->rate_Hz, x->reach.b_Nspm * j / STEPS, 0, 0, 0, 1};
        for (int i = 0; i <= STEPS; i++) {
            const double k = x->reach.k_Npm * i / STEPS;
            fprintf(f, "%.9g,%.9g,%.9g,%.6f\n", x->rate_Hz, k, l.fixed, rho_on(o, &l, k));
        }
        fputc('\n', f);
    }
    fputc('\n', f);
}

static void write_picture(FILE *f, const struct found *x, int n)
{
    fprintf(f,
        "# Made by exhand drop --sweep. Inside this directory, PLOTS the way to "
        "ports/posix/plot:\n#   gnuplot -c sweep.gp PLOTS\nplots=ARG1\n"
        "out='stability.png'; cells='stability.csv'; border='border.csv'; rho='rho.csv'\nrates='");
    for (int i = 0; i < n; i++) { fprintf(f, "%s%.6g", i ? " " : "", x[i].rate_Hz); }
    fprintf(f, "'; k_tops='");
    for (int i = 0; i < n; i++) { fprintf(f, "%s%.6g", i ? " " : "", x[i].reach.k_Npm); }
    fprintf(f, "'; b_tops='");
    for (int i = 0; i < n; i++) { fprintf(f, "%s%.6g", i ? " " : "", x[i].reach.b_Nspm); }
    fprintf(f, "'; paper_ks='");
    for (int i = 0; i < n; i++) {
        const struct table2_row *row = table2_at(x[i].rate_Hz);
        fprintf(f, "%s%.6g", i ? " " : "", row ? row->k_Npm : -1);
    }
    fprintf(f, "'; paper_bs='");
    for (int i = 0; i < n; i++) {
        const struct table2_row *row = table2_at(x[i].rate_Hz);
        fprintf(f, "%s%.6g", i ? " " : "", row ? row->b_Nspm : -1);
    }
    fprintf(f, "'\nload plots.'/stability.gp'\n");
}

static void ratio(const char *what, double slow, double fast, const char *paper)
{
    if (slow > 0 && fast > 0) {
        printf("  %-44s %6.1f   %s\n", what, fast / slow, paper);
    } else {
        printf("  %-44s      -   %s\n", what, paper);
    }
}

/* Where a border peaks: the value and at which of the other gain; dashes for none. */
static const char *peak_text(char text[40], double v, double at, int open)
{
    snprintf(text, 40, "%16s %6s", "-", "-");
    if (v > 0) {
        char value[20];
        snprintf(value, sizeof value, "%s%.5g", open ? ">= " : "", v);
        snprintf(text, 40, "%16s %6.4g", value, at);
    }
    return text;
}

static void print(const struct found *x, int n, int falls)
{
    const struct found *slow = NULL, *fast = NULL;
    int any_open = 0;
    printf("\nThe border at each rate: stable where nine of ten falls come to rest, %d falls a "
           "cell\n\n"
           "  rate |largest stable k   at b |largest stable b   at k | rho < 1:  k       b | "
           "stiffest stable "
           "| paper's row\n"
           "    Hz |             N/m   Ns/m |            Ns/m    N/m |       N/m    Ns/m |         "
           "    N/m "
           "|     k    b\n",
        falls);
    for (int i = 0; i < n; i++) {
        const struct table2_row *row = table2_at(x[i].rate_Hz);
        char paper[40] = "-", stiffest[24] = "-", k[40], b[40];
        if (row) { snprintf(paper, sizeof paper, "%5.0f %4.0f", row->k_Npm, row->b_Nspm); }
        if (x[i].stiffness_Npm > 0) {
            snprintf(stiffest, sizeof stiffest, "%.0f", x[i].stiffness_Npm);
        }
        printf("%6.6g |%s |%s | %9.5g %7.4g | %15s | %s\n", x[i].rate_Hz,
            peak_text(k, x[i].sim.k_Npm, x[i].sim.k_at_b, x[i].sim.k_open),
            peak_text(b, x[i].sim.b_Nspm, x[i].sim.b_at_k, x[i].sim.b_open), x[i].linear.k_Npm,
            x[i].linear.b_Nspm, stiffest, paper);
        any_open |= x[i].sim.k_open | x[i].sim.b_open;
        if (x[i].rate_Hz == 90) { slow = &x[i]; }
        if (x[i].rate_Hz == 2000) { fast = &x[i]; }
    }
    if (any_open) { printf("\n>=: stable up to where the grid ends, no border found\n"); }
    if (!slow || !fast) { return; }
    printf("\nFrom 90 to 2000 Hz                              times\n");
    ratio("largest stable k", slow->sim.k_open ? 0 : slow->sim.k_Npm,
        fast->sim.k_open ? 0 : fast->sim.k_Npm, "paper: nearly 20 in its text, 13.3 in its table");
    ratio("largest stable b", slow->sim.b_open ? 0 : slow->sim.b_Nspm,
        fast->sim.b_open ? 0 : fast->sim.b_Nspm,
        "paper: nearly 20 in its text; its table starts at 0");
    ratio("stiffest stable cell", slow->stiffness_Npm, fast->stiffness_Npm, "paper: 36");
    ratio("largest k with rho < 1", slow->linear.k_Npm, fast->linear.k_Npm, "");
    ratio("largest b with rho < 1", slow->linear.b_Nspm, fast->linear.b_Nspm, "");
}

static FILE *create(const struct sweep_opt *o, const char *name)
{
    char path[TABLE2_PATH_B];
    FILE *f;
    snprintf(path, sizeof path, "%s/%s", o->dir, name);
    f = fopen(path, "w");
    if (f == NULL) { cli_complain("%s: %s", path, strerror(errno)); }
    return f;
}

static int finish(FILE *f, const struct sweep_opt *o, const char *name)
{
    const int bad = ferror(f);
    if (fclose(f) == 0 && !bad) { return 0; }
    cli_complain("%s/%s: can't be written", o->dir, name);
    return 1;
}

/* What a rate buys, for the picture of it (plot/rate.gp). */
static int write_stiffness(const struct sweep_opt *o, const struct found *x)
{
    FILE *f = create(o, "stiffness.csv");
    if (f == NULL) { return 1; }
    fprintf(f,
        "rate_hz,k_n_per_m,at_b_ns_per_m,open,linear_k_n_per_m,stiffest_n_per_m,paper_k_n_per_m\n");
    for (int i = 0; i < o->rates; i++) {
        const struct table2_row *row = table2_at(x[i].rate_Hz);
        fprintf(f, "%.9g,%.9g,%.9g,%d,%.9g,%.9g,", x[i].rate_Hz, x[i].sim.k_Npm, x[i].sim.k_at_b,
            x[i].sim.k_open, x[i].linear.k_Npm, x[i].stiffness_Npm);
        if (row) { fprintf(f, "%.9g", row->k_Npm); }
        fputc('\n', f);
    }
    return finish(f, o, "stiffness.csv");
}

int plane_report(const struct cells *cells, const struct sweep_opt *o)
{
    struct found *x = calloc((size_t)o->rates, sizeof *x);
    FILE *border_f = create(o, "border.csv"), *rho_f = create(o, "rho.csv");
    FILE *gp = create(o, "sweep.gp");
    int err = x == NULL || border_f == NULL || rho_f == NULL || gp == NULL;
    if (err == 0) {
        fprintf(border_f, "rate_hz,along,k_n_per_m,b_ns_per_m\n");
        for (int i = 0; i < o->rates; i++) {
            x[i] = find(cells, o, o->rate_Hz[i], border_f);
            write_rho(rho_f, o, &x[i]);
        }
        write_picture(gp, x, o->rates);
        err |= write_stiffness(o, x);
        print(x, o->rates, o->base.board.falls);
    }
    if (border_f) { err |= finish(border_f, o, "border.csv"); }
    if (rho_f) { err |= finish(rho_f, o, "rho.csv"); }
    if (gp) { err |= finish(gp, o, "sweep.gp"); }
    free(x);
    return err;
}
