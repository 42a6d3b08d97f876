/* SPDX-License-Identifier: MIT */
/* exhand glove: recordings as stable angles, logs, a stock glove. */
#include "glove/modes.h"

#include "base/names.h"
#include "base/assign.h"
#include "base/cli.h"
#include "glove_tty.h"
#include "base/option.h"
#include "base/param.h"
#include "box/glove_image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- options with a syntax of their own --- */

static int take_setting(void *ctx, const char *text)
{
    struct glove_options *o = ctx;
    char name[ASSIGN_NAME_B];
    double value;
    if (assign_split("set", text, name, &value)) { return 2; }
    if (strncmp(name, "cal_", 4) == 0 || strcmp(name, "user") == 0 || strcmp(name, "glove") == 0 ||
        strcmp(name, "present") == 0) {
        cli_complain("--set: %s: comes with the calibration: give --calibration FILE", name);
        return 2;
    }
    if (strcmp(name, "glove_fc") == 0) { o->fc_given = 1; }
    if (cli_param_set(exh_scene_glove.params, name, value) < 0) { return 2; }
    if (o->settings == GLOVE_SETTINGS) {
        cli_complain("--set: at most %d", GLOVE_SETTINGS);
        return 2;
    }
    o->setting[o->settings++] = (struct run_setting){
        cli_signal_find(exh_scene_glove.params->table, name, NULL)->name, value};
    return 0;
}

/* One of the motor's device or of the glove's chain: no name is in both. */
static int take_device(void *ctx, const char *text)
{
    struct glove_options *o = ctx;
    const struct sim_device_row *row;
    char name[ASSIGN_NAME_B];
    double value;
    int err;
    if (assign_split("device", text, name, &value)) { return 2; }
    err = sim_glove_set(&o->chain, name, value, &row);
    if (err && row == NULL) { err = sim_device_set(&o->device, name, value, &row); }
    return err ? assign_refused("glove", name, value, row) : 0;
}

/* All parameters except the calibration's, which are the last: 22 of each are not informative. */
static void print_params(void)
{
    const struct exh_signal_table *all = exh_scene_glove.params->table;
    const struct exh_signal_table t = {all->group, (uint16_t)(all->groups - 1)};
    printf(
        "Parameters of the scene (--set NAME=VALUE; those of the calibration come from a file)\n");
    cli_signal_print(stdout, &t, NULL);
    printf(
        "\nThe simulated glove and its card (--device NAME=VALUE; `exhand drop --params` lists the "
        "motor's)\n");
    for (int i = 0; i < sim_glove_rows; i++) {
        const struct sim_device_row *r = &sim_glove_row[i];
        printf("  %-13s %-8s %14.12g  %14.12g .. %-14.12g %-8s %s\n", r->name, names_unit(r->unit),
            r->value, r->min, r->max, r->sure, r->help);
    }
}

/* --- the command --- */

int glove_bad(const char *what)
{
    cli_complain("%s: `exhand glove --help` lists the options", what);
    return 2;
}

/* What would do nothing is not meant so. */
static int check_rest(const struct glove_options *o)
{
    const struct {
        int wrong;
        const char *why;
    } row[] = {
        {o->play && !o->record, "--play: goes with --record"},
        {o->serial && (o->play || o->does || o->cards),
            "--serial: a hand is in that glove: leave --play, --does and --cards out"},
        {o->serial && o->pose && (o->record || o->tips || o->deg || o->calibration || o->settings),
            "--pose: with --serial its rows are codes as they come: leave --record, --tips, --deg, "
            "--calibration and --set out"},
        {o->glove_Hz > 0 && !o->serial, "--glove-rate: goes with --serial"},
        {(o->does && !o->record) || (o->pose && !o->record && !o->serial),
            "--does and --pose: go with --record, --pose with --serial, too"},
        {(o->does || o->pose) && o->play,
            "--play: says what the hand does: leave --does and --pose out"},
        {o->seconds > 0 && o->csv, "--seconds: a recording is as long as it is"},
    };
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        if (row[i].wrong) { return glove_bad(row[i].why); }
    }
    return 0;
}

static int check(const struct glove_options *o)
{
    if (!o->study && !o->csv && !o->record && !o->serial) {
        return glove_bad("what to do is missing: --csv, --record or --serial");
    }
    if ((o->record || o->serial) && o->csv) {
        return glove_bad("--record or --serial, and --csv: one at a time");
    }
    if (o->csv && o->rate_Hz <= 0 && !o->columns) {
        return glove_bad("--csv: --rate HZ says how fast its rows came");
    }
    if (o->unit && recording_unit_of(o->unit) == RECORDING_GUESS) {
        cli_complain("--unit: %.60s: give codes, rad, deg or turn", o->unit);
        return 2;
    }
    if ((o->columns || o->scale) && !o->csv && !o->play) {
        return glove_bad("--columns, --scale: of the rows of --csv or --play");
    }
    if (o->scale && o->unit && recording_unit_of(o->unit) != RECORDING_CODES) {
        return glove_bad("--scale: makes codes of the rows: leave out --unit");
    }
    if ((o->tips || o->deg) && (!(o->csv || (o->serial && !o->record)) || o->study)) {
        return glove_bad("--tips and --deg: go with --csv, or with --serial without --record");
    }
    return check_rest(o);
}

