/* SPDX-License-Identifier: MIT */
#include "lab/contact/held.h"

#include "exhand/run/loop.h"

#include "exhand/board.h"
#include "exhand/exhand.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define REST_S 0.02 /* f0_rest */

/* One finger's part of the bilateral scene, and what it has not. */
static struct {
    struct held_law law;
    struct exh_quad_par quad_par;
    struct exh_velocity_par velocity_par;
    struct exh_contact_par contact_par;
    struct exh_drive_par drive_par;
    struct exh_tracking_par track_par;
    struct exh_motion_par watch_par;
    struct exh_safety_par safety_par;
    struct exh_passivity_par passivity_par;
    struct exh_quad_cfg quad_cfg;
    struct exh_velocity_window_cfg velocity_cfg;
    struct exh_velocity_pole_cfg pole_cfg;
    struct exh_velocity_foaw_cfg foaw_cfg;
    struct exh_velocity_track_cfg observer_cfg;
    struct exh_drive_cfg drive_cfg;
    struct exh_tracking_cfg track_cfg;
    struct exh_motion_cfg watch_cfg;
    struct exh_safety_cfg safety_cfg;
    struct exh_passivity_cfg passivity_cfg;
    struct exh_knot to_cur[2], to_force[2];
    int32_t lim_m_q30, one_mps_q27, still_mps_q27, pulse_Nspm_q20;
    uint32_t pulse_ticks, rest_ticks;
} cfg;

struct edges { /* of the count: the last two ticks at which it changed, the same way */
    int32_t cnt, way;
    uint32_t now, last, gap;
};

static struct state {
    struct exh_quad quad;
    struct exh_velocity_window velocity, played;
    struct exh_velocity_pole pole;
    struct exh_velocity_foaw foaw;
    struct exh_velocity_track observer;
    struct exh_contact contact;
    struct exh_drive drive;
    struct exh_tracking track;
    struct exh_motion watch;
    struct exh_safety safety;
    struct exh_passivity passivity;
    struct edges edges;
    int32_t play_cnt, pulse_N_q20, out_m_q30;
    uint32_t touched_ticks, rest_ticks;
    struct bilateral_paper paper;
} s;

static const struct exh_axis axis = {&s.quad, &cfg.quad_cfg, &s.velocity, &cfg.velocity_cfg,
    &s.watch, &cfg.watch_cfg, &s.track, &cfg.track_cfg, &s.drive, &cfg.drive_cfg, NULL, NULL};

/* --- velocity --- */

/* One edge a gap ago says a speed; that none came since says that it is no more than that. */
static int32_t edges_mps_q27(struct edges *e, int32_t cnt)
{
    const int32_t moved = cnt - e->cnt, way = moved > 0 ? 1 : moved < 0 ? -1 : 0;
    const int32_t one_mps_q27 = cfg.one_mps_q27; /* a count a tick */
    uint32_t since;
    e->now++;
    if (way) {
        e->gap = way == e->way ? e->now - e->last : 0; /* a turn says no speed */
        e->way = way;
        e->last = e->now;
        e->cnt = cnt;
    }
    since = e->now - e->last;
    if (e->gap == 0 || since > (uint32_t)cfg.law.of) { return 0; }
    if (way) { return (int32_t)((int64_t)one_mps_q27 * moved / (int32_t)e->gap); }
    return e->way * (one_mps_q27 / (int32_t)(since >= e->gap ? since + 1 : e->gap));
}

/* A count that follows one behind. */
static int32_t with_play(int32_t *at, int32_t cnt)
{
    if (cnt > *at + 1) { *at = cnt - 1; }
    if (cnt < *at) { *at = cnt; }
    return *at;
}

