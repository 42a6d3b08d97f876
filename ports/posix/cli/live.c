/* exhand run: a box that goes on, on the simulated device. */
#include "cli.h"

#include "assign.h"
#include "bilateral.h"
#include "contacts.h"
#include "live.h"
#include "modbus.h"
#include "option.h"
#include "outfile.h"
#include "param.h"
#include "table2.h"

#include "guarded/guarded.h"

#include "exhand/error.h"

#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#define SETTINGS_MAX 64
#define IMAGE_B      65536

struct live_options {
    const char *scene, *params, *log, *blackbox, *modbus, *save;
    double rate_Hz, seconds, let_go_s;
    int64_t seed;
    int pace, grip, list, remote;
    struct contacts gpio;
    const char *set[SETTINGS_MAX];
    int sets;
    struct run_setting setting[SETTINGS_MAX];
    struct bilateral_options hand;
    struct run_live live;
    FILE *file;
};

/* --- who is told what happens --- */

static struct {
    int on, status;
} clients; /* of Modbus */

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    live_person_start(sc, board);
    if (!clients.on) { return; }
    clients.status = mail_start(sc, board) < 0 ? 1 : live_modbus_serve();
    if (clients.status) { posix_stop(); }
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    live_person_before(tick, in);
    if (clients.on) { mail_before(in); }
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    if (clients.on) { mail_after(in); }
    live_person_after(tick, in, out);
}

static const struct exh_loop_hooks hooks = {start, before, after};

static void interrupted(int sig)
{
    (void)sig;
    posix_interrupt();
}

static void catch_signals(void)
{
    struct sigaction on;
    memset(&on, 0, sizeof on);
    on.sa_handler = interrupted;
    (void)sigaction(SIGINT, &on, NULL);
    (void)sigaction(SIGTERM, &on, NULL);
}

/* --- options --- */

static const struct exh_scene *scene_of(const struct live_options *o)
{
    static const struct exh_scene *const all[] = {&exh_scene_drop, &exh_scene_guarded,
                                                  &exh_scene_bilateral};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        if (strcmp(o->scene, all[i]->name) == 0) { return all[i]; }
    }
    cli_complain("--scene: %s: give drop, guarded or bilateral", o->scene);
    return NULL;
}

/* What may be set depends on the scene, which may come later. */
static int take_set(void *ctx, const char *text)
{
    struct live_options *o = ctx;
    if (o->sets == SETTINGS_MAX) {
        cli_complain("--set: at most %d", SETTINGS_MAX);
        return 2;
    }
    o->set[o->sets++] = text;
    return 0;
}

static int take_fingers(void *ctx, const char *text)
{
    struct live_options *o = ctx;
    return bilateral_take_fingers(&o->hand, text);
}

static int take_speed(void *ctx, const char *text)
{
    struct live_options *o = ctx;
    return bilateral_take_speeds(&o->hand, text);
}

