/* SPDX-License-Identifier: MIT */
/* How do Table II and the time until rest change if the simulator's plant is integrated in another
 * way?
 *
 *   statistics [--short] [RUNS]
 *   statistics [--short] count
 *
 * The first runs the whole simulator and the real scene with the paper's rows and ten falls a run.
 * plant_advance_piece() is replaced by that of this folder. For each method, step and row it prints
 *   method,step_s,rate_Hz,runs,b_Npm,b_se,rest_s,rest_se,rest,oscillates
 * b_Npm is the mean stiffness of the runs, as `exhand drop` reads it; b_se is its standard error.
 * rest_s is the time from the first contact of a fall until motor and force stay within the bounds
 * of "at rest", over the falls that come to rest. rest is their share. oscillates is the share at
 * 1.5 times both gains. RUNS runs are at the gains and half as many at 1.5 times. All methods have
 * the same seeds.
 *
 * count is for callgrind. It runs a fall at 500 Hz twice by each method and step, since the first
 * run includes one-time work, and prints method,step_s,seconds. */
#include "method.h"

#include "base/jobs.h"
#include "box/run.h"
#include "box/table2.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FALLS   10
#define SEED    501
#define RUN_MAX 200
#define CELLS   64

static struct cell {
    enum method method;
    double step_s;
} cell[CELLS];
static int cells;

/* --- the simulator's plant, from here --- */

static enum method now;

void plant_advance(struct plant *p, const struct sim_device *d, double dt_s, double ref_A, int held)
{
    if (held) {
        leapfrog_hold(p, d, dt_s, ref_A);
        return;
    }
    method_advance(now, p, d, dt_s, ref_A, NULL);
}

void plant_advance_piece(
    struct plant *p, const struct sim_device *d, const struct plant_piece *s, double ref_A)
{
    method_advance(now, p, d, s->n * s->h_s, ref_A, NULL);
}

void plant_advance_hand_piece(struct plant *p, const struct sim_device *d,
    const struct plant_piece *s, double ref_A, const struct plant_hand *hand)
{
    method_advance(now, p, d, s->n * s->h_s, ref_A, hand);
}

/* --- a run --- */

struct result {
    int bad, falls, resting, oscillating;
    double b_Npm, rest_s; /* the latter the mean of those that rest */
};

/* From the contact to the first sample from which on both keep within the bounds; < 0: they never
 * do. */
static double rest_time(const struct fall_log *log, size_t first, size_t end, double until_s)
{
    const struct fall_rest_opt *const o = &fall_rest_opt_default;
    double q_lo = 1e9, q_hi = -1e9, f_lo = 1e9, f_hi = -1e9;
    size_t i = end;
    while (i > first && log->sample[i - 1].t_s > until_s) { i--; }
    for (; i > first; i--) {
        const struct fall_sample *s = &log->sample[i - 1];
        if (s->q_m < q_lo) { q_lo = s->q_m; }
        if (s->q_m > q_hi) { q_hi = s->q_m; }
        if (s->f_mon_N < f_lo) { f_lo = s->f_mon_N; }
        if (s->f_mon_N > f_hi) { f_hi = s->f_mon_N; }
        if (q_hi - q_lo > o->travel_m || f_hi - f_lo > o->force_N) { break; }
    }
    return i < end ? log->sample[i].t_s - log->sample[first].t_s : -1;
}