static int32_t velocity_mps_q27(const struct exh_axis_now *now)
{
    const int plays = cfg.law.damper == HELD_PLAY;
    const int32_t cnt = plays ? with_play(&s.play_cnt, now->cnt) : now->cnt;
    int32_t v = now->vel_mps_q27;
    switch (cfg.law.estimator) {
    case HELD_POLE: v = exh_velocity_pole_step(&s.pole, &cfg.pole_cfg, cnt); break;
    case HELD_FOAW: v = exh_velocity_foaw_step(&s.foaw, &cfg.foaw_cfg, cnt); break;
    case HELD_TRACK: v = exh_velocity_track_step(&s.observer, &cfg.observer_cfg, cnt); break;
    case HELD_EDGES: v = edges_mps_q27(&s.edges, cnt); break;
    case HELD_WINDOW:
    default:
        if (plays) { v = exh_velocity_window_step(&s.played, &cfg.velocity_cfg, cnt); }
    }
    return cfg.law.damper == HELD_STILL && abs(v) <= cfg.still_mps_q27 ? 0 : v;
}

/* --- the scene --- */

static int setup(struct exh_scene_board board)
{
    const struct exh_velocity_scale scale = {cfg.quad_par.step_m_q42, board.T};
    const struct exh_axis_setup parts = {&cfg.quad_cfg, &cfg.quad_par, &cfg.velocity_cfg,
        &cfg.velocity_par, &cfg.watch_cfg, &cfg.watch_par, &cfg.track_cfg, &cfg.track_par,
        &cfg.drive_cfg, &cfg.drive_par, NULL, NULL};
    const struct exh_table to_cur = {cfg.to_cur, 2}, to_force = {cfg.to_force, 2};
    const struct held_law *l = &cfg.law;
    int err = exh_table_setup(cfg.to_cur, 2);
    memset(&s, 0, sizeof s);
    if (err == 0) { err = exh_table_invert(cfg.to_force, cfg.to_cur, 2); }
    if (err == 0) { err = exh_axis_setup(&parts, board.T, board.enc_bits, to_cur, to_force); }
    if (err == 0) { err = exh_safety_setup(&cfg.safety_cfg, &cfg.safety_par, board.T); }
    if (err == 0 && l->passivity) {
        err = exh_passivity_setup(&cfg.passivity_cfg, &cfg.passivity_par, &cfg.drive_cfg, to_force,
            scale, cfg.watch_par.speed_mps_q27);
    }
    if (err == 0 && l->estimator == HELD_POLE) {
        err = exh_velocity_pole_setup(&cfg.pole_cfg, scale, (uint32_t)l->of);
    }
    if (err == 0 && l->estimator == HELD_FOAW) {
        err = exh_velocity_foaw_setup(&cfg.foaw_cfg, scale, (unsigned)l->of, 1);
    }
    if (err == 0 && l->estimator == HELD_TRACK) {
        err = exh_velocity_track_setup(&cfg.observer_cfg, scale, (uint32_t)l->of);
    }
    return err;
}

/* The pulse requested at the moment of contact, for a while. */
static int32_t pulse_N_q20(int touching, int32_t mps_q27)
{
    if (!touching) {
        s.touched_ticks = 0;
        return 0;
    }
    if (s.touched_ticks++ == 0) {
        s.pulse_N_q20 = mps_q27 > 0 ? exh_sat32(exh_mul_shr(cfg.pulse_Nspm_q20, mps_q27, 27)) : 0;
    }
    return s.touched_ticks <= cfg.pulse_ticks ? s.pulse_N_q20 : 0;
}

/* A slack string is wound in, as the scene does it. */
static void wind_in(void)
{
    struct exh_contact *c = &s.contact;
    if (c->touching || c->inward || c->turn_m_q30 != s.out_m_q30) {
        s.rest_ticks = 0;
    } else if (s.rest_ticks < cfg.rest_ticks) {
        s.rest_ticks++;
    } else {
        c->inward = 1;
    }
    s.out_m_q30 = c->turn_m_q30;
}

