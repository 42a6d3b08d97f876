/* SPDX-License-Identifier: MIT */
#include "lab/drop/friction.h"

#include "base/jobs.h"
#include "base/option.h"
#include "box/table2.h"

#include "sim/linear.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define GAIN_FIRST 0.1 /* of the paper's gains: the ray is climbed from here */
#define GAIN_STEP  1.25
#define GAIN_MOST  20
#define K_MAX_NPM  1e6 /* what the scene takes */
#define B_MAX_NSPM 1e3
#define HALVINGS   3

enum kind { BOTH, DRY, VISCOUS, KINDS };
static const char *const kind_name[] = {"all", "dry", "viscous"};
static const char *const kind_text[] = {
    "all friction", "dry friction alone, viscous as it is", "viscous friction alone, dry as it is"};

struct ray {
    const struct sweep_opt *o;
    int points;
};

struct limit {
    int done, error, kind, rate_i;
    double scale;
    double stable, unstable; /* gains, of the paper's; 0: at rest at none tried */
    int open;                /* the ray ended first: there is no unstable */
    double linear;           /* the largest with rho < 1 */
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

/* 1, 0, or < 0: interrupted, or a run failed. */
static int rests(const struct run_cfg *base, double rate_Hz, double gain, struct limit *x)
{
    const struct table2_row *row = table2_gains(rate_Hz);
    int error;
    const struct cell c = sweep_cell(base, rate_Hz, gain * row->k_Npm, gain * row->b_Nspm, &error);
    if (error > 0) { x->error = 1; }
    return error ? -1 : cell_stable(&c);
}

/* The ray ends where the scene would refuse k or b. */
static double gain_most(double rate_Hz)
{
    const struct table2_row *row = table2_gains(rate_Hz);
    double most = GAIN_MOST;
    if (row->k_Npm * most > K_MAX_NPM) { most = K_MAX_NPM / row->k_Npm; }
    if (row->b_Nspm * most > B_MAX_NSPM) { most = B_MAX_NSPM / row->b_Nspm; }
    return most;
}

/* As on a line of the sweep: from the first gain at rest up to the first that is not. */
static void climb(const struct run_cfg *base, double rate_Hz, struct limit *x)
{
    const double most = gain_most(rate_Hz);
    double gain = GAIN_FIRST;
    int stable = 0;
    for (; gain < most; gain *= GAIN_STEP) {
        stable = rests(base, rate_Hz, gain, x);
        if (stable < 0 || (stable == 0 && x->stable > 0)) { break; }
        if (stable == 1) { x->stable = gain; }
    }
    x->unstable = gain;
    x->open = gain >= most;
    for (int i = 0; i < HALVINGS && x->stable > 0 && stable >= 0 && !x->open; i++) {
        const double mid = (x->stable + x->unstable) / 2;
        stable = rests(base, rate_Hz, mid, x);
        if (stable == 1) {
            x->stable = mid;
        } else {
            x->unstable = mid;
        }
    }
    x->done = stable >= 0;
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
    const struct ray *ray = ctx;
    const struct sweep_opt *o = ray->o;
    struct run_cfg base = o->base;
    struct limit x;
    memset(&x, 0, sizeof x);
    x.kind = i / (o->rates * ray->points);
    x.rate_i = i / ray->points % o->rates;
    x.scale = 2.0 * (i % ray->points) / (ray->points - 1);
    base.board.device = with_friction(&o->base.board.device, x.kind, x.scale);
    climb(&base, o->rate_Hz[x.rate_i], &x);
    x.linear = linear_limit(&base, o->rate_Hz[x.rate_i]);
    memcpy(result, &x, sizeof x);
}

/* --- what came out --- */

static void print(const struct sweep_opt *o, const struct limit *x, int points)
{
    printf("\nThe border along the ray through the paper's point, in its gains, against friction\n"
           "(%d falls a cell; -: at rest at no gain from %.1f up; >=: at rest at the last gain "
           "tried)\n",
        o->base.board.falls, GAIN_FIRST);
    for (int kind = 0; kind < KINDS; kind++) {
        printf("\n%-38s", kind_text[kind]);
        for (int r = 0; r < o->rates; r++) { printf(" %6.6g Hz", o->rate_Hz[r]); }
        printf("\n");
        for (int p = 0; p < points; p++) {
            printf("  times %-30.4g", 2.0 * p / (points - 1));
            for (int r = 0; r < o->rates; r++) {
                const struct limit *l = &x[(kind * o->rates + r) * points + p];
                char text[16];
                snprintf(text, sizeof text, "%s%.2f", l->open ? ">= " : "", l->stable);
                if (l->stable > 0) {
                    printf(" %9s", text);
                } else {
                    printf("         -");
                }
            }
            printf("\n");
        }
    }
}

static int write_csv(FILE *f, const struct sweep_opt *o, const struct limit *x, int n)
{
    fprintf(f, "friction,rate_hz,times,gain_stable,gain_unstable,gain_linear\n");
    for (int i = 0; i < n; i++) {
        char unstable[24] = "";
        if (!x[i].open) { snprintf(unstable, sizeof unstable, "%.6g", x[i].unstable); }
        fprintf(f, "%s,%.9g,%.6g,%.6g,%s,%.6g\n", kind_name[x[i].kind], o->rate_Hz[x[i].rate_i],
            x[i].scale, x[i].stable, unstable, x[i].linear);
    }
    return ferror(f);
}

static int write_picture(FILE *f, const struct sweep_opt *o)
{
    fprintf(f, "# Made by exhand drop --friction. Inside this directory, PLOTS the way to "
               "ports/posix/plot:\n#   gnuplot -c friction.gp PLOTS\nplots=ARG1\n"
               "out='friction.png'; data='friction.csv'; rates='");
    for (int i = 0; i < o->rates; i++) { fprintf(f, "%s%.6g", i ? " " : "", o->rate_Hz[i]); }
    fprintf(f, "'\nload plots.'/friction.gp'\n");
    return ferror(f);
}

static int write_files(const struct sweep_opt *o, const struct limit *x, int n)
{
    static const char *const name[] = {"friction.csv", "friction.gp"};
    for (int i = 0; i < 2; i++) {
        char path[TABLE2_PATH_B];
        FILE *f;
        int bad;
        snprintf(path, sizeof path, "%s/%s", o->dir, name[i]);
        f = fopen(path, "w");
        if (f == NULL) {
            cli_complain("%s: %s", path, strerror(errno));
            return 1;
        }
        bad = i == 0 ? write_csv(f, o, x, n) : write_picture(f, o);
        if (fclose(f) != 0 || bad) {
            cli_complain("%s: can't be written", path);
            return 1;
        }
    }
    return 0;
}

int friction_run(const struct sweep_opt *o, int points)
{
    const struct ray ray = {o, points};
    const int n = KINDS * o->rates * points;
    struct limit *x = calloc((size_t)n, sizeof *x);
    const struct jobs jobs = {n, o->jobs, sizeof *x, x, work, &ray, "rays", posix_interrupt};
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
