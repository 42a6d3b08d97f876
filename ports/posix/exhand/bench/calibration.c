/* SPDX-License-Identifier: MIT */
#include "bench/calibration.h"

#include "base/option.h"
#include "base/param.h"

#include "calibrate/calibrate.h"
#include "exhand/run/loop.h"

#include "exhand/board.h"
#include "exhand/error.h"

#include <string.h>

#define GO_ID   0x8211
#define MASS_ID 0x8220

static struct {
    const struct calibration_cfg *cfg;
    struct calibration *out;
    struct exh_period T;
    int asked;      /* steps that the person was asked to prepare */
    int32_t step;   /* as of the last tick */
    uint32_t begin; /* tick at which the step began */
    int32_t begin_m_q30;
    int busy;
} run;

static double si(int32_t raw, int frac) { return (double)raw / (double)(INT64_C(1) << frac); }

static struct calibrate_signals signals(void)
{
    struct calibrate_signals s;
    memcpy(&s, exh_scene_signals(&exh_scene_calibrate), sizeof s);
    return s;
}

/* --- the person and the narrator, as hooks of the loop --- */

static void start(const struct exh_scene *sc, struct exh_scene_board board)
{
    (void)sc;
    run.T = board.T;
}

/* A step waits: ask for its place, and say so when it is prepared. */
static void before(uint32_t tick, struct exh_scene_in *in)
{
    const struct calibrate_signals s = signals();
    const double *hung_kg = run.cfg->hung_kg ? run.cfg->hung_kg : run.cfg->mass_kg;
    const int mass = s.step - CALIBRATE_MASS;
    if (tick == 0) { in->command = EXH_CMD_RUN; }
    if (tick == 0 || !s.waits) { return; }
    if (run.asked == s.step) {
        run.asked++;
        posix_bench(
            calibrate_ask((unsigned)s.step) == CALIBRATE_ASK_MASS ? BENCH_MASS : BENCH_SLACK,
            mass >= 0 && mass < run.cfg->masses ? hung_kg[mass] : 0);
    } else if (posix_bench_ready()) {
        (void)exh_params_stage(exh_scene_calibrate.params, GO_ID, 0, s.step + 1);
    }
}

static void say_result(FILE *f, int32_t step, unsigned result)
{
    const struct calibrate *s = calibrate_state();
    const double amount_m = run.out->last_travel_m;
    char name[24];
    if (f == NULL) { return; }
    if (step >= CALIBRATE_MASS) {
        snprintf(name, sizeof name, "mass %.4g kg", run.cfg->mass_kg[step - CALIBRATE_MASS]);
    } else {
        snprintf(name, sizeof name, "%s", calibrate_step_text((unsigned)step));
    }
    fprintf(f, "  %-14s %7.2f s  up to %6.1f mA  %6.1f mm   ", name, run.out->last_s,
        run.out->last_most_A * 1e3, amount_m * 1e3);
    if (result > EXH_PROBE_DONE) {
        fprintf(f, "FAILED: %s\n", calibrate_result_text(result));
    } else if (step == CALIBRATE_ZERO) {
        fprintf(f, "monitor reads %d codes at no current\n", (int)run.out->c.mon_zero_raw);
    } else if (step == CALIBRATE_POLARITY) {
        fprintf(f, "the string goes in at %.1f mA\n", run.out->polarity_A * 1e3);
    } else if (step == CALIBRATE_HOME) {
        fprintf(f, "its end lies %.2f mm in from where it was\n", -run.out->home_m * 1e3);
    } else if (step == CALIBRATE_F0) {
        fprintf(
            f, "the slack string returns at %.1f mA\n", si(run.out->c.f0_A_q26, EXH_Q_CUR) * 1e3);
    } else {
        const struct exh_weigh *w = &s->weigh[step - CALIBRATE_MASS];
        fprintf(f, "lifts at %.1f mA, sinks at %.1f mA\n", si(w->lift_A_q26, EXH_Q_CUR) * 1e3,
            si(w->sink_A_q26, EXH_Q_CUR) * 1e3);
    }
}

static void step_ended(int32_t step, unsigned result)
{
    const struct calibrate *s = calibrate_state();
    const struct exh_quad_par *quad = &calibrate_config()->par->quad;
    calibrate_points(s, calibrate_config(), &run.out->c);
    run.out->polarity_A = si(s->polarity.cur_A_q26, EXH_Q_CUR);
    run.out->home_m = si(exh_quad_pos_m_q30(quad, s->home.home_cnt), EXH_Q_POS);
    say_result(run.cfg->progress, step, result);
}

