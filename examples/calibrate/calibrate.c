/* SPDX-License-Identifier: MIT */
#include "calibrate.h"

#define ROW_A(id, name, max_mA, dflt_mA, help) \
    { \
        (id), EXH_Q_CUR, EXH_WHEN_SETUP, EXH_Q(1, 1000, EXH_Q_CUR), \
            EXH_Q(max_mA, 1000, EXH_Q_CUR), EXH_Q(dflt_mA, 1000, EXH_Q_CUR), (name), "a", (help) \
    }
#define ROW_M(id, name, max_mm, dflt_um, help) \
    { \
        (id), EXH_Q_POS, EXH_WHEN_SETUP, EXH_Q(1, 10000, EXH_Q_POS), \
            EXH_Q(max_mm, 1000, EXH_Q_POS), EXH_Q(dflt_um, 1000000, EXH_Q_POS), (name), "m", \
            (help) \
    }
#define ROW_MS(id, name, max_ms, dflt_ms, help) \
    { \
        (id), 0, EXH_WHEN_SETUP, 1, (max_ms), (dflt_ms), (name), "ms", (help) \
    }

static const struct exh_signal own_rows[] = {
    {0x8201, EXH_Q_FORCE, EXH_WHEN_SETUP, EXH_Q(97, 10, EXH_Q_FORCE), EXH_Q(99, 10, EXH_Q_FORCE),
        EXH_Q(981, 100, EXH_Q_FORCE), "gravity", "m_per_s2", "where the masses hang"},
    ROW_A(0x8202, "i_max", 3300, 3300, "no step goes beyond this current"),
    ROW_A(0x8203, "i_step", 100, 5, "currents rise and fall by this"),
    ROW_A(0x8204, "pol_max", 500, 300, "polarity check: no further than this"),
    ROW_A(0x8205, "home_cur", 500, 100, "homing pulls with this"),
    ROW_A(0x8206, "slack_cur", 500, 50, "takes up a standing mass's slack"),
    {0x8212, EXH_Q_FORCE, EXH_WHEN_SETUP, EXH_Q(1, 10, EXH_Q_FORCE), EXH_Q(50, 1, EXH_Q_FORCE),
        EXH_Q(2, 1, EXH_Q_FORCE), "kf_min", "n_per_a",
        "no mass gets more current than its force over this"},
    ROW_A(0x8207, "end_cur", 6600, 6600, "tables go on straight from the last mass to here"),
    ROW_M(0x8208, "move", 5, 300, "this far within a dwell is movement"),
    ROW_M(0x8209, "travel", 100, 30000, "travel limit of all steps but home"),
    ROW_M(0x820A, "home_min", 500, 100000, "an end nearer than this is a jam"),
    ROW_M(0x820B, "home_max", 500, 300000, "travel limit of homing"),
    {0x820C, EXH_Q_VEL, EXH_WHEN_SETUP, EXH_Q(1, 1000, EXH_Q_VEL), EXH_Q(1, 4, EXH_Q_VEL),
        EXH_Q(2, 100, EXH_Q_VEL), "f0_speed", "m_per_s", "f0 returns the slack string so fast"},
    ROW_MS(0x820D, "dwell", 1000, 100, "time at each current"),
    ROW_MS(0x820E, "hold", 10000, 500, "means are taken over this"),
    ROW_MS(0x820F, "step_time", 600000, 120000, "no phase of a step takes longer"),
    ROW_MS(0x8210, "wait_time", 1000000, 600000, "no wait for a person takes longer"),
    {0x8211, 0, EXH_WHEN_WORD, 0, CALIBRATE_MASS + CALIBRATE_MASSES, 0, "go", "",
        "the person's word: step + 1, new while it waits"},
};

/* Instances: the list of masses. */
static const struct exh_signal mass_rows[] = {
    {0x8220, EXH_Q_FORCE, EXH_WHEN_SETUP, 0, EXH_Q(5, 1, EXH_Q_FORCE), 0, "mass", "kg",
        "a known mass, rising from one to the next; 0 ends the list"},
};

static const struct exh_signal signal_rows[] = {
    {0x8301, EXH_Q_POS, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "q", "m", "position"},
    {0x8302, EXH_Q_CUR, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "i_des", "a", "current coded"},
    {0x8303, EXH_Q_CUR, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "i_mon", "a",
        "current monitored"},
    {0x8304, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "step", "",
        "0 zero, 1 polarity, 2 home, 3 f0, 4... masses"},
    {0x8305, 0, EXH_WHEN_OUTPUT, 0, 1, 0, "waits", "", "for the person"},
    {0x8306, 0, EXH_WHEN_OUTPUT, 0, CALIBRATE_RESULTS, 0, "result", "", "why it ended, 1 done"},
    {0x8307, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "limits", "", "limits acting, bits"},
    {0x8308, 0, EXH_WHEN_OUTPUT, 0, 5, 0, "state", "",
        "0 off, 1 arm, 2 run, 3 limit, 4 release, 5 fault"},
    {0x8309, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "faults", "", "fault causes latched, bits"},
    {0x830A, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "present", "", "fault causes now, bits"},
};

