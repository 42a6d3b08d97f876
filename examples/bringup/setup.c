/* SPDX-License-Identifier: MIT */
/* Parameters, set-up, and the one instance of this image. */
#include "bringup.h"

#include "exhand/board.h"

#define GRAVITY_MPS2_Q20 EXH_Q(981, 100, EXH_Q_FORCE)
#define MASS_MIN_KG_Q20  EXH_Q(5, 100, EXH_Q_FORCE)

#define COUNT(r) (sizeof(r) / sizeof((r)[0]))

#define ROW(id, frac, min, max, dflt, name, unit, help) \
    { \
        (id), (frac), EXH_WHEN_SETUP, (min), (max), (dflt), (name), (unit), (help) \
    }
#define ROW_A(id, name, min_mA, max_mA, dflt_mA, help) \
    ROW(id, EXH_Q_CUR, EXH_Q(min_mA, 1000, EXH_Q_CUR), EXH_Q(max_mA, 1000, EXH_Q_CUR), \
        EXH_Q(dflt_mA, 1000, EXH_Q_CUR), name, "a", help)
#define ROW_N(id, name, min_mN, max_mN, dflt_mN, help) \
    ROW(id, EXH_Q_FORCE, EXH_Q(min_mN, 1000, EXH_Q_FORCE), EXH_Q(max_mN, 1000, EXH_Q_FORCE), \
        EXH_Q(dflt_mN, 1000, EXH_Q_FORCE), name, "n", help)
#define ROW_M(id, name, max_mm, dflt_um, help) \
    ROW(id, EXH_Q_POS, EXH_Q(1, 10000, EXH_Q_POS), EXH_Q(max_mm, 1000, EXH_Q_POS), \
        EXH_Q(dflt_um, 1000000, EXH_Q_POS), name, "m", help)
#define ROW_V(id, name, max_mmps, dflt_mmps, help) \
    ROW(id, EXH_Q_VEL, EXH_Q(20, 1000, EXH_Q_VEL), EXH_Q(max_mmps, 1000, EXH_Q_VEL), \
        EXH_Q(dflt_mmps, 1000, EXH_Q_VEL), name, "m_per_s", help)
#define ROW_MS(id, name, min_ms, max_ms, dflt_ms, help) \
    ROW(id, 0, min_ms, max_ms, dflt_ms, name, "ms", help)

static const struct exh_signal own_rows[] = {
    ROW(0x8701, 0, 1, BRINGUP_STAGES, 1, "stage", "",
        "1 no motors, 2 dummy load, 3 motor, 4 string, 5 finger"),
    ROW(0x8702, 0, 0, BRINGUP_FINGERS - 1, 0, "finger", "", "thumb 0 .. little 4"),
    ROW(0x8703, 0, 0, INT32_MAX, 0, "shown", "", "the number that the stage before printed"),
    ROW(0x8704, 0, 0, 1, 1, "loop", "", "stage 1: 1 the D/A is wired to the monitor's input"),
    {0x8705, EXH_Q_FORCE, EXH_WHEN_PERSON, EXH_Q(1, 1, EXH_Q_FORCE), EXH_Q(50, 1, EXH_Q_FORCE),
        EXH_Q(3339, 1000, EXH_Q_FORCE), "kf", "n_per_a", "string force per motor current"},
    ROW_A(0x8706, "da_max", 100, 540, 528,
        "stage 1: highest code, as a current; a drive that is off may be given 1000"),
    ROW_A(0x8707, "load_max", 100, 1000, 300, "stage 2: highest current"),
    ROW_A(0x8708, "run_max", 100, 500, 200, "stage 3: highest current"),
    ROW_N(0x8709, "f_string", 500, 10000, 1500, "stage 4: highest force"),
    ROW_N(0x870A, "f_finger", 500, 2000, 1000, "stage 5: highest force"),
    ROW_A(0x870B, "i_step", 1, 50, 5, "polarity: currents rise by this"),
    ROW_A(0x870C, "pol_max", 10, 500, 150, "polarity: no further than this"),
    ROW_A(0x870D, "home_cur", 10, 500, 100, "homing pulls with this"),
    ROW(0x870E, 0, 1, 1000, 5, "ramp", "", "fastest rise, a_per_s in stages 1 to 3, n_per_s above"),
    ROW_A(0x870F, "zero_tol", 1, 200, 20, "monitor at no current: not farther from 0"),
    ROW_A(
        0x8710, "mon_tol", 1, 200, 20, "monitor off the current commanded: not by more than this"),
    ROW(0x8711, 0, 0, 30, 10, "mon_percent", "percent", "and this share of it"),
    ROW(0x8712, 0, 1, 50, 25, "read_percent", "percent", "the balance off the force: not by more"),
    ROW_V(0x8713, "v_max", 1000, 250, "faster than this for three ticks ends it"),
    ROW_V(0x8714, "v_trip", 500, 100, "stage 3: lets go at this speed"),
    ROW_M(0x8715, "turn", 200, 20000, "stage 1: the encoder is turned so far, and back"),
    ROW_M(0x8716, "move", 5, 300, "this far within a dwell is movement"),
    ROW_M(0x8717, "travel", 100, 30000, "travel limit of each phase but home"),
    ROW_M(0x8718, "home_min", 500, 50000, "an end nearer than this is a jam"),
    ROW_M(0x8719, "home_max", 500, 300000, "travel limit of homing"),
    ROW_MS(0x871A, "hold", 100, 60000, 3000, "a level is held for this, means are taken over it"),
    ROW_MS(0x871B, "doubt", 5, 500, 50, "the monitor is compared over this"),
    ROW_MS(
        0x871C, "dwell", 10, 1000, 100, "time at each current of polarity; movement is per dwell"),
    ROW_MS(0x871D, "stop_time", 20, 1000, 200, "stage 3: at rest so long after letting go"),
    ROW_MS(0x871E, "step_time", 100, 60000, 20000, "no motion takes longer"),
    ROW_MS(0x871F, "wait_time", 1000, 600000, 120000, "no wait for the person takes longer"),
    ROW(0x8723, EXH_Q_FORCE, 0, EXH_Q(1, 1, EXH_Q_FORCE), 0, "mass", "kg",
        "stage 4: weighs this mass, 0.05 at least, instead of the balance; 0: does not"),
    ROW_N(0x8720, "read1", 0, 20000, 0, "what the balance read at the first force; 0: not yet"),
    ROW_N(0x8721, "read2", 0, 20000, 0, "at the second"),
    ROW_N(0x8722, "read3", 0, 20000, 0, "at the third"),
};

