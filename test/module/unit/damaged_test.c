/* SPDX-License-Identifier: MIT */
/* Configuration in damaged memory, until the guard detects it. A tick may give any values within
 * its limits, but no index leaves its array, no shift its word and no loop its end. The sanitizers
 * of the unit tests detect that. */
#include "exhand/drive.h"
#include "exhand/filter.h"
#include "exhand/frame.h"
#include "exhand/glove.h"
#include "exhand/precontact.h"
#include "exhand/quad.h"
#include "exhand/quantizer.h"
#include "exhand/safety.h"
#include "exhand/table.h"
#include "exhand/velocity.h"

#include "check.h"

#define ROUNDS 1500u
#define TICKS  24u

static uint32_t seed = 1;

static uint32_t any(void)
{
    seed = seed * 1664525u + 1013904223u;
    return seed >> 8 ^ seed << 13;
}

static int32_t any_i32(void) { return (int32_t)(any() - UINT32_C(0x80000000)); }

/* One bit of it in one round, every byte in the next. */
static void damage(void *memory, size_t size_B, uint32_t round)
{
    uint8_t *byte = memory;
    if (round & 1) {
        for (size_t i = 0; i < size_B; i++) { byte[i] = (uint8_t)any(); }
    } else {
        byte[any() % size_B] ^= (uint8_t)(1u << any() % 8);
    }
}

static const struct exh_period T = {1, 1000};
static const struct exh_velocity_scale scale = {EXH_Q(6632, 100000000, EXH_Q_STEP), {1, 1000}};

TEST(velocity)
{
    for (uint32_t r = 0; r < ROUNDS; r++) {
        const struct exh_velocity_par par = {(int32_t)(r % 5)};
        struct exh_velocity_window_cfg window_cfg;
        struct exh_velocity_foaw_cfg foaw_cfg;
        struct exh_velocity_pole_cfg pole_cfg;
        struct exh_velocity_track_cfg track_cfg;
        struct exh_velocity_window window = {{0}, 0, 0};
        struct exh_velocity_foaw foaw = {{0}, 0, 0};
        struct exh_velocity_pole pole = {0, 0, 0};
        struct exh_velocity_track track = {0, 0, 0, 0};
        memset(&foaw_cfg, 0, sizeof foaw_cfg);
        CHECK_EQ_I64(exh_velocity_window_setup(&window_cfg, scale, &par), 0);
        CHECK_EQ_I64(exh_velocity_foaw_setup(&foaw_cfg, scale, 1 + r % 16, 1), 0);
        CHECK_EQ_I64(exh_velocity_pole_setup(&pole_cfg, scale, r), 0);
        CHECK_EQ_I64(exh_velocity_track_setup(&track_cfg, scale, r), 0);
        damage(&window_cfg, sizeof window_cfg, r);
        damage(&foaw_cfg, sizeof foaw_cfg, r);
        damage(&pole_cfg, sizeof pole_cfg, r);
        damage(&track_cfg, sizeof track_cfg, r);
        for (uint32_t k = 0; k < TICKS; k++) {
            const int32_t cnt = any_i32() >> any() % 31;
            (void)exh_velocity_window_step(&window, &window_cfg, cnt);
            CHECK(window.at < EXH_VELOCITY_N, "%u", (unsigned)window.at);
            (void)exh_velocity_foaw_step(&foaw, &foaw_cfg, cnt);
            (void)exh_velocity_pole_step(&pole, &pole_cfg, cnt);
            (void)exh_velocity_track_step(&track, &track_cfg, cnt);
        }
    }
}

TEST(encoder_and_quantizer)
{
    static const struct exh_quad_par par = {
        EXH_Q(6632, 100000000, EXH_Q_STEP), EXH_Q(10, 1, EXH_Q_VEL)};
    static const struct exh_quantizer_par step = {11, EXH_Q(20, 1, 16)};
    for (uint32_t r = 0; r < ROUNDS; r++) {
        struct exh_quad_cfg cfg;
        struct exh_quantizer_cfg quantizer_cfg;
        struct exh_quad s;
        struct exh_quantizer quantizer = {0, 0};
        memset(&s, 0, sizeof s);
        CHECK_EQ_I64(exh_quad_setup(&cfg, &par, T, 24), 0);
        CHECK_EQ_I64(exh_quantizer_setup(&quantizer_cfg, &step), 0);
        damage(&cfg.jump_cnt, sizeof cfg.jump_cnt, r);
        damage(&cfg.unused, sizeof cfg.unused, r);
        damage(&quantizer_cfg, sizeof quantizer_cfg, r);
        for (uint32_t k = 0; k < TICKS; k++) {
            (void)exh_quad_step(&s, &cfg, any() & 0xFFFFFF);
            (void)exh_quantizer_step(&quantizer, &quantizer_cfg, any_i32());
        }
    }
}

