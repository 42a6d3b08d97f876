/* SPDX-License-Identifier: MIT */
/* exhand drop: the falls at each rate, run, judged, written. */
#include "drop/options.h"

#include "base/csv.h"
#include "base/jobs.h"
#include "base/names.h"
#include "base/outfile.h"
#include "base/outlog.h"
#include "drop/outdir.h"
#include "drop/print.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct run_cfg drop_run_cfg(const struct drop_options *o, int i, double scale, uint64_t seed)
{
    const struct table2_row *g = table2_gains(o->rate_Hz[i]);
    struct run_cfg c;
    memset(&c, 0, sizeof c);
    c.rate_Hz = (uint32_t)(o->rate_Hz[i] + 0.5);
    c.k_Npm = (o->k_Npm < 0 ? g->k_Npm : o->k_Npm) * o->scale * scale;
    c.b_Nspm = (o->b_Nspm < 0 ? g->b_Nspm : o->b_Nspm) * o->scale * scale;
    c.scene = drop_scene(o);
    c.setting = o->setting;
    c.settings = o->settings;
    c.images = &o->images;
    if (o->params.load) {
        c.live.image = o->params.image;
        c.live.image_B = o->params.len_B;
        c.live.name = o->params.load;
        c.live.gains = 1;
    }
    c.board = posix_config_default();
    c.board.device = o->device;
    c.wall = o->phase < 0 ? RUN_WALL_DRAWN : RUN_WALL_AT_PHASE;
    c.phase = o->phase;
    c.board.seed = seed;
    c.board.falls = o->falls < 0 ? 10 : (int)o->falls;
    c.board.T = o->T;
    c.board.pace = o->pace;
    c.board.gpio = o->gpio.given;
    c.board.let_go_s = o->let_go_s;
    c.board.cards.how = o->cards ? POSIX_CARDS_INSTANT : POSIX_CARDS_NONE;
    return c;
}

struct table2_result drop_shown(const struct drop_options *o, int i)
{
    struct run_cfg c = drop_run_cfg(o, i, 1, (uint64_t)o->seed);
    struct table2_result r;
    char log[TABLE2_PATH_B], csv[TABLE2_PATH_B], plot[TABLE2_PATH_B], fault[TABLE2_PATH_B];

    c.blackbox = o->blackbox;
    if (o->out == NULL) { return table2_measure_more(&c, NULL, TABLE2_SAME, o->more); }
    if (c.blackbox == NULL) {
        outdir_path(fault, o->out, o->rate_Hz[i], "_fault.exh");
        c.blackbox = fault;
    }
    outdir_path(log, o->out, o->rate_Hz[i], ".exh");
    outdir_path(csv, o->out, o->rate_Hz[i], ".csv");
    outdir_path(plot, o->out, o->rate_Hz[i], "");
    c.board.log = outfile_open("out", log);
    if (c.board.log == NULL) {
        memset(&r, 0, sizeof r);
        r.error = 1;
        return r;
    }
    r = table2_measure_more(&c, plot, TABLE2_SAME, o->more);
    if (r.done && r.dumps == 0 && c.blackbox == fault) { (void)remove(fault); } /* an earlier one */
    if (outlog_close(c.board.log) != 0) {
        r.error = 1;
    } else if (r.done && csv_write(log, csv, CSV_FALLS, CSV_IN_USE) != 0) {
        r.error = 1;
    }
    return r;
}

/* Of each rate first the runs at its gains, then, for the gates, as many at 1.5 times both. The
 * first of all is the one that is written. */
static int runs_of_rate(const struct drop_options *o) { return (int)o->runs * (o->gates ? 2 : 1); }

static void work(const void *ctx, int i, void *result)
{
    const struct drop_options *o = ctx;
    const int rate_i = i / runs_of_rate(o), run = i % runs_of_rate(o);
    struct table2_result r;
    if (run == 0) {
        r = drop_shown(o, rate_i);
    } else {
        const struct run_cfg c = drop_run_cfg(o, rate_i, run < o->runs ? 1 : 1.5,
            (uint64_t)o->seed + (uint64_t)run % (uint64_t)o->runs);
        r = table2_measure_more(&c, NULL, TABLE2_SAME, o->more);
    }
    memcpy(result, &r, sizeof r);
}

/* --- reporting --- */

static void complain_faults(const struct table2_result *r)
{
    char what[NAMES_B];
    names_faults(what, sizeof what, r->faults);
    cli_complain("%.6g Hz: the box stopped with faults %#x: %s", r->rate_Hz, r->faults, what);
}