static const struct exh_signal signal_rows[] = {
    {0x8801, EXH_Q_POS, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "q", "m", "position"},
    {0x8802, EXH_Q_VEL, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "qd", "m_per_s", "velocity"},
    {0x8803, EXH_Q_CUR, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "i_des", "a", "current coded"},
    {0x8804, EXH_Q_CUR, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "i_mon", "a",
        "current monitored"},
    {0x8805, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "phase", "", "of the stage, from 0"},
    {0x8806, 0, EXH_WHEN_OUTPUT, 0, BRINGUP_RESULTS, 0, "result", "", "why it ended, 1 done"},
    {0x8807, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "limits", "", "limits acting, bits"},
    {0x8808, 0, EXH_WHEN_OUTPUT, 0, 5, 0, "state", "",
        "0 off, 1 arm, 2 run, 3 limit, 4 release, 5 fault"},
    {0x8809, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "faults", "", "fault causes latched, bits"},
    {0x880A, 0, EXH_WHEN_OUTPUT, 0, INT32_MAX, 0, "present", "", "fault causes now, bits"},
};

static const struct exh_signal_group param_groups[] = {
    {exh_quad_rows, EXH_QUAD_ROWS, 1},
    {exh_drive_rows, EXH_DRIVE_ROWS, 1},
    {exh_safety_rows, EXH_SAFETY_ROWS, 1},
    {own_rows, COUNT(own_rows), 1},
};
static const struct exh_signal_table param_table = {param_groups, 4};
static const struct exh_signal_group signal_groups[] = {{signal_rows, COUNT(signal_rows), 1}};
static const struct exh_signal_table signal_table = {signal_groups, 1};

EXH_STATIC_ASSERT(
    bringup_own_matches_rows, sizeof(struct bringup_own_par) / sizeof(int32_t) == COUNT(own_rows));
EXH_STATIC_ASSERT(bringup_signals_match_rows,
    sizeof(struct bringup_signals) / sizeof(int32_t) == COUNT(signal_rows));

/* --- set-up --- */

static uint32_t crc_word(uint32_t crc, int32_t v)
{
    uint8_t byte[4];
    struct exh_bytes c = exh_bytes_writer(byte, sizeof byte);
    exh_bytes_i32(&c, &v);
    return exh_crc32(crc, byte, sizeof byte);
}

/* The scene's own limits, each from the first stage that uses it. */
static uint32_t crc_limits(uint32_t crc, int32_t stage, const struct bringup_own_par *own)
{
    const struct {
        int32_t stage, limit;
    } of[] = {
        {1, own->loop},
        {1, own->da_max_A_q26},
        {1, own->zero_A_q26},
        {1, own->mon_A_q26},
        {1, own->mon_percent},
        {2, own->load_max_A_q26},
        {2, own->move_m_q30},
        {3, own->run_max_A_q26},
        {3, own->pol_max_A_q26},
        {3, own->v_max_mps_q27},
        {3, own->travel_m_q30},
        {4, own->kf_NpA_q20},
        {4, own->f_max_N_q20},
        {4, own->home_A_q26},
        {4, own->read_percent},
    };
    for (size_t i = 0; i < COUNT(of); i++) {
        if (stage >= of[i].stage) { crc = crc_word(crc, of[i].limit); }
    }
    return crc;
}

