/* SPDX-License-Identifier: MIT */
/* exhand run: a box that goes on, on the simulated device. */
#include "base/cli.h"

#include "base/assign.h"
#include "box/glove_image.h"
#include "box/glove_line.h"
#include "box/world_line.h"
#include "live/live.h"
#include "live/log_turn.h"
#include "slave/slave.h"
#include "base/option.h"
#include "base/outfile.h"
#include "base/param.h"
#include "base/scenes.h"
#include "base/until.h"
#include "base/messages.h"

#include "exhand/error.h"

#include <stdio.h>
#include <string.h>

#define IMAGE_B 65536

/* --- options --- */

static const struct exh_scene *scene_of(const struct live_options *o)
{
    static const struct exh_scene *const all[] = {
        &exh_scene_drop, &exh_scene_guarded, &exh_scene_bilateral};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        if (strcmp(o->scene, all[i]->name) == 0) { return all[i]; }
    }
    if (cli_scene_more && strcmp(o->scene, cli_scene_more->name) == 0) { return cli_scene_more; }
    cli_complain("--scene: %s: give drop, guarded or bilateral%s", o->scene,
        cli_scene_more ? ", or custom" : "");
    return NULL;
}

/* What may be set depends on the scene, which may come later. */
static int take_set(void *ctx, const char *text)
{
    struct live_options *o = ctx;
    if (o->sets == LIVE_SETTINGS_MAX) {
        cli_complain("--set: at most %d", LIVE_SETTINGS_MAX);
        return 2;
    }
    o->set[o->sets++] = text;
    return 0;
}

static int take_fingers(void *ctx, const char *text)
{
    struct live_options *o = ctx;
    o->fingers = text;
    return bilateral_take_fingers(&o->hand, text);
}

static int take_speed(void *ctx, const char *text)
{
    struct live_options *o = ctx;
    o->speed = text;
    return bilateral_take_speeds(&o->hand, text);
}

/* One of a scene that is not bilateral. */
static int settle(struct live_options *o, const struct exh_scene *sc, int i)
{
    char name[ASSIGN_NAME_B];
    double value;
    if (assign_split("set", o->set[i], name, &value)) { return 2; }
    if (cli_param_set_by(sc->params, "--set: ", name, value) < 0) { return 2; }
    o->setting[i] =
        (struct run_setting){cli_signal_find(sc->params->table, name, NULL)->name, value};
    return 0;
}

/* A world elsewhere, and what the simulated hand does before it. */
static int hand_of(struct live_options *o, const struct exh_scene *sc)
{
    struct sim_exo_par *const exo = &o->hand.run.board.exo;
    const struct {
        const char *name, *value;
    } own[] = {{"udp", o->udp}, {"key", o->hand.key}, {"record", o->record},
        {"fingers", o->fingers}, {"speed", o->speed}};
    int err = 0;
    if (o->hand.columns && o->record == NULL) {
        cli_complain("--record-columns: goes with --record");
        return 2;
    }
    for (size_t i = 0; sc != &exh_scene_bilateral && i < sizeof own / sizeof own[0]; i++) {
        if (own[i].value == NULL) { continue; }
        cli_complain("--%s: %.60s: goes with --scene bilateral, not %s", own[i].name, own[i].value,
            o->scene);
        return 2;
    }
    if (o->slack_s < 0) { o->slack_s = o->udp && !o->gpio.given ? WORLD_LINE_SLACK_S : 0; }
    o->pace |= o->udp != NULL;
    err = world_line_use(o->udp, o->hand.key, &o->hand.run.board.line);
    if (err || o->record == NULL) { return err; }
    err = hand_record_read(&o->recorded, o->record, o->hand.columns, o->record_Hz, exo);
    if (err == 0) { err = hand_record_again(&o->recorded); }
    if (err == 0) { hand_record_use(&o->recorded, exo); }
    return err;
}

static int settle_all(struct live_options *o, const struct exh_scene *sc)
{
    int err = 0;
    sc->defaults();
    for (int i = 0; err == 0 && i < o->sets; i++) {
        err = sc == &exh_scene_bilateral ? bilateral_take_setting(&o->hand, o->set[i])
                                         : settle(o, sc, i);
    }
    return err;
}

static int read_params(struct live_options *o)
{
    static unsigned char image[IMAGE_B];
    const long len = o->params ? outfile_read("load-params", o->params, "image that a run saved",
                                     image, sizeof image)
                               : 0;
    if (len < 0) { return (int)-len; }
    o->live.image = o->params ? image : NULL;
    o->live.image_B = (size_t)len;
    o->live.name = o->params;
    return 0;
}

static int open_modbus(const struct live_options *o)
{
    const struct mail_cfg mail = {o->save, o->write, o->remote};
    if (o->modbus == NULL) { return 0; }
    mail_open(&mail);
    return live_modbus_open(o->modbus);
}

