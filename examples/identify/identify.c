/* SPDX-License-Identifier: MIT */
#include "identify.h"

#define ROW_A(id, name, min_mA, max_mA, dflt_mA, help) \
    { \
        (id), EXH_Q_CUR, EXH_WHEN_SETUP, EXH_Q(min_mA, 1000, EXH_Q_CUR), \
            EXH_Q(max_mA, 1000, EXH_Q_CUR), EXH_Q(dflt_mA, 1000, EXH_Q_CUR), (name), "a", (help) \
    }
#define ROW_M(id, name, dflt_mm, help) \
    { \
        (id), EXH_Q_POS, EXH_WHEN_SETUP, EXH_Q(50, 1000, EXH_Q_POS), EXH_Q(500, 1000, EXH_Q_POS), \
            EXH_Q(dflt_mm, 1000, EXH_Q_POS), (name), "m", (help) \
    }

static const struct exh_signal own_rows[] = {
    {0x8901, EXH_Q_FORCE, EXH_WHEN_SETUP, EXH_Q(1, 100, EXH_Q_FORCE), EXH_Q(5, 1, EXH_Q_FORCE),
        EXH_Q(5, 10, EXH_Q_FORCE), "mass", "kg", "the known mass"},
    ROW_A(0x8902, "i_max", 100, 3300, 3300, "no part goes beyond this current"),
    ROW_A(0x8903, "ramp", 10, 10000, 1000, "slow pulls rise and fall by this a second"),
    ROW_A(0x8904, "pulse", 1, 1000, 100, "the first pulse is so much above what moves the rotor"),
    {0x8905, EXH_Q_VEL, EXH_WHEN_SETUP, EXH_Q(1, 10, EXH_Q_VEL), EXH_Q(5, 1, EXH_Q_VEL),
        EXH_Q(2, 1, EXH_Q_VEL), "v_max", "m_per_s", "faster than this ends it"},
    ROW_M(0x8906, "slack", 90, "pulses end when so much of the slack string is in"),
    ROW_M(0x8907, "travel", 130, "no part may move farther from where the stage began"),
    {0x8908, 0, EXH_WHEN_SETUP, 1, 100, 14, "repeats", "", "rounds of pulses, and of the mass"},
    {0x8909, 0, EXH_WHEN_SETUP, 1, 1000000, 600000, "wait_time", "ms",
        "no wait for a person takes longer"},
    {0x890A, 0, EXH_WHEN_WORD, 0, IDENTIFY_STAGES, 0, "go", "",
        "the person's word: stage + 1, new while it waits"},
};

static const struct exh_signal signal_rows[] = {
    {0x8A01, EXH_Q_POS, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "q", "m", "position"},
    {0x8A02, EXH_Q_CUR, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "i_des", "a", "current coded"},
    {0x8A03, EXH_Q_CUR, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "i_mon", "a",
        "current monitored"},
    {0x8A04, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "part", "", "of the run"},
    {0x8A05, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "repeat", "", "round, from 0"},
    {0x8A06, 0, EXH_WHEN_OUTPUT, 0, 1, 0, "waits", "", "for the person"},
    {0x8A07, 0, EXH_WHEN_OUTPUT, 0, IDENTIFY_RESULTS, 0, "result", "", "why it ended, 1 done"},
    {0x8A08, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "limits", "", "limits acting, bits"},
    {0x8A09, 0, EXH_WHEN_OUTPUT, 0, 5, 0, "state", "",
        "0 off, 1 arm, 2 run, 3 limit, 4 release, 5 fault"},
    {0x8A0A, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "faults", "", "fault causes latched, bits"},
    {0x8A0B, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "present", "", "fault causes now, bits"},
};

#define COUNT(r) (sizeof(r) / sizeof((r)[0]))

static const struct exh_signal_group param_groups[] = {
    {exh_quad_rows, EXH_QUAD_ROWS, 1},
    {exh_drive_rows, EXH_DRIVE_ROWS, 1},
    {exh_tracking_rows, EXH_TRACKING_ROWS, 1},
    {exh_safety_rows, EXH_SAFETY_ROWS, 1},
    {own_rows, COUNT(own_rows), 1},
};
static const struct exh_signal_table param_table = {param_groups, 5};
static const struct exh_signal_group signal_groups[] = {{signal_rows, COUNT(signal_rows), 1}};
static const struct exh_signal_table signal_table = {signal_groups, 1};