TEST(filter)
{
    static const int32_t fc_Hz_q16[] = {EXH_Q(30, 1, 16), EXH_Q(300, 1, 16)};
    for (uint32_t r = 0; r < ROUNDS; r++) {
        const struct exh_filter_par par = {(int32_t)(1 + r / 2 % 2), fc_Hz_q16[r / 4 % 2]};
        struct exh_filter_cfg cfg;
        struct exh_filter s;
        uint8_t kind;
        memset(&s, 0, sizeof s);
        CHECK_EQ_I64(exh_filter_setup(&cfg, &par, T), 0);
        kind = cfg.kind;
        damage(&cfg, sizeof cfg, r);
        cfg.kind = kind; /* one that is none ends the run, by an assertion */
        for (uint32_t k = 0; k < TICKS; k++) {
            const int32_t x = any_i32();
            int32_t y;
            exh_filter_step(&s, &cfg, &x, &y, 1);
        }
    }
}

/* --- drive --- */

static const struct exh_drive_par drive_par = {EXH_Q(40, 1, EXH_Q_FORCE), 200000, 200000,
    EXH_Q(66, 10, EXH_Q_CUR), EXH_Q(33, 10, EXH_Q_CUR), 2700, 32768, 12184,
    EXH_Q(324900, 176, EXH_Q_DAC), 0, EXH_Q(5164, 10000000, EXH_Q_MON), EXH_Q(40, 1, EXH_Q_FORCE),
    EXH_Q(66, 10, EXH_Q_CUR)};

/* n of a table can say 256. Knots beyond the two valid ones hold zeros. */
static struct exh_knot knot[256];

static void make_drive(struct exh_drive_cfg *cfg, uint32_t round)
{
    struct exh_table to_cur = {knot, 2}, none = {NULL, 0};
    memset(knot, 0, sizeof knot);
    knot[1].x = EXH_Q(22, 1, EXH_Q_FORCE);
    knot[1].y = EXH_Q(66, 10, EXH_Q_CUR);
    CHECK_EQ_I64(exh_table_setup(knot, 2), 0);
    CHECK_EQ_I64(exh_drive_setup(cfg, &drive_par, T, to_cur, none), 0);
    damage(knot, 2 * sizeof knot[0], round);
    damage(&cfg->force_to_cur.n, 1, round);
    damage(&cfg->f_top_N_q20, sizeof cfg->f_top_N_q20, round);
    damage(&cfg->i_top_A_q26, sizeof cfg->i_top_A_q26, round);
    damage(&cfg->i_whole_A_q26, sizeof cfg->i_whole_A_q26, round);
    damage(&cfg->top_limit, sizeof cfg->top_limit, round);
    damage(&cfg->tick_N_q20, sizeof cfg->tick_N_q20, round);
    damage(&cfg->dac_A_q26, sizeof cfg->dac_A_q26, round);
    damage(&cfg->i2t_budget_q32, sizeof cfg->i2t_budget_q32, round);
    damage(&cfg->i2t_fold, sizeof cfg->i2t_fold, round);
    damage(&cfg->i2t_shift, 1, round);
}

