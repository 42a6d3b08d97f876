/* SPDX-License-Identifier: MIT */
#include "bilateral.h"

static uint32_t sensors_of(const struct exh_hand_map *map, unsigned f)
{
    uint32_t mask = 0;
    for (unsigned j = 0; j < EXH_HAND_JOINTS; j++) {
        for (unsigned t = 0; t < EXH_HAND_TERMS; t++) {
            const struct exh_hand_joint *joint = &map->joint[f][j];
            if (joint->gain_q24[t] != 0) { mask |= UINT32_C(1) << joint->sensor[t]; }
        }
    }
    return mask;
}

int bilateral_finger_setup(struct bilateral_cfg *cfg, unsigned place, struct exh_scene_board board,
    struct exh_scene_calib *calib)
{
    const unsigned f = cfg->at[place];
    const struct bilateral_par *par = cfg->par;
    const struct exh_drive_par *drive = &par->drive[f];
    struct bilateral_finger_cfg *c = &cfg->finger[f];
    const struct exh_calib_finger finger = {f, drive, par->kf_NpA_q20[f]};
    const struct exh_axis_setup parts = {&c->quad, &par->quad[f], &c->velocity, &par->velocity[f],
        &c->watch, &par->watch[f], &c->track, &par->track[f], &cfg->drive[place], drive,
        &c->chatter, &par->chatter[f]};
    int err;

    c->sensors = sensors_of(&exh_hit2_map, f);
    err = exh_calib_set_tables(&c->calib, calib, &par->calib, &finger);
    if (err == 0) {
        err = exh_axis_setup(&parts, board.T, board.enc_bits, exh_calib_to_cur(&c->calib),
            exh_calib_to_force(&c->calib));
    }
    if (err == 0) {
        err = exh_polarity_setup(&c->polarity, &par->polarity, par->quad[f].step_m_q42, board.T);
    }
    if (err == 0) { err = exh_hand_setup(&c->hand, &exh_hit2_bones[f], &par->hand[f]); }
    if (err == 0) { err = exh_hand_couple(&c->hand, &exh_hit2_map, f); }
    if (err == 0) {
        err = exh_precontact_setup(&c->precontact, &par->precontact[f], par->material,
            BILATERAL_MATERIALS, par->hand[f].pad_m_q30, board.T);
    }
    return err;
}

/* While all joints stay, the position of the last frame holds. It is computed again in every
 * BILATERAL_KEEP_FRAMES-th frame, so that damaged memory heals. */
static int stays(struct bilateral_finger *s, const int32_t *joint_turn_q32, unsigned how)
{
    uint32_t moved = s->how ^ how;
    for (unsigned j = 0; j < EXH_HAND_JOINTS; j++) {
        moved |= (uint32_t)(s->joint_turn_q32[j] ^ joint_turn_q32[j]);
        s->joint_turn_q32[j] = joint_turn_q32[j];
    }
    if (BILATERAL_KEEP_FRAMES == 1) { return 0; }
    s->how = (uint8_t)how;
    if (moved == 0 && s->keep_frames > 0) {
        s->keep_frames--;
        return 1;
    }
    s->keep_frames = BILATERAL_KEEP_FRAMES - 1;
    return 0;
}

void bilateral_finger_see(struct bilateral_finger *s, const struct bilateral_cfg *cfg, unsigned f,
    const int32_t *angle_turn_q32)
{
    const unsigned sloped = cfg->par->precontact[f].from_slope != 0;
    int32_t joint_turn_q32[EXH_HAND_JOINTS];
    s->clamped = (uint8_t)exh_hand_joints(&exh_hit2_map, f, angle_turn_q32, joint_turn_q32);
    if (stays(s, joint_turn_q32, s->clamped | sloped << EXH_HAND_JOINTS)) { return; }
    if (sloped) {
        struct exh_hand_finger hand = cfg->finger[f].hand; /* joints at a limit do not move */
        if (s->clamped & 1u << 1) { hand.pull_radpm_q20[0] = 0; }
        if (s->clamped & 1u << 2) { hand.pull_radpm_q20[1] = 0; }
        exh_hand_tip_slope(&hand, s->joint_turn_q32, &s->tip_m_q30, &s->slope_q24);
    } else {
        exh_hand_tip(&cfg->finger[f].hand, s->joint_turn_q32, &s->tip_m_q30);
    }
}

/* The law with the material of the frozen plane. Without one there is no contact. */
static struct exh_contact_par touch(
    const struct exh_precontact *p, const struct bilateral_cfg *cfg, unsigned f)
{
    const struct exh_contact_par *own = &cfg->par->contact[f];
    return (struct exh_contact_par){p->taken.k_Npm_q10, p->taken.b_Nspm_q20, own->f0_N_q20,
        own->f0_band_m_q30, own->hyst_m_q30};
}