#define COUNT(r) (sizeof(r) / sizeof((r)[0]))

static const struct exh_signal_group param_groups[] = {
    {exh_quad_rows, EXH_QUAD_ROWS, 1},
    {exh_drive_rows, EXH_DRIVE_ROWS, 1},
    {exh_tracking_rows, EXH_TRACKING_ROWS, 1},
    {exh_safety_rows, EXH_SAFETY_ROWS, 1},
    {own_rows, COUNT(own_rows), 1},
    {mass_rows, 1, CALIBRATE_MASSES},
};
static const struct exh_signal_table param_table = {param_groups, 6};
static const struct exh_signal_group signal_groups[] = {{signal_rows, COUNT(signal_rows), 1}};
static const struct exh_signal_table signal_table = {signal_groups, 1};

EXH_STATIC_ASSERT(calibrate_par_matches_rows,
    sizeof(struct calibrate_par) / sizeof(int32_t) == EXH_QUAD_ROWS + EXH_DRIVE_ROWS +
                                                          EXH_TRACKING_ROWS + EXH_SAFETY_ROWS +
                                                          COUNT(own_rows) + CALIBRATE_MASSES);
EXH_STATIC_ASSERT(calibrate_signals_match_rows,
    sizeof(struct calibrate_signals) / sizeof(int32_t) == COUNT(signal_rows));

/* --- set-up --- */

/* Parameters in ROM have passed no row check: tests each range, and that no step exceeds i_max. */
static int own_ok(const struct calibrate_own_par *own)
{
    if (!exh_rows_validate(own_rows, COUNT(own_rows), own)) { return 0; }
    return own->pol_max_A_q26 <= own->i_max_A_q26 && own->home_A_q26 <= own->i_max_A_q26 &&
           own->slack_A_q26 <= own->i_max_A_q26;
}

/* The motions, all limited by the same few parameters. */
static int setup_motions(
    struct calibrate_cfg *cfg, const struct calibrate_own_par *own, struct exh_probe_scale scale)
{
    const struct exh_probe_par mass = {own->step_A_q26, own->i_max_A_q26, own->dwell_ms,
        own->time_ms, own->move_m_q30, own->travel_m_q30};
    const struct exh_home_par home = {own->home_A_q26, own->dwell_ms, own->time_ms, own->move_m_q30,
        own->home_min_m_q30, own->home_max_m_q30};
    struct exh_probe_par polarity = mass, f0 = mass;
    int err;
    polarity.end_A_q26 = f0.end_A_q26 = own->pol_max_A_q26;
    f0.move_m_q30 = exh_clamp(
        (int64_t)exh_udiv64(
            (uint64_t)(uint32_t)own->f0_speed_mps_q27 * (uint32_t)own->dwell_ms, 125, NULL),
        1, INT32_MAX); /* v q27 * ms / 1000, in q30 */
    if (exh_probe_ticks(own->dwell_ms, scale.T) < 2) { return -EXH_E_RATE; }
    cfg->zero_ticks = exh_probe_ticks(own->hold_ms, scale.T);
    cfg->wait_ticks = exh_probe_ticks(own->wait_ms, scale.T);
    err = exh_probe_setup(&cfg->polarity, &polarity, scale);
    if (err == 0) { err = exh_probe_setup(&cfg->f0, &f0, scale); }
    return err == 0 ? exh_home_setup(&cfg->home, &home, scale) : err;
}

/* F = m g, N q20, error <= 1/2 LSB; both are q20. */
static int64_t force_of(const struct calibrate_par *par, unsigned i)
{
    return exh_mul_shr(par->mass_kg_q20[i], par->own.gravity_mps2_q20, EXH_Q_FORCE);
}

/* Limits the current to the mass: a mass that does not lift is held fast, and a lighter one is
 * detected sooner. Refuses a mass that the slack current alone might lift. */