/* The number that a finished stage prints, 1 .. 999999, from all values that it confirms. */
static uint32_t number_of(int32_t stage, const struct bringup_par *par)
{
    const int32_t *const quad = (const int32_t *)(const void *)&par->quad;
    const int32_t *const drive = (const int32_t *)(const void *)&par->drive;
    uint64_t rest;
    uint32_t crc = crc_word(crc_word(0, stage), par->own.finger);
    for (size_t i = 0; i < EXH_QUAD_ROWS; i++) { crc = crc_word(crc, quad[i]); }
    /* Without the last two, the person's limits: a stage confirms nothing about them. */
    for (size_t i = 0; i < EXH_DRIVE_ROWS - 2; i++) { crc = crc_word(crc, drive[i]); }
    crc = crc_limits(crc, stage, &par->own);
    (void)exh_udiv64(crc, 999999, &rest);
    return (uint32_t)rest + 1;
}

/* The limit of the stage, where the table ends, and its levels. */
static int setup_levels(struct bringup_cfg *cfg)
{
    const struct bringup_own_par *own = &cfg->par->own;
    const int32_t f_N_q20 = own->stage == 4 ? own->f_max_N_q20 : own->f_finger_N_q20;
    const int32_t cap_A_q26[3] = {own->da_max_A_q26, own->load_max_A_q26, own->run_max_A_q26};
    int32_t top_A_q26, top_N_q20;
    if (own->stage < 4) {
        cfg->kf_NpA_q20 = INT32_C(1) << EXH_Q_FORCE;
        top_A_q26 = cap_A_q26[own->stage - 1];
        top_N_q20 = top_A_q26 >> (EXH_Q_CUR - EXH_Q_FORCE);
    } else {
        cfg->kf_NpA_q20 = own->kf_NpA_q20;
        top_N_q20 = f_N_q20;
        top_A_q26 = exh_clamp((int64_t)exh_udiv64((uint64_t)(uint32_t)f_N_q20 << EXH_Q_CUR,
                                  (uint32_t)own->kf_NpA_q20, NULL),
            1, EXH_PROBE_CUR_MAX_A_Q26);
    }
    for (int32_t k = 0; k < BRINGUP_LEVELS; k++) {
        cfg->level_N_q20[k] = (int32_t)exh_udiv64(
            (uint64_t)(uint32_t)top_N_q20 * (uint32_t)(k + 1), BRINGUP_LEVELS, NULL);
    }
    cfg->to_cur[0] = (struct exh_knot){0, 0, {0, 0}};
    cfg->to_cur[1] = (struct exh_knot){top_N_q20, top_A_q26, {0, 0}};
    if ((own->stage == 3 && own->pol_max_A_q26 > top_A_q26) ||
        (own->stage == 4 && own->home_A_q26 > top_A_q26)) {
        return -EXH_E_RANGE;
    }
    return exh_table_setup(cfg->to_cur, 2);
}

static int setup_motions(struct bringup_cfg *cfg, struct exh_period T)
{
    const struct bringup_own_par *own = &cfg->par->own;
    const struct exh_probe_scale scale = {cfg->par->quad.step_m_q42, T};
    const struct exh_probe_par polarity = {own->step_A_q26, own->pol_max_A_q26, own->dwell_ms,
        own->time_ms, own->move_m_q30, own->travel_m_q30};
    const struct exh_home_par home = {own->home_A_q26, own->dwell_ms, own->time_ms, own->move_m_q30,
        own->home_min_m_q30, own->home_max_m_q30};
    const int err = exh_probe_setup(&cfg->polarity, &polarity, scale);
    if (exh_probe_ticks(own->dwell_ms, T) < 2 || exh_probe_ticks(own->doubt_ms, T) < 2) {
        return -EXH_E_RATE;
    }
    cfg->turn_cnt = exh_clamp(
        (int64_t)exh_udiv64((uint64_t)(uint32_t)own->turn_m_q30 << (EXH_Q_STEP - EXH_Q_POS),
            (uint32_t)scale.step_m_q42, NULL),
        4, INT32_MAX / 2);
    cfg->hold_ticks = exh_probe_ticks(own->hold_ms, T);
    cfg->doubt_ticks = exh_probe_ticks(own->doubt_ms, T);
    cfg->dwell_ticks = exh_probe_ticks(own->dwell_ms, T);
    cfg->stop_ticks = exh_probe_ticks(own->stop_ms, T);
    cfg->time_ticks = exh_probe_ticks(own->time_ms, T);
    cfg->wait_ticks = exh_probe_ticks(own->wait_ms, T);
    return err == 0 ? exh_home_setup(&cfg->home, &home, scale) : err;
}

