/* exhand drop: the paper's falling-mass experiment, run, judged, written. */
#include "cli.h"

#include "csv.h"
#include "jobs.h"
#include "option.h"
#include "param.h"
#include "table2.h"

#include "drop/drop.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define RATES_MAX 64
#define SETTINGS_MAX 64

struct drop_options {
    double rate_Hz[RATES_MAX];
    int rates;
    double k_Npm, b_Nspm, scale; /* < 0: the paper's at that rate                 */
    long falls, seed, jobs, spread, replicates;
    int pace;
    const char *out;
    struct run_setting setting[SETTINGS_MAX];
    int settings;
    struct sim_device device;
    struct exh_period T;
};

/* --- options with a syntax of their own --- */

static int take_rates(void *ctx, const char *text)
{
    struct drop_options *o = ctx;
    char *end = NULL;
    o->rates = 0;
    do {
        const double v = strtod(end ? end + 1 : text, &end);
        if (o->rates == RATES_MAX || !(v >= 1 && v <= 20000) || v != (double)(long)v) {
            fprintf(stderr, "--rate: %s (whole numbers 1..20000 Hz, commas between, at most %d): "
                            "e.g. --rate 90,2000\n", text, RATES_MAX);
            return 2;
        }
        o->rate_Hz[o->rates++] = v;
    } while (*end == ',');
    return *end == '\0' ? 0 : take_rates(ctx, "?");
}

static int take_period(void *ctx, const char *text)
{
    struct drop_options *o = ctx;
    unsigned long num, den;
    if (sscanf(text, "%lu/%lu", &num, &den) != 2 || num < 1 || den < num || den / num > 20000 ||
        den > 0xFFFFFFFFul) {
        fprintf(stderr, "--period: %s (N/D seconds, 1/20000..1): e.g. --period 597/1193182\n", text);
        return 2;
    }
    o->T = (struct exh_period){(uint32_t)num, (uint32_t)den};
    o->rate_Hz[0] = (double)((den + num / 2) / num);
    o->rates = 1;
    return 0;
}

/* name=value; the name stays in argv's own memory. */
static int split(const char *option, const char *text, char **name, double *value)
{
    const char *equals = strchr(text, '=');
    char *end = NULL;
    *name = NULL;
    if (equals != NULL) { *value = strtod(equals + 1, &end); }
    if (equals == NULL || end == equals + 1 || *end != '\0') {
        fprintf(stderr, "--%s: %s: give NAME=VALUE\n", option, text);
        return 2;
    }
    *name = malloc((size_t)(equals - text) + 1);
    if (*name == NULL) { return 2; }
    memcpy(*name, text, (size_t)(equals - text));
    (*name)[equals - text] = '\0';
    return 0;
}

static int take_setting(void *ctx, const char *text)
{
    struct drop_options *o = ctx;
    char *name;
    double value;
    if (split("set", text, &name, &value)) { return 2; }
    if (o->settings == SETTINGS_MAX) {
        fprintf(stderr, "--set: at most %d\n", SETTINGS_MAX);
        return 2;
    }
    exh_scene_drop.defaults();
    if (cli_param_set(exh_scene_drop.params, name, value) < 0) { return 2; }
    o->setting[o->settings++] = (struct run_setting){name, value}; /* kept till exit */
    return 0;
}

static int take_device(void *ctx, const char *text)
{
    struct drop_options *o = ctx;
    const struct sim_device_row *row;
    char *name;
    double value;
    int err;
    if (split("device", text, &name, &value)) { return 2; }
    err = sim_device_set(&o->device, name, value, &row);
    if (err && row) {
        fprintf(stderr, "%s: %.9g (allowed %.9g..%.9g %s): choose a value in that range\n", name, value,
                row->min, row->max, row->unit);
    } else if (err) {
        fprintf(stderr, "%s: no such value of the device: `exhand drop --params` lists them\n", name);
    }
    free(name);
    return err ? 2 : 0;
}

