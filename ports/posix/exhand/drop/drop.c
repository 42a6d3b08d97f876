/* SPDX-License-Identifier: MIT */
/* exhand drop: the paper's falling-mass experiment, run, judged, written. */
#include "base/cli.h"

#include "base/assign.h"
#include "lab/drop/border.h"
#include "base/contacts.h"
#include "log/csv.h"
#include "lab/drop/original.h"
#include "lab/drop/friction.h"
#include "base/images.h"
#include "base/jobs.h"
#include "base/names.h"
#include "base/option.h"
#include "lab/drop/preset.h"
#include "drop/outdir.h"
#include "base/param.h"
#include "base/params_file.h"
#include "base/scene_more.h"
#include "lab/drop/sweep.h"
#include "base/messages.h"

#include "drop/drop.h"
#include "guarded/guarded.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RATES_MAX    64
#define SETTINGS_MAX 64

struct drop_options {
    struct params_file params;
    double rate_Hz[RATES_MAX];
    int rates, rates_given;
    double k_Npm, b_Nspm, scale; /* < 0: the paper's at that rate */
    int64_t falls, seed, jobs, spread, friction;
    int pace, cards, sweep, check, readings, guarded, custom;
    const char *out, *grid, *shard, *blackbox, *preset;
    double let_go_s;
    struct run_setting setting[SETTINGS_MAX];
    int settings;
    struct sim_device device;
    struct images images;
    struct exh_period T;
    struct contacts gpio;
};

static const struct exh_scene *scene_of(const struct drop_options *o)
{
    return o->custom ? cli_scene_more : o->guarded ? &exh_scene_guarded : &exh_scene_drop;
}

/* --- options with a syntax of their own --- */

static int bad_rates(const char *text, const char *why)
{
    cli_complain(
        "--rate: %s: %s (whole numbers 1..20000 Hz, each once, commas between, at most %d): "
        "e.g. --rate 90,2000",
        text, why, RATES_MAX);
    return 2;
}

static int take_rates(void *ctx, const char *text)
{
    struct drop_options *o = ctx;
    const char *at = text;
    o->rates = 0;
    o->rates_given = 1;
    for (;;) {
        char *end;
        const double v = strtod(at, &end);
        if (end == at || !(v >= 1 && v <= 20000) || v != (double)(long)v) {
            return bad_rates(text, "not a list of rates");
        }
        for (int i = 0; i < o->rates; i++) {
            if (o->rate_Hz[i] == v) { return bad_rates(text, "a rate comes twice"); }
        }
        if (o->rates == RATES_MAX) { return bad_rates(text, "too many"); }
        o->rate_Hz[o->rates++] = v;
        if (*end == '\0') { return 0; }
        if (*end != ',') { return bad_rates(text, "not a list of rates"); }
        at = end + 1;
    }
}

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static int take_period(void *ctx, const char *text)
{
    struct drop_options *o = ctx;
    unsigned long long num = 0, den = 0;
    char *end = NULL;
    if (is_digit(text[0])) { num = strtoull(text, &end, 10); }
    if (end && end[0] == '/' && is_digit(end[1])) { den = strtoull(end + 1, &end, 10); }
    if (den == 0 || *end != '\0' || num < 1 || num > den || den > UINT32_MAX || den > 20000 * num) {
        cli_complain("--period: %s (N/D seconds, 1/20000..1, both whole and below 2^32): "
                     "e.g. --period 597/1193182",
                     text);
        return 2;
    }
    o->T = (struct exh_period){(uint32_t)num, (uint32_t)den};
    return 0;
}

static int take_setting(void *ctx, const char *text)
{
    struct drop_options *o = ctx;
    char name[ASSIGN_NAME_B];
    double value;
    if (assign_split("set", text, name, &value)) { return 2; }
    if (o->settings == SETTINGS_MAX) {
        cli_complain("--set: at most %d", SETTINGS_MAX);
        return 2;
    }
    if (strcmp(name, "k") == 0 || strcmp(name, "b") == 0) {
        cli_complain("--set: %s: give --%s VALUE: the gains belong to the table", text, name);
        return 2;
    }
    exh_scene_guarded.defaults(); /* knows all that drop knows */
    if (cli_param_set(exh_scene_guarded.params, name, value) < 0) { return 2; }
    o->setting[o->settings++] = (struct run_setting){
        cli_signal_find(exh_scene_guarded.params->table, name, NULL)->name, value};
    return 0;
}