static int setup_mass(struct exh_weigh_cfg *cfg, const struct calibrate_par *par, unsigned i,
    struct exh_probe_scale scale)
{
    const struct calibrate_own_par *own = &par->own;
    const uint64_t most_A_q26 =
        exh_udiv64((uint64_t)force_of(par, i) << EXH_Q_CUR, (uint32_t)own->kf_min_NpA_q20, NULL);
    const int32_t end_A_q26 =
        most_A_q26 < (uint32_t)own->i_max_A_q26 ? (int32_t)most_A_q26 : own->i_max_A_q26;
    const struct exh_probe_par probe = {own->step_A_q26, end_A_q26, own->dwell_ms, own->time_ms,
        own->move_m_q30, own->travel_m_q30};
    const struct exh_weigh_par weigh = {probe, own->slack_A_q26, own->hold_ms};
    return exh_weigh_setup(cfg, &weigh, scale);
}

static int setup_masses(
    struct calibrate_cfg *cfg, const struct calibrate_par *par, struct exh_probe_scale scale)
{
    int err = 0;
    cfg->masses = 0;
    for (unsigned i = 0; err == 0 && i < CALIBRATE_MASSES && par->mass_kg_q20[i] > 0; i++) {
        if (i > 0 && par->mass_kg_q20[i] <= par->mass_kg_q20[i - 1]) { return -EXH_E_MONOTONE; }
        err = setup_mass(&cfg->weigh[i], par, i, scale);
        cfg->masses++;
    }
    return err == 0 && cfg->masses == 0 ? -EXH_E_RANGE : err;
}

int calibrate_setup(
    struct calibrate_cfg *cfg, const struct calibrate_par *par, struct exh_scene_board board)
{
    const struct exh_probe_scale scale = {par->quad.step_m_q42, board.T};
    const struct exh_table to_cur = {cfg->one_to_one, 2}, none = {NULL, 0};
    const int32_t end_A_q26 = par->own.i_max_A_q26;
    const struct exh_axis_setup parts = {.quad = &cfg->quad,
        .quad_par = &par->quad,
        .track = &cfg->track,
        .track_par = &par->track,
        .drive = &cfg->drive,
        .drive_par = &par->drive};
    int err;
    if (!own_ok(&par->own)) { return -EXH_E_RANGE; }
    cfg->par = par;
    cfg->one_to_one[0] = (struct exh_knot){0, 0, {0, 0}};
    cfg->one_to_one[1] =
        (struct exh_knot){end_A_q26 >> (EXH_Q_CUR - EXH_Q_FORCE), end_A_q26, {0, 0}};
    err = exh_table_setup(cfg->one_to_one, 2);
    if (err == 0) { err = exh_axis_setup(&parts, board.T, board.enc_bits, to_cur, none); }
    if (err == 0) { err = exh_safety_setup(&cfg->safety, &par->safety, board.T); }
    if (err == 0) { err = setup_motions(cfg, &par->own, scale); }
    return err == 0 ? setup_masses(cfg, par, scale) : err;
}

/* --- steps --- */

/* Inputs of a step in a tick. */
struct view {
    int32_t cnt, mon_A_q26;
    int16_t mon_raw;
};

/* One tick of a step; returns its result. *cur_A_q26 receives the requested current. */
typedef uint8_t step_fn(
    struct calibrate *s, const struct calibrate_cfg *cfg, struct view v, int32_t *cur_A_q26);

static uint8_t zero(
    struct calibrate *s, const struct calibrate_cfg *cfg, struct view v, int32_t *cur_A_q26)
{
    const int64_t moved = exh_wrap_diff(v.cnt, s->start_cnt);
    const int32_t move = cfg->polarity.move_cnt;
    *cur_A_q26 = 0;
    exh_mean_add(&s->zero_raw, v.mon_raw);
    if (moved >= move || -moved >= move) { return EXH_PROBE_TRAVEL; }
    return s->zero_raw.n >= cfg->zero_ticks ? EXH_PROBE_DONE : EXH_PROBE_BUSY;
}

static uint8_t polarity(
    struct calibrate *s, const struct calibrate_cfg *cfg, struct view v, int32_t *cur_A_q26)
{
    if (s->tick == 0) { exh_probe_start(&s->polarity, v.cnt, 0); }
    (void)exh_probe_step(&s->polarity, &cfg->polarity, v.cnt);
    *cur_A_q26 = s->polarity.cur_A_q26;
    return s->polarity.result;
}

static uint8_t home(
    struct calibrate *s, const struct calibrate_cfg *cfg, struct view v, int32_t *cur_A_q26)
{
    if (s->tick == 0) { exh_home_start(&s->home, v.cnt); }
    (void)exh_home_step(&s->home, &cfg->home, v.cnt);
    *cur_A_q26 = s->home.cur_A_q26;
    return s->home.result;
}