static void held_tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    const struct exh_axis_now now = exh_axis_sense(&axis, &in->drive, EXH_INDEX);
    const uint32_t din = (in->drive.din & (EXH_DIN_DRIVE0 - 1u)) | EXH_DIN_DRIVE0;
    const struct exh_safety_in box = {
        din, 0, in->missed, in->command, 1, EXH_UNTESTED | EXH_UNCALIBRATED | EXH_UNPOLARISED};
    const struct exh_permit permit = exh_axis_permit(&s.safety, &cfg.safety_cfg, &now, 1, box);
    const struct exh_contact_in q = {now.pos_m_q30, velocity_mps_q27(&now), cfg.lim_m_q30};
    struct exh_force_ledger f;
    struct exh_current_ledger i;
    struct exh_drive_out placed;
    uint32_t limits = now.limits;

    s.paper.c = exh_contact_step(&s.contact, &cfg.contact_par, q, &f);
    wind_in();
    f.damper_N_q20 += pulse_N_q20(s.paper.c, q.vel_mps_q27);
    if (cfg.law.passivity) {
        limits |= exh_passivity_step(&s.passivity, &cfg.passivity_cfg, now.cnt, s.paper.c, &f);
    }
    limits |= exh_axis_force(&axis, &permit, &f, &i);
    exh_axis_out(&axis, &s.safety, now.cnt, &i, &limits, &placed);
    if (cfg.law.passivity) {
        exh_passivity_update(&s.passivity, &cfg.passivity_cfg, &f, i.coded_A_q26);
    }
    memset(out, 0, sizeof *out);
    out->dac_raw[EXH_INDEX] = placed.dac_raw[0];
    out->enable = (uint8_t)((placed.enable & 1u) << EXH_INDEX);
    out->alive = placed.alive;
    s.paper.q_m_q30 = now.pos_m_q30;
    s.paper.qd_mps_q27 = q.vel_mps_q27;
    s.paper.f_des_N_q20 = f.force_N_q20;
    s.paper.i_des_A_q26 = i.coded_A_q26;
    s.paper.f_mon_N_q20 = exh_drive_monitor_N_q20(&cfg.drive_cfg, now.mon_A_q26);
    s.paper.q_lim_m_q30 = cfg.lim_m_q30;
}

static struct exh_scene held = {.name = "held",
    .rate_Hz = 2000,
    .fingers = EXH_FINGERS,
    .safety = &s.safety,
    .setup = setup,
    .tick = held_tick};

/* --- the run --- */

static struct {
    struct bilateral_run *r;
    double *work_J;
    double touch_m, was_m, was_N, done_J;
    int works, failed;
} run;

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    run.r->T = board.T;
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    if (tick == 0) { in->command = EXH_CMD_RUN; }
}

/* The motor pulls the string in: what it gives is its force times the way that q becomes less. */
static void work(const struct sim_finger *f)
{
    const double force_N = f->device.kf_npa * f->plant.cur_A;
    run.done_J -= (force_N + run.was_N) / 2 * (f->plant.q_m - run.was_m);
    run.was_N = force_N;
    run.was_m = f->plant.q_m;
}

static int make_room(struct bilateral_track *t)
{
    const size_t cap = t->cap ? 2 * t->cap : 8192;
    struct bilateral_sample *more = realloc(t->at, cap * sizeof *more);
    double *works = run.works ? realloc(run.work_J, cap * sizeof *works) : NULL;
    if (more) { t->at = more; }
    if (works) { run.work_J = works; }
    if (more == NULL || (run.works && works == NULL)) { return 0; }
    t->cap = cap;
    return 1;
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const struct sim_finger *f = posix_finger(EXH_INDEX);
    const enum sim_path_phase phase = f->path.phase;
    const int under_way =
        phase == SIM_PATH_APPROACH || phase == SIM_PATH_HOLD || phase == SIM_PATH_WITHDRAW;
    struct bilateral_track *t = &run.r->finger[EXH_INDEX];
    (void)tick, (void)in, (void)out;
    work(f);
    run.r->ticks++;
    if (t->n == t->cap && !make_room(t)) {
        run.failed = 1;
        posix_stop();
        return;
    }
    if (run.works) { run.work_J[t->n] = run.done_J; }
    t->at[t->n++] = (struct bilateral_sample){s.paper, EXH_PRECONTACT_STANDS,
        under_way ? (int32_t)f->path.number : 0, phase == SIM_PATH_HOLD, f->plant.x_m, (double)NAN,
        run.touch_m};
    if (phase == SIM_PATH_DONE) { posix_stop(); }
}

