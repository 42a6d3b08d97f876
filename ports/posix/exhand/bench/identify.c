/* SPDX-License-Identifier: MIT */
/* exhand identify: what is this device? */
#include "base/cli.h"

#include "base/assign.h"
#include "base/jobs.h"
#include "base/option.h"
#include "base/outfile.h"
#include "base/outlog.h"
#include "base/until.h"
#include "identify/estimate.h"
#include "identify/result.h"
#include "identify/session.h"
#include "identify/trace.h"

#include "identify/identify.h"

#include <string.h>

#define MOST 0.95 /* of the edges: said if fewer are used */

struct options {
    struct identify_session s;
    int64_t rate_Hz, seed, repeats;
    const char *out, *log;
};

struct found {
    const struct identify_data *data;
    struct result_file r;
    int no_memory;
};

static int take_device(void *ctx, const char *text)
{
    struct options *o = ctx;
    return assign_device(&o->s.board.device, "identify", text);
}

static void defaults(struct options *o)
{
    memset(o, 0, sizeof *o);
    o->rate_Hz = 2000;
    o->seed = 1;
    o->s.mass_kg = 0.5;
    o->s.board = posix_config_default();
}

/* --- results --- */

/* truth: of a simulated device, or NULL. */
static void print(
    const struct estimate_of *e, const struct result_file *r, const struct model *truth)
{
    printf("%-9s %-8s %11s  %11s    %-11s %s\n", "", "", "value", "95 %", "",
        truth ? "      truth" : "");
    for (int i = 0; i < MODEL_PARS; i++) {
        printf("%-9s %-8s %11.5g  %11.5g .. %-11.5g", model_row[i].name, model_row[i].unit,
            r->value.value[i], r->low.value[i], r->high.value[i]);
        if (truth) { printf(" %11.5g", truth->value[i]); }
        printf("\n");
    }
    printf("%-9s %-8s %11.5g  %11.5g .. %-11.5g", "mu_both", "", model_mu(&r->value), r->mu_low,
        r->mu_high);
    if (truth) { printf(" %11.5g", model_mu(truth)); }
    printf("\n%u rounds, %zu edges of counts", e->rounds, e->counts);
    if (e->counted < MOST * (double)e->counts) {
        printf(", %.0f %% used: the string slackened and struck in the others",
            100 * e->counted / (double)e->counts);
    }
    printf("; residual %.3g of %.3g allowed: %s\n", r->residual, RESULT_RESIDUAL_MAX,
        r->residual <= RESULT_RESIDUAL_MAX ? "the model fits" : "the model does NOT fit");
}

static void write_result(FILE *f, const void *ctx)
{
    const struct found *x = ctx;
    result_write(f, &x->r);
}

static void write_trace(FILE *f, const void *ctx)
{
    const struct found *x = ctx;
    (void)identify_trace(f, x->data, &x->r.value, 1);
}

static void write_pictures(FILE *f, const void *ctx)
{
    (void)ctx;
    outfile_pictures(f, "identify");
    fprintf(f, "out='identify.png'; trace='trace.csv'\nload plots.'/identify.gp'\n");
}

static int write_files(const char *dir, const struct found *x)
{
    if (outfile_write(dir, "trace.csv", write_trace, x) != 0 ||
        outfile_write(dir, "pictures.gp", write_pictures, x) != 0) {
        return 1;
    }
    /* A model that does not fit is shown, but not written for the advisor. */
    return x->r.residual <= RESULT_RESIDUAL_MAX ? outfile_write(dir, "device.txt", write_result, x)
                                                : 0;
}

