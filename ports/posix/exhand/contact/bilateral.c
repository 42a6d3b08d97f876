/* SPDX-License-Identifier: MIT */
/* exhand bilateral: the paper's second experiment. */
#include "contact/bilateral.h"

#include "box/hand_record.h"
#include "box/world_line.h"

#include "base/assign.h"
#include "base/cli.h"
#include "base/option.h"
#include "base/outfile.h"
#include "base/param.h"

#include "world/world.h"

#include <stdio.h>
#include <string.h>

static struct hand_record recorded; /* of --record */

static int load_scene(struct bilateral_options *o)
{
    char why[700];
    if (o->scene == NULL) { return 0; }
    o->run.scene = world_load_file(o->scene, why, sizeof why);
    if (o->run.scene == NULL) {
        cli_complain("--scene: %s", why);
        return 2;
    }
    o->run.board.exo.fingers &= world_scene(o->run.scene)->fingers;
    if (o->run.board.exo.fingers == 0) {
        cli_complain("--scene: %s: holds none of the fingers in use: choose others with --fingers",
            o->scene);
        return 2;
    }
    return 0;
}

/* Set-up softens a default material that the rate does not allow: what is said of the run is so. */
static void say_softened(struct bilateral_options *o)
{
    const struct exh_params *p = exh_scene_bilateral.params;
    uint32_t at_k, at_b;
    double k, b;
    if (o->scene || !cli_signal_find(p->table, "mat_k", &at_k) ||
        !cli_signal_find(p->table, "mat_b", &at_b)) {
        return;
    }
    k = cli_signal_value(&exh_material_rows[0], p->active[at_k]);
    b = cli_signal_value(&exh_material_rows[1], p->active[at_b]);
    if (k < o->run.k_Npm || b < o->run.b_Nspm) {
        cli_complain("k %.6g N/m, b %.6g Ns/m: outside the rule of gains at %.6g Hz: softened to "
                     "k %.6g, b %.6g (--set rule_on=0 keeps them)",
            o->run.k_Npm, o->run.b_Nspm, (double)o->run.rate_Hz, k, b);
        o->run.k_Npm = k;
        o->run.b_Nspm = b;
    }
}

/* Whether a run with these parameters begins at all: 0, or 2 after a line on stderr. */
static int probe(struct bilateral_options *o)
{
    struct bilateral_run_cfg c = bilateral_at_speed(o, o->speed[0].mps);
    struct bilateral_run r;
    int err;
    if (o->udp) { return 0; }
    c.board.max_ticks = 1;
    c.blackbox = NULL;
    err = bilateral_run(&c, &r);
    bilateral_run_free(&r);
    if (err == 0) { say_softened(o); }
    if (err == 0 && o->params.save) {
        return params_save_file(o->params.save, exh_scene_bilateral.params);
    }
    return err < 0 ? 2 : 0;
}

/* Those of the first material, which is that of walls: what is said of the run. */
static int take_gains(struct bilateral_options *o)
{
    struct exh_params *p = exh_scene_bilateral.params;
    uint32_t k, b;
    exh_scene_bilateral.defaults();
    if (params_take(o->params.load, p, o->params.image, o->params.len_B) < 0) { return 2; }
    if (o->scene || !cli_signal_find(p->table, "mat_k", &k) ||
        !cli_signal_find(p->table, "mat_b", &b)) {
        return 0;
    }
    o->run.k_Npm = cli_signal_value(&exh_material_rows[0], p->staged[k]);
    o->run.b_Nspm = cli_signal_value(&exh_material_rows[1], p->staged[b]);
    return 0;
}

static int load_params(struct bilateral_options *o)
{
    int err;
    if ((o->params.load || o->params.save) && o->study) {
        cli_complain("--load-params, --save-params: leave out --sweep, --check, --hands, --crisp");
        return 2;
    }
    if (o->params.save && o->udp) {
        cli_complain("--save-params: leave out --udp");
        return 2;
    }
    if (o->params.load && (o->run.k_Npm >= 0 || o->run.b_Nspm >= 0)) {
        cli_complain("--load-params: the image has stiffness and damping: leave out --k and --b; "
                     "--set mat_k=... "
                     "comes behind it");
        return 2;
    }
    if (o->params.load) {
        o->run.live.image = o->params.image;
        o->run.live.name = o->params.load;
    }
    err = params_file_read(&o->params);
    o->run.live.image_B = o->params.len_B;
    return err == 0 && o->params.load ? take_gains(o) : err;
}

