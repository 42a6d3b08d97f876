/* SPDX-License-Identifier: MIT */
#include "glove.h"

#include "exhand/board.h"

#define PARAMS \
    (EXH_GLOVE_ROWS + EXH_HAND_ROWS + GLOVE_OWN_ROWS + GLOVE_CAL_ROWS * EXH_GLOVE_SENSORS)
#define ALL_SENSORS ((1 << EXH_GLOVE_SENSORS) - 1)

#define ANGLE(i, name, help) \
    { \
        (uint16_t)(0x8501 + (i)), 32, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, (name), "turn", \
            (help) \
    }
#define JOINT(i, name, help) \
    { \
        (uint16_t)(0x8521 + (i)), 32, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, (name), "turn", \
            (help) \
    }
#define TIP(i, name, help) \
    { \
        (uint16_t)(0x8541 + (i)), EXH_Q_POS, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, (name), \
            "m", (help) \
    }

static const struct exh_signal signal_rows[] = {
    ANGLE(0, "thumb_rotate", "glove: thumb across the palm"),
    ANGLE(1, "thumb_mpj", "thumb, middle joint"),
    ANGLE(2, "thumb_ij", "thumb, last joint"),
    ANGLE(3, "thumb_ab", "thumb to index"),
    ANGLE(4, "index_mpj", "knuckle"),
    ANGLE(5, "index_pij", "middle joint"),
    ANGLE(6, "index_dij", "last joint"),
    ANGLE(7, "middle_mpj", "knuckle"),
    ANGLE(8, "middle_pij", "middle joint"),
    ANGLE(9, "middle_dij", "last joint"),
    ANGLE(10, "middle_index_ab", "between the two"),
    ANGLE(11, "ring_mpj", "knuckle"),
    ANGLE(12, "ring_pij", "middle joint"),
    ANGLE(13, "ring_dij", "last joint"),
    ANGLE(14, "ring_middle_ab", "between the two"),
    ANGLE(15, "pinkie_mpj", "knuckle"),
    ANGLE(16, "pinkie_pij", "middle joint"),
    ANGLE(17, "pinkie_dij", "last joint"),
    ANGLE(18, "pinkie_ring_ab", "between the two"),
    ANGLE(19, "palm_arch", "hollow of the palm"),
    ANGLE(20, "wrist_pitch", "up"),
    ANGLE(21, "wrist_yaw", "out"),
    {0x8517, 0, EXH_WHEN_OUTPUT, 0, ALL_SENSORS, 0, "glove_faults", "",
        "sensors not believed, bits"},
    JOINT(0, "thumb_q0", "robot: sideways"),
    JOINT(1, "thumb_q1", "knuckle"),
    JOINT(2, "thumb_q2", "middle joint, the last follows it"),
    JOINT(3, "index_q0", "sideways"),
    JOINT(4, "index_q1", "knuckle"),
    JOINT(5, "index_q2", "middle joint"),
    JOINT(6, "middle_q0", "sideways"),
    JOINT(7, "middle_q1", "knuckle"),
    JOINT(8, "middle_q2", "middle joint"),
    JOINT(9, "ring_q0", "sideways"),
    JOINT(10, "ring_q1", "knuckle"),
    JOINT(11, "ring_q2", "middle joint"),
    JOINT(12, "little_q0", "sideways"),
    JOINT(13, "little_q1", "knuckle"),
    JOINT(14, "little_q2", "middle joint"),
    {0x8530, 0, EXH_WHEN_OUTPUT, 0, (1 << 15) - 1, 0, "clamped", "", "joints at a limit, bits"},
    TIP(0, "thumb_x", "fingertip P_F in the palm's frame"),
    TIP(1, "thumb_y", ""),
    TIP(2, "thumb_z", ""),
    TIP(3, "index_x", ""),
    TIP(4, "index_y", ""),
    TIP(5, "index_z", ""),
    TIP(6, "middle_x", ""),
    TIP(7, "middle_y", ""),
    TIP(8, "middle_z", ""),
    TIP(9, "ring_x", ""),
    TIP(10, "ring_y", ""),
    TIP(11, "ring_z", ""),
    TIP(12, "little_x", ""),
    TIP(13, "little_y", ""),
    TIP(14, "little_z", ""),
    {0x8550, 0, EXH_WHEN_OUTPUT, 0, UINT16_MAX, 0, "age", "",
        "ticks since the frame was converted"},
};
#define SIGNALS (sizeof signal_rows / sizeof signal_rows[0])

