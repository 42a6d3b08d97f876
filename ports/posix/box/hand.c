/* SPDX-License-Identifier: MIT */
#include "box/hand.h"
#include "box/hand_rule.h"

#include "box/arming.h"
#include "box/dumpfile.h"
#include "box/glove_line.h"
#include "box/world_line.h"
#include "base/option.h"
#include "base/param.h"

#include "exhand/run/log.h"
#include "exhand/run/loop.h"

#include "world/world.h"

#include "exhand/board.h"
#include "exhand/error.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define PATIENCE_S 0.5 /* a link that has to be heard of, and the like */
#define SEES_HZ    100 /* truth is looked at */
#define AFTER_S    0.2 /* the last thing that is kept after the last approach */

static struct {
    const struct bilateral_run_cfg *cfg;
    struct bilateral_run *r;
    struct peer peer;
    struct peer_world world;
    int logged, no_memory;
    uint32_t last_tick;
    double done_s;  /* when all fingers had done; < 0: not yet */
    int ran, again; /* the box came to run; what stood in its way is gone */
    int sees;       /* the world is in this process */
    uint64_t see_every;
} run;

/* --- hooks --- */

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    run.r->T = board.T;
    bilateral_leave_out(run.cfg);
    dumpfile_start(sc, board);
    if (run.cfg->more) { run.cfg->more->start(sc, board); }
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    if ((tick == 0 || run.again) && !run.cfg->live.on) { in->command = EXH_CMD_RUN; }
    if (run.cfg->more) { run.cfg->more->before(tick, in); }
    dumpfile_before(tick, in);
}

static uint32_t digest_of(uint32_t digest, const struct bilateral_paper *p)
{
    const int32_t v[] = {
        p->q_m_q30, p->qd_mps_q27, p->f_des_N_q20, p->i_des_A_q26, p->c, p->f_mon_N_q20};
    return exh_crc32(digest, v, sizeof v);
}

static void widen(struct bilateral_range *g, double x_m, const struct bilateral_paper *raw,
    const int32_t *joint, int first)
{
    if (first || x_m < g->lo_m) { g->lo_m = x_m; }
    if (first || x_m > g->hi_m) { g->hi_m = x_m; }
    for (int j = 0; j < EXH_HAND_JOINTS; j++) {
        if (first || joint[j] < g->lo_turn_q32[j]) { g->lo_turn_q32[j] = joint[j]; }
        if (first || joint[j] > g->hi_turn_q32[j]) { g->hi_turn_q32[j] = joint[j]; }
    }
    if (raw->f_des_N_q20 > g->f_max_N_q20) { g->f_max_N_q20 = raw->f_des_N_q20; }
    g->touched += raw->c != 0;
}

static struct bilateral_finger_is finger_is(const struct bilateral_run_cfg *c, unsigned f)
{
    const struct bilateral_finger_is w = {f, c->board.exo.finger[f].arm_m, c->board.hand.pose};
    return w;
}

/* The true state of world and finger, independent of all messages. */
static void see_truth(unsigned f, struct bilateral_sample *s, int touches)
{
    const struct bilateral_finger_is w = finger_is(run.cfg, f);
    const double t_s = posix_time_s();
    if (run.r->ticks % run.see_every == 0) {
        s->inside_m = bilateral_gap_m(&run.world, &w, s->x_m, t_s);
    }
    if (touches) { s->touch_m = bilateral_string_m(&run.world, &w, t_s, 0); }
}

static void keep(
    unsigned f, struct bilateral_track *t, const struct bilateral_paper *raw, int32_t bits)
{
    const struct sim_finger *plant = posix_finger(f);
    const enum sim_path_phase phase = plant->path.phase;
    const int under_way =
        phase == SIM_PATH_APPROACH || phase == SIM_PATH_HOLD || phase == SIM_PATH_WITHDRAW;
    struct bilateral_sample s = {*raw, bits,
        phase == SIM_PATH_PLAY ? 1
        : under_way            ? (int32_t)plant->path.number
                               : 0,
        phase == SIM_PATH_HOLD, plant->plant.x_m, (double)NAN, (double)NAN};
    if (run.sees) { see_truth(f, &s, raw->c && !t->c); }
    if (t->n == t->cap) {
        const size_t cap = t->cap ? 2 * t->cap : 8192;
        struct bilateral_sample *more = realloc(t->at, cap * sizeof *more);
        if (more == NULL) {
            run.no_memory = 1;
            posix_stop();
            return;
        }
        t->at = more;
        t->cap = cap;
    }
    t->at[t->n++] = s;
}

