/* SPDX-License-Identifier: MIT */
#include "box/run.h"

#include "box/arming.h"
#include "box/dumpfile.h"
#include "box/idle.h"
#include "base/option.h"
#include "base/param.h"
#include "base/params_file.h"
#include "base/scenes.h"

#include "sim/codes.h"
#include "sim/random.h"

#include "drop/drop.h"
#include "exhand/run/log.h"
#include "exhand/run/loop.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/safety.h"

#include <stdlib.h>
#include <string.h>

static struct {
    struct run *r;
    const struct exh_scene *scene;
    const struct exh_loop_hooks *more;
    struct fall_sample *sample;
    size_t *start;
    size_t samples_cap, starts_cap;
    int fall; /* under observation in the present tick, 0 = none */
    int live;
    int no_memory;
    double mon_gain;
    int logged;                 /* unused records would cost a third of a run */
    uint32_t last_tick, passed; /* the latter of ticks that the loop had no part in */
    int ran;                    /* the box came to run */
    int all;                    /* every tick is run */
    struct idle idle;
} run;

static void *grow(void *p, size_t *cap, size_t n, size_t size)
{
    void *q;
    if (n < *cap) { return p; }
    *cap = *cap ? 2 * *cap : 1024;
    q = realloc(p, *cap * size);
    if (q == NULL) { run.no_memory = 1; }
    return q ? q : p;
}

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    run.r->T = board.T;
    if (sc == &exh_scene_guarded) { guard_start(&run.r->guard, board); }
    dumpfile_start(sc, board);
    if (run.more) { run.more->start(sc, board); }
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    const int fall = posix_fall();
    if (tick == 0 && !run.live) { in->command = EXH_CMD_RUN; }
    if (run.logged && fall != run.fall) { exh_log_mark(tick, fall); }
    if (fall != 0 && fall != run.fall && !run.live) {
        run.start = grow(run.start, &run.starts_cap, run.r->log.falls, sizeof *run.start);
        if (!run.no_memory) { run.start[run.r->log.falls++] = run.r->log.samples; }
    }
    run.fall = fall;
    if (run.more) { run.more->before(tick, in); }
    dumpfile_before(tick, in);
}

static double si(int32_t raw, int frac) { return (double)raw / (double)(INT64_C(1) << frac); }

/* The mass is held until the device is in RUN. A device that does not reach RUN makes the
 * experiment invalid, unless another client commands it. */
static void watch_arming(const struct drop_signals *s)
{
    const enum arming is = arming_is(s->state);
    if (run.live && run.ran && is == ARMING_REFUSED) {
        run.ran = 0;
        posix_hold();
    }
    if (run.ran || is == ARMING_GOES_ON || (run.more && is != ARMING_RUNS)) { return; }
    run.ran = is == ARMING_RUNS;
    if (run.ran) {
        posix_ready();
    } else {
        arming_complain(s->arm_step, s->present);
        run.r->refused = s->arm_step ? (uint32_t)s->arm_step : (uint32_t)EXH_ARM_RAMP;
        posix_stop();
    }
}

static void keep(uint32_t tick, const struct drop_signals *s)
{
    run.sample = grow(run.sample, &run.samples_cap, run.r->log.samples, sizeof *run.sample);
    if (run.no_memory) {
        posix_stop();
        return;
    }
    run.sample[run.r->log.samples++] = (struct fall_sample){
        .t_s = (double)tick * run.r->T.num / run.r->T.den,
        .q_m = si(s->q_m_q30, EXH_Q_POS),
        .qd_mps = si(s->qd_mps_q27, EXH_Q_VEL),
        .f_des_N = si(s->f_des_N_q20, EXH_Q_FORCE),
        .i_des_A = si(s->i_des_A_q26, EXH_Q_CUR),
        .f_mon_N = si(s->f_mon_N_q20, EXH_Q_FORCE) * run.mon_gain,
        .c = s->c,
    };
}