EXH_STATIC_ASSERT(identify_par_matches_rows,
    sizeof(struct identify_par) / sizeof(int32_t) ==
        EXH_QUAD_ROWS + EXH_DRIVE_ROWS + EXH_TRACKING_ROWS + EXH_SAFETY_ROWS + COUNT(own_rows));
EXH_STATIC_ASSERT(identify_signals_match_rows,
    sizeof(struct identify_signals) / sizeof(int32_t) == COUNT(signal_rows));

const char *identify_result_text(unsigned result)
{
    static const char *const text[IDENTIFY_RESULTS - EXH_PROBE_RESULTS] = {
        "the box left RUN",
        "a limit of the drive acts",
        "nobody prepared the stage",
        "too fast",
        "nothing hangs on the string",
    };
    return result >= EXH_PROBE_RESULTS && result < IDENTIFY_RESULTS
               ? text[result - EXH_PROBE_RESULTS]
               : exh_probe_result_text(result);
}

/* --- set-up --- */

#define FAST_MS 10

/* At least two counts, since one may be noise. */
static int32_t counts_of(int64_t m_q30, int32_t step_m_q42)
{
    const uint64_t n =
        exh_udiv64((uint64_t)m_q30 << (EXH_Q_STEP - EXH_Q_POS), (uint32_t)step_m_q42, 0);
    return n < 2 ? 2 : n > 1u << 30 ? 1 << 30 : (int32_t)n;
}

static void setup_parts(
    struct identify_cfg *cfg, const struct identify_par *par, struct exh_period T)
{
    static const uint8_t far_mm[IDENTIFY_FARS] = {1, 2, 6, 12, 15, 30, 38, 50};
    const struct identify_own_par *own = &par->own;
    const int32_t step = par->quad.step_m_q42;
    for (unsigned i = 0; i < IDENTIFY_FARS; i++) {
        cfg->far_cnt[i] = counts_of((int64_t)far_mm[i] * EXH_Q(1, 1000, EXH_Q_POS), step);
    }
    cfg->T = T;
    cfg->slack_cnt = counts_of(own->slack_m_q30, step);
    cfg->travel_cnt = counts_of(own->travel_m_q30, step);
    cfg->fast_ticks = exh_probe_ticks(FAST_MS, T);
    /* v q27 for fast_ticks T, in q30 */
    cfg->fast_cnt = counts_of(
        (int64_t)exh_udiv64(
            (uint64_t)(uint32_t)own->v_max_mps_q27 * 8 * cfg->fast_ticks * T.num, T.den, 0),
        step);
    cfg->ramp_A_q26 =
        exh_clamp((int64_t)exh_udiv64((uint64_t)(uint32_t)own->ramp_A_q26 * T.num, T.den, 0), 1,
            EXH_Q(1, 10, EXH_Q_CUR));
    cfg->half_per_s_q31 = (int32_t)exh_udiv64((uint64_t)T.num << 30, T.den, 0) | 1;
    cfg->still_ticks = exh_probe_ticks(60, T);
    cfg->short_ticks = exh_probe_ticks(20, T);
    cfg->long_ticks = exh_probe_ticks(35, T);
    cfg->half_ticks = exh_probe_ticks(100, T);
    cfg->wait_ticks = exh_probe_ticks(own->wait_ms, T);
}