static const struct exh_signal_group param_groups[] = {{exh_glove_rows, EXH_GLOVE_ROWS, 1},
    {exh_hand_rows, EXH_HAND_ROWS, 1}, {glove_own_rows, GLOVE_OWN_ROWS, 1},
    {glove_cal_rows, GLOVE_CAL_ROWS, EXH_GLOVE_SENSORS}};
static const struct exh_signal_table param_table = {param_groups, 4};
static const struct exh_signal_group signal_groups[] = {{signal_rows, SIGNALS, 1}};
static const struct exh_signal_table signal_table = {signal_groups, 1};

EXH_STATIC_ASSERT(glove_par_matches_rows, sizeof(struct glove_par) == PARAMS * sizeof(int32_t));
EXH_STATIC_ASSERT(
    glove_signals_match_rows, sizeof(struct glove_signals) == SIGNALS * sizeof(int32_t));

/* --- calibration --- */

void glove_par_of_cal(struct glove_par *par, const struct exh_glove_cal *cal)
{
    glove_rows_of_cal(&par->own, par->sensor, cal);
}

void glove_cal_of_par(struct exh_glove_cal *cal, const struct glove_par *par)
{
    glove_cal_of_rows(cal, &par->own, par->sensor);
}

/* --- frame --- */

int glove_setup(struct glove_cfg *cfg, const struct glove_par *par, struct exh_period T)
{
    int err;
    glove_cal_of_par(&cfg->cal, par);
    err = exh_glove_setup(&cfg->glove, &par->glove, &cfg->cal, T);
    for (unsigned f = 0; err == 0 && f < EXH_FINGERS; f++) {
        err = exh_hand_setup(&cfg->finger[f], &exh_hit2_bones[f], &par->hand);
    }
    return err;
}

void glove_frame(struct glove *s, const struct glove_cfg *cfg, const struct exh_glove_in *in)
{
    struct glove_signals *sig = &s->sig;
    uint32_t clamped = 0;
    sig->faults = (int32_t)exh_glove_step(&s->glove, &cfg->glove, in, sig->angle_turn_q32);
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        int32_t *joint = sig->joint_turn_q32[f];
        clamped |= exh_hand_joints(&exh_hit2_map, f, sig->angle_turn_q32, joint)
                   << (EXH_HAND_JOINTS * f);
        exh_hand_tip(&cfg->finger[f], joint, &sig->tip_m_q30[f]);
    }
    sig->clamped = (int32_t)clamped;
}

/* --- the one instance of this image --- */

static struct glove_par active, staged;
static struct exh_params params;
static struct glove_signals signals;
static struct glove_cfg cfg;
static struct glove state;

/* No drives: the gate stays closed and makes all output frames. */
#define DAC_ZERO_RAW 32768
static struct exh_safety shut;

static void defaults(void)
{
    exh_params_setup(&params, &param_table, (int32_t *)&active, (int32_t *)&staged);
    glove_par_of_cal(&active, &exh_glove_cal_default);
    staged = active;
}

int glove_stage_cal(const struct exh_glove_cal *cal, struct exh_glove_error *bad)
{
    const int err = exh_glove_cal_validate(cal, bad);
    if (err == 0) {
        glove_par_of_cal(&staged, cal);
        params.pending = 1;
    }
    return err;
}

static int setup(struct exh_scene_board board)
{
    const uint64_t num = (uint64_t)board.T.num * (uint32_t)active.own.every;
    state = (struct glove){0};
    shut = (struct exh_safety){.fingers = 1};
    if (num > UINT32_MAX) { return -EXH_E_RATE; }
    return glove_setup(&cfg, &active, (struct exh_period){(uint32_t)num, board.T.den});
}

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    if (in->glove_new) { glove_frame(&state, &cfg, &in->glove); }
    state.sig.age_ticks = in->glove.age_ticks;
    signals = state.sig;
    exh_gate_shut(&shut, DAC_ZERO_RAW, out);
}

static void state_bytes(struct exh_bytes *c)
{
    int32_t *held = (int32_t *)&state.sig; /* repeated in the next ticks */
    exh_glove_serialize(c, &state.glove);
    for (unsigned i = 0; i < SIGNALS; i++) { exh_bytes_i32(c, &held[i]); }
    exh_safety_serialize(c, &shut);
}

const struct exh_scene exh_scene_glove = {
    .name = "glove",
    .rate_Hz = 2000,
    .fingers = 0,
    .params = &params,
    .apply = exh_params_apply,
    .signals = &signal_table,
    .values = (int32_t *)&signals,
    .read_glove = exh_board_read_glove,
    .glove_every = &active.own.every,
    .defaults = defaults,
    .setup = setup,
    .tick = tick,
    .state = state_bytes,
};
