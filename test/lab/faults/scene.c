/* SPDX-License-Identifier: MIT */
/* The run that others branch from: a finger that presses against a wall in the full box, or a mass
 * that falls onto one. */
#include "lab/faults/faults.h"

#include "box/hand.h"
#include "box/run.h"

#include "bilateral/bilateral.h"
#include "drop/drop.h"

#include "sim/random.h"

#include "exhand/error.h"

#include <string.h>

#define RUN_AT_S 0.05 /* until then nothing is commanded */

static struct {
    const struct faults_base *base;
    faults_at *at;
    void *ctx;
    uint32_t run_tick;
} own;

unsigned faults_finger(uint8_t scene) { return scene == FAULTS_BILATERAL ? FAULTS_FINGER : 0; }

/* --- what the box says --- */

static void look_at_drop(struct faults_view *v)
{
    const struct drop_signals *s = (const void *)exh_scene_signals(&exh_scene_drop);
    v->state = s->state;
    v->faults = (uint32_t)s->faults;
    v->present = (uint32_t)s->present;
    v->limits = (uint32_t)s->limits;
    v->force_N_q20[0] = s->f_des_N_q20;
    v->coded_A_q26[0] = s->i_des_A_q26;
}

static void look_at_bilateral(struct faults_view *v)
{
    const struct bilateral_signals *s = (const void *)exh_scene_signals(&exh_scene_bilateral);
    v->state = s->box.state;
    v->faults = (uint32_t)s->box.faults;
    v->present = (uint32_t)s->box.present;
    v->limits = (uint32_t)s->more[FAULTS_FINGER].limits;
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        v->force_N_q20[f] = s->paper[f].f_des_N_q20;
        v->coded_A_q26[f] = s->paper[f].i_des_A_q26;
    }
}

static void look_at(uint8_t scene, struct faults_view *v)
{
    const struct exh_safety *s = faults_memory(scene).safety;
    memset(v, 0, sizeof *v);
    v->open = exh_safety_is_open(s);
    v->refused = s->refused;
    if (scene == FAULTS_DROP) {
        look_at_drop(v);
    } else {
        look_at_bilateral(v);
    }
}

/* --- its memory --- */

struct faults_memory faults_memory(uint8_t scene)
{
    const struct exh_scene *sc = scene == FAULTS_DROP ? &exh_scene_drop : &exh_scene_bilateral;
    struct faults_memory m;
    memset(&m, 0, sizeof m);
    if (sc->params->table == NULL) { sc->defaults(); } /* asked before any run */
    m.par = sc->params->active;
    m.table = sc->params->table;
    m.pars = exh_signal_count(sc->params->table);
    if (scene == FAULTS_DROP) {
        struct drop_cfg *cfg;
        m.safety = &drop_memory(&cfg)->safety;
        m.cal = cfg->calib.force_to_cur;
        m.cal_B = 2 * sizeof cfg->calib.force_to_cur[0]; /* a straight line */
        m.guard = drop_guard();
        m.area = cfg;
        m.area_B = sizeof *cfg;
    } else {
        struct bilateral_cfg *cfg;
        m.safety = &bilateral_memory(&cfg)->safety;
        m.cal = cfg->finger[FAULTS_FINGER].calib.force_to_cur;
        m.cal_B = 2 * sizeof cfg->finger[FAULTS_FINGER].calib.force_to_cur[0];
        m.guard = bilateral_guard();
        m.area = cfg;
        m.area_B = sizeof *cfg;
    }
    return m;
}

/* The guard is sealed again, or it would report a fault before arming. */
void faults_lose(uint8_t scene, uint32_t steps)
{
    const struct faults_memory m = faults_memory(scene);
    const uint8_t left = (uint8_t)~steps;
    if (scene == FAULTS_DROP) {
        struct drop_cfg *cfg;
        (void)drop_memory(&cfg);
        cfg->calib.vouches &= left;
        if (steps & EXH_ARM_SELFTEST) { cfg->tested = 0; }
    } else {
        struct bilateral_cfg *cfg;
        (void)bilateral_memory(&cfg);
        cfg->vouches &= left;
        if (steps & EXH_ARM_SELFTEST) { cfg->tested = 0; }
    }
    exh_integrity_seal(m.guard, m.area, m.area_B, m.guard->params);
}

void faults_through_bytes(uint8_t scene)
{
    static uint8_t bytes[16384];
    void (*state)(struct exh_bytes *) =
        scene == FAULTS_DROP ? exh_scene_drop.state : exh_scene_bilateral.state;
    struct exh_bytes to = exh_bytes_writer(bytes, sizeof bytes), from;
    state(&to);
    EXH_ASSERT(exh_bytes_ok(&to));
    from = exh_bytes_reader(bytes, to.at);
    if (scene == FAULTS_DROP) {
        struct drop_cfg *cfg;
        struct drop *s = drop_memory(&cfg);
        memset(s, 0, sizeof *s);
    } else {
        struct bilateral_cfg *cfg;
        struct bilateral *s = bilateral_memory(&cfg);
        memset(s, 0, sizeof *s);
    }
    state(&from);
}

