/* SPDX-License-Identifier: MIT */
#include "lab/drop/friction.h"

#include "base/jobs.h"
#include "base/option.h"
#include "base/outfile.h"
#include "box/table2.h"
#include "lab/drop/ray.h"

#include "sim/linear.h"

#include <stdlib.h>
#include <string.h>

#define GAIN_FIRST 0.1 /* of the paper's gains */
#define GAIN_MOST  20  /* of the linear test */

enum kind { BOTH, DRY, VISCOUS, KINDS };
static const char *const kind_name[] = {"all", "dry", "viscous"};
static const char *const kind_text[] = {
    "all friction", "dry friction alone, viscous as it is", "viscous friction alone, dry as it is"};

struct plan {
    const struct sweep_opt *o;
    int points;
};

struct limit {
    int done, error, kind, rate_i;
    double scale;
    struct ray_border border; /* gains, of the paper's */
    double linear;            /* the largest with rho < 1 */
};

static struct sim_device with_friction(const struct sim_device *d, int kind, double scale)
{
    struct sim_device f = *d;
    if (kind != VISCOUS) {
        f.mu_motor *= scale;
        f.mu_mass *= scale;
        f.coulomb_n *= scale;
    }
    if (kind != DRY) { f.viscous_nspm *= scale; }
    return f;
}

static int run_at(void *ctx, const struct ray *r, double gain, int *rest, int *falls)
{
    const struct run_cfg *base = ctx;
    *falls = base->board.falls;
    *rest = study_rest(base, r->rate_Hz, gain * r->k_Npm, gain * r->b_Nspm);
    return *rest < 0 ? *rest : 0;
}

static double linear_limit(const struct run_cfg *base, double rate_Hz)
{
    const struct table2_row *row = table2_gains(rate_Hz);
    const int window = sweep_window(base);
    double below = 0, above = GAIN_MOST;
    for (double g = 0.02; g < GAIN_MOST; g *= 1.02) {
        const double rho =
            linear_rho(&base->board.device, 1 / rate_Hz, g * row->k_Npm, g * row->b_Nspm, window);
        above = g;
        if (!(rho >= 0 && rho < 1)) { break; }
        below = g;
    }
    return below > 0 ? (below + above) / 2 : 0;
}

static void work(const void *ctx, int i, void *result)
{
    const struct plan *plan = ctx;
    const struct sweep_opt *o = plan->o;
    struct run_cfg base = o->base;
    const struct table2_row *row = table2_gains(o->rate_Hz[i / plan->points % o->rates]);
    const struct ray through = {o->rate_Hz[i / plan->points % o->rates], row->k_Npm, row->b_Nspm,
        GAIN_FIRST, o->per_octave};
    struct limit x;
    memset(&x, 0, sizeof x);
    x.kind = i / (o->rates * plan->points);
    x.rate_i = i / plan->points % o->rates;
    x.scale = 2.0 * (i % plan->points) / (plan->points - 1);
    base.board.device = with_friction(&o->base.board.device, x.kind, x.scale);
    x.border = ray_border(&through, run_at, &base);
    x.done = x.border.error == 0;
    x.error = x.border.error == -1;
    x.linear = linear_limit(&base, o->rate_Hz[x.rate_i]);
    memcpy(result, &x, sizeof x);
}

/* --- results --- */

static void print(const struct sweep_opt *o, const struct limit *x, int points)
{
    printf(
        "\nThe border on the line through the paper's gains, in multiples of these, against "
        "friction\n"
        "(where half of the falls rest, %d falls at each of %d gains an octave; -: at no gain from "
        "%.1f up; >=: at\nthe last gain that the scene takes; 95 %% intervals: friction.csv)\n",
        o->base.board.falls, o->per_octave, GAIN_FIRST);
    for (int kind = 0; kind < KINDS; kind++) {
        printf("\n%-38s", kind_text[kind]);
        for (int r = 0; r < o->rates; r++) { printf(" %6.6g Hz", o->rate_Hz[r]); }
        printf("\n");
        for (int p = 0; p < points; p++) {
            printf("  times %-30.4g", 2.0 * p / (points - 1));
            for (int r = 0; r < o->rates; r++) {
                const struct limit *l = &x[(kind * o->rates + r) * points + p];
                char text[16];
                snprintf(text, sizeof text, "%s%.2f",
                    l->border.status == LOGISTIC_OPEN ? ">= " : "", l->border.gain);
                if (l->border.status != LOGISTIC_NONE) {
                    printf(" %9s", text);
                } else {
                    printf("         -");
                }
            }
            printf("\n");
        }
    }
}

static void write_csv(FILE *f, const struct sweep_opt *o, const struct limit *x, int n)
{
    fprintf(f, "friction,rate_hz,times,gain,gain_low,gain_high,open,gain_linear\n");
    for (int i = 0; i < n; i++) {
        const struct ray_border *b = &x[i].border;
        char border[64] = ",,";
        if (b->status != LOGISTIC_NONE) {
            snprintf(border, sizeof border, "%.6g,%.6g,%.6g", b->gain, b->low, b->high);
        }
        fprintf(f, "%s,%.9g,%.6g,%s,%d,%.6g\n", kind_name[x[i].kind], o->rate_Hz[x[i].rate_i],
            x[i].scale, border, b->status == LOGISTIC_OPEN, x[i].linear);
    }
}

static void write_picture(FILE *f, const struct sweep_opt *o)
{
    fprintf(f, "# Made by exhand drop --friction. Inside this directory, PLOTS the way to "
               "ports/posix/plot:\n#   gnuplot -c friction.gp PLOTS\nplots=ARG1\n"
               "out='friction.png'; data='friction.csv'; rates='");
    for (int i = 0; i < o->rates; i++) { fprintf(f, "%s%.6g", i ? " " : "", o->rate_Hz[i]); }
    fprintf(f, "'\nload plots.'/friction.gp'\n");
}

static int write_files(const struct sweep_opt *o, const struct limit *x, int n)
{
    static const char *const name[] = {"friction.csv", "friction.gp"};
    for (int i = 0; i < 2; i++) {
        FILE *f = outfile_in(o->dir, name[i]);
        if (f == NULL) { return 1; }
        if (i == 0) {
            write_csv(f, o, x, n);
        } else {
            write_picture(f, o);
        }
        if (outfile_close(f)) { return 1; }
    }
    return 0;
}

int friction_run(const struct sweep_opt *o, int points)
{
    const struct plan plan = {o, points};
    const int n = KINDS * o->rates * points;
    struct limit *x = calloc((size_t)n, sizeof *x);
    const struct jobs jobs = {n, o->jobs, sizeof *x, x, work, &plan, "rays", posix_interrupt};
    int status;

    if (x == NULL) {
        cli_complain("out of memory: a smaller --friction");
        return 1;
    }
    status = sweep_open_dir(o->dir, "friction");
    if (status == 0) { status = jobs_run(&jobs); }
    for (int i = 0; i < n && status == 0; i++) { status = !x[i].done; }
    if (status == JOBS_INTERRUPTED) {
        cli_complain("interrupted: --friction keeps nothing of what it has run");
    }
    if (status == 0) {
        print(o, x, points);
        status = write_files(o, x, n);
    }
    free(x);
    return status;
}
