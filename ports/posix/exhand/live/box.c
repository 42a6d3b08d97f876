/* SPDX-License-Identifier: MIT */
/* exhand run: the two kinds of box, and the receivers of their events. */
#include "live/live.h"

#include "box/dumpfile.h"
#include "slave/slave.h"
#include "box/world_line.h"
#include "box/table2.h"
#include "base/param.h"

#include "exhand/error.h"

#include <limits.h>
#include <math.h>
#include <string.h>

/* --- receivers of events --- */

static struct {
    int on, status;
} clients; /* of Modbus */

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    live_person_start(sc, board);
    live_status_start(sc, board);
    if (!clients.on) { return; }
    clients.status = mail_start(sc, board) < 0 ? 1 : live_modbus_serve();
    if (clients.status) { posix_stop(); }
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    live_person_before(tick, in);
    if (clients.on) { (void)mail_before(in); }
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    if (clients.on) { mail_after(in); }
    (void)out;
    live_status_after(tick, in);
}

static const struct exh_loop_hooks hooks = {start, before, after};

/* --- the box --- */

static void board(const struct live_options *o, struct posix_config *b)
{
    b->seed = (uint64_t)o->seed;
    b->pace = o->pace;
    b->gpio = o->gpio.given;
    b->slack_s = o->slack_s;
    b->log = live_log_file();
    b->log_put = b->log ? live_log_put : NULL;
    b->wires_in = live_wires;
    b->max_ticks = (uint32_t)(o->seconds * o->rate_Hz + 0.5);
    if (o->seconds > 0 && b->max_ticks == 0) { b->max_ticks = 1; } /* 0: never */
}

/* A dump that could not be written is a separate error. */
static int dumped(int err, int dumps) { return err == 0 && dumps < 0 ? -EXH_E_IO : err; }

/* A mass that is let fall again and again. */
static int run_mass(const struct live_options *o, const struct exh_scene *sc)
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
    live_status(0);
    err = run_drop(&c, &r);
    err = dumped(err, r.dumps);
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

/* The paper's gains are a falling mass's. Who asks for none must not be refused: where a hand's
 * rule of gains is narrower at this rate, its own, so at any rule_on. */
static void hand_gains(struct bilateral_run_cfg *c, double rate_Hz)
{
    const struct table2_row *g = table2_gains(rate_Hz);
    struct exh_gains_par rule = bilateral_rule;
    c->k_Npm = g->k_Npm;
    c->b_Nspm = g->b_Nspm;
    if (exh_gains_scale(&rule, (struct exh_period){1, c->rate_Hz}) < 0) { return; }
    c->b_Nspm =
        fmin(c->b_Nspm, cli_signal_value(&exh_material_rows[1], rule.b_Nspm_q20[rule.knots - 1]));
    c->k_Npm = fmin(c->k_Npm, cli_signal_value(&exh_material_rows[0],
                                  exh_gains_k_max(&rule, (int32_t)(c->b_Nspm * 0x1p20))));
}

static struct bilateral_run_cfg hand_cfg(struct live_options *o)
{
    struct bilateral_run_cfg c;
    o->hand.seed = o->seed;
    o->hand.approaches = 0; /* for ever */
    c = bilateral_at_speed(&o->hand, o->hand.speed[0].mps);
    c.rate_Hz = (uint32_t)(o->rate_Hz + 0.5);
    hand_gains(&c, o->rate_Hz);
    return c;
}

int live_stage(struct live_options *o, const struct exh_scene *sc)
{
    struct bilateral_run_cfg c;
    sc->defaults();
    if (sc != &exh_scene_bilateral) { return 0; }
    c = hand_cfg(o);
    return bilateral_stage(&c);
}

static struct bilateral_run felt; /* what the hand's box did */

/* Fingers that approach a wall, or do what was recorded, again and again. */
static int run_hand(struct live_options *o)
{
    struct bilateral_run_cfg c = hand_cfg(o);
    int err;
    c.live = o->live;
    c.more = &hooks;
    c.blackbox = o->blackbox;
    board(o, &c.board);
    c.board.glove_tty = o->glove ? &o->tty : NULL;
    c.glove_cal = o->glove_image ? &o->glove_cal : NULL;
    live_status(lowest(c.board.exo.fingers));
    err = bilateral_run(&c, &felt);
    err = dumped(err, felt.dumps);
    bilateral_run_free(&felt);
    if (o->glove) { glove_tty_close(&o->tty); }
    return err;
}

int live_box(struct live_options *o, const struct exh_scene *sc)
{
    dumpfile_paced(o->pace);
    clients.on = o->modbus != NULL;
    clients.status = 0;
    live_person(&(struct live_person){o->grip, o->let_go_s});
    return sc == &exh_scene_bilateral ? run_hand(o) : run_mass(o, sc);
}

int live_box_felt(const struct live_options *o)
{
    long contacts = 0;
    if (o->udp == NULL && o->record == NULL) { return 0; }
    bilateral_print_session(stdout, &felt, o->hand.run.board.exo.fingers);
    if (o->udp == NULL) { return 0; }
    world_line_print(stdout, &felt.box);
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) { contacts += felt.finger[f].contacts; }
    return contacts == 0 && !world_line_heard();
}

int live_box_clients(void) { return clients.status; }