/* One of a scene that is not bilateral. */
static int settle(struct live_options *o, const struct exh_scene *sc, int i)
{
    char name[ASSIGN_NAME_B];
    double value;
    if (assign_split("set", o->set[i], name, &value)) { return 2; }
    if (cli_param_set(sc->params, name, value) < 0) { return 2; }
    o->setting[i] =
        (struct run_setting){cli_signal_find(sc->params->table, name, NULL)->name, value};
    return 0;
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

static int open_log(struct live_options *o)
{
    if (o->log == NULL) { return 0; }
    if (!o->pace && o->seconds == 0) { /* gigabytes a minute */
        cli_complain("--log: without an end it fills the disk as fast as it goes: give --seconds, or --pace");
        return 2;
    }
    o->file = fopen(o->log, "wb");
    if (o->file == NULL) {
        cli_complain("--log: %s: %s: give a file that can be written", o->log, strerror(errno));
        return 2;
    }
    return 0;
}

/* --- the two kinds of box --- */

static void board(const struct live_options *o, struct posix_config *b)
{
    b->seed = (uint64_t)o->seed;
    b->pace = o->pace;
    b->gpio = o->gpio.given;
    b->log = o->file;
    b->wires_in = live_wires;
    b->max_ticks = (uint32_t)(o->seconds * o->rate_Hz + 0.5);
    if (o->seconds > 0 && b->max_ticks == 0) { b->max_ticks = 1; } /* 0: never */
}

/* A mass that is let fall again and again. */
static int run_mass(const struct live_options *o, const struct exh_scene *sc, uint32_t *lost)
{
    const struct table2_row *g = table2_gains(o->rate_Hz);
    struct run_cfg c = {.scene = sc,
                        .rate_Hz = (uint32_t)(o->rate_Hz + 0.5),
                        .k_Npm = g->k_Npm,
                        .b_Nspm = g->b_Nspm,
                        .setting = o->setting,
                        .settings = o->sets,
                        .more = &hooks,
                        .blackbox = o->blackbox,
                        .live = o->live};
    struct run r;
    int err;
    c.board = posix_config_default();
    c.board.falls = INT_MAX;
    board(o, &c.board);
    live_person(&(struct live_person){o->grip, o->let_go_s, 0});
    err = run_drop(&c, &r);
    *lost = r.lost;
    run_free(&r);
    return err;
}

static unsigned lowest(unsigned mask)
{
    unsigned i = 0;
    while (mask > 1 && !(mask & 1)) {
        mask >>= 1;
        i++;
    }
    return i;
}

/* Fingers that approach a wall again and again. */
static int run_hand(struct live_options *o, uint32_t *lost)
{
    const struct table2_row *g = table2_gains(o->rate_Hz);
    struct bilateral_run_cfg c;
    struct bilateral_run r;
    int err;
    o->hand.seed = o->seed;
    o->hand.approaches = 0; /* for ever */
    c = bilateral_at_speed(&o->hand, o->hand.speed[0].mps);
    c.rate_Hz = (uint32_t)(o->rate_Hz + 0.5);
    c.k_Npm = g->k_Npm;
    c.b_Nspm = g->b_Nspm;
    c.live = o->live;
    c.more = &hooks;
    c.blackbox = o->blackbox;
    if (o->live.image) { c.fit_scale = 0; } /* it was, when that was saved */
    board(o, &c.board);
    live_person(&(struct live_person){o->grip, o->let_go_s, lowest(c.board.exo.fingers)});
    err = bilateral_run(&c, &r);
    *lost = r.lost;
    bilateral_run_free(&r);
    return err;
}

static int open_modbus(const struct live_options *o)
{
    const struct mail_cfg mail = {o->save, o->remote};
    if (o->modbus == NULL) { return 0; }
    mail_open(&mail);
    clients.on = 1;
    return live_modbus_open(o->modbus);
}

/* Everything that can be refused before the loop. */
static int prepare(struct live_options *o, const struct exh_scene *sc)
{
    int err = settle_all(o, sc);
    if (err == 0 && o->seconds * o->rate_Hz >= 4294967295.0) {
        cli_complain("--seconds: %.6g: at %.6g Hz %.0f at most, or leave it out", o->seconds,
                     o->rate_Hz, 4294967294.0 / o->rate_Hz);
        err = 2;
    }
    if (err == 0 && o->modbus == NULL && (o->save || o->remote)) {
        cli_complain("--save and --remote: what clients may do: only with --modbus");
        err = 2;
    }
    if (err == 0) { err = contacts_check(&o->gpio, o->pace); }
    if (err == 0) { err = read_params(o); }
    if (err == 0) { err = open_log(o); }
    if (err == 0) { err = contacts_begin(&o->gpio); }
    if (err == 0) { err = open_modbus(o); }
    return err;
}

static int close_log(const struct live_options *o, uint32_t lost)
{
    if (o->file == NULL || (fclose(o->file) == 0 && lost == 0)) { return 0; }
    cli_complain("%s: can't be written: %lu records lost", o->log, (unsigned long)lost);
    return 1;
}

static int go(struct live_options *o)
{
    const struct exh_scene *sc = scene_of(o);
    uint32_t lost = 0;
    int err = sc ? prepare(o, sc) : 2;
    if (err == 0) {
        catch_signals();
        err = sc == &exh_scene_bilateral ? run_hand(o, &lost) : run_mass(o, sc, &lost);
        err = err == -EXH_E_IO ? 1 : err < 0 ? 2 : 0; /* the board failed; it could not be set up */
        live_person_end();
    }
    if (clients.on) { live_modbus_close(); }
    contacts_end();
    if (close_log(o, lost) && err == 0) { err = 1; }
    if (err == 0) { err = clients.status; }
    return err ? err : posix_interrupted() ? 130 : 0;
}

int cli_run(int argc, char **argv)
{
    static struct live_options o;
    const struct cli_call set = {take_set, &o}, fingers = {take_fingers, &o},
                          speed = {take_speed, &o};
    const struct cli_call gpio = {contacts_take, &o.gpio};
    union {
        const struct cli_call *view;
        void *to;
    } u[4] = {{&set}, {&fingers}, {&speed}, {&gpio}};
    const struct cli_option option[] = {
        {"scene", CLI_TEXT, &o.scene, 0, 0, "NAME", "drop, guarded or bilateral (drop)"},
        {"rate", CLI_REAL, &o.rate_Hz, 1, 20000, "HZ", "of the loop (2000)"},
        {"pace", CLI_FLAG, &o.pace, 0, 0, NULL, "follow the wall clock; else as fast as it goes"},
        {"seconds", CLI_REAL, &o.seconds, 0, 1e9, "S", "the box's time, then it ends (never)"},
        {"fingers", CLI_CALL, u[1].to, 0, 0, "F[,F...]",
         "of bilateral: thumb, index, ... or all (index)"},
        {"speed", CLI_CALL, u[2].to, 0, 0, "V",
         "of bilateral: slow, natural, fast or m/s (natural)"},
        {"set", CLI_CALL, u[0].to, 0, 0, "NAME=VALUE", "a parameter of the scene"},
        {"load-params", CLI_TEXT, &o.params, 0, 0, "FILE",
         "an image of parameters, restored before --set"},
        {"grip", CLI_FLAG, &o.grip, 0, 0, NULL,
         "the dead-man is gripped anew after a stop or fault"},
        {"let-go", CLI_REAL, &o.let_go_s, 0, 1e9, "S",
         "it is let go then: a fault; without --grip for good (never)"},
        {"modbus", CLI_TEXT, &o.modbus, 0, 0, "WHERE",
         "serve the registers at tcp:ADDRESS:PORT or rtu:DEVICE:BAUD"},
        {"save", CLI_TEXT, &o.save, 0, 0, "FILE",
         "clients may save the parameters there, for --load-params"},
        {"remote", CLI_FLAG, &o.remote, 0, 0, NULL,
         "clients may command RUN and CLEAR; the dead-man holds all the same"},
        {"gpio", CLI_CALL, u[3].to, 0, 0, CONTACTS_ARG, CONTACTS_HELP},
        {"log", CLI_TEXT, &o.log, 0, 0, "FILE", "for `exhand replay` and `exhand csv`"},
        {"blackbox", CLI_TEXT, &o.blackbox, 0, 0, "FILE", "the last seconds before a fault, a log"},
        {"seed", CLI_INT, &o.seed, 0, 1e9, "N", "of all chance in the simulation (1)"},
        {"params", CLI_FLAG, &o.list, 0, 0, NULL, "list the scene's parameters"},
    };
    const struct cli_command c = {
        "run",
        "[options]",
        "A box that goes on, on the simulated device: a mass falls, or fingers approach a wall, "
        "again and\n"
        "again, until --seconds or Ctrl-C (outputs safe, log complete, exit status 130).",
        option,
        (int)(sizeof option / sizeof option[0]),
        0};
    int err;
    memset(&o, 0, sizeof o);
    bilateral_defaults(&o.hand);
    (void)bilateral_take_speeds(&o.hand, "natural");
    o.scene = "drop";
    o.rate_Hz = 2000;
    o.seed = 1;
    o.live.on = 1;
    err = cli_parse(&c, argc, argv, NULL);
    if (err) { return err == 1 ? 0 : err; }
    if (o.list) {
        const struct exh_scene *sc = scene_of(&o);
        if (sc == NULL) { return 2; }
        sc->defaults();
        cli_signal_print(stdout, sc->params->table);
        return 0;
    }
    return go(&o);
}