static int tell(const struct options *o, const struct identify_data *data)
{
    struct estimate_of e;
    struct found x = {.data = data};
    const struct model truth = model_of(&o->s.board.device, data->T_s);
    int err = identify_estimate(&e, data);
    if (err == 0 && e.fit.cost <= RESULT_RESIDUAL_MAX) {
        err = identify_resample(&e, data, jobs_cores());
    }
    if (err == JOBS_INTERRUPTED) { return err; }
    if (err) {
        cli_complain(err < 0 ? "out of memory" : "the run has too little to fit");
        return 1;
    }
    result_take(&x.r, &e, data->T_s, data->mass_kg);
    print(&e, &x.r, o->log ? NULL : &truth);
    if (o->out && write_files(o->out, &x)) { return 1; }
    return x.r.residual > RESULT_RESIDUAL_MAX;
}

/* --- a run --- */

/* 0, or a status after a line on stderr. */
static int run(struct options *o, struct identify_data *data)
{
    int err;
    if (o->log) { return identify_data_log(data, o->log); }
    if (o->out) {
        o->s.board.log = outfile_in(o->out, "identify.exh");
        if (o->s.board.log == NULL) { return 2; }
    }
    err = identify_session(&o->s, data) ? 2 : 0;
    if (o->s.board.log && outlog_close(o->s.board.log) != 0) { err = 1; }
    return posix_interrupted() ? 130 : err;
}

static int identify(struct options *o)
{
    static struct identify_data data;
    int err;
    o->s.rate_Hz = (uint32_t)o->rate_Hz;
    o->s.repeats = (int)o->repeats;
    o->s.board.seed = (uint64_t)o->seed;
    if (o->out && outfile_dir(o->out, "identify.exh") != 0) { return 2; }
    until_catch(UNTIL_RESTARTS);
    err = run(o, &data);
    if (err == 0) {
        printf("the device ran for %.1f s%s\n", (double)data.n * data.T_s,
            data.result == EXH_PROBE_DONE ? "" : ", and stopped before its end");
        fflush(stdout);
    }
    if (err == 0 && data.result != EXH_PROBE_DONE) {
        const struct identify_run *r = &identify_state()->run;
        cli_complain("%s, round %u: %s: put it right and begin again%s",
            identify_part_text(r->part), r->repeat, identify_result_text(data.result),
            data.result == EXH_PROBE_STILL ? ", perhaps with a lighter mass" : "");
        err = 1;
    }
    if (err == 0) { err = tell(o, &data); }
    identify_data_free(&data);
    return err;
}

int cli_identify(int argc, char **argv)
{
    static struct options o;
    struct cli_call device = {take_device, &o};
    const struct cli_option option[] = {
        {"mass", CLI_REAL, &o.s.mass_kg, 0.01, 5, "KG", "the known mass (0.5)"},
        {"hung", CLI_REAL, &o.s.hung_kg, 0.01, 5, "KG",
            "the true mass, to simulate a mistake (the same)"},
        {"rate", CLI_INT, &o.rate_Hz, 100, 20000, "HZ", "loop rate (2000)"},
        {"repeats", CLI_INT, &o.repeats, 2, 100, "N", "rounds (14)"},
        {"seed", CLI_INT, &o.seed, 0, 1e15, "N", "random seed of the simulation (1)"},
        {"from-log", CLI_TEXT, &o.log, 0, 0, "LOG", "a log of the scene instead of a run"},
        {"out", CLI_TEXT, &o.out, 0, 0, "DIR",
            "write log, device.txt and a picture's script there"},
        {"device", CLI_CALL, &device, 0, 0, "NAME=VALUE",
            "a value of the simulated device: exhand drop --params"},
    };
    const struct cli_command c = {"identify", "[options]",
        "What is this device? Pulses of the free rotor, then pulls, steps, a square wave and drops "
        "of\n"
        "a known mass; a model of rotor, string, friction and delay is fitted to the encoder's\n"
        "counts. Newton and metre come from the known mass: a wrong mass scales all values in "
        "newton\n"
        "or kilogram, and no residual shows it. Exit status 1: the model does not fit.",
        option, (int)(sizeof option / sizeof option[0]), 0};
    int err;
    defaults(&o);
    err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    err = assign_step(&o.s.board.device, 0, 0);
    return err ? 2 : identify(&o);
}