/* One run, as it was recorded, instead of approaches. */
static int load_record(struct bilateral_options *o)
{
    int err;
    if (o->record == NULL && o->columns != NULL) {
        cli_complain("--record-columns: goes with --record");
        return 2;
    }
    if (o->record == NULL) { return 0; }
    if (o->study) {
        cli_complain("--record: what was recorded is played once: leave out --sweep, --check, "
                     "--hands, --crisp");
        return 2;
    }
    err = hand_record_read(&recorded, o->record, o->columns, o->record_Hz, &o->run.board.exo);
    if (err) { return err; }
    hand_record_use(&recorded, &o->run.board.exo);
    o->speeds = 1;
    (void)snprintf(o->speed[0].name, BILATERAL_NAME_B, "recorded");
    return 0;
}

/* Each finger is the mass on its string, and held by the hand: the lightest and the stiffest
 * decide. */
static int steps_too_long(struct bilateral_options *o)
{
    const struct sim_finger_par *const p = o->run.board.exo.finger;
    struct sim_device d = o->run.board.device;
    double hand_npm = 0, hand_nspm = 0;
    int err;
    d.mass_kg = p[0].mass_kg;
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        if (p[f].mass_kg < d.mass_kg) { d.mass_kg = p[f].mass_kg; }
        if (p[f].k_Npm > hand_npm) { hand_npm = p[f].k_Npm; }
        if (p[f].b_Nspm > hand_nspm) { hand_nspm = p[f].b_Nspm; }
    }
    err = assign_step(&d, hand_npm, hand_nspm);
    o->run.board.device.substep_s = d.substep_s;
    return err;
}

/* Options that do not go together: 0, or 2 after a line on stderr. */
static int refuse(const struct bilateral_options *o)
{
    if (o->run.trace_every && o->udp) {
        cli_complain("--trace: leave out --udp: a world elsewhere asks for its own");
        return 2;
    }
    if (o->run.blackbox && (o->speeds != 1 || o->study)) {
        cli_complain("--blackbox: one speed, once: --out names a dump for each speed");
        return 2;
    }
    return 0;
}

/* --set has priority over the other options in the run, so its value is printed. */
static void gain(const struct bilateral_options *o, const char *name, double paper, double *value)
{
    if (*value < 0) { *value = paper; }
    for (int i = 0; i < o->settings; i++) {
        if (strcmp(o->setting[i].name, name) == 0) { *value = o->setting[i].value; }
    }
}

/* Of walls; a scene has its own. */
static void own_gains(struct bilateral_options *o)
{
    if (o->scene) { return; }
    gain(o, "mat_k", PAPER_K_NPM, &o->run.k_Npm);
    gain(o, "mat_b", PAPER_B_NSPM, &o->run.b_Nspm);
}

static int go(struct bilateral_options *o, double rate_Hz, const struct bilateral_study *study)
{
    const struct outfile_option leaves[] = {
        {"blackbox", o->run.blackbox}, {"save-params", o->params.save}};
    int err = study->refuse ? study->refuse(o, rate_Hz) : 0;
    if (err == 0) { err = steps_too_long(o); }
    if (err == 0) { err = load_scene(o); }
    if (err == 0) { err = load_record(o); }
    if (err == 0) { err = load_params(o); }
    if (err) { return err; }
    o->run.rate_Hz = (uint32_t)(rate_Hz + 0.5);
    own_gains(o);
    if (world_line_use(o->udp, o->key, &o->run.board.line)) { return 2; }
    o->run.trial = o->study;
    if (o->udp) {
        o->run.board.pace = 1;
        o->run.board.slack_s = WORLD_LINE_SLACK_S;
    }
    err = refuse(o);
    if (err == 0) { err = outfile_try(leaves, sizeof leaves / sizeof leaves[0]); }
    if (err == 0 && o->out) { err = bilateral_out_open(o->out); }
    if (err) { return err; }
    err = probe(o);
    if (err) { return err; }
    err = study->run ? study->run(o) : bilateral_experiment(o);
    if (o->out) { bilateral_out_clear(o->out); }
    world_free(o->run.scene);
    sim_trace_free(&o->trace);
    hand_record_free(&recorded);
    return err;
}

/* --- the command --- */

static struct bilateral_options is;
static struct {
    double rate_Hz;
    int list;
} asked;

static struct cli_call speeds = {bilateral_take_speeds, &is},
                       fingers = {bilateral_take_fingers, &is};
