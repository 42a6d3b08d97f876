/* SPDX-License-Identifier: MIT */
/* The shortest complete scene: one finger against one virtual wall. */
#include "../scene.h"

#include "exhand/exhand.h"

static const struct exh_quad_par quad_par = {EXH_Q(6632, 100000000, EXH_Q_STEP),
                                             EXH_Q(10, 1, EXH_Q_VEL)};
static const struct exh_velocity_par vel_par = {1};
static const struct exh_contact_par contact_par = {.k_Npm_q10 = EXH_Q(2000, 1, EXH_Q_K),
                                                   .b_Nspm_q20 = EXH_Q(10, 1, EXH_Q_B)};
static const struct exh_drive_par drive_par = {.f_max_N_q20 = EXH_Q(5, 1, EXH_Q_FORCE),
                                               .slew_up_Nps = 1000,
                                               .slew_down_Nps = 1000,
                                               .i_peak_A_q26 = EXH_Q(33, 10, EXH_Q_CUR),
                                               .i_cont_A_q26 = EXH_Q(33, 10, EXH_Q_CUR),
                                               .peak_ms = 2700,
                                               .dac_zero_raw = 32768,
                                               .dac_span_raw = 12184,
                                               .dac_rawpA_q16 = EXH_Q(324900, 176, EXH_Q_DAC),
                                               .mon_A_q40 = EXH_Q(5164, 10000000, EXH_Q_MON)};
static const struct exh_track_par track_par = {EXH_Q(1, 4, EXH_Q_CUR), 20};
static const struct exh_safety_par safety_par = {1, EXH_Q(1, 1, EXH_Q_FORCE), 50, 500, 15};
/* Its parameters are constants; an encoder that is lost is a cause by itself. */
#define vouched (EXH_UNTESTED | EXH_UNCALIBRATED | EXH_UNPOLARISED | EXH_ARM_ENCODER)
static const int32_t wall_m_q30 = EXH_Q(2, 100, EXH_Q_POS);

#ifdef EXH_FROZEN /* what set-up makes of one period and counter, as constants: ../frozen.h */
#include EXH_FROZEN
#else
static struct exh_quad_cfg quad_cfg;
static struct exh_velocity_window_cfg vel_cfg;
static struct exh_drive_cfg drive_cfg;
static struct exh_track_cfg track_cfg;
static struct exh_safety_cfg safety_cfg;
static struct exh_knot knot[2] = {{0, 0, {0, 0}},
                                  {EXH_Q(22, 1, EXH_Q_FORCE), EXH_Q(66, 10, EXH_Q_CUR), {0, 0}}};
#endif
static struct state {
    struct exh_quad quad;
    struct exh_velocity_window vel;
    struct exh_contact contact;
    struct exh_drive drive;
    struct exh_track track;
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
    const struct exh_velocity_scale scale = {quad_par.step_m_q42, board.T};
    const struct exh_table force_to_cur = {knot, 2}, no_table = {0, 0};
    int err = exh_table_set(knot, 2);
    s = (struct state){0};
    if (err == 0) { err = exh_quad_setup(&quad_cfg, &quad_par, board.T, board.enc_bits); }
    if (err == 0) { err = exh_velocity_window_setup(&vel_cfg, scale, &vel_par); }
    if (err == 0) {
        err = exh_drive_setup(&drive_cfg, &drive_par, board.T, force_to_cur, no_table);
    }
    if (err == 0) { err = exh_track_setup(&track_cfg, &track_par, board.T); }
    if (err == 0) { err = exh_safety_setup(&safety_cfg, &safety_par, board.T); }
    return err;
}
#endif

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    struct exh_force_ledger f;
    struct exh_current_ledger i;
    const int32_t cnt = exh_quad_extend(&s.quad, &quad_cfg, in->drive.enc_raw[0]);
    const struct exh_contact_in q = {exh_quad_pos_m_q30(&quad_par, cnt),
                                     exh_velocity_window_mps_q27(&s.vel, &vel_cfg, cnt),
                                     wall_m_q30};
    const int32_t mon_A_q26 = exh_drive_monitor_A_q26(&drive_cfg, in->drive.mon_raw[0]);
    const int astray = exh_track_step(&s.track, &track_cfg, mon_A_q26);
    const uint32_t raised =
        (s.quad.lost ? EXH_FAULT_ENCODER : 0u) | (astray ? EXH_FAULT_TRACKING : 0u);
    const struct exh_safety_in box = {in->drive.din, raised, in->missed, in->command, 1, vouched};
    const struct exh_permit permit = exh_safety_step(&s.safety, &safety_cfg, box);
    uint32_t limits;

    exh_contact_law(&s.contact, &contact_par, q, &f);
    limits = exh_drive_force(&s.drive, &drive_cfg, &permit, &f);
    limits |= exh_drive_current(&s.drive, &drive_cfg, &f, &i);
    exh_gate(&s.safety, &drive_cfg, 1, &i, &limits, out);
    exh_track_coded(&s.track, i.coded_A_q26);
}

const struct exh_scene exh_scene_minimal = {.name = "minimal",
                                            .rate_Hz = 1000,
                                            .fingers = 1,
                                            .safety = &s.safety,
                                            .setup = setup,
                                            .tick = tick};
