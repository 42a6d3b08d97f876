/* SPDX-License-Identifier: MIT */
#include "lab/drop/border.h"

#include "base/jobs.h"
#include "base/option.h"
#include "base/outfile.h"
#include "box/table2.h"

#include "sim/linear.h"
#include "lab/drop/reach.h"
#include "sim/plant.h"

#include <stdlib.h>
#include <string.h>

#define TICKS     2500  /* watched when let go: 0.995^2500 = 4e-6 */
#define OFFSET    0.2   /* let go this share of the penetration above rest */
#define NEAR      0.005 /* |rho - 1| below this is on the border */
#define AGREE_MIN 0.99
#define DROPS     3 /* falls a cell of the second table */
#define SETTINGS  80
#define OVER      1.5 /* the agreement's grid, times the linear border */
#define WIDE      2.6 /* how far friction moves the border at most, and more */
#define HIGH      1.6

/* What the scene and the device take. */
#define K_MAX_NPM     1e6
#define B_MAX_NSPM    1e3
#define Q_LIM_MAX_M   1.0
#define OBSERVE_MAX_S 100

enum part { FRICTION = 1, SATURATION = 2, STEPS = 4, PULLBACK = 8, ALL = 15 };
enum start { LET_GO, DROPPED, STARTS };

static const struct {
    unsigned parts;
    const char *name, *what;
} variant[] = {
    {0, "none", "none of these"},
    {FRICTION, "friction", "dry friction"},
    {SATURATION, "saturation", "peak current"},
    {STEPS, "steps", "encoder, D/A and monitor steps, noise"},
    {PULLBACK, "pullback", "pull-back force F0"},
    {ALL, "all", "all: the device"},
};
#define VARIANTS ((int)(sizeof variant / sizeof variant[0]))

/* Runs 0.. are the agreement's grid at each rate, then each start and variant's. */
struct plan {
    const struct sweep_opt *o;
    double *k_top, *b_top; /* of the linear border, per rate */
    int columns, rows;     /* of the second table's grid */
};

struct check {
    int done, error, rate_i, variant, start, agreement;
    double k_Npm, b_Nspm, rho;
    int stable;
};

/* The device with only these parts of it switched on. */
static void switch_parts(struct run_cfg *c, unsigned parts, struct run_setting *set)
{
    struct sim_device *d = &c->board.device;
    memcpy(set, c->setting, (size_t)c->settings * sizeof *set);
    c->setting = set;
    if (!(parts & FRICTION)) { d->mu_motor = d->mu_mass = d->coulomb_n = 0; }
    if (!(parts & SATURATION)) {
        d->kf_npa = 15; /* 99 N at the 6.6 A that are the most the scene takes */
        d->peak_a = 20;
        set[c->settings++] = (struct run_setting){"f_max", 100};
        set[c->settings++] = (struct run_setting){"slew_up", 1e7};
        set[c->settings++] = (struct run_setting){"slew_down", 1e7};
    }
    if (!(parts & STEPS)) {
        d->step_m = 1e-6;
        d->decode = 1;
        d->mon_noise_a = 0;
    }
    if (!(parts & PULLBACK)) { set[c->settings++] = (struct run_setting){"f0", 0}; }
}

/* Held on the wall, the string as taut as the weight makes it. */
static void let_go(struct run_cfg *c, struct run_setting *set)
{
    struct sim_device *d = &c->board.device;
    const double weight_N = d->mass_kg * SIM_GRAVITY;
    const double rest_m = weight_N / c->k_Npm;
    c->board.falls = 1;
    c->board.from_here = 1;
    c->board.from_q_m = (1 - OFFSET) * rest_m;
    c->board.from_x_m = c->board.from_q_m + weight_N / d->cable_npm;
    set[c->settings++] = (struct run_setting){"q_lim", -c->board.from_q_m};
    set[c->settings++] = (struct run_setting){"arm_force", 10}; /* the wall carries it already */
    d->observe_s = (double)TICKS / c->rate_Hz;
    if (d->observe_s < 1) { d->observe_s = 1; }
}

static struct check plan_cell(const struct plan *p, int i)
{
    const struct sweep_opt *o = p->o;
    const int agreement = o->rates * o->columns * o->rows;
    struct check x;
    int columns = p->columns, rows = p->rows, cell = i;
    double wide = WIDE, high = HIGH;

    memset(&x, 0, sizeof x);
    x.agreement = i < agreement;
    if (x.agreement) {
        columns = o->columns;
        rows = o->rows;
        wide = high = OVER;
    } else {
        cell = (i - agreement) / (STARTS * VARIANTS);
        x.variant = (i - agreement) / STARTS % VARIANTS;
        x.start = (i - agreement) % STARTS;
    }
    x.rate_i = cell / (columns * rows);
    x.k_Npm = wide * p->k_top[x.rate_i] * (cell % columns + 1) / columns;
    x.b_Nspm = high * p->b_top[x.rate_i] * (cell / columns % rows) / (rows - 1);
    return x;
}