/* Reports the problems of the runs of a rate, each kind once. Returns 1 if there are any. */
static int check(const struct drop_options *o, const struct table2_result *r)
{
    int err = 0, falls = 0, incomplete = 0;
    unsigned faults = 0;
    for (int i = 0; i < runs_of_rate(o); i++) {
        err |= r[i].error != 0;
        if (!r[i].done) { continue; }
        if (r[i].faults & ~faults) { complain_faults(&r[i]); }
        faults |= r[i].faults;
        falls += i < o->runs ? r[i].falls : 0;
        incomplete += i < o->runs ? r[i].incomplete : 0;
    }
    if (incomplete) {
        cli_complain("%.6g Hz: %d of %d falls were not seen to their end: no contact, or the mass "
                     "ran away",
            r->rate_Hz, incomplete, falls);
    }
    return err || faults || incomplete;
}

static int check_all(const struct drop_options *o, const struct table2_result *r)
{
    int err = 0;
    for (int i = 0; i < o->rates; i++) { err |= check(o, r + i * runs_of_rate(o)); }
    return err;
}

static int done(const struct table2_result *r, int n)
{
    int done = 0;
    for (int i = 0; i < n; i++) { done += r[i].done; }
    return done;
}

static int write_out(const struct drop_options *o, const struct table2_result *r,
    const struct table2_runs *row, const struct table2_result *shown, int rows)
{
    if (o->out == NULL) { return 0; }
    return outdir_table(o->out, row, rows) | outdir_runs(o->out, r, o->rates * runs_of_rate(o)) |
           outdir_pictures(o->out, &o->device, shown, rows);
}

/* Rates of which the first run was done. */
static int report(const struct drop_options *o, const struct table2_result *r)
{
    static struct table2_runs row[DROP_RATES_MAX];
    static struct table2_result shown[DROP_RATES_MAX];
    int rows = 0, err, failed = 0;
    for (int i = 0; i < o->rates; i++) {
        const struct table2_result *first = r + i * runs_of_rate(o);
        if (!first->done) { continue; }
        shown[rows] = *first;
        row[rows++] = table2_runs(first, o->gates ? first + o->runs : NULL, (int)o->runs);
    }
    if (rows == 0) { return 0; } /* what an earlier run left stays, whole */
    if (o->out) { outdir_clear(o->out); }
    err = write_out(o, r, row, shown, rows);
    if (o->gates) { failed = table2_print_gates(stdout, row, rows); }
    table2_print_runs(stdout, row, rows);
    table2_print_paper(stdout, row, rows);
    return err || failed;
}

/* The first runs once more with passivity only observing. */
static struct table2_result observed(const struct drop_options *o, int i)
{
    struct run_setting setting[DROP_SETTINGS_MAX + 1];
    struct run_cfg c = drop_run_cfg(o, i, 1, (uint64_t)o->seed);
    memcpy(setting, o->setting, sizeof o->setting);
    setting[o->settings] = (struct run_setting){"passivity", 0};
    c.setting = setting;
    c.settings = o->settings + 1;
    return table2_measure(&c, NULL, TABLE2_SAME);
}

static void report_guard(const struct drop_options *o, const struct table2_result *r)
{
    struct guard_row row[DROP_RATES_MAX];
    int rows = 0;
    for (int i = 0; i < o->rates; i++) {
        const struct table2_result *on = r + i * runs_of_rate(o), off = observed(o, i);
        if (!on->done || !off.done) { continue; }
        row[rows++] = (struct guard_row){on->rate_Hz, on->k_Npm, on->b_Nspm, on->guard, off.guard,
            on->b_Npm, off.b_Npm, on->falls, on->oscillating, off.oscillating};
    }
    guard_print(stdout, row, rows);
}

int drop_experiment(const struct drop_options *o, drop_after *after)
{
    const int n = o->rates * runs_of_rate(o);
    struct table2_result *r = calloc((size_t)n, sizeof *r);
    const struct jobs jobs = {n, (int)o->jobs, sizeof *r, r, work, o, "runs", posix_interrupt};
    int ran, err;
    if (r == NULL) {
        cli_complain("out of memory: fewer --runs");
        return 1;
    }
    ran = jobs_run(&jobs);
    err = check_all(o, r);
    if (ran == 0 || done(r, n) > 0) { err |= report(o, r); }
    if (ran == 0 && o->guarded) { report_guard(o, r); }
    if (ran == 0 && after) { err |= after(o, r, runs_of_rate(o)); }
    if (ran == JOBS_INTERRUPTED) {
        cli_complain("interrupted: %d of %d runs were finished%s%s", done(r, n), n,
            o->out ? ", what they wrote is kept in " : "", o->out ? o->out : "");
    }
    free(r);
    return ran ? ran : err;
}