/* What clients may do goes with somewhere they come to. */
static int check_clients(const struct live_options *o)
{
    if (o->modbus == NULL && (o->save || o->remote || o->write)) {
        cli_complain(
            "--modbus-write, --save and --remote: what clients may do: only with --modbus");
        return 2;
    }
    if (o->save && !o->write) {
        cli_complain(
            "--save: %s: clients only read, and save nothing: give --modbus-write, too", o->save);
        return 2;
    }
    return 0;
}

/* Everything that can be refused before the loop. */
static int prepare(struct live_options *o, const struct exh_scene *sc)
{
    const struct outfile_option leaves[] = {
        {"log", o->log}, {"blackbox", o->blackbox}, {"save", o->save}};
    int err = settle_all(o, sc);
    if (err == 0) { err = hand_of(o, sc); }
    if (err == 0 && o->seconds * o->rate_Hz >= 4294967295.0) {
        cli_complain("--seconds: %.6g: at %.6g Hz %.0f at most, or leave it out", o->seconds,
            o->rate_Hz, 4294967294.0 / o->rate_Hz);
        err = 2;
    }
    if (err == 0) { err = check_clients(o); }
    if (err == 0 && o->slack_s > 0 && !o->pace) {
        cli_complain("--slack: nothing is late in virtual time: only with --pace");
        err = 2;
    }
    /* A real output would stay as long, and no fault would show it. */
    if (err == 0 && o->slack_s > 0 && o->gpio.given) {
        cli_complain("--slack: not with --gpio: a real output has no time to make up for");
        err = 2;
    }
    if (err == 0 && o->glove && (sc != &exh_scene_bilateral || !o->pace || o->params)) {
        cli_complain(
            "--glove-serial: goes with --scene bilateral and --pace, without --load-params");
        err = 2;
    }
    if (err == 0 && o->glove_image && !o->glove) {
        cli_complain(
            "--glove-calibration: the simulated glove is calibrated: goes with --glove-serial");
        err = 2;
    }
    if (err == 0 && o->glove_image) {
        err = glove_image_read(&o->glove_cal, "glove-calibration", o->glove_image);
    }
    if (err == 0) { err = contacts_check(&o->gpio, o->pace); }
    if (err == 0) { err = read_params(o); }
    if (err == 0 && ((o->log_size.B && !o->log) || (o->log_size.keep >= 0 && !o->log_size.B))) {
        cli_complain("--log-keep goes with --log-size, and this with --log");
        err = 2;
    }
    if (err == 0 && o->log && !o->pace && o->seconds <= 0) { /* gigabytes a minute */
        cli_complain("--log: without an end it fills the disk as fast as it goes: give --seconds, "
                     "or --pace");
        err = 2;
    }
    if (err == 0) { err = outfile_try(leaves, sizeof leaves / sizeof leaves[0]); }
    if (err == 0) { err = live_log_open(o->log, o->pace, &o->log_size); }
    if (err == 0) { err = contacts_begin(&o->gpio); }
    if (err == 0) { err = open_modbus(o); }
    if (err == 0 && o->glove) {
        err = glove_serial_open(&o->tty, "glove-serial", o->glove, GLOVE_SERIAL_HZ);
    }
    return err;
}

static int go(struct live_options *o)
{
    const struct exh_scene *sc = scene_of(o);
    int err = sc ? prepare(o, sc) : 2;
    if (err == 0) {
        until_catch(UNTIL_COMES_BACK);
        words_begin(o->pace);
        err = live_box(o, sc);
        err = err == -EXH_E_IO ? 1 : err < 0 ? 2 : 0; /* the board failed; it could not be set up */
        words_end();
        live_status_end();
        if (err == 0) { err = live_box_felt(o); }
    }
    if (o->modbus) { live_modbus_close(); }
    contacts_end();
    hand_record_free(&o->recorded);
    if (live_log_close() && err == 0) { err = 1; }
    if (err == 0) { err = live_box_clients(); }
    return err ? err : posix_interrupted() ? 130 : 0;
}

static void defaults(struct live_options *o)
{
    memset(o, 0, sizeof *o);
    bilateral_defaults(&o->hand);
    (void)bilateral_take_speeds(&o->hand, "natural");
    o->scene = "drop";
    o->rate_Hz = 2000;
    o->seed = 1;
    o->slack_s = -1;
    o->record_Hz = o->hand.record_Hz;
    o->live.on = 1;
    o->log_size.keep = -1;
}

static int list(struct live_options *o)
{
    const struct exh_scene *sc = scene_of(o);
    if (sc == NULL) { return 2; }
    if (live_stage(o, sc) < 0) { return 2; }
    cli_signal_print(stdout, sc->params->table, sc->params->staged);
    return 0;
}