static uint8_t f0(
    struct calibrate *s, const struct calibrate_cfg *cfg, struct view v, int32_t *cur_A_q26)
{
    if (s->tick == 0) { exh_probe_start(&s->f0, v.cnt, 0); }
    (void)exh_probe_step(&s->f0, &cfg->f0, v.cnt);
    *cur_A_q26 = s->f0.cur_A_q26;
    return s->f0.result;
}

static uint8_t mass(
    struct calibrate *s, const struct calibrate_cfg *cfg, struct view v, int32_t *cur_A_q26)
{
    const unsigned i = s->step - CALIBRATE_MASS;
    struct exh_weigh *w = &s->weigh[i];
    if (s->tick == 0) { exh_weigh_start(w, &cfg->weigh[i], v.cnt); }
    (void)exh_weigh_step(w, &cfg->weigh[i], v.cnt, s->coded_A_q26, v.mon_A_q26);
    *cur_A_q26 = w->cur_A_q26;
    return w->result;
}

static const struct {
    const char *text;
    step_fn *step;
    enum calibrate_ask ask;
} steps[] = {
    {"zero", zero, CALIBRATE_ASK_SLACK},
    {"polarity", polarity, CALIBRATE_ASK_SLACK},
    {"home", home, CALIBRATE_ASK_SLACK},
    {"f0", f0, CALIBRATE_ASK_SLACK},
    {"mass", mass, CALIBRATE_ASK_MASS},
};

static unsigned kind(unsigned step) { return step < CALIBRATE_MASS ? step : CALIBRATE_MASS; }

enum calibrate_ask calibrate_ask(unsigned step) { return steps[kind(step)].ask; }

const char *calibrate_step_text(unsigned step) { return steps[kind(step)].text; }

const char *calibrate_result_text(unsigned result)
{
    static const char *const text[CALIBRATE_RESULTS - EXH_PROBE_RESULTS] = {
        "the box left RUN",
        "a limit of the drive acts",
        "nobody prepared the step",
    };
    return result >= EXH_PROBE_RESULTS && result < CALIBRATE_RESULTS
               ? text[result - EXH_PROBE_RESULTS]
               : exh_probe_result_text(result);
}

/* From here on only a new confirmation of the person counts. */
static void begin_wait(struct calibrate *s, const struct calibrate_cfg *cfg)
{
    s->busy = s->word = 0;
    s->tick = 0;
    s->go = cfg->par->own.go;
}

/* Zero current until the person confirms; the step starts in the next tick. */
static void wait(struct calibrate *s, const struct calibrate_cfg *cfg, int32_t cnt, int run)
{
    const int32_t go = cfg->par->own.go;
    if (go != s->go) { s->word = go == s->step + 1; }
    s->go = go;
    if (!run && s->ran) {
        s->result = CALIBRATE_OFF;
    } else if (run && s->word) {
        s->busy = 1;
        s->tick = 0;
        s->start_cnt = cnt;
    } else if (++s->tick >= cfg->wait_ticks) {
        s->result = CALIBRATE_NOBODY;
    }
}

/* The current for this tick. */
static int32_t go_on(struct calibrate *s, const struct calibrate_cfg *cfg, struct view v, int run)
{
    int32_t cur_A_q26 = 0;
    uint8_t r;
    if (s->result != EXH_PROBE_BUSY) { return 0; }
    if (!s->busy) {
        wait(s, cfg, v.cnt, run);
        s->ran |= (uint8_t)run;
        return 0;
    }
    r = run ? steps[kind(s->step)].step(s, cfg, v, &cur_A_q26) : CALIBRATE_OFF;
    s->tick++;
    if (r == EXH_PROBE_BUSY) { return cur_A_q26; }
    begin_wait(s, cfg);
    if (r != EXH_PROBE_DONE) {
        s->result = r; /* step stays at the failed one */
    } else if (++s->step == CALIBRATE_MASS + cfg->masses) {
        s->result = EXH_PROBE_DONE;
    }
    return 0;
}

void calibrate_start(struct calibrate *s, const struct calibrate_cfg *cfg)
{
    *s = (struct calibrate){0};
    begin_wait(s, cfg);
}

/* The result of this scene proves calibration and polarity. */
#define VOUCHED (EXH_UNTESTED | EXH_UNCALIBRATED | EXH_UNPOLARISED)