int identify_setup(
    struct identify_cfg *cfg, const struct identify_par *par, struct exh_scene_board board)
{
    const struct exh_table to_cur = {cfg->one_to_one, 2}, none = {0, 0};
    const int32_t end_A_q26 = par->own.i_max_A_q26;
    const struct exh_axis_setup parts = {.quad = &cfg->quad,
        .quad_par = &par->quad,
        .track = &cfg->track,
        .track_par = &par->track,
        .drive = &cfg->drive,
        .drive_par = &par->drive};
    int err;
    if (!exh_rows_validate(own_rows, COUNT(own_rows), &par->own)) { return -EXH_E_RANGE; }
    cfg->par = par;
    cfg->one_to_one[0] = (struct exh_knot){0, 0, {0, 0}};
    cfg->one_to_one[1] =
        (struct exh_knot){end_A_q26 >> (EXH_Q_CUR - EXH_Q_FORCE), end_A_q26, {0, 0}};
    err = exh_table_setup(cfg->one_to_one, 2);
    if (err == 0) { err = exh_axis_setup(&parts, board.T, board.enc_bits, to_cur, none); }
    if (err == 0) { err = exh_safety_setup(&cfg->safety, &par->safety, board.T); }
    if (err == 0) { setup_parts(cfg, par, board.T); }
    return err;
}

/* --- a tick --- */

/* From here on only a new confirmation of the person counts. */
static void begin_wait(struct identify *s, const struct identify_cfg *cfg)
{
    s->busy = s->word = 0;
    s->wait = 0;
    s->go = cfg->par->own.go;
}

void identify_start(struct identify *s, const struct identify_cfg *cfg)
{
    *s = (struct identify){0};
    begin_wait(s, cfg);
}

/* Zero current until the person confirms; the stage starts in the next tick. */
static void wait(struct identify *s, const struct identify_cfg *cfg, int32_t cnt, int run)
{
    const int32_t go = cfg->par->own.go;
    if (go != s->go) { s->word = go == s->run.stage + 1; }
    s->go = go;
    if (!run && s->ran) {
        s->result = IDENTIFY_OFF;
    } else if (run && s->word) {
        s->busy = 1;
        identify_begin(&s->run, cfg, cnt);
    } else if (++s->wait >= cfg->wait_ticks) {
        s->result = IDENTIFY_NOBODY;
    }
    s->ran |= (uint8_t)run;
}

/* The current for this tick. */
static int32_t go_on(struct identify *s, const struct identify_cfg *cfg, int32_t cnt, int run)
{
    uint8_t r;
    if (s->result != EXH_PROBE_BUSY) { return 0; }
    if (!s->busy) {
        wait(s, cfg, cnt, run);
        return 0;
    }
    r = run ? identify_step(&s->run, cfg, cnt) : (uint8_t)IDENTIFY_OFF;
    if (r == EXH_PROBE_BUSY) { return s->run.cur_A_q26; }
    begin_wait(s, cfg);
    if (r != EXH_PROBE_DONE) {
        s->result = r; /* stage and part stay at the failed ones */
    } else if (++s->run.stage == IDENTIFY_STAGES) {
        s->result = EXH_PROBE_DONE;
    }
    return 0;
}

static void signals(const struct identify *s, const struct exh_axis_now *now, uint32_t limits,
    int32_t coded_A_q26, struct identify_signals *sig)
{
    sig->q_m_q30 = now->pos_m_q30;
    sig->i_des_A_q26 = coded_A_q26;
    sig->i_mon_A_q26 = now->mon_A_q26;
    sig->part = s->run.part;
    sig->repeat = s->run.repeat;
    sig->waits = !s->busy && s->result == EXH_PROBE_BUSY;
    sig->result = s->result;
    sig->limits = (int32_t)limits;
    sig->state = s->safety.state;
    sig->faults = exh_from_u32(s->safety.faults);
    sig->present = (int32_t)s->safety.present;
}

/* The result of this scene gives polarity and calibration. */
#define VOUCHED (EXH_UNTESTED | EXH_UNCALIBRATED | EXH_UNPOLARISED)