/* The drive's limits, or lower ones of the material and of a late contact. */
static struct exh_drive_most most(
    const struct exh_precontact *p, const struct bilateral_cfg *cfg, unsigned f)
{
    struct exh_drive_most own = {cfg->par->drive[f].f_max_N_q20, cfg->par->drive[f].slew_up_Nps};
    if (p->phase == EXH_PRECONTACT_FROZEN && p->taken.f_max_N_q20 < own.f_max_N_q20) {
        own.f_max_N_q20 = p->taken.f_max_N_q20;
    }
    if (p->late && cfg->par->precontact[f].late_slew_Nps < own.slew_up_Nps) {
        own.slew_up_Nps = cfg->par->precontact[f].late_slew_Nps;
    }
    return own;
}

/* Winds in a slack string. A finger that met no wall, or left one fast, returns without the string.
 * A slack string does not move, so the law sees no inward movement and F0 does not act. After a
 * rest it counts as running in, until it runs out by F0's band again. In contact it is taut. */
static void wind_in(struct bilateral_finger *s, uint32_t rest_ticks)
{
    struct exh_contact *c = &s->contact;
    if (c->touching || c->inward || c->turn_m_q30 != s->out_m_q30) {
        s->rest_ticks = 0;
    } else if (s->rest_ticks < rest_ticks) {
        s->rest_ticks++;
    } else {
        c->inward = 1;
    }
    s->out_m_q30 = c->turn_m_q30;
}

/* The pull of arming instead of the law: no more than it requests, whatever share the ramp has. */
static uint32_t pull(const struct bilateral *s, const struct bilateral_cfg *cfg, unsigned f,
    const struct exh_axis *axis, struct exh_permit permit, struct exh_force_ledger *force,
    struct exh_current_ledger *i)
{
    const struct exh_polarity_cfg *c = &cfg->finger[f].polarity;
    const struct exh_drive_par *drive = &cfg->par->drive[f];
    const struct exh_drive_most own = {
        exh_clamp(c->pull_N_q20, 0, drive->f_max_N_q20), drive->slew_up_Nps};
    *force =
        (struct exh_force_ledger){.pullback_N_q20 = exh_polarity_force_N_q20(&s->polarity[f], c)};
    permit.share_q30 = INT32_C(1) << 30;
    return exh_axis_force_within(axis, &permit, own, force, i);
}

uint32_t bilateral_finger_feel(struct bilateral *s, const struct bilateral_cfg *cfg, unsigned place,
    const struct exh_permit *permit, struct exh_current_ledger *i, struct bilateral_paper *p,
    int32_t *bits)
{
    const unsigned f = bilateral_at(cfg, place);
    struct bilateral_finger *now = &s->finger[f];
    const struct exh_precontact_in where = {now->tip_m_q30, now->slope_q24, p->q_m_q30,
        bilateral_finger_age(s, cfg, place), now->contact.touching, permit->mode == EXH_PERMIT_OPEN,
        p->qd_mps_q27};
    struct exh_contact_in q = {p->q_m_q30, p->qd_mps_q27, 0};
    struct exh_contact_par law;
    struct exh_force_ledger force;
    const struct exh_axis axis = bilateral_axis(s, cfg, place, f);
    uint32_t limits;

    *bits = (int32_t)exh_precontact_step(&now->precontact, &cfg->finger[f].precontact, &where);
    p->d_m_q30 = now->precontact.d_m_q30;
    q.lim_m_q30 = now->precontact.lim_m_q30;
    law = touch(&now->precontact, cfg, f);
    p->c = 0;
    if (exh_precontact_none(&now->precontact)) {
        exh_contact_step_free(&now->contact, &law, q.pos_m_q30, &force);
    } else {
        p->c = exh_contact_step(&now->contact, &law, q, &force);
    }
    wind_in(now, cfg->rest_ticks);
    limits = s->pulls
                 ? pull(s, cfg, f, &axis, *permit, &force, i)
                 : exh_axis_force_within(&axis, permit, most(&now->precontact, cfg, f), &force, i);
    if (!(limits & EXH_LIMIT_SLEW)) { exh_precontact_arrived(&now->precontact); }
    p->f_des_N_q20 = force.force_N_q20;
    p->q_lim_m_q30 = q.lim_m_q30;
    return limits;
}

void bilateral_finger_bytes(struct exh_bytes *c, struct bilateral_finger *s)
{
    exh_quad_serialize(c, &s->quad);
    exh_velocity_window_serialize(c, &s->velocity);
    exh_contact_serialize(c, &s->contact);
    exh_drive_serialize(c, &s->drive);
    exh_tracking_serialize(c, &s->track);
    exh_motion_serialize(c, &s->watch);
    exh_chatter_serialize(c, &s->chatter);
    exh_precontact_serialize(c, &s->precontact);
    exh_bytes_i32(c, &s->out_m_q30);
    exh_bytes_u32(c, &s->rest_ticks);
    for (unsigned j = 0; j < EXH_HAND_JOINTS; j++) { exh_bytes_i32(c, &s->joint_turn_q32[j]); }
    exh_bytes_vec3(c, &s->tip_m_q30);
    exh_bytes_vec3(c, &s->slope_q24);
    exh_bytes_u8(c, &s->clamped);
    s->keep_frames = 0; /* it was of another position */
}