/* The ticks up to the end of a fall that are known. */
static void pass(uint32_t tick, struct drop_signals *s)
{
    uint32_t n = 0;
    int16_t mon_raw;
    if (!idle_step(&run.idle)) { return; }
    while (!run.no_memory && posix_pass(&mon_raw)) {
        s->f_mon_N_q20 = idle_monitor_N_q20(mon_raw);
        keep(tick + ++n, s);
    }
    idle_passed(n);
    run.r->ticks += n;
    run.r->known += n;
    run.passed += n;
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    struct drop_signals s;
    memcpy(&s, exh_scene_signals(run.scene), sizeof s);
    if (run.scene == &exh_scene_guarded) { guard_after(&run.r->guard); }
    dumpfile_after(tick, in, out);
    run.last_tick = tick;
    run.r->ticks++;
    run.r->faults |= (uint32_t)s.faults;
    watch_arming(&s);
    if (run.more) { run.more->after(tick, in, out); }
    if (run.fall == 0 || run.live) { return; }
    keep(tick + run.passed, &s);
    if (!run.all) { pass(tick + run.passed, &s); }
}

static const struct exh_scene *scene_of(const struct run_cfg *c)
{
    return c->scene ? c->scene : &exh_scene_drop;
}

int run_image(const struct run_live *l, struct exh_params *p)
{
    return l->image ? params_take(l->name, p, l->image, l->image_B) : 0;
}

void run_image_left(const struct run_live *l, const struct exh_params *p)
{
    if (l->image) { params_tell_left(l->name, p, l->image, l->image_B); }
}

/* 1: the rate is not the controller's own; this was reported. */
static int other_rate(const struct run_cfg *c, const struct exh_scene *sc)
{
    const uint32_t only_Hz = sc == cli_scene_more ? cli_scene_more_rate_Hz() : 0;
    if (only_Hz && c->rate_Hz != only_Hz) {
        cli_complain("rate: %lu Hz: this controller was made for %lu Hz (MODEL_RATE): give --rate "
                     "%lu, or one made for another",
            (unsigned long)c->rate_Hz, (unsigned long)only_Hz, (unsigned long)only_Hz);
        return 1;
    }
    return 0;
}

/* Why set-up refused, as far as the scene knows; 1: reported. */
static int complain(const struct run_cfg *c, const struct exh_scene *sc)
{
    if (sc == cli_scene_more && cli_scene_more_unknown()) {
        cli_complain("%s: no input of the slot or parameter is named so (--custom --params lists "
                     "them): name the "
                     "model's port otherwise, or MODEL_MAP=%s=NAME",
            cli_scene_more_unknown(), cli_scene_more_unknown());
        return 1;
    }
    return images_complain(c->images, sc);
}

static double fraction(double v) { return v - (double)sim_floor(v); }

static double wall_m(const struct run_cfg *c)
{
    const struct sim_device *d = &c->board.device;
    struct sim_random chance = {c->board.seed ^ 0x77616C6C}; /* not the run's own chance */
    if (c->wall == RUN_WALL_AT_HEIGHT) { return d->height_m; }
    return sim_wall_m(d, c->wall == RUN_WALL_DRAWN ? sim_random_unit(&chance) : c->phase);
}

/* An image has the wall of the run that saved it: another place between the same two counts. */
static int image_wall(const struct run_cfg *c)
{
    const struct exh_params *p = scene_of(c)->params;
    const struct sim_device *d = &c->board.device;
    double off_cnt;
    uint32_t i;
    if (c->live.image == NULL || c->wall == RUN_WALL_AT_HEIGHT ||
        !cli_signal_find(p->table, "q_lim", &i)) {
        return 0;
    }
    off_cnt = (si(p->staged[i], EXH_Q_POS) - d->height_m) * d->decode / d->step_m;
    return off_cnt > -0.51 && off_cnt < 0.51;
}

/* As the scene will have it. */
static void tell_wall(const struct run_cfg *c, struct run *r)
{
    const struct exh_params *p = scene_of(c)->params;
    uint32_t i;
    if (!cli_signal_find(p->table, "q_lim", &i)) { return; }
    r->q_lim_m = si(p->staged[i], EXH_Q_POS);
    r->phase = fraction(r->q_lim_m / (c->board.device.step_m / c->board.device.decode));
}

