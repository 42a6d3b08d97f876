/* SPDX-License-Identifier: MIT */
/* angle and hand: sine and cosine, sensors to joints to a fingertip and its slope. */
#include "modules.h"

#include "exhand/angle.h"
#include "exhand/fix.h"
#include "exhand/hand.h"

void golden_angle(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave x;
    struct golden_rng r = golden_rng("angle", rate_Hz, 0);
    golden_wave(&x, "angle", rate_Hz, 1, INT32_MIN, INT32_MAX, INT32_C(1) << 24);
    while (g->tick < GOLDEN_TICKS) {
        const uint32_t eighth = (uint32_t)golden_draw(&r, 0, 7);
        const int32_t near = exh_from_u32((eighth << 29) + (uint32_t)golden_draw(&r, -3, 3));
        struct exh_sincos y;
        golden_put(g, x.at[g->tick]);
        golden_put(g, near);
        exh_sincos(x.at[g->tick], &y);
        golden_put(g, y.sin_q30);
        golden_put(g, y.cos_q30);
        exh_sincos(near, &y);
        golden_put(g, y.sin_q30);
        golden_put(g, y.cos_q30);
        golden_tick(g);
    }
}

static int32_t any_size(struct golden_rng *r, int32_t lo, int32_t hi)
{
    const int64_t any = golden_draw(r, lo, hi);
    return (int32_t)(any >> golden_draw(r, 0, 8));
}

static void any_joint(struct golden_rng *r, struct exh_hand_joint *j)
{
    j->bias_turn_q32 = any_size(r, INT32_MIN, INT32_MAX);
    for (int t = 0; t < EXH_HAND_TERMS; t++) {
        j->gain_q24[t] = any_size(r, -(INT32_C(1) << 27), INT32_C(1) << 27);
    }
    for (int t = 0; t < EXH_HAND_TERMS; t++) { j->sensor[t] = (uint8_t)golden_draw(r, 0, 21); }
    j->lo_turn_q32 = (int32_t)golden_draw(r, INT32_MIN, 0);
    j->hi_turn_q32 = (int32_t)golden_draw(r, 0, INT32_MAX);
}

static void any_bones(struct golden_rng *r, struct exh_hand_bones *b)
{
    struct golden_turn t;
    struct golden_turn u;
    for (int i = 0; i < 3; i++) { b->len_m_q34[i] = (int32_t)golden_draw(r, 1, 687194767); }
    t = golden_any_turn(r);
    u = golden_any_turn(r);
    const int64_t rot[3][3] = {{t.c * u.d, -t.s * u.c, t.s * u.s},
        {t.s * u.d, t.c * u.c, -t.c * u.s}, {0, u.s * t.d, u.c * t.d}};
    for (int i = 0; i < 9; i++) {
        b->rot_q30[i / 3][i % 3] = golden_q30(rot[i / 3][i % 3], t.d * u.d);
    }
    for (int i = 0; i < 3; i++) {
        b->base_m_q32[i] = (int32_t)golden_draw(r, -536870912, 536870912);
    }
}

struct some_hand {
    struct exh_hand_map map;
    struct exh_hand_bones bones[EXH_FINGERS];
    struct exh_hand_finger finger[EXH_FINGERS];
};

static void any_hand(struct golden_rng *r, struct some_hand *h)
{
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        struct exh_hand_par par = {.pad_m_q30 = 0};
        for (unsigned j = 0; j < EXH_HAND_JOINTS; j++) { any_joint(r, &h->map.joint[f][j]); }
        any_bones(r, &h->bones[f]);
        par.arm1_m_q30 = (int32_t)golden_draw(r, 4294968, 53687091);
        par.arm2_m_q30 = (int32_t)golden_draw(r, 0, 53687091);
        par.arm3_m_q30 = (int32_t)golden_draw(r, 0, 53687091);
        CHECK_EQ_I64(exh_hand_setup(&h->finger[f], &h->bones[f], &par), 0);
        for (unsigned j = 0; j < 2; j++) {
            h->map.bent[f][j] = h->map.joint[f][1 + j].sensor[golden_draw(r, 0, 1)];
        }
        h->map.bent[f][2] = h->map.joint[f][1 + golden_draw(r, 0, 1)].sensor[golden_draw(r, 0, 1)];
        /* Where it is refused, the finger is as it was. */
        if (golden_draw(r, 0, 3) != 0) { (void)exh_hand_couple(&h->finger[f], &h->map, f); }
    }
    CHECK_EQ_I64(exh_hand_map_validate(&h->map), 0);
}

static void put_vec(struct golden *g, const struct exh_vec3 *v)
{
    golden_put(g, v->x);
    golden_put(g, v->y);
    golden_put(g, v->z);
}

void golden_hand(struct golden *g, uint32_t rate_Hz)
{
    static struct golden_wave w[4];
    static struct some_hand h;
    struct golden_rng r = golden_rng("hand", rate_Hz, 0);
    for (uint32_t i = 0; i < 4; i++) {
        golden_wave(&w[i], "hand", rate_Hz, 1 + i, INT32_MIN, INT32_MAX,
            INT32_C(1) << golden_draw(&r, 16, 28));
    }
    while (g->tick < GOLDEN_TICKS) {
        const unsigned f = g->tick % EXH_FINGERS;
        int32_t sensor[EXH_GLOVE_SENSORS];
        int32_t joint[EXH_HAND_JOINTS];
        struct exh_vec3 tip;
        struct exh_vec3 again;
        struct exh_vec3 slope;
        if (g->tick == 0 || g->tick == GOLDEN_AGAIN) { any_hand(&r, &h); }
        for (int i = 0; i < EXH_GLOVE_SENSORS; i++) { sensor[i] = w[i & 3].at[g->tick] ^ i; }
        golden_put(g, f);
        golden_put(g, exh_hand_joints(&h.map, f, sensor, joint));
        for (int j = 0; j < EXH_HAND_JOINTS; j++) { golden_put(g, joint[j]); }
        exh_hand_tip(&h.finger[f], joint, &tip);
        exh_hand_tip_slope(&h.finger[f], joint, &again, &slope);
        put_vec(g, &tip);
        put_vec(g, &slope);
        if (memcmp(&tip, &again, sizeof tip) != 0) { CHECK(0, "two calls, two fingertips"); }
        golden_tick(g);
    }
}