void identify_tick(struct identify *s, const struct identify_cfg *cfg,
    const struct exh_scene_in *in, struct exh_drive_out *out, struct identify_signals *sig)
{
    const struct exh_axis axis = {.quad = &s->quad,
        .quad_cfg = &cfg->quad,
        .track = &s->track,
        .track_cfg = &cfg->track,
        .drive = &s->drive,
        .drive_cfg = &cfg->drive};
    const struct exh_axis_now now = exh_axis_sense(&axis, &in->drive, 0);
    const struct exh_safety_in box = {in->drive.din, 0, in->missed, in->command, 1, VOUCHED};
    const struct exh_permit permit = exh_axis_permit(&s->safety, &cfg->safety, &now, 1, box);
    const int32_t cur_A_q26 = go_on(s, cfg, now.cnt, exh_safety_is_running(&s->safety));
    struct exh_force_ledger f = {0};
    struct exh_current_ledger i;
    uint32_t limits;

    f.pullback_N_q20 = cur_A_q26 >> (EXH_Q_CUR - EXH_Q_FORCE); /* 1 N for 1 A */
    limits = now.limits | exh_axis_force(&axis, &permit, &f, &i);
    exh_axis_out(&axis, &s->safety, now.cnt, &i, &limits, out);
    if (s->busy && (limits & ~(uint32_t)EXH_LIMIT_SLEW)) { /* from the next tick: no current */
        s->result = IDENTIFY_LIMITED;
        s->busy = 0;
    }
    signals(s, &now, limits, i.coded_A_q26, sig);
}

/* --- the one instance of this image --- */

static struct identify_par active, staged;
static struct exh_params params;
static struct identify_signals signal;
static struct identify_cfg cfg;
static struct identify state;

static void defaults(void)
{
    exh_params_setup(&params, &param_table, (int32_t *)&active, (int32_t *)&staged);
    /* The monitor's zero is unknown, so its offset must not count as current. */
    active.track.tol_A_q26 = staged.track.tol_A_q26 = EXH_Q(1, 2, EXH_Q_CUR);
}

static int setup(struct exh_scene_board board)
{
    const int err = identify_setup(&cfg, &active, board);
    if (err == 0) { identify_start(&state, &cfg); }
    return err;
}

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    identify_tick(&state, &cfg, in, out, &signal);
}

static void run_bytes(struct exh_bytes *c, struct identify_run *r)
{
    int32_t *const i32[] = {&r->cur_A_q26, &r->free_A_q26, &r->up_A_q26, &r->down_A_q26,
        &r->pulse_A_q26, &r->start_cnt, &r->part_cnt, &r->low_cnt, &r->high_cnt, &r->seen_cnt,
        &r->fast_cnt};
    uint32_t *const u32[] = {
        &r->tick, &r->still, &r->fast, &r->half, &r->flip, &r->long_ticks, &r->chance};
    uint8_t *const u8[] = {&r->part, &r->stage, &r->repeat, &r->sign};
    for (unsigned i = 0; i < COUNT(i32); i++) { exh_bytes_i32(c, i32[i]); }
    for (unsigned i = 0; i < COUNT(u32); i++) { exh_bytes_u32(c, u32[i]); }
    for (unsigned i = 0; i < COUNT(u8); i++) { exh_bytes_u8(c, u8[i]); }
    if (identify_part_text(r->part) == 0 || r->stage > IDENTIFY_STAGES) { exh_bytes_fail(c); }
}

static void state_bytes(struct exh_bytes *c)
{
    exh_quad_serialize(c, &state.quad);
    exh_drive_serialize(c, &state.drive);
    exh_tracking_serialize(c, &state.track);
    exh_safety_serialize(c, &state.safety);
    run_bytes(c, &state.run);
    exh_bytes_i32(c, &state.go);
    exh_bytes_u32(c, &state.wait);
    exh_bytes_u8(c, &state.busy);
    exh_bytes_u8(c, &state.word);
    exh_bytes_u8(c, &state.ran);
    exh_bytes_u8(c, &state.result);
}

const struct identify *identify_state(void) { return &state; }

const struct identify_cfg *identify_config(void) { return &cfg; }

const struct exh_scene exh_scene_identify = {
    .name = "identify",
    .rate_Hz = 2000,
    .fingers = 1,
    .params = &params,
    .apply = exh_params_apply,
    .safety = &state.safety,
    .signals = &signal_table,
    .values = (int32_t *)&signal,
    .defaults = defaults,
    .setup = setup,
    .tick = tick,
    .state = state_bytes,
};