static int set_parameters(const struct run_cfg *c)
{
    const struct sim_device *d = &c->board.device;
    const struct run_setting calibrated[] = {
        {"step", d->step_m / d->decode},
        {"kf", d->kf_npa},
        {"dac_scale", d->dac_perA},
        {"dac_zero", d->dac_zero},
        {"mon_scale", d->mon_apc},
        {"q_lim", wall_m(c)},
        {"k", c->k_Npm},
        {"b", c->b_Nspm},
    };
    struct exh_params *p = scene_of(c)->params;
    int err = 0;
    scene_of(c)->defaults();
    err = images_give(c->images, scene_of(c));
    for (size_t i = 0; err == 0 && i < sizeof calibrated / sizeof calibrated[0]; i++) {
        err = cli_param_set(p, calibrated[i].name, calibrated[i].value);
    }
    if (err == 0) { err = run_image(&c->live, p); }
    if (err == 0 && image_wall(c)) { err = cli_param_set(p, "q_lim", wall_m(c)); }
    if (err == 0 && c->live.gains) {
        err = cli_param_set_by(p, "--k: ", "k", c->k_Npm);
        if (err == 0) { err = cli_param_set_by(p, "--b: ", "b", c->b_Nspm); }
    }
    for (int i = 0; err == 0 && i < c->settings; i++) {
        err = cli_param_set_by(p, "--set: ", c->setting[i].name, c->setting[i].value);
    }
    if (err == 0) { run_image_left(&c->live, p); }
    return err;
}

int run_check(const struct run_cfg *c)
{
    const struct exh_period T = c->board.T.num ? c->board.T : (struct exh_period){1, c->rate_Hz};
    int err = set_parameters(c);
    if (err < 0) { return err; }
    exh_params_apply(scene_of(c)->params);
    err = scene_of(c)->setup((struct exh_scene_board){T, exh_board_info.enc_bits});
    if (err == -EXH_E_RATE && other_rate(c, scene_of(c))) { return err; }
    if (err < 0 && !complain(c, scene_of(c))) {
        cli_complain("these parameters together: %s", exh_error_text(err));
    }
    return err;
}

int run_drop(const struct run_cfg *c, struct run *r)
{
    static const struct exh_loop_hooks hooks = {start, before, after};
    struct posix_config board;
    int err;

    memset(r, 0, sizeof *r);
    memset(&run, 0, sizeof run);
    run.r = r;
    run.scene = scene_of(c);
    run.more = c->more;
    run.live = c->live.on;
    run.logged = c->board.log != NULL;
    run.all = c->all || run.scene != &exh_scene_drop || run.more || run.logged ||
              c->board.log_put || c->blackbox;
    run.mon_gain = c->mon_gain != 0 ? c->mon_gain : 1;
    err = set_parameters(c);
    if (err == 0) {
        tell_wall(c, r);
        board = c->board;
        board.wait = 1;
        posix_configure(&board);
        if (dumpfile_open(c->blackbox, run.logged, c->blackbox_B)) { return -EXH_E_SHORT; }
        err = exh_loop(run.scene, c->rate_Hz, &hooks);
        r->dumps = dumpfile_close(err < 0);
        if (err == 0 && r->refused) {
            err = -EXH_E_STATE; /* already reported */
        } else if (err == -EXH_E_RATE) {
            if (!other_rate(c, run.scene)) {
                cli_complain("rate: %lu Hz (allowed 1..%lu): choose one in that range",
                    (unsigned long)c->rate_Hz, (unsigned long)exh_board_info.rate_max_Hz);
            }
        } else if (err < 0 && !complain(c, run.scene)) {
            cli_setup_complain(run.scene->params, (double)c->rate_Hz, err);
        }
        if (run.logged && r->T.num != 0) {
            r->lost = exh_log_end(run.last_tick + 1);
        } /* it was started */
    }
    r->log.sample = run.sample;
    r->log.start = run.start;
    if (run.no_memory) {
        cli_complain("out of memory: fewer falls, or a lower rate");
        err = err ? err : -EXH_E_SHORT;
    }
    return err;
}

void run_free(struct run *r)
{
    /* The log's view of the arrays is const, but we own them. */
    union {
        const void *view;
        void *own;
    } u;
    u.view = r->log.sample;
    free(u.own);
    u.view = r->log.start;
    free(u.own);
    memset(r, 0, sizeof *r);
}