static void work(const void *ctx, int i, void *result)
{
    const struct plan *p = ctx;
    struct run_setting set[SETTINGS];
    struct check x = plan_cell(p, i);
    struct run_cfg c = p->o->base;
    struct table2_result r;

    c.rate_Hz = (uint32_t)(p->o->rate_Hz[x.rate_i] + 0.5);
    c.k_Npm = x.k_Npm;
    c.b_Nspm = x.b_Nspm;
    c.board.falls = DROPS;
    c.board.seed = study_seed(c.board.seed, c.rate_Hz, x.k_Npm, x.b_Nspm, i);
    switch_parts(&c, variant[x.variant].parts, set);
    if (x.start == LET_GO) { let_go(&c, set); }
    if (x.agreement) {
        if (c.board.device.substep_s > 10e-6) { c.board.device.substep_s = 10e-6; }
        c.board.device.servo_hz = 100000; /* no phase of chance: the delay is the test's */
        c.board.device.delay_s += 0.5 / p->o->base.board.device.servo_hz - 0.5 / 100000;
    }
    r = table2_measure(&c, NULL, TABLE2_REST);
    x.error = r.error;
    x.done = r.done && !r.error;
    x.stable = !r.faults && 10 * (r.falls - r.oscillating - r.incomplete) >= 9 * r.falls;
    x.rho = linear_rho(&p->o->base.board.device, 1 / p->o->rate_Hz[x.rate_i], x.k_Npm, x.b_Nspm,
        sweep_window(&p->o->base));
    memcpy(result, &x, sizeof x);
}

/* --- results --- */

static int linear(const struct check *x) { return x->rho >= 0 && x->rho < 1; }

static int print_agreement(const struct plan *p, const struct check *x, int n)
{
    const struct sweep_opt *o = p->o;
    int all[2] = {0, 0};
    printf(
        "\nLet go a fifth above rest, %d ticks: comes to rest, and rho < 1?\n"
        "(no dry friction, saturation, steps, pull-back; %d x %d cells over 1.5 times the linear "
        "border)\n\n"
        "  rate | cells | |rho - 1| >= %.3f: agree        | nearer: agree\n",
        TICKS, o->columns, o->rows, NEAR);
    for (int r = 0; r < o->rates; r++) {
        int away[2] = {0, 0}, near[2] = {0, 0};
        for (int i = 0; i < n; i++) {
            const double off = x[i].rho < 1 ? 1 - x[i].rho : x[i].rho - 1;
            const int agree = x[i].stable == linear(&x[i]);
            int *to = off < NEAR ? near : away;
            if (!x[i].agreement || x[i].rate_i != r || x[i].rho < 0) { continue; }
            to[0]++;
            to[1] += agree;
        }
        printf("%6.6g | %5d | %5d of %5d = %6.2f %%       | %4d of %4d\n", o->rate_Hz[r],
            away[0] + near[0], away[1], away[0], away[0] ? 100.0 * away[1] / away[0] : 0, near[1],
            near[0]);
        all[0] += away[0];
        all[1] += away[1];
    }
    printf("   all |       | %5d of %5d = %6.2f %% (>= %.0f %%)\n", all[1], all[0],
        all[0] ? 100.0 * all[1] / all[0] : 0, 100 * AGREE_MIN);
    return all[0] > 0 && all[1] >= AGREE_MIN * all[0];
}

static void print_parts(const struct plan *p, const struct check *x, int n, int start)
{
    if (start == LET_GO) {
        printf(
            "\nThe same with one of these switched on, alone: cells at rest, in %% of those with "
            "rho < 1\n(in brackets: at rest though rho >= 1, not at rest though rho < 1; %d x %d "
            "cells "
            "over 2.6 times\nthe linear k and 1.6 times b)\n\n%-38s",
            p->columns, p->rows, "");
    } else {
        printf("\nThe same dropped from the height, %d falls a cell: the string goes slack, force "
               "only "
               "pulls\n\n%-38s",
            DROPS, "");
    }
    for (int r = 0; r < p->o->rates; r++) { printf(" %9.6g Hz   ", p->o->rate_Hz[r]); }
    printf("\n");
    for (int v = 0; v < VARIANTS; v++) {
        printf("%-38s", variant[v].what);
        for (int r = 0; r < p->o->rates; r++) {
            int rest = 0, within = 0, won = 0, lost = 0;
            char text[32];
            for (int i = 0; i < n; i++) {
                if (x[i].agreement || x[i].rate_i != r || x[i].variant != v ||
                    x[i].start != start) {
                    continue;
                }
                rest += x[i].stable;
                within += linear(&x[i]);
                won += x[i].stable && !linear(&x[i]);
                lost += !x[i].stable && linear(&x[i]);
            }
            snprintf(text, sizeof text, "%4.0f (+%d -%d)", within ? 100.0 * rest / within : 0, won,
                lost);
            printf(" %-14s", text);
        }
        printf("\n");
    }
}