/* Refuses a mass that half of homing's current might lift, or that the stage's limit can hardly
 * lift. */
static int setup_weigh(struct bringup_cfg *cfg, struct exh_period T)
{
    const struct bringup_own_par *own = &cfg->par->own;
    const struct exh_probe_scale scale = {cfg->par->quad.step_m_q42, T};
    const struct exh_probe_par probe = {own->step_A_q26, cfg->to_cur[1].y, own->dwell_ms,
        own->time_ms, own->move_m_q30, own->travel_m_q30};
    const struct exh_weigh_par weigh = {probe, own->home_A_q26 / 2, own->hold_ms};
    cfg->mass_N_q20 = exh_sat32(exh_mul_shr(own->mass_kg_q20, GRAVITY_MPS2_Q20, EXH_Q_FORCE));
    if (cfg->list != BRINGUP_WEIGHS) { return 0; }
    if (own->mass_kg_q20 < MASS_MIN_KG_Q20 || cfg->mass_N_q20 >= own->f_max_N_q20) {
        return -EXH_E_RANGE;
    }
    return exh_weigh_setup(&cfg->weigh, &weigh, scale);
}

int bringup_setup(
    struct bringup_cfg *cfg, const struct bringup_par *par, struct exh_scene_board board)
{
    static const struct exh_velocity_par window = {3}; /* 8 ticks */
    const struct exh_axis_setup parts = {.quad = &cfg->quad,
        .quad_par = &par->quad,
        .velocity = &cfg->vel,
        .velocity_par = &window,
        .drive = &cfg->drive,
        .drive_par = &cfg->drive_par};
    const struct exh_table to_cur = {cfg->to_cur, 2}, none = {NULL, 0};
    int err = exh_rows_validate(own_rows, COUNT(own_rows), &par->own) ? 0 : -EXH_E_RANGE;
    if (err < 0) { return err; }
    cfg->par = par;
    cfg->drive_par = par->drive;
    if (cfg->drive_par.slew_up_Nps > par->own.ramp_ps) {
        cfg->drive_par.slew_up_Nps = par->own.ramp_ps;
    }
    cfg->list =
        (uint8_t)(par->own.stage == 4 && par->own.mass_kg_q20 ? BRINGUP_WEIGHS : par->own.stage);
    cfg->number = number_of(par->own.stage, par);
    cfg->before = par->own.stage > 1 ? number_of(par->own.stage - 1, par) : 0;
    err = setup_levels(cfg);
    if (err == 0) {
        err = exh_gain_set(&cfg->looped_A_q26, UINT64_C(32490) << (EXH_Q_CUR + EXH_Q_DAC),
            UINT64_C(32768) * (uint32_t)par->drive.dac_rawpA_q16);
    }
    if (err == 0) { err = exh_axis_setup(&parts, board.T, board.enc_bits, to_cur, none); }
    if (err == 0) { err = exh_safety_setup(&cfg->safety, &par->safety, board.T); }
    if (err == 0) { err = setup_motions(cfg, board.T); }
    return err == 0 ? setup_weigh(cfg, board.T) : err;
}

/* --- the one instance of this image --- */

static struct bringup_par active, staged;
static struct exh_params params;
static struct bringup_signals signal;
static struct bringup_cfg cfg;
static struct bringup state;

static void defaults(void)
{
    exh_params_setup(&params, &param_table, (int32_t *)&active, (int32_t *)&staged);
}

static int setup(struct exh_scene_board board)
{
    const int err = bringup_setup(&cfg, &active, board);
    if (err == 0) { bringup_start(&state); }
    return err;
}

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    bringup_tick(&state, &cfg, in, out, &signal);
}

static void tell(void)
{
    static char text[BRINGUP_TEXT_B];
    const unsigned len = bringup_text(text, &state, &cfg);
    if (len > 0) { (void)exh_board_log(text, len); }
}

const struct bringup *bringup_state(void) { return &state; }

const struct bringup_cfg *bringup_config(void) { return &cfg; }

/* Not replayable: its state is not saved. */
const struct exh_scene exh_scene_bringup = {
    .name = "bringup",
    .rate_Hz = 1000,
    .fingers = BRINGUP_FINGERS,
    .params = &params,
    .apply = exh_params_apply,
    .safety = &state.safety,
    .signals = &signal_table,
    .values = (int32_t *)&signal,
    .defaults = defaults,
    .setup = setup,
    .tick = tick,
    .tell = tell,
};
