/* SPDX-License-Identifier: MIT */
/* exhand drop: the falls at each rate, run, judged, written. */
#include "drop/options.h"

#include "base/csv.h"
#include "base/jobs.h"
#include "base/names.h"
#include "drop/outdir.h"
#include "drop/print.h"

#include <errno.h>
#include <stdio.h>
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
        (void)remove(fault); /* an earlier run's */
    }
    outdir_path(log, o->out, o->rate_Hz[i], ".exh");
    outdir_path(csv, o->out, o->rate_Hz[i], ".csv");
    outdir_path(plot, o->out, o->rate_Hz[i], "");
    c.board.log = fopen(log, "wb");
    if (c.board.log == NULL) {
        cli_complain("%s: %s", log, strerror(errno));
        memset(&r, 0, sizeof r);
        r.error = 1;
        return r;
    }
    r = table2_measure_more(&c, plot, TABLE2_SAME, o->more);
    if (fclose(c.board.log) != 0 || r.lost) {
        cli_complain("%s: can't be written: %lu records lost", log, r.lost);
        r.error = 1;
    } else if (r.done && csv_write(log, csv, CSV_FALLS, CSV_IN_USE) != 0) {
        r.error = 1;
    }
    return r;
}

static void work(const void *ctx, int i, void *result)
{
    const struct table2_result r = drop_shown(ctx, i);
    memcpy(result, &r, sizeof r);
}

/* --- reporting --- */

/* What is wrong with the runs that were done: 1 if anything. */
int drop_check(const struct drop_options *o, const struct table2_result *r, int n)
{
    int err = 0;
    for (int i = 0; i < n; i++) {
        err |= r[i].error != 0;
        if (!r[i].done) { continue; }
        if (r[i].faults) {
            char what[NAMES_B];
            names_faults(what, sizeof what, r[i].faults);
            cli_complain(
                "%.6g Hz: the box stopped with faults %#x: %s", r[i].rate_Hz, r[i].faults, what);
            err = 1;
        }
        if (i < o->rates && r[i].incomplete) {
            cli_complain(
                "%.6g Hz: %d of %d falls were not seen to their end: no contact, or the mass ran "
                "away",
                r[i].rate_Hz, r[i].incomplete, r[i].falls);
            err = 1;
        }
    }
    return err;
}

int drop_done(const struct table2_result *r, int n)
{
    int done = 0;
    for (int i = 0; i < n; i++) { done += r[i].done; }
    return done;
}

int drop_write(const struct drop_options *o, const struct table2_result *row, int rows)
{
    if (o->out == NULL) { return 0; }
    return outdir_table(o->out, row, rows) | outdir_pictures(o->out, &o->device, row, rows);
}

static int report(const struct drop_options *o, const struct table2_result *r)
{
    struct table2_result row[DROP_RATES_MAX];
    int rows = 0, err;
    for (int i = 0; i < o->rates; i++) {
        if (r[i].done) { row[rows++] = r[i]; }
    }
    if (rows == 0) { return 0; }
    err = drop_write(o, row, rows);
    table2_print_runs(stdout, row, rows);
    table2_print_paper(stdout, row, rows);
    return err;
}

/* The same runs once more with passivity only observing. */
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

void drop_report_guard(const struct drop_options *o, const struct table2_result *r)
{
    struct guard_row row[DROP_RATES_MAX];
    int rows = 0;
    for (int i = 0; i < o->rates; i++) {
        const struct table2_result off = observed(o, i);
        if (!r[i].done || !off.done) { continue; }
        row[rows++] = (struct guard_row){r[i].rate_Hz, r[i].k_Npm, r[i].b_Nspm, r[i].guard,
            off.guard, r[i].b_Npm, off.b_Npm, r[i].falls, r[i].oscillating, off.oscillating};
    }
    guard_print(stdout, row, rows);
}

int drop_experiment(const struct drop_options *o)
{
    static struct table2_result r[DROP_RATES_MAX];
    const struct jobs jobs = {
        o->rates, (int)o->jobs, sizeof *r, r, work, o, "runs", posix_interrupt};
    int ran, err;
    memset(r, 0, sizeof r);
    ran = jobs_run(&jobs);
    err = drop_check(o, r, o->rates) | report(o, r);
    if (ran == 0 && o->guarded) { drop_report_guard(o, r); }
    if (ran == JOBS_INTERRUPTED) {
        cli_complain("interrupted: %d of %d rates were finished%s%s", drop_done(r, o->rates),
            o->rates, o->out ? ", what they wrote is kept in " : "", o->out ? o->out : "");
    }
    return ran ? ran : err;
}