static int take_device(void *ctx, const char *text)
{
    struct drop_options *o = ctx;
    return assign_device(&o->device, "drop", text);
}

static void print_params(const struct exh_scene *scene)
{
    scene->defaults();
    printf("Parameters of the scene (--set NAME=VALUE)\n");
    cli_signal_print(stdout, scene->params->table);
    printf(
        "\nThe simulated device (--device NAME=VALUE); step, kf and the scales also calibrate the "
        "scene\n");
    for (int i = 0; i < sim_device_rows; i++) {
        const struct sim_device_row *r = &sim_device_row[i];
        printf("  %-13s %-8s %14.12g  %14.12g .. %-14.12g %-8s %s\n", r->name, r->unit, r->value,
               r->min, r->max, r->sure, r->help);
    }
}

/* --- running --- */

/* Jobs 0..rates-1 are the runs shown and written; then, per rate, `spread` runs at
 * the gains and `spread` at 1.5 times both. */
static struct run_cfg job_cfg(const struct drop_options *o, int rate_i, double scale, uint64_t seed)
{
    const struct table2_row *g = table2_gains(o->rate_Hz[rate_i]);
    struct run_cfg c;
    memset(&c, 0, sizeof c);
    c.rate_Hz = (uint32_t)(o->rate_Hz[rate_i] + 0.5);
    c.k_Npm = (o->k_Npm < 0 ? g->k_Npm : o->k_Npm) * o->scale * scale;
    c.b_Nspm = (o->b_Nspm < 0 ? g->b_Nspm : o->b_Nspm) * o->scale * scale;
    c.scene = scene_of(o);
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

static enum table2_ask asked(const struct drop_options *o)
{
    return o->readings ? TABLE2_READINGS : TABLE2_SAME;
}

static struct table2_result shown_run(const struct drop_options *o, int i)
{
    struct run_cfg c = job_cfg(o, i, 1, (uint64_t)o->seed);
    struct table2_result r;
    char log[TABLE2_PATH_B], csv[TABLE2_PATH_B], plot[TABLE2_PATH_B], fault[TABLE2_PATH_B];