static void print_params(void)
{
    exh_scene_drop.defaults();
    printf("Parameters of the scene (--set NAME=VALUE)\n");
    cli_signal_print(stdout, exh_scene_drop.params->table);
    printf("\nThe simulated device (--device NAME=VALUE); step, kf and the scales also calibrate the "
           "scene\n");
    for (int i = 0; i < sim_device_rows; i++) {
        const struct sim_device_row *r = &sim_device_row[i];
        printf("  %-13s %-8s %12.7g  %12.7g .. %-12.7g %-8s %s\n", r->name, r->unit, r->value, r->min,
               r->max, r->sure, r->help);
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
    c.rate_Hz = (uint32_t)o->rate_Hz[rate_i];
    c.k_Npm = (o->k_Npm < 0 ? g->k_Npm : o->k_Npm) * o->scale * scale;
    c.b_Nspm = (o->b_Nspm < 0 ? g->b_Nspm : o->b_Nspm) * o->scale * scale;
    c.setting = o->setting;
    c.settings = o->settings;
    c.board = posix_config_default();
    c.board.device = o->device;
    c.board.seed = seed;
    c.board.falls = (int)o->falls;
    c.board.T = o->T;
    c.board.pace = o->pace;
    return c;
}

static void path(char *to, size_t size, const struct drop_options *o, double rate_Hz,
                 const char *suffix)
{
    snprintf(to, size, "%s/drop_%gHz%s", o->out, rate_Hz, suffix);
}

static int write_csv(const char *log, const char *csv)
{
    FILE *f = fopen(csv, "w");
    int err;
    if (f == NULL) {
        fprintf(stderr, "%s: %s\n", csv, strerror(errno));
        return 1;
    }
    err = csv_write(log, f, 0);
    return fclose(f) != 0 || err;
}

static struct table2_result shown_run(const struct drop_options *o, int i)
{
    struct run_cfg c = job_cfg(o, i, 1, (uint64_t)o->seed);
    struct table2_result r;
    char log[512], csv[512], plot[512];

    if (o->out == NULL) { return table2_measure(&c, (size_t)o->replicates, NULL); }
    path(log, sizeof log, o, o->rate_Hz[i], ".exh");
    path(csv, sizeof csv, o, o->rate_Hz[i], ".csv");
    path(plot, sizeof plot, o, o->rate_Hz[i], "");
    c.board.log = fopen(log, "wb");
    if (c.board.log == NULL) {
        fprintf(stderr, "%s: %s\n", log, strerror(errno));
        memset(&r, 0, sizeof r);
        r.error = 1;
        return r;
    }
    r = table2_measure(&c, (size_t)o->replicates, plot);
    if (fclose(c.board.log) != 0) { r.error = 1; }
    if (r.lost) { fprintf(stderr, "%s: %lu records lost\n", log, r.lost); }
    if (r.error == 0) { r.error = write_csv(log, csv); }
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
        r = table2_measure(&c, 0, NULL);
    }
    memcpy(result, &r, sizeof r);
}

static FILE *open_out(const struct drop_options *o, const char *name)
{
    char p[512];
    FILE *f;
    snprintf(p, sizeof p, "%s/%s", o->out, name);
    f = fopen(p, "w");
    if (f == NULL) { fprintf(stderr, "%s: %s\n", p, strerror(errno)); }
    return f;
}

static int write_tables(const struct drop_options *o, const struct table2_result *r,
                        const struct table2_spread *s)
{
    FILE *f = open_out(o, "table2.csv");
    int err = f == NULL;
    if (f) {
        table2_csv_header(f);
        for (int i = 0; i < o->rates; i++) { table2_csv_line(f, &r[i]); }
        err |= fclose(f) != 0;
    }
    if (s == NULL) { return err; }
    f = open_out(o, "spread.csv");
    err |= f == NULL;
    if (f) {
        table2_spread_csv_header(f);
        for (int i = 0; i < o->rates; i++) { table2_spread_csv_line(f, &r[i], &s[i]); }
        err |= fclose(f) != 0;
    }
    return err;
}