/* What ends it all is the scene's to say: a step that is done is not yet the end. */
static void all_ended(int32_t step, const struct calibrate_signals *s)
{
    run.out->step = (unsigned)step;
    run.out->result = (unsigned)s->result;
    run.out->limits = (uint32_t)s->limits & ~(uint32_t)EXH_LIMIT_GATE;
    posix_stop();
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    const struct calibrate_signals s = signals();
    const double cur_A = si(s.i_des_A_q26, EXH_Q_CUR);
    const double far_m = si(s.q_m_q30 - run.begin_m_q30, EXH_Q_POS);
    const int busy = !s.waits && s.result == EXH_PROBE_BUSY;
    const int ends = s.result != EXH_PROBE_BUSY && run.out->result == EXH_PROBE_BUSY;
    (void)in;
    (void)out;
    if (ends && !run.busy) { /* in a wait: it began where the last step ended */
        run.out->last_s = (double)(tick - run.begin) * run.T.num / run.T.den;
        run.out->last_most_A = run.out->last_travel_m = 0;
    } else if (busy && !run.busy) {
        run.begin = tick;
        run.begin_m_q30 = s.q_m_q30;
        run.out->last_s = run.out->last_most_A = run.out->last_travel_m = 0;
    } else if (busy || run.busy) {
        run.out->last_s = (double)(tick - run.begin) * run.T.num / run.T.den;
        if (far_m > run.out->last_travel_m) { run.out->last_travel_m = far_m; }
        if (-far_m > run.out->last_travel_m) { run.out->last_travel_m = -far_m; }
        if (cur_A > run.out->last_most_A) { run.out->last_most_A = cur_A; }
    }
    if (cur_A > run.out->most_A) { run.out->most_A = cur_A; }
    run.out->faults |= (uint32_t)s.faults;
    if (ends) { all_ended(run.step, &s); }
    if (ends || (run.busy && !busy)) {
        step_ended(run.step, s.result ? (unsigned)s.result : EXH_PROBE_DONE);
        run.begin = tick;
    }
    run.busy = busy;
    run.step = s.step;
}

/* --- a run --- */

/* The names of the bits that are set, commas between. */
static void names(char *to, size_t size, uint32_t bits, const char *const *name, unsigned count)
{
    to[0] = '\0';
    for (unsigned i = 0; i < count; i++) {
        const size_t n = strlen(to);
        if (bits >> i & 1) { snprintf(to + n, size - n, "%s%s", n ? ", " : "", name[i]); }
    }
}

void calibration_why(char to[CALIBRATION_WHY_B], const struct calibration *r)
{
    static const char *const fault[] = {"emergency stop", "drive not ready", "ticks missed",
        "encoder", "dead-man released", "current tracking", "encoder stands", "too fast", "glove",
        "card", "link", "supply", "watchdog", "configuration", "state of the box"};
    static const char *const limit[] = {"pull", "force: f_max, or i_max", "slew", "peak: i_peak",
        "I2t: i_cont, i_peak, peak_time", "D/A span", "gate", "ramp", "release", "speed",
        "passivity", "person: person_f, person_i"};
    char list[120] = "";
    if (r->result == CALIBRATE_OFF) {
        names(list, sizeof list, r->faults, fault, sizeof fault / sizeof fault[0]);
        if (list[0] == '\0') { snprintf(list, sizeof list, "by command"); }
    } else if (r->result == CALIBRATE_LIMITED) {
        names(list, sizeof list, r->limits & ~(uint32_t)EXH_LIMIT_SLEW, limit,
            sizeof limit / sizeof limit[0]);
    }
    snprintf(to, CALIBRATION_WHY_B, "%s%s%s%s", calibrate_result_text(r->result),
        list[0] ? " (" : "", list, list[0] ? ")" : "");
}

static int set_parameters(const struct calibration_cfg *c)
{
    const struct sim_device *d = &c->board.device;
    const struct calibration_setting known[] = {
        {"step", d->step_m / d->decode},
        {"dac_scale", d->dac_perA},
        {"dac_zero", d->dac_zero},
        {"mon_scale", d->mon_apc},
    };
    struct exh_params *p = exh_scene_calibrate.params;
    int err = 0;
    exh_scene_calibrate.defaults();
    for (size_t i = 0; err == 0 && i < sizeof known / sizeof known[0]; i++) {
        err = cli_param_set(p, known[i].name, known[i].value);
    }
    for (int i = 0; err == 0 && i < c->settings; i++) {
        err = cli_param_set(p, c->setting[i].name, c->setting[i].value);
    }
    for (int i = 0; err == 0 && i < c->masses; i++) {
        err = exh_params_stage(
            p, MASS_ID, (uint16_t)i, (int32_t)(c->mass_kg[i] * (1 << EXH_Q_FORCE) + 0.5));
    }
    return err;
}

