/* SPDX-License-Identifier: MIT */
/* exhand-lab drop: the falling mass as it is studied. */
#include "lab/lab.h"

#include "base/assign.h"
#include "base/jobs.h"
#include "drop/options.h"
#include "drop/outdir.h"
#include "drop/print.h"
#include "lab/drop/border.h"
#include "lab/drop/friction.h"
#include "lab/drop/original.h"
#include "lab/drop/preset.h"
#include "lab/drop/spread.h"
#include "lab/drop/sweep.h"

#include <stdlib.h>
#include <string.h>

static struct {
    int64_t spread, friction;
    int sweep, check, readings;
    const char *grid, *shard, *preset;
} is;

/* --- further runs --- */

/* Jobs 0..rates-1 are the runs shown and written; then, per rate, `spread` runs at
 * the gains and `spread` at 1.5 times both. */
static void work(const void *ctx, int i, void *result)
{
    const struct drop_options *o = ctx;
    struct table2_result r;
    if (i < o->rates) {
        r = drop_shown(o, i);
    } else {
        const int j = i - o->rates;
        const int rate_i = j / (2 * (int)is.spread);
        const int run = j % (2 * (int)is.spread);
        const struct run_cfg c = drop_run_cfg(o, rate_i, run < is.spread ? 1 : 1.5,
            (uint64_t)o->seed + 1 + (uint64_t)(run % is.spread));
        r = table2_measure_more(&c, NULL, TABLE2_SAME, o->more);
    }
    memcpy(result, &r, sizeof r);
}

static int write_spread(
    const char *dir, const struct table2_result *r, const struct table2_spread *s, int rows)
{
    FILE *f = outdir_create(dir, "spread.csv");
    if (f == NULL) { return 1; }
    table2_spread_csv_header(f);
    for (int i = 0; i < rows; i++) { table2_spread_csv_line(f, &r[i], &s[i]); }
    return outdir_finish(f, dir, "spread.csv");
}

/* The rows that were done, as tables and for people. 0, or 1 after a line on stderr. */
static int report(const struct drop_options *o, const struct table2_result *r)
{
    struct table2_result row[DROP_RATES_MAX];
    struct table2_spread spread[DROP_RATES_MAX];
    int rows = 0, err;
    for (int i = 0; i < o->rates; i++) {
        const struct table2_result *first = r + o->rates + 2 * i * is.spread;
        if (!r[i].done) { continue; }
        row[rows] = r[i];
        spread[rows++] = table2_spread(first, first + is.spread, (int)is.spread);
    }
    if (rows == 0) { return 0; }
    err = drop_write(o, row, rows);
    if (is.spread && o->out) { err |= write_spread(o->out, row, spread, rows); }
    table2_print_runs(stdout, row, rows);
    if (is.spread) { table2_spread_print(stdout, row, spread, rows); }
    table2_print_paper(stdout, row, rows);
    return err;
}

/* Of the further runs where there are any, else of those shown. */
static int report_readings(const struct drop_options *o, const struct table2_result *r)
{
    const int spread = (int)is.spread;
    const struct table2_readings t = {
        r, o->rates, spread ? o->rates : 0, spread ? 2 * spread : 1, spread ? spread : 1};
    char path[TABLE2_PATH_B];
    FILE *f;
    table2_readings_print(stdout, &t);
    if (o->out == NULL) { return 0; }
    snprintf(path, sizeof path, "%s/readings.csv", o->out);
    f = fopen(path, "w");
    if (f != NULL) { table2_readings_csv(f, &t); }
    if (f == NULL || fclose(f) != 0) {
        cli_complain("%s: can't be written", path);
        return 1;
    }
    return 0;
}

static int experiment(const struct drop_options *o)
{
    const int further = 2 * o->rates * (int)is.spread, n = o->rates + further;
    struct table2_result *r = calloc((size_t)n, sizeof *r);
    const struct jobs jobs = {n, (int)o->jobs, sizeof *r, r, work, o, "runs", posix_interrupt};
    int ran, err;

    if (r == NULL) {
        cli_complain("out of memory: a smaller --spread");
        return 1;
    }
    ran = jobs_run(&jobs);
    err = drop_check(o, r, n) | report(o, r);
    if (ran == 0 && o->guarded) { drop_report_guard(o, r); }
    if (ran == 0 && is.readings) { err |= report_readings(o, r); }
    if (ran == JOBS_INTERRUPTED) {
        cli_complain("interrupted: %d of %d rates and %d of %d further runs were finished%s%s",
            drop_done(r, o->rates), o->rates, drop_done(r + o->rates, further), further,
            o->out ? ", what they wrote is kept in " : "", o->out ? o->out : "");
    }
    free(r);
    return ran ? ran : err;
}