/* Panel variables of plot/force_position.gp for one run. */
static void panel(FILE *f, const char *name, const struct table2_result *r, const char *prefix,
                  double q0_m)
{
    fprintf(f, "%s_raw='%s_raw.csv'; %s_avg='%s_averaged.csv'; %s_line='%s_line.csv'\n", name, prefix,
            name, prefix, name, prefix);
    fprintf(f, "%s_rate=%.6g; %s_k=%.6g; %s_b=%.6g; %s_stiffness='%.0f'; %s_q0=%.9g\n", name,
            r->rate_Hz, name, r->k_Npm, name, r->b_Nspm, name, r->b_Npm, name, q0_m);
}

static void list(FILE *f, const char *name, const struct table2_result *r, int n,
                 double (*value)(const struct table2_result *))
{
    fprintf(f, "%s='", name);
    for (int i = 0; i < n; i++) { fprintf(f, "%s%.6g", i ? " " : "", value(&r[i])); }
    fprintf(f, "'\n");
}

static double value_rate(const struct table2_result *r)
{
    return r->rate_Hz;
}
static double value_k(const struct table2_result *r)
{
    return r->k_Npm;
}
static double value_b(const struct table2_result *r)
{
    return r->b_Nspm;
}
static double value_stiffness(const struct table2_result *r)
{
    return (double)(long)(r->b_Npm + 0.5);
}

/* What gnuplot needs to draw the pictures: gnuplot -e "plots='DIR'" pictures.gp */
static int write_pictures(const struct drop_options *o, const struct table2_result *r)
{
    const int last = o->rates - 1;
    char prefix[512];
    FILE *f = open_out(o, "pictures.gp");
    if (f == NULL) { return 1; }
    fprintf(f, "# Made by exhand drop: gnuplot -e \"plots='ports/posix/cli/plot'\" %s/pictures.gp\n",
            o->out);
    fprintf(f, "out='%s/force_position.png'; fit='linear fit, position over force'\n", o->out);
    path(prefix, sizeof prefix, o, o->rate_Hz[0], "");
    panel(f, "a", &r[0], prefix, o->device.height_m);
    path(prefix, sizeof prefix, o, o->rate_Hz[last], "");
    panel(f, "b", &r[last], prefix, o->device.height_m);
    fprintf(f, "load plots.'/force_position.gp'\nreset\n");
    fprintf(f, "out='%s/fall.png'; q_lim_m=%.9g\nfiles='", o->out, o->device.height_m);
    for (int i = 0; i < o->rates; i++) {
        path(prefix, sizeof prefix, o, o->rate_Hz[i], "_fall.csv");
        fprintf(f, "%s%s", i ? " " : "", prefix);
    }
    fprintf(f, "'\n");
    list(f, "rates", r, o->rates, value_rate);
    list(f, "ks", r, o->rates, value_k);
    list(f, "bs", r, o->rates, value_b);
    list(f, "stiffnesses", r, o->rates, value_stiffness);
    fprintf(f, "load plots.'/fall.gp'\n");
    return fclose(f) != 0;
}

static void interrupted(int sig)
{
    (void)sig;
    posix_stop();
}

static int check(const struct drop_options *o, const struct table2_result *r, int n)
{
    int err = 0;
    for (int i = 0; i < n; i++) {
        err |= r[i].error != 0;
        if (r[i].faults) {
            fprintf(stderr, "%g Hz: the box stopped with faults %#x\n", r[i].rate_Hz, r[i].faults);
            err = 1;
        }
        if (i < o->rates && r[i].incomplete) {
            fprintf(stderr, "%g Hz: %d of %d falls were not seen to their end\n", r[i].rate_Hz,
                    r[i].incomplete, r[i].falls);
            err = 1;
        }
    }
    return err;
}