static int32_t fix(double v, int frac) { return (int32_t)floor(ldexp(v, frac) + 0.5); }

/* The scene's parameters, as it would run with this device. */
static void take(const struct held_law *l, const struct bilateral_run_cfg *c)
{
    const struct sim_device *d = &c->board.device;
    const double step_m = d->step_m / l->decode, rate_Hz = l->rate_Hz;
    memset(&cfg, 0, sizeof cfg);
    cfg.law = *l;
    cfg.quad_par = (struct exh_quad_par){fix(step_m, EXH_Q_STEP), fix(10, EXH_Q_VEL)};
    cfg.velocity_par.p = l->estimator == HELD_WINDOW ? l->of : 1;
    cfg.contact_par = (struct exh_contact_par){fix(l->k_Npm, EXH_Q_K), fix(l->b_Nspm, EXH_Q_B),
        EXH_Q(107, 1000, EXH_Q_FORCE), EXH_Q(2, 10000, EXH_Q_POS), fix(l->hyst_m, EXH_Q_POS)};
    cfg.drive_par =
        (struct exh_drive_par){fix(40, EXH_Q_FORCE), 200000, 200000, EXH_Q(66, 10, EXH_Q_CUR),
            EXH_Q(33, 10, EXH_Q_CUR), 2700, 32768, 12184, fix(d->dac_perA, EXH_Q_DAC), 0,
            fix(d->mon_apc, EXH_Q_MON), fix(40, EXH_Q_FORCE), EXH_Q(66, 10, EXH_Q_CUR)};
    cfg.track_par = (struct exh_tracking_par){fix(0.25, EXH_Q_CUR), 20};
    cfg.watch_par = (struct exh_motion_par){fix(3, EXH_Q_VEL), 20, 0, fix(0.25, EXH_Q_CUR)};
    cfg.safety_par = (struct exh_safety_par){1, fix(1, EXH_Q_FORCE), 50, 500, 15};
    cfg.passivity_par.on = l->passivity;
    cfg.to_cur[1].y = cfg.drive_par.i_peak_A_q26;
    cfg.to_cur[1].x =
        (int32_t)exh_mul_shr(fix(d->kf_npa, EXH_Q_FORCE), cfg.drive_par.i_peak_A_q26, EXH_Q_CUR);
    cfg.one_mps_q27 = fix(step_m * rate_Hz, EXH_Q_VEL);
    cfg.still_mps_q27 = (cfg.one_mps_q27 >> cfg.velocity_par.p) + 1;
    cfg.pulse_Nspm_q20 = fix(l->pulse_Nspm, EXH_Q_B);
    cfg.rest_ticks = (uint32_t)(REST_S * rate_Hz) + 1;
    cfg.pulse_ticks = (uint32_t)(l->pulse_s * rate_Hz + 0.5);
    cfg.lim_m_q30 = l->lim_m_q30 ? l->lim_m_q30
                                 : fix(c->at_m - c->board.exo.path[EXH_INDEX].start_m, EXH_Q_POS);
}

int held_run(const struct held_law *l, const struct bilateral_run_cfg *c, struct bilateral_run *r,
    double **work_J)
{
    static const struct exh_loop_hooks hooks = {start, before, after};
    struct posix_config board = c->board;
    int err;
    memset(r, 0, sizeof *r);
    memset(&run, 0, sizeof run);
    run.r = r;
    run.works = work_J != NULL;
    run.touch_m = c->at_m;
    board.device.decode = l->decode;
    board.exo.fingers = 1u << EXH_INDEX;
    board.exo.path[EXH_INDEX].believed_m = c->at_m;
    take(l, c);
    held.read_glove = board.glove ? exh_board_read_glove : NULL; /* its instants, too */
    posix_configure(&board);
    err = exh_loop(&held, l->rate_Hz, &hooks);
    r->faults = s.safety.faults;
    if (work_J) { *work_J = run.work_J; }
    return err == 0 && (run.failed || r->faults) ? -EXH_E_STATE : err;
}
