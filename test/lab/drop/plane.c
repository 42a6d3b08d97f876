/* SPDX-License-Identifier: MIT */
#include "lab/drop/plane.h"

#include "base/option.h"
#include "base/outfile.h"
#include "box/table2.h"

#include "sim/linear.h"

#include <stdlib.h>
#include <string.h>

#define GAIN_FIRST 0.1
#define ROOM       1.15 /* of the picture beyond the border */

struct ray plane_ray(const struct sweep_opt *o, double rate_Hz, struct reach reach, int j)
{
    const double share = (double)j / o->rays;
    return (struct ray){
        rate_Hz, reach.k_Npm * (1 - share), reach.b_Nspm * share, GAIN_FIRST, o->per_octave};
}

/* --- what a rate has --- */

/* Of one gain: the largest on the border, its interval, and where. */
struct peak {
    double at, low, high, other;
    int open; /* falls still rest where a ray ends: so much or more */
};

struct found {
    double rate_Hz;
    struct reach linear;
    struct peak k, b;
    double k_top, b_top; /* of the picture */
};

struct known {
    const struct cells *cells;
    int ray;
};

static int known_at(void *ctx, const struct ray *r, double gain, int *rest, int *falls)
{
    const struct known *x = ctx;
    const struct cell *c = cells_find(x->cells, r->rate_Hz, x->ray, gain);
    if (c == NULL) { return 1; }
    *rest = c->resting;
    *falls = c->falls;
    return 0;
}

static void raise_peak(struct peak *p, const struct ray_border *x, double v, double other)
{
    if (v * x->gain <= p->at) { return; }
    *p = (struct peak){
        v * x->gain, v * x->low, v * x->high, other * x->gain, x->status == LOGISTIC_OPEN};
}

static struct found find(
    const struct cells *cells, const struct sweep_opt *o, int rate_i, struct reach reach, FILE *f)
{
    const double rate_Hz = o->rate_Hz[rate_i];
    struct found x;
    memset(&x, 0, sizeof x);
    x.rate_Hz = rate_Hz;
    x.linear = reach;
    for (int j = 0; j < o->rays; j++) {
        const struct ray r = plane_ray(o, rate_Hz, reach, j);
        struct known known = {cells, j};
        const struct ray_border b = ray_border(&r, known_at, &known);
        if (b.error || b.status == LOGISTIC_NONE) { continue; }
        raise_peak(&x.k, &b, r.k_Npm, r.b_Nspm);
        raise_peak(&x.b, &b, r.b_Nspm, r.k_Npm);
        fprintf(f, "%.9g,%d,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%d\n", rate_Hz, j, r.k_Npm * b.gain,
            r.b_Nspm * b.gain, r.k_Npm * b.low, r.b_Nspm * b.low, r.k_Npm * b.high,
            r.b_Nspm * b.high, b.status == LOGISTIC_OPEN);
    }
    x.k_top = ROOM * (x.k.high > reach.k_Npm ? x.k.high : reach.k_Npm);
    x.b_top = ROOM * (x.b.high > reach.b_Nspm ? x.b.high : reach.b_Nspm);
    return x;
}