int cli_run(int argc, char **argv)
{
    static struct live_options o;
    struct cli_call set = {take_set, &o}, fingers = {take_fingers, &o}, speed = {take_speed, &o};
    struct cli_call gpio = {contacts_take, &o.gpio}, size = {log_turn_take_size, &o.log_size.B};
    const struct cli_option option[] = {
        {"scene", CLI_TEXT, &o.scene, 0, 0, "NAME",
            "drop, guarded or bilateral (drop); custom where the program has one"},
        {"rate", CLI_REAL, &o.rate_Hz, 1, 20000, "HZ", "of the loop (2000)"},
        {"pace", CLI_FLAG, &o.pace, 0, 0, NULL,
            "run in real time, where ticks may be missed; else as fast as possible"},
        {"slack", CLI_REAL, &o.slack_s, 0, 60, "S",
            "with --pace: a tick this late is made up for, else missed (0; with --udp 1)"},
        {"seconds", CLI_REAL, &o.seconds, 0, 1e9, "S", "the box's time, then it ends (never)"},
        {"fingers", CLI_CALL, &fingers, 0, 0, "F[,F...]",
            "of bilateral: thumb, index, ... or all (index)"},
        {"speed", CLI_CALL, &speed, 0, 0, "V",
            "of bilateral: slow, natural, fast or m/s (natural)"},
        {"udp", CLI_TEXT, &o.udp, 0, 0, "HOST:PORT",
            "of bilateral: the world is another process there; with --pace"},
        {"key", CLI_TEXT, &o.hand.key, 0, 0, "FILE",
            "with --udp: the key of both sides, 32 hexadecimal digits"},
        {"record", CLI_TEXT, &o.record, 0, 0, "FILE", "of bilateral: fingers do this recording"},
        {"record-rate", CLI_REAL, &o.record_Hz, 0.1, 10000, "HZ", "of rows without a clock (100)"},
        {"record-columns", CLI_TEXT, &o.hand.columns, 0, 0, "LIST", "of `exhand glove`"},
        {"set", CLI_CALL, &set, 0, 0, "NAME=VALUE", "a parameter of the scene"},
        {"load-params", CLI_TEXT, &o.params, 0, 0, "FILE",
            "an image of parameters, restored before --set"},
        {"grip", CLI_FLAG, &o.grip, 0, 0, NULL,
            "grip the dead-man switch again after a stop or fault"},
        {"let-go", CLI_REAL, &o.let_go_s, 0, 1e9, "S",
            "release it at this time: a fault; without --grip it stays released (never)"},
        {"modbus", CLI_TEXT, &o.modbus, 0, 0, "WHERE", "serve tcp:ADDRESS:PORT or rtu:DEVICE:BAUD"},
        {"modbus-write", CLI_FLAG, &o.write, 0, 0, NULL, "clients may write, to reduce force"},
        {"save", CLI_TEXT, &o.save, 0, 0, "FILE", "clients may save there, for --load-params"},
        {"remote", CLI_FLAG, &o.remote, 0, 0, NULL,
            "clients may command RUN and CLEAR; the dead-man holds all the same"},
        {"glove-serial", CLI_TEXT, &o.glove, 0, 0, "DEVICE",
            "of bilateral: a stock glove there; the fingers stay simulated"},
        {"glove-calibration", CLI_TEXT, &o.glove_image, 0, 0, "FILE",
            "the user's, of `exhand calibrate --glove` (a default hand)"},
        {"gpio", CLI_CALL, &gpio, 0, 0, CONTACTS_ARG, CONTACTS_HELP},
        {"log", CLI_TEXT, &o.log, 0, 0, "FILE", "for `exhand replay` and `exhand csv`"},
        {"log-size", CLI_CALL, &size, 0, 0, "BYTES[k|M|G]", "size of a file, then FILE.1"},
        {"log-keep", CLI_INT, &o.log_size.keep, 0, 1e6, "N", "number of old files to keep (all)"},
        {"blackbox", CLI_TEXT, &o.blackbox, 0, 0, "FILE", "the last seconds before a fault, a log"},
        {"seed", CLI_INT, &o.seed, 0, 1e9, "N", "random seed of the simulation (1)"},
        {"params", CLI_FLAG, &o.list, 0, 0, NULL, "list the scene's parameters"},
    };
    const struct cli_command c = {"run", "[options]",
        "A box that goes on, on the simulated device: a mass falls, or fingers approach a wall, "
        "again and\n"
        "again, until --seconds or Ctrl-C (outputs safe, log complete, exit status 130).",
        option, (int)(sizeof option / sizeof option[0]), 0};
    int err;
    defaults(&o);
    err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    return o.list ? list(&o) : go(&o);
}