void calibrate_tick(struct calibrate *s, const struct calibrate_cfg *cfg,
    const struct exh_scene_in *in, struct exh_drive_out *out, struct calibrate_signals *sig)
{
    const struct exh_axis axis = {.quad = &s->quad,
        .quad_cfg = &cfg->quad,
        .track = &s->track,
        .track_cfg = &cfg->track,
        .drive = &s->drive,
        .drive_cfg = &cfg->drive};
    const struct exh_axis_now now = exh_axis_sense(&axis, &in->drive, 0);
    const struct view v = {now.cnt, now.mon_A_q26, in->drive.mon_raw[0]};
    const struct exh_safety_in box = {in->drive.din, 0, in->missed, in->command, 1, VOUCHED};
    const struct exh_permit permit = exh_axis_permit(&s->safety, &cfg->safety, &now, 1, box);
    const int32_t cur_A_q26 = go_on(s, cfg, v, exh_safety_is_running(&s->safety));
    struct exh_force_ledger f = {0};
    struct exh_current_ledger i;
    uint32_t limits;

    f.pullback_N_q20 = cur_A_q26 >> (EXH_Q_CUR - EXH_Q_FORCE); /* 1 N for 1 A */
    limits = now.limits | exh_axis_force(&axis, &permit, &f, &i);
    exh_axis_out(&axis, &s->safety, now.cnt, &i, &limits, out);
    s->coded_A_q26 = i.coded_A_q26;
    if (s->busy && (limits & ~(uint32_t)EXH_LIMIT_SLEW)) { /* from the next tick: no current */
        s->result = CALIBRATE_LIMITED;
        s->busy = 0;
    }

    sig->q_m_q30 = now.pos_m_q30;
    sig->i_des_A_q26 = i.coded_A_q26;
    sig->i_mon_A_q26 = v.mon_A_q26;
    sig->step = s->step;
    sig->waits = !s->busy && s->result == EXH_PROBE_BUSY;
    sig->result = s->result;
    sig->limits = (int32_t)limits;
    sig->state = s->safety.state;
    sig->faults = exh_from_u32(s->safety.faults);
    sig->present = (int32_t)s->safety.present;
}

/* --- results --- */

void calibrate_points(
    const struct calibrate *s, const struct calibrate_cfg *cfg, struct exh_calib *c)
{
    const struct calibrate_par *par = cfg->par;
    /* Users of the monitor subtract this code, so the points do as well. */
    const int32_t zero_raw = exh_mean_value(&s->zero_raw);
    const int32_t zero_A_q26 = exh_drive_monitor_A_q26(&cfg->drive, (int16_t)zero_raw);

    c->dac_rawpA_q16 = par->drive.dac_rawpA_q16;
    c->dac_zero_raw = par->drive.dac_zero_raw;
    c->mon_A_q40 = par->drive.mon_A_q40;
    c->mon_zero_raw = zero_raw;
    c->f0_A_q26 = s->f0.result == EXH_PROBE_DONE ? s->f0.cur_A_q26 : 0;
    c->end_A_q26 = par->own.end_A_q26;
    c->points = 0;
    for (unsigned i = 0; i < cfg->masses && i < c->cap; i++) {
        if (s->weigh[i].result != EXH_PROBE_DONE) { break; }
        c->point[i] = exh_weigh_point(&s->weigh[i], exh_sat32(force_of(par, i)));
        c->point[i].mon_A_q26 = exh_sat32((int64_t)c->point[i].mon_A_q26 - zero_A_q26);
        c->points++;
    }
}

/* --- the one instance of this image --- */

static struct calibrate_par active, staged;
static struct exh_params params;
static struct calibrate_signals signals;
static struct calibrate_cfg cfg;
static struct calibrate state;

static void defaults(void)
{
    exh_params_setup(&params, &param_table, (int32_t *)&active, (int32_t *)&staged);
    /* The monitor's zero is unknown, so its offset must not count as current. */
    active.track.tol_A_q26 = staged.track.tol_A_q26 = EXH_Q(1, 2, EXH_Q_CUR);
}

static int setup(struct exh_scene_board board)
{
    const int err = calibrate_setup(&cfg, &active, board);
    if (err == 0) { calibrate_start(&state, &cfg); }
    return err;
}

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    calibrate_tick(&state, &cfg, in, out, &signals);
}

const struct calibrate *calibrate_state(void) { return &state; }

const struct calibrate_cfg *calibrate_config(void) { return &cfg; }

/* Not replayable: its state is not saved. */
const struct exh_scene exh_scene_calibrate = {
    .name = "calibrate",
    .rate_Hz = 2000,
    .fingers = 1,
    .params = &params,
    .apply = exh_params_apply,
    .safety = &state.safety,
    .signals = &signal_table,
    .values = (int32_t *)&signals,
    .defaults = defaults,
    .setup = setup,
    .tick = tick,
};