static int experiment(const struct drop_options *o)
{
    const int n = o->rates + 2 * o->rates * (int)o->spread;
    struct table2_result *r = calloc((size_t)n, sizeof *r);
    struct table2_spread s[RATES_MAX];
    const struct jobs jobs = {n, (int)o->jobs, sizeof *r, r, work, o, "runs"};
    int err;

    if (r == NULL) {
        fprintf(stderr, "drop: out of memory: a smaller --spread\n");
        return 1;
    }
    if (o->out != NULL && mkdir(o->out, 0777) != 0 && errno != EEXIST) {
        fprintf(stderr, "--out: %s: %s\n", o->out, strerror(errno));
        free(r);
        return 2;
    }
    signal(SIGINT, interrupted);
    signal(SIGTERM, interrupted);
    err = jobs_run(&jobs);
    for (int i = 0; o->spread > 0 && i < o->rates; i++) {
        const struct table2_result *first = r + o->rates + 2 * i * o->spread;
        s[i] = table2_spread(first, first + o->spread, (int)o->spread);
    }
    err |= check(o, r, n);
    if (o->out != NULL) { err |= write_tables(o, r, o->spread ? s : NULL) | write_pictures(o, r); }
    table2_print(stdout, r, o->spread ? s : NULL, o->rates);
    free(r);
    return err;
}

int cli_drop(int argc, char **argv)
{
    static struct drop_options o; /* too large for a stack to like */
    int list = 0, err;
    const struct cli_call rates = {take_rates, &o}, period = {take_period, &o};
    const struct cli_call setting = {take_setting, &o}, device = {take_device, &o};
    union {
        const struct cli_call *view;
        void *to;
    } u[4] = {{&rates}, {&period}, {&setting}, {&device}};
    const struct cli_option option[] = {
        {"rate", CLI_CALL, u[0].to, 0, 0, "HZ[,HZ...]", "loop rates, 1..20000 (the paper's six)"},
        {"period", CLI_CALL, u[1].to, 0, 0, "N/D", "one exact period in s, as a timer makes it"},
        {"k", CLI_REAL, &o.k_Npm, 0, 1e6, "N/M", "stiffness (the paper's at that rate)"},
        {"b", CLI_REAL, &o.b_Nspm, 0, 1e3, "NS/M", "damping (the paper's at that rate)"},
        {"scale", CLI_REAL, &o.scale, 0, 100, "G", "multiplies both (1)"},
        {"falls", CLI_INT, &o.falls, 1, 1000, "N", "falls a run (10)"},
        {"spread", CLI_INT, &o.spread, 0, 1000, "N", "further runs, at 1 and 1.5 times both gains (0)"},
        {"seed", CLI_INT, &o.seed, 0, 1e9, "N", "of all chance in the simulation (1)"},
        {"out", CLI_TEXT, &o.out, 0, 0, "DIR", "write logs, CSVs and tables there"},
        {"jobs", CLI_INT, &o.jobs, 1, 1024, "N", "processes at a time (one a core)"},
        {"pace", CLI_FLAG, &o.pace, 0, 0, NULL, "follow the wall clock, for people who watch"},
        {"replicates", CLI_INT, &o.replicates, 0, 100000, "N", "of the bootstrap (1000)"},
        {"set", CLI_CALL, u[2].to, 0, 0, "NAME=VALUE", "a parameter of the scene"},
        {"device", CLI_CALL, u[3].to, 0, 0, "NAME=VALUE", "a value of the simulated device"},
        {"params", CLI_FLAG, &list, 0, 0, NULL, "list both, with units and ranges"},
    };
    const struct cli_command c = {
        "drop", "[options]",
        "The paper's experiment: 0.5 kg falls 7 cm onto a virtual wall, ten times, at each rate.",
        option, (int)(sizeof option / sizeof option[0]), 0};

    o.k_Npm = o.b_Nspm = -1;
    o.scale = 1;
    o.falls = 10;
    o.seed = 1;
    o.replicates = 1000;
    o.jobs = jobs_cores();
    o.device = sim_device_default();
    for (o.rates = 0; o.rates < TABLE2_ROWS; o.rates++) {
        o.rate_Hz[o.rates] = table2_paper[o.rates].rate_Hz;
    }
    err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (list) {
        print_params();
        return 0;
    }
    return experiment(&o);
}