/* 1 while the finger has something to do. */
static int one_finger(unsigned f, const struct bilateral_signals *sig)
{
    const struct bilateral_paper *raw = &sig->paper[f];
    const struct sim_finger *plant = posix_finger(f);
    const int32_t bits = sig->more[f].bits;
    struct bilateral_track *t = &run.r->finger[f];
    if (run.cfg->keep) { keep(f, t, raw, bits); }
    if (bits & EXH_PRECONTACT_FREEZE) {
        t->freezes++;
        t->scale = ((double)raw->q_lim_m_q30 - raw->q_m_q30) / -(double)raw->d_m_q30;
    }
    if (bits & EXH_PRECONTACT_STANDS) { t->frozen_yet = 1; }
    if (raw->c) { t->unfrozen += !(bits & EXH_PRECONTACT_STANDS); }
    if (raw->c && !t->c) { t->contacts++; }
    t->c = raw->c;
    if (!run.cfg->bare) {
        widen(&t->range, plant->plant.x_m, raw, sig->more[f].joint_turn_q32, run.r->ticks == 1);
        if (t->frozen_yet) { t->digest = digest_of(t->digest, raw); }
    }
    return plant->path.phase != SIM_PATH_DONE;
}

/* A device that does not reach RUN makes the experiment invalid, unless another client commands
 * it. */
static void watch_arming(const struct bilateral_signals *sig)
{
    const enum arming is = arming_is(sig->box.state);
    if (run.ran || is == ARMING_GOES_ON || (run.cfg->more && is != ARMING_RUNS)) { return; }
    run.ran = is == ARMING_RUNS;
    run.again = !run.ran && sig->box.present == 0 && sig->box.arm_step == EXH_ARM_DEADMAN;
    if (!run.ran && !run.again && posix_time_s() >= PATIENCE_S) {
        run.r->unarmed = sig->box.arm_step;
        run.r->faults = (uint32_t)sig->box.present;
        if (!run.cfg->board.cards.quiet) { arming_complain(sig->box.arm_step, sig->box.present); }
        posix_stop();
    }
}

/* A bare run needs none of those that are made only to be shown. */
static const struct bilateral_signals *signals(void)
{
    const struct exh_scene *sc = &exh_scene_bilateral;
    return (const void *)(run.cfg->bare && run.ran ? sc->values : exh_scene_signals(sc));
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const struct bilateral_signals *sig = signals();
    unsigned fingers = run.cfg->board.exo.fingers;
    int busy = 0;
    dumpfile_after(tick, in, out);
    run.last_tick = tick;
    run.r->ticks++;
    watch_arming(sig);
    if (!run.sees) { world_line_after(&sig->box); }
    for (unsigned f = 0; fingers; f++, fingers >>= 1) {
        if (fingers & 1) { busy |= one_finger(f, sig); }
    }
    if (run.cfg->more) { run.cfg->more->after(tick, in, out); }
    if (!busy && run.done_s < 0) { run.done_s = posix_time_s(); }
    if (!busy && posix_time_s() > run.done_s + AFTER_S) { posix_stop(); }
}

/* --- before a run --- */

/* A world elsewhere may have heard this seed before: another at every start, and logged. */
static double session_of(const struct bilateral_run_cfg *c)
{
    if (c->session) { return c->session; }
    return c->board.line.udp_local ? 1 + (double)(exh_board_cycles() >> 2)
                                   : 1 + (double)(c->board.seed % 1000000);
}

/* One s is not used while the other is. */
static int refuse_scale(const struct bilateral_run_cfg *c)
{
    const char *const per_tip = exh_precontact_rows[2].name;
    const char *const from_slope = exh_precontact_rows[3].name;
    uint32_t index;
    if (!cli_signal_find(exh_scene_bilateral.params->table, from_slope, &index) ||
        !exh_scene_bilateral.params->staged[index]) {
        return 0;
    }
    for (int i = 0; i < c->settings; i++) {
        if (strcmp(c->setting[i].name, per_tip) == 0) {
            cli_complain("--set %s: it is not used while %s is 1: give --set %s=0, too", per_tip,
                from_slope, from_slope);
            return -EXH_E_RANGE;
        }
    }
    return 0;
}

