/* SPDX-License-Identifier: MIT */
#include "box/table2.h"

#include "falls/analysis.h"
#include "base/option.h"
#include "base/outfile.h"

#include <string.h>

const struct table2_row table2_paper[TABLE2_ROWS] = {
    {90, 1500, 0, 1374},
    {100, 2000, 0, 1506},
    {200, 2000, 15, 7203},
    {500, 6000, 20, 11977},
    {1000, 10000, 40, 18936},
    {2000, 20000, 60, 50004},
};

const struct table2_row *table2_at(double rate_Hz)
{
    for (int i = 0; i < TABLE2_ROWS; i++) {
        const double off_Hz = rate_Hz - table2_paper[i].rate_Hz;
        const double most_Hz = 1e-3 * table2_paper[i].rate_Hz;
        if (off_Hz <= most_Hz && off_Hz >= -most_Hz) { return &table2_paper[i]; }
    }
    return NULL;
}

const struct table2_row *table2_gains(double rate_Hz)
{
    const struct table2_row *row = table2_at(rate_Hz);
    int i = TABLE2_ROWS - 1;
    while (i > 0 && table2_paper[i].rate_Hz > rate_Hz) { i--; }
    return row ? row : &table2_paper[i];
}

/* --- one run --- */

void table2_failed(struct table2_result *r, const char *what, const char *why)
{
    cli_complain("%.6g Hz: %s: %s", r->rate_Hz, what, why);
    r->error = 1;
    r->done = 0;
}

static void judge_rest(const struct run *run, const struct sim_device *d, struct table2_result *r)
{
    struct fall_rest rest[1000];
    struct fall_rest_opt opt = fall_rest_opt_default;
    struct fall_contacts contacts;
    enum fall_status status = FALL_NO_MEMORY;

    opt.observe_s = d->observe_s;
    opt.encoder_step_m = d->step_m / d->decode;
    r->falls = (int)run->log.falls;
    if (run->log.falls <= sizeof rest / sizeof rest[0]) {
        status = fall_dissect(&run->log, 1, &contacts);
        if (status == FALL_OK) { status = fall_rest(&run->log, &contacts, &opt, rest); }
        fall_contacts_free(&contacts);
    }
    if (status != FALL_OK) { table2_failed(r, "rest", fall_status_text(status)); }
    for (size_t i = 0; r->error == 0 && i < run->log.falls; i++) {
        r->oscillating += rest[i].rest == FALL_OSCILLATES;
        r->buzzing += rest[i].rest == FALL_BUZZ;
        r->incomplete += rest[i].rest == FALL_INCOMPLETE;
    }
}

static void write_plot(const struct fall_stiffness *s, const char *prefix, struct table2_result *r)
{
    char name[3][TABLE2_PATH_B];
    const struct fall_plot_paths paths = {name[0], name[1], name[2]};
    snprintf(name[0], sizeof name[0], "%s_raw.csv", prefix);
    snprintf(name[1], sizeof name[1], "%s_averaged.csv", prefix);
    snprintf(name[2], sizeof name[2], "%s_line.csv", prefix);
    if (fall_write_plot(s, FALL_B, &paths) != FALL_OK) { r->error = 1; }
}

/* The first fall alone, for the picture over time. */
static void write_fall(const struct fall_log *log, const char *prefix, struct table2_result *r)
{
    char name[TABLE2_PATH_B];
    const size_t end = log->falls > 1 ? log->start[1] : log->samples;
    FILE *f;
    snprintf(name, sizeof name, "%s_fall.csv", prefix);
    f = outfile_open("out", name);
    if (f != NULL) { fprintf(f, "t_s,q_m,qd_m_per_s,f_des_n,i_des_a,c,f_mon_n\n"); }
    for (size_t i = log->start[0]; f != NULL && i < end; i++) {
        const struct fall_sample *s = &log->sample[i];
        fprintf(f, "%.9f,%.9g,%.9g,%.9g,%.9g,%d,%.9g\n", s->t_s, s->q_m, s->qd_mps, s->f_des_N,
            s->i_des_A, s->c, s->f_mon_N);
    }
    if (f == NULL || outfile_close(f) != 0) { r->error = 1; }
}

