/* SPDX-License-Identifier: MIT */
/* The shortest complete scene: one finger against one virtual wall. */
#include "exhand/run/scene.h"

#include "exhand/exhand.h"

static const struct exh_quad_par quad_par = {
    EXH_Q(6632, 100000000, EXH_Q_STEP), EXH_Q(10, 1, EXH_Q_VEL)};
static const struct exh_velocity_par vel_par = {1};
static const struct exh_contact_par contact_par = {
    .k_Npm_q10 = EXH_Q(2000, 1, EXH_Q_K), .b_Nspm_q20 = EXH_Q(10, 1, EXH_Q_B)};
static const struct exh_drive_par drive_par = {.f_max_N_q20 = EXH_Q(5, 1, EXH_Q_FORCE),
    .slew_up_Nps = 1000,
    .slew_down_Nps = 1000,
    .i_peak_A_q26 = EXH_Q(33, 10, EXH_Q_CUR),
    .i_cont_A_q26 = EXH_Q(33, 10, EXH_Q_CUR),
    .peak_ms = 2700,
    .dac_zero_raw = 32768,
    .dac_span_raw = 12184,
    .dac_rawpA_q16 = EXH_Q(324900, 176, EXH_Q_DAC),
    .mon_A_q40 = EXH_Q(5164, 10000000, EXH_Q_MON),
    .person_N_q20 = EXH_Q(5, 1, EXH_Q_FORCE),
    .person_A_q26 = EXH_Q(33, 10, EXH_Q_CUR)};
static const struct exh_tracking_par track_par = {EXH_Q(1, 4, EXH_Q_CUR), 20};
static const struct exh_safety_par safety_par = {1, EXH_Q(1, 1, EXH_Q_FORCE), 50, 500, 15};
/* All parameters are constants. */
#define vouched (EXH_UNTESTED | EXH_UNCALIBRATED | EXH_UNPOLARISED)
static const int32_t wall_m_q30 = EXH_Q(2, 100, EXH_Q_POS);

#ifdef EXH_FROZEN /* results of set-up as constants: ../frozen.h */
#include EXH_FROZEN
#else
static struct exh_quad_cfg quad_cfg;
static struct exh_velocity_window_cfg vel_cfg;
static struct exh_drive_cfg drive_cfg;
static struct exh_tracking_cfg track_cfg;
static struct exh_safety_cfg safety_cfg;
static struct exh_knot knot[2] = {
    {0, 0, {0, 0}}, {EXH_Q(22, 1, EXH_Q_FORCE), EXH_Q(66, 10, EXH_Q_CUR), {0, 0}}};
#endif
static struct state {
    struct exh_quad quad;
    struct exh_velocity_window vel;
    struct exh_drive drive;
    struct exh_tracking track;
    struct exh_safety safety;
} s;

#ifdef EXH_FROZEN
static int setup(struct exh_scene_board board)
{
    s = (struct state){0};
    return exh_frozen_for(frozen_board, board);
}
#else
static int setup(struct exh_scene_board board)
{
    static const struct exh_axis_setup parts = {.quad = &quad_cfg,
        .quad_par = &quad_par,
        .velocity = &vel_cfg,
        .velocity_par = &vel_par,
        .track = &track_cfg,
        .track_par = &track_par,
        .drive = &drive_cfg,
        .drive_par = &drive_par};
    const struct exh_table to_cur = {knot, 2}, no_table = {0, 0};
    int err = exh_table_setup(knot, 2);
    s = (struct state){0};
    if (err == 0) { err = exh_axis_setup(&parts, board.T, board.enc_bits, to_cur, no_table); }
    if (err == 0) { err = exh_safety_setup(&safety_cfg, &safety_par, board.T); }
    return err;
}
#endif

static const struct exh_axis axis = {.quad = &s.quad,
    .quad_cfg = &quad_cfg,
    .velocity = &s.vel,
    .velocity_cfg = &vel_cfg,
    .track = &s.track,
    .track_cfg = &track_cfg,
    .drive = &s.drive,
    .drive_cfg = &drive_cfg};

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    const struct exh_axis_now now = exh_axis_sense(&axis, &in->drive, 0);
    const struct exh_safety_in box = {in->drive.din, 0, in->missed, in->command, 1, vouched};
    const struct exh_permit permit = exh_axis_permit(&s.safety, &safety_cfg, &now, 1, box);
    const struct exh_contact_in q = {now.pos_m_q30, now.vel_mps_q27, wall_m_q30};
    struct exh_force_ledger f;
    struct exh_current_ledger i;
    uint32_t limits;

    (void)exh_contact_law(&contact_par, q, &f);
    limits = now.limits | exh_axis_force(&axis, &permit, &f, &i);
    exh_axis_out(&axis, &s.safety, now.cnt, &i, &limits, out);
}

const struct exh_scene exh_scene_minimal = {.name = "minimal",
    .rate_Hz = 1000,
    .fingers = 1,
    .safety = &s.safety,
    .setup = setup,
    .tick = tick};