/* rho over the plane of a rate, for the contour of rho = 1. */
static void write_rho(FILE *f, const struct sweep_opt *o, const struct found *x)
{
    enum { STEPS = 60 };
    const struct sim_device *d = &o->base.board.device;
    const int window = sweep_window(&o->base);
    for (int j = 0; j <= STEPS; j++) {
        const double b = x->b_top * j / STEPS;
        for (int i = 0; i <= STEPS; i++) {
            const double k = x->k_top * i / STEPS;
            fprintf(f, "%.9g,%.9g,%.9g,%.6f\n", x->rate_Hz, k, b,
                linear_rho(d, 1 / x->rate_Hz, k, b, window));
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
    for (int i = 0; i < n; i++) { fprintf(f, "%s%.6g", i ? " " : "", x[i].k_top); }
    fprintf(f, "'; b_tops='");
    for (int i = 0; i < n; i++) { fprintf(f, "%s%.6g", i ? " " : "", x[i].b_top); }
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

/* "3120 (2980..3290)" */
static const char *peak_text(char text[48], const struct peak *p, int decimals)
{
    strcpy(text, "-");
    if (p->at > 0 && p->open) {
        snprintf(text, 48, ">= %.*f", decimals, p->at);
    } else if (p->at > 0) {
        snprintf(
            text, 48, "%.*f (%.*f..%.*f)", decimals, p->at, decimals, p->low, decimals, p->high);
    }
    return text;
}

static void ratio(
    const char *what, const struct peak *slow, const struct peak *fast, const char *paper)
{
    if (slow->at > 0 && fast->at > 0 && !slow->open && !fast->open) {
        printf("  %-24s %5.1f (%.1f..%.1f)   %s\n", what, fast->at / slow->at,
            fast->low / slow->high, fast->high / slow->low, paper);
    } else {
        printf("  %-24s     -               %s\n", what, paper);
    }
}

static void print(const struct found *x, int n, const struct sweep_opt *o)
{
    const struct found *slow = NULL, *fast = NULL;
    printf(
        "\nThe border at each rate: where half of the falls come to rest, by a logistic fit along "
        "%d lines from the origin, %d points an\noctave of both gains, %d falls a point, each with "
        "the wall at its own position between two counts;\n95 %% interval. Linear model: the "
        "device without steps, friction and limits.\n\n"
        "  rate |    largest stable k      at b |    largest stable b      at k | linear:   k      "
        " b | paper's row\n"
        "    Hz |         N/m              Ns/m |        Ns/m               N/m |       N/m    "
        "Ns/m |     k    b\n",
        o->rays, o->per_octave, o->base.board.falls);
    for (int i = 0; i < n; i++) {
        const struct table2_row *row = table2_at(x[i].rate_Hz);
        char paper[40] = "-", k[48], b[48];
        if (row) { snprintf(paper, sizeof paper, "%5.0f %4.0f", row->k_Npm, row->b_Nspm); }
        printf("%6.6g | %20s %8.1f | %20s %8.0f | %9.0f %7.1f | %s\n", x[i].rate_Hz,
            peak_text(k, &x[i].k, 0), x[i].k.other, peak_text(b, &x[i].b, 1), x[i].b.other,
            x[i].linear.k_Npm, x[i].linear.b_Nspm, paper);
        if (x[i].rate_Hz == 90) { slow = &x[i]; }
        if (x[i].rate_Hz == 2000) { fast = &x[i]; }
    }
    if (!slow || !fast) { return; }
    printf("\nFrom 90 to 2000 Hz         times\n");
    ratio(
        "largest stable k", &slow->k, &fast->k, "paper: nearly 20 in its text, 13.3 in its table");
    ratio("largest stable b", &slow->b, &fast->b,
        "paper: nearly 20 in its text; its table starts at 0");
    if (slow->linear.k_Npm > 0) {
        printf(
            "  %-24s %5.1f\n", "largest k, linear model", fast->linear.k_Npm / slow->linear.k_Npm);
        printf("  %-24s %5.1f\n", "largest b, linear model",
            fast->linear.b_Nspm / slow->linear.b_Nspm);
    }
}

/* What a rate buys, for the picture of it (plot/rate.gp). */
static int write_stiffness(const struct sweep_opt *o, const struct found *x)
{
    FILE *f = outfile_in(o->dir, "stiffness.csv");
    if (f == NULL) { return 1; }
    fprintf(f, "rate_hz,k_n_per_m,k_low_n_per_m,k_high_n_per_m,at_b_ns_per_m,open,linear_k_n_per_m,"
               "paper_k_n_per_m\n");
    for (int i = 0; i < o->rates; i++) {
        const struct table2_row *row = table2_at(x[i].rate_Hz);
        fprintf(f, "%.9g,%.9g,%.9g,%.9g,%.9g,%d,%.9g,", x[i].rate_Hz, x[i].k.at, x[i].k.low,
            x[i].k.high, x[i].k.other, x[i].k.open, x[i].linear.k_Npm);
        if (row) { fprintf(f, "%.9g", row->k_Npm); }
        fputc('\n', f);
    }
    return outfile_close(f);
}

int plane_report(const struct cells *cells, const struct sweep_opt *o, const struct reach *reach)
{
    struct found *x = calloc((size_t)o->rates, sizeof *x);
    FILE *border_f = outfile_in(o->dir, "border.csv"), *rho_f = outfile_in(o->dir, "rho.csv");
    FILE *gp = outfile_in(o->dir, "sweep.gp");
    int err = x == NULL || border_f == NULL || rho_f == NULL || gp == NULL;
    if (err == 0) {
        fprintf(border_f, "rate_hz,ray,k_n_per_m,b_ns_per_m,k_low_n_per_m,b_low_ns_per_m,"
                          "k_high_n_per_m,b_high_ns_per_m,open\n");
        for (int i = 0; i < o->rates; i++) {
            x[i] = find(cells, o, i, reach[i], border_f);
            write_rho(rho_f, o, &x[i]);
        }
        write_picture(gp, x, o->rates);
        err |= write_stiffness(o, x);
        print(x, o->rates, o);
    }
    err |= outfile_end(border_f, !err) | outfile_end(rho_f, !err) | outfile_end(gp, !err);
    free(x);
    return err;
}
