/* SPDX-License-Identifier: MIT */
#include "tick.h"

#define MM(x) EXH_Q(x, 1000, EXH_Q_POS)
#define ROUND 1024u
#define APART 205u /* ticks from one finger to the next */
#define MEET  300u /* a finger meets its plane so far into its bend */

static const struct exh_material_par material = {
    EXH_Q(19973, 1, EXH_Q_K), EXH_Q(617, 10, EXH_Q_B), EXH_Q(12, 1, EXH_Q_FORCE)};

/* 0 .. ROUND/2 and back. */
static int32_t bent_at(uint32_t i)
{
    const uint32_t at = i % ROUND;
    return (int32_t)(at < ROUND / 2 ? at : ROUND - at);
}

static void bend(int32_t joint_turn_q32[3], int32_t bent)
{
    joint_turn_q32[0] = bent * (EXH_DEG(5, 1) / (int32_t)(ROUND / 2));
    joint_turn_q32[1] = bent * (EXH_DEG(80, 1) / (int32_t)(ROUND / 2));
    joint_turn_q32[2] = bent * (EXH_DEG(60, 1) / (int32_t)(ROUND / 2));
}

/* String per tick of ROUND/2: 60 mm in all. */
#define STRING_M_Q30 (MM(60) / (int32_t)(ROUND / 2))

void tick_input(struct tick_in *in, uint32_t i)
{
    const struct tick_in none = {.pos_m_q30 = {0}};
    *in = none;
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const uint32_t at = i + APART * f;
        bend(&in->angle_turn_q32[3 * f], bent_at(at));
        in->pos_m_q30[f] = STRING_M_Q30 * bent_at(at);
        in->vel_mps_q27[f] =
            (at % ROUND < ROUND / 2 ? 1 : -1) * (STRING_M_Q30 >> (EXH_Q_POS - EXH_Q_VEL)) * 2000;
    }
    for (unsigned k = 3 * EXH_FINGERS; k < EXH_GLOVE_SENSORS; k++) {
        in->angle_turn_q32[k] = EXH_DEG(1, 16) * bent_at(i + k);
    }
}

/* The plane along the axis that the fingertip moves along most, so that the normal is exact. */
static struct exh_plane plane_of(const struct exh_hand_finger *hand)
{
    struct exh_plane p = {EXH_PLANE_HIT, 0, 1, {0, 0, 0}, {0, 0, 0}};
    int32_t joint_turn_q32[3];
    struct exh_vec3 from, to;
    int32_t way[3];
    int axis = 0;
    bend(joint_turn_q32, 0);
    exh_hand_tip(hand, joint_turn_q32, &from);
    bend(joint_turn_q32, (int32_t)MEET);
    exh_hand_tip(hand, joint_turn_q32, &to);
    way[0] = to.x - from.x;
    way[1] = to.y - from.y;
    way[2] = to.z - from.z;
    for (int k = 1; k < 3; k++) {
        if ((way[k] < 0 ? -way[k] : way[k]) > (way[axis] < 0 ? -way[axis] : way[axis])) {
            axis = k;
        }
    }
    (&p.normal_q30.x)[axis] = way[axis] > 0 ? -(INT32_C(1) << 30) : INT32_C(1) << 30;
    p.point_m_q30 = to;
    return p;
}

int tick_setup(struct tick_box *b)
{
    static const struct exh_period T = {1, 2000};
    static const struct exh_filter_par filter = {2, EXH_Q(20, 1, 16)};
    static const struct exh_contact_par wall = {EXH_Q(19973, 1, EXH_Q_K), EXH_Q(617, 10, EXH_Q_B),
        EXH_Q(107, 1000, EXH_Q_FORCE), EXH_Q(2, 10000, EXH_Q_POS), 0};
    static const struct exh_precontact_par freeze = {
        -MM(5), MM(1), 1 << 24, 0, 0, 60000, MM(5), 60000, 50, 100};
    const struct exh_hand_par hand = {
        exh_hand_rows[0].dflt, exh_hand_rows[1].dflt, exh_hand_rows[2].dflt, exh_hand_rows[3].dflt};
    const struct tick_box power_on = {.wall = wall, .freeze = freeze};
    struct tick_in at_rest;
    int err;
    *b = power_on;
    err = exh_filter_setup(&b->filter, &filter, T);
    if (err == 0) {
        err = exh_precontact_setup(&b->precontact, &b->freeze, &material, 1, hand.pad_m_q30, T);
    }
    for (unsigned f = 0; err == 0 && f < EXH_FINGERS; f++) {
        err = exh_hand_setup(&b->hand[f], &exh_hit2_bones[f], &hand);
        if (err == 0) {
            const struct exh_plane p = plane_of(&b->hand[f]);
            err = exh_precontact_update(&b->plane[f], &b->precontact, &p, 0);
        }
    }
    tick_input(&at_rest, 0);
    exh_filter_reset(b->channel, at_rest.angle_turn_q32, EXH_GLOVE_SENSORS);
    return err;
}

int32_t tick_once(struct tick_box *b, const struct tick_in *in)
{
    int32_t angle_turn_q32[EXH_GLOVE_SENSORS];
    int32_t all = 0;
    exh_filter_step(b->channel, &b->filter, in->angle_turn_q32, angle_turn_q32, EXH_GLOVE_SENSORS);
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        struct exh_precontact_in at = {{0, 0, 0}, {0, 0, 0}, in->pos_m_q30[f], 0,
            b->contact[f].touching, 1, in->vel_mps_q27[f]};
        struct exh_contact_in q = {in->pos_m_q30[f], in->vel_mps_q27[f], 0};
        exh_hand_tip(&b->hand[f], &angle_turn_q32[3 * f], &at.tip_m_q30);
        (void)exh_precontact_step(&b->plane[f], &b->precontact, &at);
        q.lim_m_q30 = b->plane[f].lim_m_q30;
        all += exh_contact_step(&b->contact[f], &b->wall, q, &b->force[f]);
    }
    return all;
}
