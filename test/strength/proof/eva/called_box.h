/* SPDX-License-Identifier: MIT */
/* As called.h: glove, hand, pre-contact and link. */
#ifndef PROOF_CALLED_BOX_H
#define PROOF_CALLED_BOX_H

#include "called_params.h"
#include "contract_box.h"

static uint32_t any_sensors(void)
{
    return Frama_C_unsigned_int_interval(0, (1u << EXH_GLOVE_SENSORS) - 1);
}

static struct exh_vec3 any_vec3(void)
{
    const struct exh_vec3 v = {any32(), any32(), any32()};
    return v;
}

/* --- glove --- */

int exh_glove_setup(struct exh_glove_cfg *cfg, const struct exh_glove_par *par,
    const struct exh_glove_cal *cal, struct exh_period T)
{
    struct exh_glove_cfg made;
    (void)T;
    /*@ assert glove_setup: \valid_read(par) && \valid_read(cal); */
    if (REFUSED()) { return -EXH_E_RANGE; }
    ANY(made);
    made.cal = cal;
    /*@ admit glove_cfg(&made); */
    *cfg = made;
    return 0;
}

uint32_t exh_glove_step(struct exh_glove *s, const struct exh_glove_cfg *cfg,
    const struct exh_glove_in *in, int32_t *angle_turn_q32)
{
    /*@ assert glove_step: glove_cfg(cfg) && \valid_read(in) && \valid(angle_turn_q32 + (0 .. 21)); */
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const uint8_t cause = s->cause[i];
        /*@ assert glove_cause: cause < 4; */
        angle_turn_q32[i] = any32();
    }
    *s = any_glove();
    return any_sensors();
}

uint32_t exh_glove_believe(struct exh_glove *s, const struct exh_glove_cfg *cfg,
    const struct exh_glove_in *in, int32_t *code_raw_q16)
{
    return exh_glove_step(s, cfg, in, code_raw_q16);
}

void exh_glove_angles(struct exh_glove *s, const struct exh_glove_cfg *cfg, unsigned from,
    unsigned to, int32_t *angle_turn_q32)
{
    /*@ assert glove_angles: glove_cfg(cfg) && from <= 22 && to <= 22 && \valid(angle_turn_q32 + (0 .. 21)); */
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { angle_turn_q32[i] = any32(); }
    *s = any_glove();
}

void exh_glove_cross(const struct exh_glove_cfg *cfg, int32_t *angle_turn_q32)
{
    /*@ assert glove_cross: glove_cfg(cfg) && \valid(angle_turn_q32 + (0 .. 21)); */
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { angle_turn_q32[i] = any32(); }
}

void exh_glove_serialize(struct exh_bytes *c, struct exh_glove *s)
{
    (void)c;
    *s = any_glove();
}

/* --- hand --- */

int exh_hand_setup(
    struct exh_hand_finger *f, const struct exh_hand_bones *bones, const struct exh_hand_par *par)
{
    /*@ assert hand_setup: \valid_read(bones) && \valid_read(par); */
    if (REFUSED()) { return -EXH_E_RANGE; }
    *f = any_hand();
    f->bones = bones;
    return 0;
}

int exh_hand_couple(struct exh_hand_finger *f, const struct exh_hand_map *map, unsigned finger)
{
    /*@ assert hand_follow: hand(f) && \valid_read(map) && finger < 5; */
    f->pull_radpm_q20[0] = Frama_C_interval(-262144000, 262144000);
    f->pull_radpm_q20[1] = Frama_C_interval(-262144000, 262144000);
    return REFUSED() ? -EXH_E_RANGE : 0;
}

uint32_t exh_hand_joints(const struct exh_hand_map *map, unsigned finger,
    const int32_t *sensor_turn_q32, int32_t *joint_turn_q32)
{
    /*@ assert hand_joints: \valid_read(map) && finger < 5 && \initialized(sensor_turn_q32 + (0 .. 21)); */
    for (unsigned j = 0; j < EXH_HAND_JOINTS; j++) { joint_turn_q32[j] = any32(); }
    return any8() & 7u;
}

void exh_hand_tip(
    const struct exh_hand_finger *f, const int32_t *joint_turn_q32, struct exh_vec3 *tip_m_q30)
{
    /*@ assert hand_tip: hand(f) && \initialized(joint_turn_q32 + (0 .. 2)); */
    *tip_m_q30 = any_vec3();
}

void exh_hand_tip_slope(const struct exh_hand_finger *f, const int32_t *joint_turn_q32,
    struct exh_vec3 *tip_m_q30, struct exh_vec3 *slope_q24)
{
    /*@ assert hand_tip_slope: hand(f) && \initialized(joint_turn_q32 + (0 .. 2)); */
    *tip_m_q30 = any_vec3();
    *slope_q24 = any_vec3();
}

/* --- bytes --- */

void exh_bytes_u8(struct exh_bytes *c, uint8_t *v)
{
    (void)c;
    *v = any8();
}

void exh_bytes_i16(struct exh_bytes *c, int16_t *v)
{
    (void)c;
    *v = (int16_t)Frama_C_interval(INT16_MIN, INT16_MAX);
}

void exh_bytes_u32(struct exh_bytes *c, uint32_t *v)
{
    (void)c;
    *v = any_u32();
}

void exh_bytes_i32(struct exh_bytes *c, int32_t *v)
{
    (void)c;
    *v = any32();
}

void exh_bytes_i32s(struct exh_bytes *c, int32_t *v, uint32_t n)
{
    (void)c;
    /*@ assert bytes_i32s: \valid(v + (0 .. n - 1)); */
    Frama_C_make_unknown((char *)v, 4 * n);
}

void exh_bytes_i64(struct exh_bytes *c, int64_t *v)
{
    (void)c;
    *v = any64();
}

#endif