/* Of so many pairs in the band, the share that the scope "till the motor stops" leaves out. */
static double resting(const struct run *run, const struct sim_device *d, size_t pairs)
{
    struct fall_opt opt = fall_opt_default;
    struct fall_contacts moving;
    struct fall_pairs raw = {NULL, 0}, band = {NULL, 0};
    enum fall_status status;
    double share = -1;
    opt.scope = FALL_SCOPE_MOVES;
    opt.step_m = d->step_m / d->decode;
    status = fall_dissect_scope(&run->log, &opt, &moving);
    if (status == FALL_OK) { status = fall_pool(&run->log, &moving, opt.lag, &raw); }
    if (status == FALL_OK) { status = fall_band(&raw, opt.band_lo_N, opt.band_hi_N, &band); }
    if (status == FALL_OK && pairs > 0) { share = 1 - (double)band.n / (double)pairs; }
    fall_contacts_free(&moving);
    fall_pairs_free(&raw);
    fall_pairs_free(&band);
    return share;
}

static void judge_stiffness(const struct run *run, const struct sim_device *d,
    const char *plot_prefix, enum table2_ask ask, struct table2_result *r)
{
    struct fall_opt opt = fall_opt_default;
    struct fall_stiffness s;
    enum fall_status status;

    status = fall_stiffness(&run->log, &opt, &s);
    r->line = s.fit.status;
    if (status != FALL_OK) {
        table2_failed(r, "stiffness", fall_status_text(status));
    } else if (s.fit.status == FALL_OK) {
        r->b_Npm = s.fit.b_Npm;
        r->a_Npm = s.fit.a_Npm;
        r->r2 = s.fit.r2;
        r->ci_low_Npm = s.b.lo_Npm;
        r->ci_high_Npm = s.b.hi_Npm;
        r->ci_bounded = s.b.status == FALL_OK;
        r->resting = resting(run, d, s.band.n);
    }
    if (plot_prefix != NULL && status == FALL_OK) {
        write_plot(&s, plot_prefix, r);
        write_fall(&run->log, plot_prefix, r);
    }
    fall_stiffness_free(&s);
    if (status != FALL_OK || ask < TABLE2_SAME) { return; }
    opt.lag = 0;
    status = fall_stiffness(&run->log, &opt, &s);
    if (status != FALL_OK) {
        table2_failed(r, "stiffness at the same tick", fall_status_text(status));
    }
    if (status == FALL_OK && s.fit.status == FALL_OK) {
        r->b_same_Npm = s.fit.b_Npm;
        r->a_same_Npm = s.fit.a_Npm;
    }
    fall_stiffness_free(&s);
}

struct table2_result table2_measure_more(
    const struct run_cfg *c, const char *plot_prefix, enum table2_ask ask, table2_judge *more)
{
    struct table2_result r;
    struct run run;

    memset(&r, 0, sizeof r);
    r.rate_Hz = c->rate_Hz;
    r.k_Npm = c->k_Npm;
    r.b_Nspm = c->b_Nspm;
    r.seed = c->board.seed;
    r.resting = -1;
    r.error = run_drop(c, &run) < 0;
    if (r.error == 0 && !posix_interrupted()) {
        r.done = 1;
        r.rate_Hz = (double)run.T.den / run.T.num;
        judge_rest(&run, &c->board.device, &r);
        if (ask >= TABLE2_LINE) { judge_stiffness(&run, &c->board.device, plot_prefix, ask, &r); }
        if (more) { more(&run.log, &c->board.device, &r); }
        r.faults = run.faults;
        r.lost = run.lost;
        r.dumps = run.dumps;
        r.guard = run.guard;
        r.phase = run.phase;
        r.q_lim_m = run.q_lim_m;
    }
    run_free(&run);
    return r;
}

struct table2_result table2_measure(
    const struct run_cfg *c, const char *plot_prefix, enum table2_ask ask)
{
    return table2_measure_more(c, plot_prefix, ask, NULL);
}