/* --- the system before, beside this one --- */

static int beside_original(const struct drop_options *o)
{
    const struct run_cfg original = drop_run_cfg(o, 0, 1, (uint64_t)o->seed),
                         box = drop_run_cfg(o, 1, 1, (uint64_t)o->seed);
    return drop_original(&original, &box, o->out);
}

/* --- the plane of gains instead of the table's points --- */

static int plane(const struct drop_options *o)
{
    struct sweep_opt s = {.rate_Hz = o->rate_Hz,
        .rates = o->rates,
        .jobs = (int)o->jobs,
        .base = drop_run_cfg(o, 0, 1, (uint64_t)o->seed),
        .dir = o->out};
    if (is.sweep + is.check + (is.friction > 0) > 1) {
        cli_complain("--sweep, --border-check, --friction: one at a time");
        return 2;
    }
    if (o->k_Npm >= 0 || o->b_Nspm >= 0 || o->scale != 1 || is.spread > 0 || o->pace ||
        o->let_go_s > 0) {
        cli_complain(
            "--%s: chooses k and b itself: leave out --k, --b, --scale, --spread, --pace, --let-go",
            is.sweep   ? "sweep"
            : is.check ? "border-check"
                       : "friction");
        return 2;
    }
    if (is.check && o->falls >= 0) {
        cli_complain("--falls and --border-check: it has its own falls: leave out one of them");
        return 2;
    }
    if (assign_grid(is.grid    ? is.grid
                    : is.sweep ? "20x16"
                               : "16x16",
            &s.columns, &s.rows) ||
        sweep_take_shard(is.shard ? is.shard : "1/1", &s.shard, &s.shards)) {
        return 2;
    }
    return is.sweep   ? sweep_run(&s)
           : is.check ? border_check(&s)
                      : friction_run(&s, (int)is.friction);
}

/* --- the command --- */

static int refuse(struct drop_options *o)
{
    int err = is.preset ? original_take(is.preset) : 0;
    o->plane = is.sweep || is.check || is.friction;
    o->further = is.spread > 0;
    o->more = is.readings ? readings_judge : NULL;
    if (err) { return err; }
    if (is.preset &&
        (o->T.num != 0 || o->rates_given || o->k_Npm >= 0 || o->b_Nspm >= 0 || o->scale != 1 ||
            o->further || o->pace || o->blackbox || o->gpio.given || o->params.load ||
            o->params.save || is.readings || o->guarded || o->custom || o->plane)) {
        cli_complain("--preset: goes with --falls, --seed, --out, --set, --device, --calibration, "
                     "--cards and --let-go alone");
        return 2;
    }
    if (is.preset) {
        o->rate_Hz[0] = ORIGINAL_RATE_HZ;
        o->rate_Hz[1] = ORIGINAL_BOX_HZ;
        o->rates = 2;
    }
    if ((is.grid && !is.sweep && !is.check) || (is.shard && !is.sweep)) {
        cli_complain("--grid and --shard: only with --sweep, --grid with --border-check too");
        return 2;
    }
    return 0;
}

static int run(const struct drop_options *o)
{
    return o->plane ? plane(o) : is.preset ? beside_original(o) : experiment(o);
}

int lab_drop(int argc, char **argv)
{
    static struct drop_options o;
    static const struct cli_option option[] = {
        {"spread", CLI_INT, &is.spread, 0, 1000, "N",
            "further runs, at 1 and 1.5 times both gains (0)"},
        {"sweep", CLI_FLAG, &is.sweep, 0, 0, NULL,
            "the stability border in the k-b plane, in DIR/stability.csv; stopped or killed, it "
            "goes "
            "on from there"},
        {"grid", CLI_TEXT, &is.grid, 0, 0, "KxB",
            "cells at each rate of --sweep (20x16), --border-check (16x16)"},
        {"shard", CLI_TEXT, &is.shard, 0, 0, "I/N",
            "the I-th of N parts of the sweep, in a file of its own; then without: one map of all"},
        {"border-check", CLI_FLAG, &is.check, 0, 0, NULL,
            "the simulated border beside that of the linear test"},
        {"friction", CLI_INT, &is.friction, 2, FRICTION_POINTS_MAX, "N",
            "the border against N amounts of friction, 0..2 times"},
        {"preset", CLI_TEXT, &is.preset, 0, 0, "NAME",
            "original: the commercial system at 90 Hz, beside this box at 2 kHz"},
        {"readings", CLI_FLAG, &is.readings, 0, 0, NULL,
            "the stiffness by every reading of the paper's analysis"},
    };
    const struct drop_study study = {
        {option, (int)(sizeof option / sizeof option[0]), NULL}, refuse, run};
    memset(&is, 0, sizeof is);
    return drop_command(argc, argv, &o, &study);
}