int bilateral_stage(const struct bilateral_run_cfg *c)
{
    const struct sim_device *d = &c->board.device;
    const struct run_setting known[] = {
        {"step", d->step_m / d->decode},
        {"kf", d->kf_npa},
        {"dac_scale", d->dac_perA},
        {"dac_zero", d->dac_zero},
        {"mon_scale", d->mon_apc},
        {"fingers", c->board.exo.fingers},
        {"session", session_of(c)},
    };
    struct exh_params *p = exh_scene_bilateral.params;
    struct exh_glove_cal cal;
    int err = 0;
    exh_scene_bilateral.defaults();
    bilateral_cal_of(&cal, &c->board.glove_par);
    err = c->board.glove_tty ? glove_serial_stage(&exh_scene_bilateral, c->glove_cal, c->rate_Hz,
                                   c->board.glove_tty->rate_Hz)
                             : bilateral_stage_cal(&cal, NULL);
    if (err == 0) { err = images_give(c->images, &exh_scene_bilateral); }
    for (size_t i = 0; err == 0 && i < sizeof known / sizeof known[0]; i++) {
        err = cli_param_set(p, known[i].name, known[i].value);
    }
    if (err == 0 && c->trial) { err = cli_param_set(p, "rule_on", BILATERAL_RULE_OFF); }
    if (err == 0 && c->trial) { err = cli_param_set(p, "chatter_energy", 0); }
    for (int i = 0; err == 0 && i < c->owns; i++) {
        err = cli_param_set(p, c->own[i].name, c->own[i].value);
    }
    if (err == 0 && c->k_Npm >= 0) { err = cli_param_set_by(p, "--k: ", "mat_k", c->k_Npm); }
    if (err == 0 && c->b_Nspm >= 0) { err = cli_param_set_by(p, "--b: ", "mat_b", c->b_Nspm); }
    if (err == 0) { err = run_image(&c->live, p); }
    /* Fingers and session are those of this run, not those of the saved image. */
    for (size_t i = sizeof known / sizeof known[0] - 2;
         err == 0 && i < sizeof known / sizeof known[0]; i++) {
        err = cli_param_set(p, known[i].name, known[i].value);
    }
    for (int i = 0; err == 0 && i < c->settings; i++) {
        err = cli_param_set_by(p, "--set: ", c->setting[i].name, c->setting[i].value);
    }
    if (err == 0) { run_image_left(&c->live, p); }
    return err ? err : refuse_scale(c);
}

static void want(struct peer_cfg *p, const struct exh_signal *row, int instance, double value)
{
    if (p->params == PEER_PARAMS) { return; }
    p->param[p->params++] = (struct exh_wire_param){
        row->id, (uint16_t)instance, (int32_t)(value * (double)(INT64_C(1) << row->frac) + 0.5)};
}

/* What the scene's materials are like goes over the link, as for any other world. */
static void want_materials(const struct bilateral_run_cfg *c, struct peer_cfg *p)
{
    const struct scene *s = c->scene ? world_scene(c->scene) : NULL;
    for (int i = 0; s && i < s->materials && i < BILATERAL_MATERIALS; i++) {
        if (c->k_Npm < 0) { want(p, &exh_material_rows[0], i, s->material[i].k); }
        if (c->b_Nspm < 0) { want(p, &exh_material_rows[1], i, s->material[i].b); }
        want(p, &exh_material_rows[2], i, s->material[i].f_max);
    }
}

/* The table of outputs is struct bilateral_signals. */
static void want_trace(const struct bilateral_run_cfg *c, struct peer_cfg *p)
{
    static const size_t at[] = {offsetof(struct bilateral_paper, q_m_q30),
        offsetof(struct bilateral_paper, f_des_N_q20),
        offsetof(struct bilateral_paper, i_des_A_q26), offsetof(struct bilateral_paper, c)};
    unsigned f = 0;
    while (f + 1 < BILATERAL_FINGERS && !(c->board.exo.fingers >> f & 1)) { f++; }
    p->trace.every = (uint32_t)c->trace_every;
    for (unsigned i = 0; i < EXH_TRACE_SIGNALS; i++) {
        p->trace.index[i] =
            (uint16_t)((f * sizeof(struct bilateral_paper) + at[i]) / sizeof(int32_t));
    }
}