static double active(const struct exh_params *p, const char *name)
{
    uint32_t at = 0;
    const struct exh_signal *row = cli_signal_find(p->table, name, &at);
    return row ? cli_signal_value(row, p->active[at]) : 0;
}

/* Checks combinations of values: a mass so small that the slack's force could lift it, and a speed
 * that reaches the travel limit within a dwell. Returns 1 if one of them is bad. */
static int say_product(const struct exh_params *p)
{
    const double least_kg = active(p, "slack_cur") * active(p, "kf_min") / active(p, "gravity");
    const double v = active(p, "f0_speed") * active(p, "dwell") / 1000;
    if (run.cfg->mass_kg[0] < least_kg + 1e-6) {
        cli_complain(
            "--mass: %.9g (slack_cur %.9g a takes at least %.9g kg, by kf_min %.9g n_per_a): "
            "choose a heavier one, or a lower slack_cur",
            run.cfg->mass_kg[0], active(p, "slack_cur"), least_kg, active(p, "kf_min"));
        return 1;
    }
    if (v >= active(p, "travel")) {
        cli_complain(
            "f0_speed: %.9g (in a dwell it goes %.9g m, allowed up to travel: %.9g m): choose "
            "a lower one",
            active(p, "f0_speed"), v, active(p, "travel"));
        return 1;
    }
    return 0;
}

/* Set-up refused values that are each in their own range: which of them disagree? */
static void say_pair(void)
{
    static const char *const pair[][2] = {{"home_min", "home_max"}, {"move", "travel"},
        {"move", "home_max"}, {"slack_cur", "i_max"}, {"pol_max", "i_max"}, {"home_cur", "i_max"},
        {"i_cont", "i_peak"}};
    const struct exh_params *p = exh_scene_calibrate.params;
    for (size_t i = 0; i < sizeof pair / sizeof pair[0]; i++) {
        uint32_t a = 0, b = 0;
        const struct exh_signal *row = cli_signal_find(p->table, pair[i][0], &a);
        if (row == NULL || cli_signal_find(p->table, pair[i][1], &b) == NULL) { continue; }
        if (p->active[a] <= p->active[b]) { continue; }
        cli_complain("%s: %.9g (allowed up to %s: %.9g %s): choose a lower one", pair[i][0],
            cli_signal_value(row, p->active[a]), pair[i][1], cli_signal_value(row, p->active[b]),
            row->unit);
        return;
    }
    if (!say_product(p)) {
        cli_complain(
            "%s: `exhand calibrate --params` lists the ranges", exh_error_text(-EXH_E_RANGE));
    }
}

int calibration_run(const struct calibration_cfg *cfg, struct calibration *out)
{
    static const struct exh_loop_hooks hooks = {start, before, after};
    struct posix_config board = cfg->board;
    int err;

    memset(out, 0, sizeof *out);
    memset(&run, 0, sizeof run);
    out->c.point = out->point;
    out->c.cap = EXH_CALIB_POINTS_MAX;
    run.cfg = cfg;
    run.out = out;
    board.bench = 1;
    err = set_parameters(cfg);
    if (err < 0) { return err; }
    posix_configure(&board);
    err = exh_loop(&exh_scene_calibrate, cfg->rate_Hz, &hooks);
    if (err == -EXH_E_RATE) {
        cli_complain(
            "rate: %lu Hz (allowed 20..%lu, and two ticks a dwell): choose one in that range",
            (unsigned long)cfg->rate_Hz, (unsigned long)exh_board_info.rate_max_Hz);
    } else if (err == -EXH_E_RANGE) {
        say_pair();
    } else if (err == -EXH_E_MONOTONE) {
        cli_complain(
            "--mass: two of them are the same to within a milligram: give masses that rise");
    } else if (err < 0) {
        cli_complain("%s", exh_error_text(err));
    } else if (posix_interrupted() || run.out->result == EXH_PROBE_BUSY) {
        cli_complain("interrupted at step %d, %s: nothing was saved", (int)run.step,
            calibrate_step_text((unsigned)run.step));
        err = -EXH_E_STATE;
    }
    return err;
}