static int load_calibration(const char *path)
{
    static struct exh_glove_cal cal;
    const int err = glove_image_read(&cal, "calibration", path);
    return err ? err : glove_stage_cal(&cal, NULL) < 0 ? 2 : 0; /* one that was read is taken */
}

static int run(struct glove_options *o, const struct glove_study *study)
{
    int err = study->check ? study->check(o) : 0;
    if (err == 0) { err = check(o); }
    if (err == 0 && o->calibration && !o->serial) { err = load_calibration(o->calibration); }
    if (err) { return err; }
    if ((o->record || o->serial) && o->rate_Hz <= 0) { o->rate_Hz = exh_scene_glove.rate_Hz; }
    if (o->serial) {
        if (o->glove_Hz <= 0) { o->glove_Hz = GLOVE_SERIAL_HZ; }
        return glove_serial(o);
    }
    if (o->record) { return glove_record(o); }
    return o->study ? study->run(o) : glove_csv(o);
}

int glove_command(int argc, char **argv, const struct glove_study *study)
{
    static struct glove_options o;
    int params = 0;
    struct cli_call set = {take_setting, &o}, device = {take_device, &o};
    const struct cli_option option[] = {
        {"csv", CLI_TEXT, &o.csv, 0, 0, "FILE",
            "a recording: 22 codes or angles a line; - is standard input"},
        {"rate", CLI_REAL, &o.rate_Hz, 1, GLOVE_RATE_TOP, "HZ",
            "of the rows, or of the loop (2000)"},
        {"tips", CLI_FLAG, &o.tips, 0, 0, NULL, "joints and fingertips of the robot hand too"},
        {"deg", CLI_FLAG, &o.deg, 0, 0, NULL, "angles in degrees, not radians"},
        {"unit", CLI_TEXT, &o.unit, 0, 0, "UNIT",
            "of the rows: codes, rad, deg, turn; else guessed"},
        {"columns", CLI_TEXT, &o.columns, 0, 0, "LIST",
            "which columns are its 22 sensors: 3-24, or 8-14,16-30, or names; time=1 (time_ms, "
            "time_us; clock=4-6: h, m, s), label=24"},
        {"scale", CLI_TEXT, &o.scale, 0, 0, "A[,B]",
            "a code is A times the row's number and B: 256,-32768 of 8-bit codes"},
        {"calibration", CLI_TEXT, &o.calibration, 0, 0, "FILE",
            "the user's calibration (a default hand)"},
        {"record", CLI_TEXT, &o.record, 0, 0, "FILE",
            "run the scene on the simulated glove, or --serial, log it there"},
        {"serial", CLI_TEXT, &o.serial, 0, 0, "DEVICE",
            "a stock glove of 22 sensors on this line; rows like --csv's, or --record"},
        {"glove-rate", CLI_REAL, &o.glove_Hz, GLOVE_TTY_RATE_MIN_HZ, GLOVE_TTY_RATE_MAX_HZ, "HZ",
            "with --serial: its frames (90)"},
        {"play", CLI_TEXT, &o.play, 0, 0, "FILE",
            "with --record: the hand does what this recording says"},
        {"does", CLI_TEXT, &o.does, 0, 0, "WHAT", "with --record: rest, poses, grasp or wave"},
        {"pose", CLI_TEXT, &o.pose, 0, 0, "NAME",
            "with --record: begin in this pose; with --serial: rows of codes for `exhand calibrate "
            "--glove`, named so"},
        {"seconds", CLI_REAL, &o.seconds, 0.001, 100000, "S",
            "duration (10, or all of --play; --serial: until Ctrl-C)"},
        {"cards", CLI_FLAG, &o.cards, 0, 0, NULL,
            "codes through the drivers and emulated cards; results do not change"},
        {"seed", CLI_INT, &o.seed, 0, 9e15, "N", "of the simulation"},
        {"set", CLI_CALL, &set, 0, 0, "NAME=VALUE", "a parameter of the scene"},
        {"device", CLI_CALL, &device, 0, 0, "NAME=VALUE", "one of the simulation"},
        {"params", CLI_FLAG, &params, 0, 0, NULL, "list both"},
    };
    const struct cli_command c = {"glove", "--csv FILE --rate HZ | --record FILE | --serial DEVICE",
        "Glove codes to stable angles and fingertips.", option,
        (int)(sizeof option / sizeof option[0]), 0};
    int err;
    memset(&o, 0, sizeof o);
    o.seed = 1;
    o.device = sim_device_default();
    o.chain = sim_glove_default();
    exh_scene_glove.defaults();
    err = cli_parse_more(&c, &study->more, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (params) {
        print_params();
        return 0;
    }
    if (assign_step(&o.device, 0, 0)) { return 2; }
    return run(&o, study);
}

int cli_glove(int argc, char **argv)
{
    static const struct glove_study none = {
        {NULL, 0, "selftest skew log from to span travel span-current"}, NULL, NULL};
    return glove_command(argc, argv, &none);
}