TEST(drive)
{
    for (uint32_t r = 0; r < ROUNDS; r++) {
        struct exh_permit permit = {EXH_PERMIT_OPEN, INT32_C(1) << 30, 1 << 20, 1, {1 << 30, 34}};
        struct exh_drive_cfg cfg;
        struct exh_drive s;
        struct exh_safety box;
        memset(&s, 0, sizeof s);
        memset(&box, 0, sizeof box);
        make_drive(&cfg, r);
        damage(&permit.fall, sizeof permit.fall, r);
        box.state = EXH_STATE_RUN;
        box.fingers = 1;
        for (uint32_t k = 0; k < TICKS; k++) {
            struct exh_force_ledger f;
            struct exh_current_ledger i;
            struct exh_drive_out out;
            uint32_t limits;
            memset(&f, 0, sizeof f);
            f.spring_N_q20 = any_i32() / 16;
            if (k == TICKS - 6) { permit.mode = EXH_PERMIT_RELEASE; }
            limits = exh_drive_force_step(&s, &cfg, &permit, &f);
            limits |= exh_drive_current_step(&s, &cfg, &f, &i);
            exh_gate_step(&box, &cfg, 1, &i, &limits, &out);
            /* The board's own D/A limit, from its parameters, still holds. */
            CHECK(out.dac_raw[0] >= 32768 - 12184 && out.dac_raw[0] <= 32768 + 12184, "%u",
                (unsigned)out.dac_raw[0]);
        }
    }
}

/* A straight line of two knots: one bit makes it none, which must not be four milliards. */
TEST(a_table_of_no_knots_ends)
{
    const struct exh_table none = {knot, 0};
    memset(knot, 0, sizeof knot);
    CHECK_EQ_I64(exh_table_at(none, 12345), 0);
}

/* --- glove, passivity, planes --- */

TEST(glove)
{
    static struct exh_glove_cal cal;
    static struct exh_glove s;
    static const struct exh_glove power_on;
    struct exh_glove_par par;
    int32_t *v = &par.order;
    for (unsigned i = 0; i < EXH_GLOVE_ROWS; i++) { v[i] = exh_glove_rows[i].dflt; }
    for (uint32_t r = 0; r < ROUNDS / 4; r++) {
        struct exh_glove_cfg cfg;
        uint8_t kind;
        cal = exh_glove_cal_default;
        s = power_on;
        CHECK_EQ_I64(exh_glove_setup(&cfg, &par, &cal, T), 0);
        kind = cfg.filter.kind;
        damage(&cfg, sizeof cfg, r);
        damage(cal.sensor, sizeof cal.sensor, r);
        cfg.cal = &cal;
        cfg.filter.kind = kind;
        for (uint32_t k = 0; k < TICKS; k++) {
            int32_t angle_turn_q32[EXH_GLOVE_SENSORS];
            struct exh_glove_in in;
            memset(&in, 0, sizeof in);
            for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
                in.raw[i] = (int16_t)(any_i32() >> 16);
            }
            (void)exh_glove_step(&s, &cfg, &in, angle_turn_q32);
        }
    }
}

TEST(planes)
{
    static const struct exh_material_par material[2] = {{1024, 0, 1 << 20}, {2048, 0, 1 << 20}};
    struct exh_precontact_par par;
    int32_t *v = &par.d_lim_m_q30;
    for (unsigned i = 0; i < EXH_PRECONTACT_ROWS; i++) { v[i] = exh_precontact_rows[i].dflt; }
    for (uint32_t r = 0; r < ROUNDS; r++) {
        struct exh_precontact_cfg cfg;
        struct exh_precontact s;
        struct exh_plane plane;
        struct exh_precontact_in in;
        memset(&s, 0, sizeof s);
        memset(&plane, 0, sizeof plane);
        memset(&in, 0, sizeof in);
        CHECK_EQ_I64(exh_precontact_setup(&cfg, &par, material, 2, 0, T), 0);
        damage(&cfg.pad_m_q60, sizeof cfg.pad_m_q60, r);
        damage(&cfg.age_ticks, sizeof cfg.age_ticks, r);
        plane.kind = EXH_PLANE_HIT;
        plane.normal_q30.z = 1 << 30;
        for (uint32_t k = 0; k < TICKS; k++) {
            plane.point_m_q30.z = any_i32() / 4;
            in.tip_m_q30.z = any_i32() / 4;
            (void)exh_precontact_update(&s, &cfg, &plane, 0);
            (void)exh_precontact_step(&s, &cfg, &in);
        }
    }
}

TEST_MAIN("unit/damaged", velocity, encoder_and_quantizer, filter, drive, a_table_of_no_knots_ends,
    glove, planes);