/* --- the run --- */

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    own.run_tick =
        own.base->not_run ? UINT32_MAX : (uint32_t)(RUN_AT_S * board.T.den / board.T.num) + 2;
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    in->command = tick == own.run_tick ? EXH_CMD_RUN : EXH_CMD_NONE;
    faults_before(tick, in); /* in a branch it commands */
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    struct faults_view v;
    (void)in;
    look_at(own.base->scene, &v);
    if (faults_after(tick, &v, out)) { return; }
    own.at(own.ctx, tick, &v);
}

uint32_t faults_run_tick(void) { return own.run_tick; }

static const struct exh_loop_hooks hooks = {start, before, after};

static void wire(struct posix_config *c, const struct faults_base *b)
{
    c->seed = b->seed;
    c->wires_in = faults_wires_in;
    c->wires_out = faults_wires_out;
    c->late = faults_late;
    c->cards.how = b->cards ? POSIX_CARDS_INSTANT : POSIX_CARDS_NONE;
    c->cards.quiet = 1;
}

/* Gains that are stable at the rate, and some reserve: the paper's or less. */
static void gains(uint32_t rate_Hz, double *k_Npm, double *b_Nspm)
{
    *k_Npm = rate_Hz < 400 ? 1000 : rate_Hz < 900 ? 3000 : 6000;
    *b_Nspm = rate_Hz < 400 ? 0 : rate_Hz < 900 ? 10 : 20;
}

static int run_finger(const struct faults_base *b)
{
    struct sim_random rng = {b->seed};
    const double hard = sim_random_unit(&rng);
    const struct run_setting set[] = {{"mat_f_max", b->gentle ? 40 : 3},
        {"stuck_time", b->stuck_ms ? b->stuck_ms : 2000}, {"glove_time", 150}, {"link_time", 200},
        {"supply_min", 18}, {"uncalibrated", !b->not_waived},
        {"chatter_energy", b->chatter ? 0.03 : 0},
        {"glove_fc", b->rate_Hz < 500 ? 0.2 * b->rate_Hz : 200}};
    struct bilateral_run_cfg c;
    struct bilateral_run r;
    struct sim_path_par *path;
    int err;
    memset(&c, 0, sizeof c);
    c.board = posix_config_default();
    c.board.exo.fingers = 1u << FAULTS_FINGER;
    path = &c.board.exo.path[FAULTS_FINGER];
    path->speed_mps = 0.1 + 0.7 * sim_random_unit(&rng);
    path->approaches = 0;                             /* for ever */
    path->first_s = 0.75 + b->wait_ms / 1000.0;       /* armed by then */
    path->hold_s = 0.3 + 0.3 * sim_random_unit(&rng); /* this finger does not tremble */
    path->back_s = path->rest_s = 0.25;
    path->push_m = 0.010 + 0.010 * sim_random_unit(&rng);
    c.board.exo.finger[FAULTS_FINGER].k_Npm = 300 + 700 * hard;
    c.board.exo.finger[FAULTS_FINGER].b_Nspm = 5 + 5 * hard;
    c.board.exo.finger[FAULTS_FINGER].mass_kg = 0.05 + 0.1 * sim_random_unit(&rng);
    wire(&c.board, b);
    c.rate_Hz = b->rate_Hz;
    gains(b->rate_Hz, &c.k_Npm, &c.b_Nspm);
    c.at_m = 0.03;
    c.trial = 1;
    c.fps = FAULTS_LINK_HZ;
    c.until_s = 1e30;
    c.setting = set;
    c.settings = sizeof set / sizeof set[0];
    c.more = &hooks;
    err = bilateral_run(&c, &r);
    bilateral_run_free(&r);
    return err;
}

static int run_mass(const struct faults_base *b)
{
    const struct run_setting set[] = {
        {"f_max", b->gentle ? 40 : 6}, {"uncalibrated", !b->not_waived}};
    struct run_cfg c;
    struct run r;
    int err;
    memset(&c, 0, sizeof c);
    c.board = posix_config_default();
    c.board.falls = 1000;
    wire(&c.board, b);
    c.rate_Hz = b->rate_Hz;
    gains(b->rate_Hz, &c.k_Npm, &c.b_Nspm);
    c.setting = set;
    c.settings = sizeof set / sizeof set[0];
    c.more = &hooks;
    err = run_drop(&c, &r);
    run_free(&r);
    return err;
}

int faults_run(const struct faults_base *b, faults_at *at, void *ctx)
{
    own.base = b;
    own.at = at;
    own.ctx = ctx;
    int err = b->scene == FAULTS_DROP ? run_mass(b) : run_finger(b);
    faults_ended();
    return err;
}