static struct cli_call link = {bilateral_take_link, &is}, setting = {bilateral_take_setting, &is};
static struct cli_call device = {bilateral_take_device, &is}, pose = {bilateral_take_pose, &is};
static struct cli_call calibration = {images_take, &is.images};
static const struct cli_option option[] = {
    {"speed", CLI_CALL, &speeds, 0, 0, "V[,V...]",
        "slow, natural, fast or m/s of string (these three)"},
    {"fingers", CLI_CALL, &fingers, 0, 0, "F[,F...]",
        "thumb, index, middle, ring, little or all (index)"},
    {"record", CLI_TEXT, &is.record, 0, 0, "FILE",
        "the fingers do what a glove recorded, instead of approaches"},
    {"record-rate", CLI_REAL, &is.record_Hz, 0.1, 10000, "HZ",
        "of its rows, if they have no clock (100)"},
    {"record-columns", CLI_TEXT, &is.columns, 0, 0, "LIST", "of `exhand glove`"},
    {"approaches", CLI_INT, &is.approaches, 1, BILATERAL_CONTACTS_MAX, "N", "at each speed (5)"},
    {"at", CLI_REAL, &is.run.at_m, 0.008, 0.06, "M", "string paid out where the wall is (0.030)"},
    {"pose", CLI_CALL, &pose, 0, 0, "NAME",
        "pose of the hand where no finger in use bends it (flat)"},
    {"scene", CLI_TEXT, &is.scene, 0, 0, "FILE", "a scene of the world simulator instead of walls"},
    {"rate", CLI_REAL, &asked.rate_Hz, 1, 20000, "HZ", "of the loop (2000)"},
    {"k", CLI_REAL, &is.run.k_Npm, 0, 1e6, "N/M", "stiffness (20000; with --scene its materials')"},
    {"b", CLI_REAL, &is.run.b_Nspm, 0, 1e3, "NS/M", "damping (60; with --scene its materials')"},
    {"link", CLI_CALL, &link, 0, 0, "SPEC",
        "none, trace=FILE (round trips), delay=S,jitter=S,loss=SHARE,... (none)"},
    {"fps", CLI_REAL, &is.run.fps, 1, 2000, "N", "frames of the world a second (400)"},
    {"trace", CLI_INT, &is.run.trace_every, 1, 1e6, "N",
        "the world asks for a trace of every N-th tick, over the link (none)"},
    {"ray", CLI_REAL, &is.run.ray_m, 0, 1, "M",
        "distance up to which walls are reported (no limit)"},
    {"world-from", CLI_REAL, &is.run.from_s, 0, 1e9, "S", "the world starts at this time (0)"},
    {"world-until", CLI_REAL, &is.run.until_s, 0, 1e30, "S", "the world ends at this time (never)"},
    {"udp", CLI_TEXT, &is.udp, 0, 0, "HOST:PORT",
        "the world is another process there; in real time"},
    {"key", CLI_TEXT, &is.key, 0, 0, "FILE",
        "with --udp: the key of both sides, 32 hexadecimal digits; packets without it are ignored"},
    {"cards", CLI_FLAG, &is.cards, 0, 0, NULL,
        "through the drivers and emulated cards; results do not change"},
    {"seed", CLI_INT, &is.seed, 0, 1e9, "N", "random seed of the simulation (1)"},
    {"seeds", CLI_INT, &is.seeds, 1, 100, "N",
        "number of seeds of the figures, from --seed on; the first is printed and written (8)"},
    {"out", CLI_TEXT, &is.out, 0, 0, "DIR", "write logs, CSVs and what pictures need there"},
    {"blackbox", CLI_TEXT, &is.run.blackbox, 0, 0, "FILE",
        "the last seconds before a fault, a log (with --out beside the others)"},
    {"let-go", CLI_REAL, &is.run.board.let_go_s, 0, 1e9, "S",
        "release the dead-man switch at this time: a fault (never)"},
    {"set", CLI_CALL, &setting, 0, 0, "NAME=VALUE", "a parameter of the scene, of all fingers"},
    {"device", CLI_CALL, &device, 0, 0, "NAME=VALUE",
        "a value of the simulated hand, glove or motors"},
    PARAMS_FILE_OPTIONS(is.params),
    {"calibration", CLI_CALL, &calibration, 0, 0, "FILE[,FILE...]",
        "of the fingers, or a directory of them (none: the simulated device as it is, "
        "uncalibrated=1)"},
    {"params", CLI_FLAG, &asked.list, 0, 0, NULL, "list all values, with units and ranges"},
};

static const struct cli_command command = {"bilateral", "[options]",
    "The paper's second experiment: a hand in glove and exoskeleton approaches a virtual "
    "object at\n"
    "three speeds. A world simulator at the other end of a link says where its surface is; "
    "the\n"
    "contact is frozen before it is touched and rendered here alone, whatever the link does.",
    option, (int)(sizeof option / sizeof option[0]), 0};

int bilateral_command(int argc, char **argv, const struct bilateral_study *study)
{
    int err;
    bilateral_defaults(&is);
    asked.rate_Hz = 2000;
    asked.list = 0;
    err = cli_parse_more(&command, &study->more, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (asked.list) {
        own_gains(&is);
        return bilateral_print_params(&is);
    }
    return go(&is, asked.rate_Hz, study);
}

int cli_bilateral(int argc, char **argv)
{
    static const struct bilateral_study none = {
        {NULL, 0, "preset sweep check hands crisp jobs"}, NULL, NULL};
    return bilateral_command(argc, argv, &none);
}