static void put_up(const struct bilateral_run_cfg *c)
{
    run.world.scene = c->scene;
    run.world.ray_m = c->ray_m;
    run.world.jump_s = c->jump_s;
    run.world.jump_m = c->jump_m;
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        const struct bilateral_finger_is w = finger_is(c, f);
        run.r->finger[f].touch_m = -1;
        if (!(c->board.exo.fingers >> f & 1)) { continue; }
        run.world.wall.fingers = (uint8_t)(run.world.wall.fingers | 1u << f);
        bilateral_wall(&run.world.wall.plane[f], &w, c->at_m);
        run.r->finger[f].touch_m = bilateral_string_m(&run.world, &w, 0, 0);
    }
}

static struct posix_config board_of(const struct bilateral_run_cfg *c)
{
    struct posix_config b = c->board;
    struct peer_cfg p = {.world = &run.world,
        .from_s = c->from_s,
        .until_s = c->until_s,
        .again_s = c->again_s,
        .param_from_s = c->param_from_s,
        .hostile = c->hostile};
    want_materials(c, &p);
    want_trace(c, &p);
    for (int i = 0; i < c->wants && p.params < PEER_PARAMS; i++) {
        p.param[p.params++] = c->want[i];
    }
    peer_start(&run.peer, &p, 1 + (uint32_t)(b.seed % 1000000));
    b.glove = 1;
    if (b.line.udp_local == NULL) {
        b.line.on = 1;
        b.line.frame = peer_frame;
        b.line.ctx = &run.peer;
        b.line.frame_s = 1 / c->fps;
    }
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        if (run.r->finger[f].touch_m > 0) { b.exo.path[f].believed_m = run.r->finger[f].touch_m; }
    }
    return b;
}

/* --- the run --- */

int bilateral_run(const struct bilateral_run_cfg *c, struct bilateral_run *r)
{
    static const struct exh_loop_hooks hooks = {start, before, after};
    struct posix_config board;
    int err;
    memset(r, 0, sizeof *r);
    memset(&run, 0, sizeof run);
    run.cfg = c;
    run.r = r;
    run.logged = c->board.log != NULL;
    run.done_s = -1;
    run.sees = c->board.line.udp_local == NULL;
    run.see_every = c->rate_Hz / SEES_HZ + 1;
    world_line_start();
    err = bilateral_stage(c);
    if (err < 0) { return err; }
    put_up(c);
    board = board_of(c);
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) { /* who knows what a world elsewhere holds */
        if (c->board.line.udp_local && !c->scene) { r->finger[f].touch_m = -1; }
    }
    posix_configure(&board);
    if (dumpfile_open(c->blackbox, run.logged, 0)) { return -EXH_E_SHORT; }
    err = exh_loop(&exh_scene_bilateral, c->rate_Hz, &hooks);
    r->dumps = dumpfile_close(err < 0);
    if (err == 0 && r->unarmed) {
        err = -EXH_E_STATE; /* already reported */
    } else if (err < 0 && !c->board.cards.quiet && !hand_rule_complain(c->rate_Hz, err) &&
               !images_complain(c->images, &exh_scene_bilateral)) {
        cli_setup_complain(exh_scene_bilateral.params, (double)c->rate_Hz, err);
    }
    if (run.logged && r->T.num != 0) { r->lost = exh_log_end(run.last_tick + 1); }
    if (err == 0) {
        const struct bilateral_signals *sig = (const void *)exh_scene_signals(&exh_scene_bilateral);
        r->box = sig->box;
        for (int f = 0; f < BILATERAL_FINGERS; f++) { r->finger[f].refused = sig->more[f].refused; }
        r->faults = (uint32_t)r->box.faults;
        for (int w = 0; w < SIM_LINK_WAYS; w++) { r->way[w] = posix_link()->way[w].counts; }
        r->frames = run.peer.frames;
        r->answers = run.peer.answers;
        r->trace = run.peer.trace;
        r->params = run.peer.cfg.params;
        for (int i = 0; i < r->params; i++) {
            r->acked += (int)(run.peer.acked >> i & 1);
            r->refused += (int)(run.peer.refused >> i & 1);
        }
    }
    if (run.no_memory) {
        cli_complain("out of memory: fewer approaches, or a lower rate");
        err = err ? err : -EXH_E_SHORT;
    }
    return err;
}

void bilateral_run_free(struct bilateral_run *r)
{
    for (unsigned f = 0; f < BILATERAL_FINGERS; f++) {
        free(r->finger[f].at);
        r->finger[f].at = NULL;
    }
}