    c.blackbox = o->blackbox;
    if (o->out == NULL) { return table2_measure(&c, NULL, asked(o)); }
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
    r = table2_measure(&c, plot, asked(o));
    if (fclose(c.board.log) != 0 || r.lost) {
        cli_complain("%s: can't be written: %lu records lost", log, r.lost);
        r.error = 1;
    } else if (r.done && csv_write(log, csv, CSV_FALLS) != 0) {
        r.error = 1;
    }
    return r;
}

static void work(const void *ctx, int i, void *result)
{
    const struct drop_options *o = ctx;
    struct table2_result r;
    if (i < o->rates) {
        r = shown_run(o, i);
    } else {
        const int j = i - o->rates;
        const int rate_i = j / (2 * (int)o->spread);
        const int run = j % (2 * (int)o->spread);
        const double scale = run < o->spread ? 1 : 1.5;
        const struct run_cfg c =
            job_cfg(o, rate_i, scale, (uint64_t)o->seed + 1 + (uint64_t)(run % o->spread));
        r = table2_measure(&c, NULL, asked(o));
    }
    memcpy(result, &r, sizeof r);
}

/* --- reporting --- */

/* What is wrong with the runs that were done: 1 if anything. */
static int check(const struct drop_options *o, const struct table2_result *r, int n)
{
    int err = 0;
    for (int i = 0; i < n; i++) {
        err |= r[i].error != 0;
        if (!r[i].done) { continue; }
        if (r[i].faults) {
            char what[NAMES_B];
            names_faults(what, sizeof what, r[i].faults);
            cli_complain("%.6g Hz: the box stopped with faults %#x: %s", r[i].rate_Hz, r[i].faults,
                         what);
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

static int count_done(const struct table2_result *r, int n)
{
    int done = 0;
    for (int i = 0; i < n; i++) { done += r[i].done; }
    return done;
}

/* The rows that were done, as tables and for people. 0, or 1 after a line on stderr. */
static int report(const struct drop_options *o, const struct table2_result *r)
{
    struct table2_result row[RATES_MAX];
    struct table2_spread spread[RATES_MAX];
    const struct table2_spread *s = o->spread > 0 ? spread : NULL;
    int rows = 0, err = 0;
    for (int i = 0; i < o->rates; i++) {
        const struct table2_result *first = r + o->rates + 2 * i * o->spread;
        if (!r[i].done) { continue; }
        row[rows] = r[i];
        spread[rows++] = table2_spread(first, first + o->spread, (int)o->spread);
    }
    if (rows == 0) { return 0; }
    if (o->out != NULL) {
        err = outdir_tables(o->out, row, s, rows) | outdir_pictures(o->out, &o->device, row, rows);
    }
    table2_print(stdout, row, s, rows);
    return err;
}

/* Of the further runs where there are any, else of those shown. */
static int report_readings(const struct drop_options *o, const struct table2_result *r)
{
    const int spread = (int)o->spread;
    const struct table2_readings t = {r, o->rates, spread ? o->rates : 0, spread ? 2 * spread : 1,
                                      spread ? spread : 1};
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

/* The same runs once more with passivity only observing. */
static struct table2_result observed(const struct drop_options *o, int i)
{
    struct run_setting setting[SETTINGS_MAX + 1];
    struct run_cfg c = job_cfg(o, i, 1, (uint64_t)o->seed);
    memcpy(setting, o->setting, sizeof o->setting);
    setting[o->settings] = (struct run_setting){"passivity", 0};
    c.setting = setting;
    c.settings = o->settings + 1;
    return table2_measure(&c, NULL, TABLE2_SAME);
}

static void report_guard(const struct drop_options *o, const struct table2_result *r)
{
    struct guard_row row[RATES_MAX];
    int rows = 0;
    for (int i = 0; i < o->rates; i++) {
        const struct table2_result off = observed(o, i);
        if (!r[i].done || !off.done) { continue; }
        row[rows++] = (struct guard_row){r[i].rate_Hz,     r[i].k_Npm,     r[i].b_Nspm, r[i].guard,
                                         off.guard,        r[i].b_Npm,     off.b_Npm,   r[i].falls,
                                         r[i].oscillating, off.oscillating};
    }
    guard_print(stdout, row, rows);
}

static int experiment(const struct drop_options *o)
{
    const int further = 2 * o->rates * (int)o->spread, n = o->rates + further;
    struct table2_result *r = calloc((size_t)n, sizeof *r);
    const struct jobs jobs = {n, (int)o->jobs, sizeof *r, r, work, o, "runs", posix_interrupt};
    int ran, err;

    if (r == NULL) {
        cli_complain("out of memory: a smaller --spread");
        return 1;
    }
    ran = jobs_run(&jobs);
    err = check(o, r, n) | report(o, r);
    if (ran == 0 && o->guarded) { report_guard(o, r); }
    if (ran == 0 && o->readings) { err |= report_readings(o, r); }
    if (ran == JOBS_INTERRUPTED) {
        cli_complain("interrupted: %d of %d rates and %d of %d further runs were finished%s%s",
                     count_done(r, o->rates), o->rates, count_done(r + o->rates, further), further,
                     o->out ? ", what they wrote is kept in " : "", o->out ? o->out : "");
    }
    free(r);
    return ran ? ran : err;
}

static int in_plane(const struct drop_options *o)
{
    return o->sweep || o->check || o->friction;
}

/* Before the run, whose fault comes once. What is there stays as it is, what is not stays away. */
static int can_write(const char *path)
{
    FILE *was = fopen(path, "rb"), *f = fopen(path, "ab");
    if (f == NULL) {
        cli_complain("--blackbox: %s: %s: give a file that can be written", path, strerror(errno));
    }
    if (f != NULL) { fclose(f); }
    if (f != NULL && was == NULL) { (void)remove(path); }
    if (was != NULL) { fclose(was); }
    return f != NULL;
}

/* The image's k and b are those of the table's rows, unless they are given. */
static int load_params(struct drop_options *o)
{
    const struct exh_scene *sc = scene_of(o);
    const int err = params_file_read(&o->params);
    uint32_t k, b;
    if (err || o->params.load == NULL) { return err; }
    sc->defaults();
    if (params_take(o->params.load, sc->params, o->params.image, o->params.len_B) < 0) { return 2; }
    if (o->k_Npm < 0 && cli_signal_find(sc->params->table, "k", &k)) {
        o->k_Npm = cli_signal_value(&exh_contact_rows[0], sc->params->staged[k]);
    }
    if (o->b_Nspm < 0 && cli_signal_find(sc->params->table, "b", &b)) {
        o->b_Nspm = cli_signal_value(&exh_contact_rows[1], sc->params->staged[b]);
    }
    return 0;
}

/* Whether what was asked for can be run at all: 0, or 2 after a line on stderr. */
static int refuse(struct drop_options *o)
{
    int err = assign_step(&o->device, 0, 0);
    if (err == 0 && o->preset) { err = original_take(o->preset); }
    if (err) { return err; }
    if (o->T.num != 0 && o->rates_given) {
        cli_complain("--period and --rate: a period is a rate: give one of them");
        return 2;
    }
    if (o->preset &&
        (o->T.num != 0 || o->rates_given || o->k_Npm >= 0 || o->b_Nspm >= 0 || o->scale != 1 ||
         o->spread > 0 || o->pace || o->blackbox || o->gpio.given || o->params.load ||
         o->params.save || o->readings || o->guarded || o->custom || in_plane(o))) {
        cli_complain("--preset: goes with --falls, --seed, --out, --set, --device, --calibration, "
                     "--cards and --let-go alone");
        return 2;
    }
    if (o->preset) {
        o->rate_Hz[0] = ORIGINAL_RATE_HZ;
        o->rate_Hz[1] = ORIGINAL_BOX_HZ;
        o->rates = 2;
    }
    if (o->T.num != 0) {
        o->rate_Hz[0] = (double)o->T.den / o->T.num;
        o->rates = 1;
    }
    if (o->blackbox && (o->rates != 1 || in_plane(o))) {
        cli_complain(
            "--blackbox: one rate, and no plane of gains: --out names a dump for each rate");
        return 2;
    }
    if (o->blackbox && !can_write(o->blackbox)) { return 2; }
    if (o->gpio.given && (o->rates != 1 || o->spread > 0 || in_plane(o))) {
        cli_complain(
            "--gpio: one rate and one run at a time, since lines are one program's: leave out "
            "--spread and planes of gains");
        return 2;
    }
    if (o->gpio.given) { o->jobs = 1; } /* the process that holds the lines */
    if (contacts_check(&o->gpio, o->pace)) { return 2; }
    if ((o->grid && !o->sweep && !o->check) || (o->shard && !o->sweep)) {
        cli_complain("--grid and --shard: only with --sweep, --grid with --border-check too");
        return 2;
    }
    if (o->params.load && in_plane(o)) {
        cli_complain("--load-params: no plane of gains, which chooses k and b itself: leave out "
                     "one of them");
        return 2;
    }
    if (o->params.save && (o->rates != 1 || in_plane(o))) {
        cli_complain("--save-params: one rate, and no plane of gains: give --rate");
        return 2;
    }
    err = load_params(o);
    for (int i = 0; err == 0 && i < o->rates; i++) {
        struct run_cfg c = job_cfg(o, i, 1, 1);
        if (run_check(&c) < 0) { return 2; }
        if (o->params.save) { err = params_save_file(o->params.save, c.scene->params); }
        c = job_cfg(o, i, 1.5, 1);
        if (o->spread > 0 && run_check(&c) < 0) { return 2; }
    }
    if (err) { return err; }
    return o->out && !in_plane(o) ? outdir_open(o->out) : 0;
}

/* --- the system before, beside this one --- */

static int beside_original(const struct drop_options *o)
{
    const struct run_cfg original = job_cfg(o, 0, 1, (uint64_t)o->seed),
                         box = job_cfg(o, 1, 1, (uint64_t)o->seed);
    return drop_original(&original, &box, o->out);
}

/* --- the plane of gains instead of the table's points --- */

static int plane(const struct drop_options *o)
{
    struct sweep_opt s = {.rate_Hz = o->rate_Hz,
                          .rates = o->rates,
                          .jobs = (int)o->jobs,
                          .base = job_cfg(o, 0, 1, (uint64_t)o->seed),
                          .dir = o->out};
    if (o->sweep + o->check + (o->friction > 0) > 1) {
        cli_complain("--sweep, --border-check, --friction: one at a time");
        return 2;
    }
    if (o->k_Npm >= 0 || o->b_Nspm >= 0 || o->scale != 1 || o->spread > 0 || o->pace ||
        o->let_go_s > 0) {
        cli_complain(
            "--%s: chooses k and b itself: leave out --k, --b, --scale, --spread, --pace, --let-go",
            o->sweep   ? "sweep"
            : o->check ? "border-check"
                       : "friction");
        return 2;
    }
    if (o->check && o->falls >= 0) {
        cli_complain("--falls and --border-check: it has its own falls: leave out one of them");
        return 2;
    }
    if (sweep_take_grid(o->grid    ? o->grid
                        : o->sweep ? "20x16"
                                   : "16x16",
                        &s.columns, &s.rows) ||
        sweep_take_shard(o->shard ? o->shard : "1/1", &s.shard, &s.shards)) {
        return 2;
    }
    return o->sweep   ? sweep_run(&s)
           : o->check ? border_check(&s)
                      : friction_run(&s, (int)o->friction);
}

int cli_drop(int argc, char **argv)
{
    static struct drop_options o; /* too large for a stack to like */
    int list = 0, err;
    const struct cli_call rates = {take_rates, &o}, period = {take_period, &o};
    const struct cli_call setting = {take_setting, &o}, device = {take_device, &o};
    const struct cli_call gpio = {contacts_take, &o.gpio}, calibration = {images_take, &o.images};
    union {
        const struct cli_call *view;
        void *to;
    } u[6] = {{&rates}, {&period}, {&setting}, {&device}, {&gpio}, {&calibration}};
    const struct cli_option option[] = {
        {"rate", CLI_CALL, u[0].to, 0, 0, "HZ[,HZ...]", "loop rates, 1..20000 (the paper's six)"},
        {"period", CLI_CALL, u[1].to, 0, 0, "N/D",
         "one exact period in s, as a timer makes it; not with --rate"},
        {"k", CLI_REAL, &o.k_Npm, 0, 1e6, "N/M", "stiffness (the paper's at that rate)"},
        {"b", CLI_REAL, &o.b_Nspm, 0, 1e3, "NS/M", "damping (the paper's at that rate)"},
        {"scale", CLI_REAL, &o.scale, 0, 100, "G", "multiplies both (1)"},
        {"falls", CLI_INT, &o.falls, 1, 1000, "N", "falls a run (10); not with --border-check"},
        {"spread", CLI_INT, &o.spread, 0, 1000, "N",
         "further runs, at 1 and 1.5 times both gains (0)"},
        {"seed", CLI_INT, &o.seed, 0, 1e9, "N", "of all chance in the simulation (1)"},
        {"out", CLI_TEXT, &o.out, 0, 0, "DIR", "write logs, CSVs of the falls and tables there"},
        {"blackbox", CLI_TEXT, &o.blackbox, 0, 0, "FILE",
         "the last seconds before a fault, a log (with --out beside the others)"},
        {"let-go", CLI_REAL, &o.let_go_s, 0, 1e9, "S",
         "the dead-man switch opens then: a fault (never)"},
        {"jobs", CLI_INT, &o.jobs, 1, 1024, "N", "processes at a time (one a core)"},
        {"cards", CLI_FLAG, &o.cards, 0, 0, NULL,
         "through the drivers and emulated cards: the same bits"},
        {"pace", CLI_FLAG, &o.pace, 0, 0, NULL, "follow the wall clock, for people who watch"},
        {"gpio", CLI_CALL, u[4].to, 0, 0, CONTACTS_ARG, CONTACTS_HELP},
        {"set", CLI_CALL, u[2].to, 0, 0, "NAME=VALUE", "a parameter of the scene"},
        {"device", CLI_CALL, u[3].to, 0, 0, "NAME=VALUE", "a value of the simulated device"},
        PARAMS_FILE_OPTIONS(o.params),
        {"calibration", CLI_CALL, u[5].to, 0, 0, "FILE",
         "of finger 0, by `exhand calibrate` (none: the simulated device as it is, "
         "uncalibrated=1)"},
        {"sweep", CLI_FLAG, &o.sweep, 0, 0, NULL,
         "the stability border in the k-b plane, in DIR/stability.csv; stopped or killed, it goes "
         "on from there"},
        {"grid", CLI_TEXT, &o.grid, 0, 0, "KxB",
         "cells at each rate of --sweep (20x16), --border-check (16x16)"},
        {"shard", CLI_TEXT, &o.shard, 0, 0, "I/N",
         "the I-th of N parts of the sweep, in a file of its own; then without: one map of all"},
        {"border-check", CLI_FLAG, &o.check, 0, 0, NULL,
         "the simulated border beside that of the linear test"},
        {"friction", CLI_INT, &o.friction, 2, FRICTION_POINTS_MAX, "N",
         "the border against N amounts of friction, 0..2 times"},
        {"preset", CLI_TEXT, &o.preset, 0, 0, "NAME",
         "original: the commercial system at 90 Hz, beside this box at 2 kHz"},
        {"guarded", CLI_FLAG, &o.guarded, 0, 0, NULL,
         "the scene with passivity, and what that takes away"},
        {"custom", CLI_FLAG, &o.custom, 0, 0, NULL,
         "the scene with a controller of your own (examples/custom)"},
        {"readings", CLI_FLAG, &o.readings, 0, 0, NULL,
         "the stiffness by every reading of the paper's analysis"},
        {"params", CLI_FLAG, &list, 0, 0, NULL, "list both, with units and ranges"},
    };
    const struct cli_command c = {
        "drop",
        "[options]",
        "The paper's experiment: 0.5 kg falls 7 cm onto a virtual wall, ten times, at each rate.\n"
        "A fall oscillates when in the last 0.5 s of its observation position moves by more than\n"
        "0.25 mm or the monitored force by more than 4 N; else it has come to rest. Buzz is rest\n"
        "in which the encoder still moves, by one or two counts.",
        option,
        (int)(sizeof option / sizeof option[0]),
        0};

    memset(&o, 0, sizeof o);
    o.k_Npm = o.b_Nspm = -1;
    o.scale = 1;
    o.falls = -1;
    o.seed = 1;
    o.jobs = jobs_cores();
    o.device = sim_device_default();
    for (o.rates = 0; o.rates < TABLE2_ROWS; o.rates++) {
        o.rate_Hz[o.rates] = table2_paper[o.rates].rate_Hz;
    }
    err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (o.custom && (o.guarded || cli_scene_more == NULL)) {
        cli_complain(o.guarded ? "--custom and --guarded: one scene at a time"
                               : "--custom: no controller in this program: make SCENE=custom "
                                 "MODEL=FOLDER links one");
        return 2;
    }
    if (list) {
        print_params(scene_of(&o));
        return 0;
    }
    err = refuse(&o);
    if (err == 0) { err = contacts_begin(&o.gpio); }
    if (o.gpio.given && err == 0) { words_begin(1); }
    if (err == 0) {
        err = in_plane(&o) ? plane(&o) : o.preset ? beside_original(&o) : experiment(&o);
    }
    words_end();
    contacts_end();
    return err;
}