static void judge(const struct run *run, const struct sim_device *d, struct result *r)
{
    struct fall_rest rest[FALLS];
    struct fall_rest_opt opt = fall_rest_opt_default;
    struct fall_contacts contacts;
    struct fall_stiffness stiffness;
    opt.observe_s = d->observe_s;
    opt.encoder_step_m = d->step_m / d->decode;
    r->falls = (int)run->log.falls;
    if (r->falls > FALLS || fall_dissect(&run->log, 1, &contacts) != FALL_OK) {
        r->bad = 1;
        return;
    }
    r->bad |= fall_rest(&run->log, &contacts, &opt, rest) != FALL_OK;
    for (size_t i = contacts.n; !r->bad && i-- > 0;) {
        const size_t fall = contacts.at[i].fall;
        const size_t end = fall + 1 < run->log.falls ? run->log.start[fall + 1] : run->log.samples;
        double s;
        if (i > 0 && contacts.at[i - 1].fall == fall) { continue; } /* not its first */
        r->oscillating += rest[fall].rest == FALL_OSCILLATES;
        if (rest[fall].rest != FALL_AT_REST && rest[fall].rest != FALL_BUZZ) { continue; }
        s = rest_time(&run->log, contacts.at[i].first, end, rest[fall].t_contact_s + opt.observe_s);
        r->resting++;
        r->rest_s += s;
    }
    fall_contacts_free(&contacts);
    if (r->resting) { r->rest_s /= r->resting; }
    if (fall_stiffness(&run->log, &fall_opt_default, &stiffness) == FALL_OK) {
        r->b_Npm = stiffness.fit.status == FALL_OK ? stiffness.fit.b_Npm : 0;
    }
    fall_stiffness_free(&stiffness);
}

struct plan {
    int runs, half; /* at the gains, at 1.5 times both */
};

static int per_row(const struct plan *p) { return p->runs + p->half; }

static void work(const void *ctx, int i, void *to)
{
    const struct plan *p = ctx;
    const int run_i = i % per_row(p), row = i / per_row(p) % TABLE2_ROWS;
    const struct cell *at = &cell[i / per_row(p) / TABLE2_ROWS];
    const double scale = run_i < p->runs ? 1 : 1.5;
    struct result r;
    struct run_cfg c;
    struct run run;
    memset(&c, 0, sizeof c);
    memset(&r, 0, sizeof r);
    now = at->method;
    c.all = 1; /* a state of rest is that of the simulator's own method */
    c.rate_Hz = (uint32_t)table2_paper[row].rate_Hz;
    c.k_Npm = table2_paper[row].k_Npm * scale;
    c.b_Nspm = table2_paper[row].b_Nspm * scale;
    c.board = posix_config_default();
    c.board.device.substep_s = at->step_s;
    c.board.seed = SEED + (uint64_t)(run_i % p->runs);
    c.board.falls = FALLS;
    r.bad = run_drop(&c, &run) < 0;
    if (!r.bad) { judge(&run, &c.board.device, &r); }
    run_free(&run);
    memcpy(to, &r, sizeof r);
}

/* --- all of them --- */

static double root_of(double v)
{
    double r = v > 1 ? v : 1;
    for (int i = 0; v > 0 && i < 200; i++) { r = 0.5 * (r + v / r); }
    return v > 0 ? r : 0;
}

struct mean {
    double sum, squares;
    int n;
};

static void add(struct mean *m, double v)
{
    m->sum += v;
    m->squares += v * v;
    m->n++;
}

static double mean_of(const struct mean *m) { return m->n ? m->sum / m->n : 0; }

static double error_of(const struct mean *m)
{
    const double at = mean_of(m);
    return m->n > 1 ? root_of((m->squares / m->n - at * at) / (m->n - 1)) : 0;
}

static int line(const struct plan *p, const struct cell *at, int row, const struct result *r)
{
    struct mean b = {0, 0, 0}, rest = {0, 0, 0};
    int falls[2] = {0, 0}, resting = 0, oscillating = 0, bad = 0;
    for (int i = 0; i < per_row(p); i++) {
        bad |= r[i].bad;
        falls[i >= p->runs] += r[i].falls;
        if (i >= p->runs) {
            oscillating += r[i].oscillating;
            continue;
        }
        resting += r[i].resting;
        if (r[i].b_Npm > 0) { add(&b, r[i].b_Npm); }
        if (r[i].resting) { add(&rest, r[i].rest_s); }
    }
    printf("%s,%.9g,%g,%d,%.1f,%.1f,%.4f,%.4f,%.4f,%.4f\n", method_name[at->method], at->step_s,
        table2_paper[row].rate_Hz, p->runs, mean_of(&b), error_of(&b), mean_of(&rest),
        error_of(&rest), (double)resting / falls[0], (double)oscillating / falls[1]);
    return bad;
}

