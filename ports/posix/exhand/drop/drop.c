/* SPDX-License-Identifier: MIT */
/* exhand drop: the paper's falling-mass experiment. */
#include "drop/options.h"

#include "base/assign.h"
#include "base/cli.h"
#include "base/jobs.h"
#include "base/messages.h"
#include "base/outfile.h"
#include "base/param.h"
#include "base/scenes.h"
#include "drop/outdir.h"

#include <string.h>

#define RUNS 20 /* per rate, by default */

/* The image's k and b are those of the table's rows, unless they are given. */
static int load_params(struct drop_options *o)
{
    const struct exh_scene *sc = drop_scene(o);
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

/* Options that do not go together: 0, or 2 after a line on stderr. */
static int refuse_pairs(const struct drop_options *o)
{
    const struct outfile_option leaves[] = {
        {"blackbox", o->blackbox}, {"save-params", o->params.save}};
    if (o->T.num != 0 && o->rates_given) {
        cli_complain("--period and --rate: a period is a rate: give one of them");
        return 2;
    }
    if (o->blackbox && (o->rates != 1 || o->plane || o->runs != 1)) {
        cli_complain("--blackbox: one rate and one run, no plane of gains: --out names a dump for "
                     "each rate");
        return 2;
    }
    if (o->gpio.given && (o->rates != 1 || o->runs != 1 || o->plane)) {
        cli_complain("--gpio: one rate and one run, since lines are one program's: leave out "
                     "--runs and planes of gains");
        return 2;
    }
    if (contacts_check(&o->gpio, o->pace)) { return 2; }
    if (o->params.load && o->plane) {
        cli_complain("--load-params: no plane of gains, which chooses k and b itself: leave out "
                     "one of them");
        return 2;
    }
    if (o->params.save && (o->rates != 1 || o->plane)) {
        cli_complain("--save-params: one rate, and no plane of gains: give --rate");
        return 2;
    }
    return outfile_try(leaves, sizeof leaves / sizeof leaves[0]);
}

/* 1: this single run is displayed. */
static int watched(const struct drop_options *o)
{
    return o->pace || o->gpio.given || o->blackbox || o->let_go_s > 0 || o->guarded;
}

/* Can the requested run be made? Returns 0, or 2 after a line on stderr. */
static int refuse(struct drop_options *o, const struct drop_study *study)
{
    int err = assign_step(&o->device, 0, 0);
    if (err == 0 && study->refuse) { err = study->refuse(o); }
    if (err) { return err; }
    if (o->runs == 0) { o->runs = watched(o) ? 1 : RUNS; }
    if (o->T.num != 0 && !o->rates_given) {
        o->rate_Hz[0] = (double)o->T.den / o->T.num;
        o->rates = 1;
    }
    err = refuse_pairs(o);
    if (o->gpio.given) { o->jobs = 1; } /* the process that holds the lines */
    if (err == 0) { err = load_params(o); }
    for (int i = 0; err == 0 && i < o->rates; i++) {
        struct run_cfg c = drop_run_cfg(o, i, 1, 1);
        if (run_check(&c) < 0) { return 2; }
        if (o->params.save) { err = params_save_file(o->params.save, c.scene->params); }
        c = drop_run_cfg(o, i, 1.5, 1);
        if (o->gates && run_check(&c) < 0) { return 2; }
    }
    if (err) { return err; }
    return o->out && !o->plane ? outdir_open(o->out) : 0;
}

static void defaults(struct drop_options *o)
{
    memset(o, 0, sizeof *o);
    o->k_Npm = o->b_Nspm = -1;
    o->scale = 1;
    o->falls = -1;
    o->phase = -1;
    o->seed = 1;
    o->jobs = jobs_cores();
    o->device = sim_device_default();
    for (o->rates = 0; o->rates < TABLE2_ROWS; o->rates++) {
        o->rate_Hz[o->rates] = table2_paper[o->rates].rate_Hz;
    }
}

static int go(struct drop_options *o, const struct drop_study *study)
{
    int err;
    if (o->custom && (o->guarded || cli_scene_more == NULL)) {
        cli_complain(o->guarded ? "--custom and --guarded: one scene at a time"
                                : "--custom: no controller in this program: make SCENE=custom "
                                  "MODEL=FOLDER links one");
        return 2;
    }
    err = refuse(o, study);
    if (err == 0) { err = contacts_begin(&o->gpio); }
    if (o->gpio.given && err == 0) { words_begin(1); }
    if (err == 0) { err = study->run ? study->run(o) : drop_experiment(o, NULL); }
    words_end();
    contacts_end();
    return err;
}

int drop_command(int argc, char **argv, struct drop_options *o, const struct drop_study *study)
{
    int list = 0, err;
    struct cli_call rates = {drop_take_rates, o}, period = {drop_take_period, o};
    struct cli_call setting = {drop_take_setting, o}, device = {drop_take_device, o};
    struct cli_call gpio = {contacts_take, &o->gpio}, calibration = {images_take, &o->images};
    const struct cli_option option[] = {
        {"rate", CLI_CALL, &rates, 0, 0, "HZ[,HZ...]", "loop rates, 1..20000 (the paper's six)"},
        {"period", CLI_CALL, &period, 0, 0, "N/D",
            "one exact period in s, as a timer makes it; not with --rate"},
        {"k", CLI_REAL, &o->k_Npm, 0, 1e6, "N/M", "stiffness (the paper's at that rate)"},
        {"b", CLI_REAL, &o->b_Nspm, 0, 1e3, "NS/M", "damping (the paper's at that rate)"},
        {"scale", CLI_REAL, &o->scale, 0, 100, "G", "multiplies both (1)"},
        {"falls", CLI_INT, &o->falls, 1, 1000, "N", "falls a run (10)"},
        {"runs", CLI_INT, &o->runs, 1, TABLE2_RUNS_MAX, "N",
            "runs at each rate (20; 1 with --pace, --gpio, --blackbox, --let-go or --guarded)"},
        {"phase", CLI_REAL, &o->phase, 0, 1, "P",
            "the wall lies P counts above an encoder count (each run draws it)"},
        {"seed", CLI_INT, &o->seed, 0, 1e9, "N",
            "random seed of the first run; each further run adds one (1)"},
        {"out", CLI_TEXT, &o->out, 0, 0, "DIR", "write logs, CSVs of the falls and tables there"},
        {"blackbox", CLI_TEXT, &o->blackbox, 0, 0, "FILE",
            "the last seconds before a fault, a log (with --out beside the others)"},
        {"let-go", CLI_REAL, &o->let_go_s, 0, 1e9, "S",
            "release the dead-man switch at this time: a fault (never)"},
        {"jobs", CLI_INT, &o->jobs, 1, 1024, "N", "processes at a time (one a core)"},
        {"cards", CLI_FLAG, &o->cards, 0, 0, NULL,
            "through the drivers and emulated cards; results do not change"},
        {"pace", CLI_FLAG, &o->pace, 0, 0, NULL, "run in real time"},
        {"gpio", CLI_CALL, &gpio, 0, 0, CONTACTS_ARG, CONTACTS_HELP},
        {"set", CLI_CALL, &setting, 0, 0, "NAME=VALUE", "a parameter of the scene"},
        {"device", CLI_CALL, &device, 0, 0, "NAME=VALUE", "a value of the simulated device"},
        PARAMS_FILE_OPTIONS(o->params),
        {"calibration", CLI_CALL, &calibration, 0, 0, "FILE",
            "of finger 0, by `exhand calibrate` (none: the simulated device as it is, "
            "uncalibrated=1)"},
        {"guarded", CLI_FLAG, &o->guarded, 0, 0, NULL,
            "the scene with the passivity controller, and how much force it removes"},
        {"custom", CLI_FLAG, &o->custom, 0, 0, NULL,
            "the scene with a controller of your own (examples/custom)"},
        {"params", CLI_FLAG, &list, 0, 0, NULL,
            "list parameters and device values, with units and ranges"},
    };
    const struct cli_command c = {"drop", "[options]",
        "The paper's experiment: 0.5 kg falls 7 cm onto a virtual wall, ten times a run, at each "
        "rate.\nEach run draws where the wall lies between two encoder counts. --out writes log, "
        "CSV and pictures\nof the first run.\n"
        "A fall oscillates when in the last 0.5 s of its observation position moves by more than\n"
        "0.25 mm or the monitored force by more than 4 N; else it has come to rest.",
        option, (int)(sizeof option / sizeof option[0]), 0};

    defaults(o);
    err = cli_parse_more(&c, &study->more, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (list) {
        drop_print_params(drop_scene(o));
        return 0;
    }
    return go(o, study);
}

int cli_drop(int argc, char **argv)
{
    static struct drop_options o; /* too large for a stack to like */
    static const struct drop_study none = {
        {NULL, 0, "gates readings sweep grid shard border-check friction preset"}, NULL, NULL};
    return drop_command(argc, argv, &o, &none);
}