static int write_csv(const struct plan *p, const struct check *x, int n)
{
    FILE *f = outfile_in(p->o->dir, "check.csv");
    if (f == NULL) { return 1; }
    fprintf(f, "table,start,switched_on,rate_hz,k_n_per_m,b_ns_per_m,rho,stable\n");
    for (int i = 0; i < n; i++) {
        fprintf(f, "%s,%s,%s,%.9g,%.9g,%.9g,%.6f,%d\n", x[i].agreement ? "agreement" : "parts",
            x[i].start == LET_GO ? "let_go" : "dropped", variant[x[i].variant].name,
            p->o->rate_Hz[x[i].rate_i], x[i].k_Npm, x[i].b_Nspm, x[i].rho, x[i].stable);
    }
    return outfile_close(f);
}

/* Whether both grids can be run at a rate: 0, or 2 after a line on stderr. */
static int refuse(const struct plan *p, int rate_i)
{
    const struct sweep_opt *o = p->o;
    const double rate_Hz = o->rate_Hz[rate_i], k_top = p->k_top[rate_i], b_top = p->b_top[rate_i];
    const double k_agree = OVER * k_top / o->columns, k_parts = WIDE * k_top / p->columns;
    const double k_least = k_agree < k_parts ? k_agree : k_parts;
    const double hang_m = (1 - OFFSET) * o->base.board.device.mass_kg * SIM_GRAVITY / k_least;
    if (hang_m > Q_LIM_MAX_M) {
        cli_complain(
            "--border-check: %.6g Hz: at k = %.3g N/m the mass would hang %.3g m deep, the scene "
            "takes %.0f m: a higher --rate, fewer columns in --grid",
            rate_Hz, k_least, hang_m, Q_LIM_MAX_M);
        return 2;
    }
    if (WIDE * k_top > K_MAX_NPM || HIGH * b_top > B_MAX_NSPM) {
        cli_complain(
            "--border-check: %.6g Hz: the grid would reach k = %.3g N/m, b = %.3g Ns/m, the scene "
            "takes %.0f, %.0f: a lower --rate",
            rate_Hz, WIDE * k_top, HIGH * b_top, K_MAX_NPM, B_MAX_NSPM);
        return 2;
    }
    return 0;
}

/* 0 with the tops of all rates, or 2 after a line on stderr. */
static int plan_rates(struct plan *p)
{
    const struct sweep_opt *o = p->o;
    for (int r = 0; r < o->rates; r++) {
        if (TICKS / o->rate_Hz[r] > OBSERVE_MAX_S) {
            cli_complain(
                "--border-check: %.6g Hz: watches %d ticks, at most %d s: --rate %d or higher",
                o->rate_Hz[r], TICKS, OBSERVE_MAX_S, TICKS / OBSERVE_MAX_S);
            return 2;
        }
        const struct reach reach =
            reach_of(&o->base.board.device, o->rate_Hz[r], sweep_window(&o->base));
        p->k_top[r] = reach.k_Npm;
        p->b_top[r] = reach.b_Nspm;
        if (!(reach.k_Npm > 0)) {
            cli_complain(
                "--border-check: %.6g Hz: no linear border, rho < 1 nowhere, or the delay is too "
                "long to tell: another --rate or --device",
                o->rate_Hz[r]);
            return 2;
        }
        if (refuse(p, r)) { return 2; }
    }
    return 0;
}

int border_check(const struct sweep_opt *o)
{
    double top[2][64];
    struct plan p = {o, top[0], top[1], (3 * o->columns + 3) / 4, (o->rows + 3) / 2};
    const int n = o->rates * (o->columns * o->rows + STARTS * VARIANTS * p.columns * p.rows);
    struct check *x = calloc((size_t)n, sizeof *x);
    const struct jobs jobs = {n, o->jobs, sizeof *x, x, work, &p, "cells", posix_interrupt};
    int status, agree = 0;

    if (x == NULL) {
        cli_complain("out of memory");
        return 1;
    }
    if (plan_rates(&p) || (o->dir != NULL && sweep_open_dir(o->dir, "border-check"))) {
        free(x);
        return 2;
    }
    status = jobs_run(&jobs);
    for (int i = 0; i < n && status == 0; i++) { status = !x[i].done; }
    if (status == JOBS_INTERRUPTED) {
        cli_complain("interrupted: --border-check keeps nothing of what it has run");
    }
    if (status == 0) {
        agree = print_agreement(&p, x, n);
        print_parts(&p, x, n, LET_GO);
        print_parts(&p, x, n, DROPPED);
        if (o->dir != NULL) { status = write_csv(&p, x, n); }
        if (!agree) { cli_complain("--border-check: fewer than %.0f %% agree", 100 * AGREE_MIN); }
    }
    free(x);
    return status ? status : !agree;
}