/* In short the first of each method. */
static void cells_of(int brief)
{
    static const struct cell all[] = {
        {METHOD_EXPLICIT, 125e-6},
        {METHOD_EXPLICIT, 62.5e-6},
        {METHOD_SEMI, 250e-6},
        {METHOD_SEMI, 62.5e-6},
        {METHOD_SEMI, 25e-6},
        {METHOD_SEMI, 12.5e-6},
        {METHOD_SEMI, 5e-6},
        {METHOD_LEAPFROG, 250e-6},
        {METHOD_LEAPFROG, 125e-6},
        {METHOD_MIDPOINT, 250e-6},
        {METHOD_MIDPOINT, 125e-6},
        {METHOD_RK4, 250e-6},
        {METHOD_RK4, 125e-6},
        {METHOD_FLOW, 250e-6},
    };
    for (int i = 0; i < (int)(sizeof all / sizeof all[0]); i++) {
        if (brief && i > 0 && all[i].method == all[i - 1].method) { continue; }
        cell[cells++] = all[i];
    }
}

void one_fall(const struct cell *at, double *seconds);

__attribute__((noinline)) void one_fall(const struct cell *at, double *seconds)
{
    struct run_cfg c;
    struct run run;
    memset(&c, 0, sizeof c);
    now = at->method;
    c.all = 1;
    c.rate_Hz = 500;
    c.k_Npm = 6000;
    c.b_Nspm = 20;
    c.board = posix_config_default();
    c.board.device.substep_s = at->step_s;
    c.board.device.observe_s = 0.6;
    c.board.falls = 1;
    if (run_drop(&c, &run) < 0) { exit(1); }
    *seconds = posix_time_s();
    run_free(&run);
}

static void count(void)
{
    for (int i = 0; i < 2 * cells; i++) {
        double seconds;
        one_fall(&cell[i / 2], &seconds);
        printf("%s,%.9g,%.9g\n", method_name[cell[i / 2].method], cell[i / 2].step_s, seconds);
    }
}

int main(int argc, char **argv)
{
    const int brief = argc > 1 && strcmp(argv[1], "--short") == 0;
    const long runs = argc > 1 + brief ? strtol(argv[1 + brief], NULL, 10) : brief ? 2 : 30;
    struct plan p;
    struct result *r;
    int n, warm = 0, err = 0;
    if (argc > 1 + brief && strcmp(argv[1 + brief], "count") == 0) {
        cells_of(brief);
        count();
        return 0;
    }
    if (runs < 2 || runs > RUN_MAX || argc > 2 + brief) {
        fprintf(stderr, "usage: statistics [--short] [RUNS] (2..%d)\n", RUN_MAX);
        return 2;
    }
    p = (struct plan){(int)runs, (int)runs / 2};
    cells_of(brief);
    n = cells * TABLE2_ROWS * per_row(&p);
    r = calloc((size_t)n, sizeof *r);
    if (r == NULL) { return 1; }
    /* The flow's exponentials, once, for all the processes to come */
    for (int i = 0; i < n && cell[i / per_row(&p) / TABLE2_ROWS].method != METHOD_FLOW; i++) {
        warm = i + 1;
    }
    work(&p, warm, r);
    {
        const struct jobs jobs = {n, jobs_cores(), sizeof *r, r, work, &p, "runs", NULL};
        if (jobs_run(&jobs) != 0) { return 1; }
    }
    printf("method,step_s,rate_Hz,runs,b_Npm,b_se,rest_s,rest_se,rest,oscillates\n");
    for (int i = 0; i < cells * TABLE2_ROWS; i++) {
        err |= line(&p, &cell[i / TABLE2_ROWS], i % TABLE2_ROWS, r + i * per_row(&p));
    }
    free(r);
    return err;
}
