/* SPDX-License-Identifier: MIT */
/* axis.h: every subset of parts does what its modules do when they are called one by one. */
#include "exhand/exhand.h"

#include "check.h"

#include <string.h>

/* All parts of one finger, with set-ups. */
struct finger {
    struct exh_quad_cfg quad_cfg;
    struct exh_velocity_window_cfg velocity_cfg;
    struct exh_motion_cfg watch_cfg;
    struct exh_tracking_cfg track_cfg;
    struct exh_chatter_cfg chatter_cfg;
    struct exh_drive_cfg drive_cfg;
    struct exh_safety_cfg safety_cfg;
    struct exh_quad quad;
    struct exh_velocity_window velocity;
    struct exh_motion watch;
    struct exh_tracking track;
    struct exh_chatter chatter;
    struct exh_drive drive;
    struct exh_safety safety;
};

static const struct exh_quad_par quad_par = {
    EXH_Q(5, 1000000, EXH_Q_STEP), EXH_Q(10, 1, EXH_Q_VEL)};
static const struct exh_velocity_par velocity_par = {2};
static const struct exh_motion_par watch_par = {
    EXH_Q(1, 10, EXH_Q_VEL), 2, 100, EXH_Q(1, 4, EXH_Q_CUR)};
static const struct exh_tracking_par track_par = {EXH_Q(1, 4, EXH_Q_CUR), 20};
/* Reported early: the limit is the 1 mJ that the motor gives as the string retracts. */
static const struct exh_chatter_par chatter_par = {EXH_Q(1, 100, 20), EXH_Q(1, 1000, 24)};
static const struct exh_drive_par drive_par = {.f_max_N_q20 = EXH_Q(10, 1, EXH_Q_FORCE),
    .slew_up_Nps = 1000,
    .slew_down_Nps = 1000,
    .i_peak_A_q26 = EXH_Q(33, 10, EXH_Q_CUR),
    .i_cont_A_q26 = EXH_Q(33, 10, EXH_Q_CUR),
    .peak_ms = 2700,
    .dac_zero_raw = 32768,
    .dac_span_raw = 12184,
    .dac_rawpA_q16 = EXH_Q(324900, 176, EXH_Q_DAC),
    .mon_A_q40 = EXH_Q(5164, 10000000, EXH_Q_MON),
    .person_N_q20 = EXH_Q(10, 1, EXH_Q_FORCE),
    .person_A_q26 = EXH_Q(33, 10, EXH_Q_CUR)};
static const struct exh_safety_par safety_par = {1, EXH_Q(1, 1, EXH_Q_FORCE), 50, 500, 15};
static struct exh_knot knot[2] = {
    {0, 0, {0, 0}}, {EXH_Q(22, 1, EXH_Q_FORCE), EXH_Q(66, 10, EXH_Q_CUR), {0, 0}}};
static const struct exh_period T = {1, 1000};
static const struct exh_table no_table = {NULL, 0};

enum { VELOCITY = 1, WATCH = 2, TRACK = 4, CHATTER = 8, SUBSETS = 16 };

static struct exh_table to_cur(void)
{
    CHECK_EQ_I64(exh_table_setup(knot, 2), 0);
    return (struct exh_table){knot, 2};
}

static struct exh_axis_setup parts_of(struct finger *f, unsigned parts)
{
    return (struct exh_axis_setup){.quad = &f->quad_cfg,
        .quad_par = &quad_par,
        .velocity = parts & VELOCITY ? &f->velocity_cfg : NULL,
        .velocity_par = &velocity_par,
        .watch = parts & WATCH ? &f->watch_cfg : NULL,
        .watch_par = &watch_par,
        .track = parts & TRACK ? &f->track_cfg : NULL,
        .track_par = &track_par,
        .chatter = parts & CHATTER ? &f->chatter_cfg : NULL,
        .chatter_par = &chatter_par,
        .drive = &f->drive_cfg,
        .drive_par = &drive_par};
}

static struct exh_axis axis_of(struct finger *f, unsigned parts)
{
    return (struct exh_axis){.quad = &f->quad,
        .quad_cfg = &f->quad_cfg,
        .velocity = parts & VELOCITY ? &f->velocity : NULL,
        .velocity_cfg = &f->velocity_cfg,
        .watch = parts & WATCH ? &f->watch : NULL,
        .watch_cfg = &f->watch_cfg,
        .track = parts & TRACK ? &f->track : NULL,
        .track_cfg = &f->track_cfg,
        .chatter = parts & CHATTER ? &f->chatter : NULL,
        .chatter_cfg = &f->chatter_cfg,
        .drive = &f->drive,
        .drive_cfg = &f->drive_cfg};
}

/* What the board reads at tick t: the string speeds up, goes back, and is lost. The monitor follows
 * for a while, then it is 0. */
static struct exh_drive_in read_at(uint32_t t, int16_t mon_raw)
{
    const uint32_t cnt = t < 900 ? t * t / 50 : 16200 - (t - 900) * 14;
    struct exh_drive_in in = {.enc_raw = {7, 7, t == 1900 ? cnt + 0x400000u : cnt, 7, 7},
        .mon_raw = {9, 9, t < 1500 ? mon_raw : 0, 9, 9},
        .din = 0x1Fu | EXH_DIN_DRIVE0};
    return in;
}

/* A law that asks for more, the further out. */
static struct exh_force_ledger law(int32_t pos_m_q30)
{
    struct exh_force_ledger f = {0};
    f.spring_N_q20 = pos_m_q30 > 0 ? pos_m_q30 / 16 : 0;
    return f;
}

static struct exh_safety_in box_of(uint32_t t, uint32_t raised, uint8_t ready)
{
    return (struct exh_safety_in){.din = 0x1Fu | EXH_DIN_DRIVE0,
        .raised = raised,
        .missed = 0,
        .command = t == 3 ? EXH_CMD_RUN : EXH_CMD_NONE,
        .fingers = 1,
        .ready = ready};
}

/* One tick by the modules themselves. */
static struct exh_drive_out by_hand(
    struct finger *f, unsigned parts, uint32_t t, int16_t mon_raw, struct exh_axis_now *now)
{
    const struct exh_drive_in in = read_at(t, mon_raw);
    struct exh_current_ledger i;
    struct exh_drive_out out;
    struct exh_force_ledger force;
    struct exh_permit permit;
    memset(now, 0, sizeof *now);
    now->cnt = exh_quad_step(&f->quad, &f->quad_cfg, in.enc_raw[2]);
    now->pos_m_q30 = exh_quad_pos_m_q30(&quad_par, now->cnt);
    if (parts & VELOCITY) {
        now->vel_mps_q27 = exh_velocity_window_step(&f->velocity, &f->velocity_cfg, now->cnt);
    }
    if (parts & WATCH) {
        now->raised |= exh_motion_step(&f->watch, &f->watch_cfg, &now->vel_mps_q27, &now->limits);
    }
    if (parts & CHATTER) { now->raised |= exh_chatter_step(&f->chatter, &f->chatter_cfg); }
    if (parts & TRACK) {
        now->mon_A_q26 = exh_drive_monitor_A_q26(&f->drive_cfg, in.mon_raw[2]);
        if (exh_tracking_step(&f->track, &f->track_cfg, now->mon_A_q26)) {
            now->raised |= EXH_FAULT_TRACKING;
        }
    }
    if (f->quad.lost) { now->raised |= EXH_FAULT_ENCODER; }
    permit = exh_safety_step(&f->safety, &f->safety_cfg,
        box_of(t, now->raised, (uint8_t)(f->quad.lost ? 0x7u : (unsigned)EXH_ARM_ALL)));
    force = law(now->pos_m_q30);
    now->limits |= exh_drive_force_step(&f->drive, &f->drive_cfg, &permit, &force);
    now->limits |= exh_drive_current_step(&f->drive, &f->drive_cfg, &force, &i);
    exh_gate_step(&f->safety, &f->drive_cfg, 1, &i, &now->limits, &out);
    if (parts & TRACK) { exh_tracking_update(&f->track, i.coded_A_q26); }
    if (parts & WATCH) { exh_motion_update(&f->watch, &f->watch_cfg, now->cnt, i.coded_A_q26); }
    if (parts & CHATTER) {
        exh_chatter_update(&f->chatter, &f->chatter_cfg, now->cnt, i.coded_A_q26);
    }
    return out;
}

/* The same by the axis. */
static struct exh_drive_out by_axis(
    struct finger *f, unsigned parts, uint32_t t, int16_t mon_raw, struct exh_axis_now *now)
{
    const struct exh_drive_in in = read_at(t, mon_raw);
    const struct exh_axis axis = axis_of(f, parts);
    struct exh_permit permit;
    struct exh_force_ledger force;
    struct exh_current_ledger i;
    struct exh_drive_out out;
    *now = exh_axis_sense(&axis, &in, 2);
    permit = exh_axis_permit(&f->safety, &f->safety_cfg, now, 1, box_of(t, 0, 0x7u));
    force = law(now->pos_m_q30);
    now->limits |= exh_axis_force(&axis, &permit, &force, &i);
    exh_axis_out(&axis, &f->safety, now->cnt, &i, &now->limits, &out);
    return out;
}

TEST(each_subset_of_parts_is_its_modules_in_order)
{
    for (unsigned parts = 0; parts < SUBSETS; parts++) {
        static struct finger a, b;
        const struct exh_axis_setup setup = parts_of(&a, parts);
        const int fast = (parts & WATCH) && (parts & VELOCITY);
        uint32_t seen = 0;
        uint16_t code = 32768;
        memset(&a, 0, sizeof a);
        CHECK_EQ_I64(exh_axis_setup(&setup, T, 24, to_cur(), no_table), 0);
        CHECK_EQ_I64(exh_safety_setup(&a.safety_cfg, &safety_par, T), 0);
        b = a;
        for (uint32_t t = 0; t < 2000; t++) {
            const int16_t mon_raw = (int16_t)(((int32_t)code - 32768) * 1049 / 1000);
            struct exh_axis_now now, want;
            const struct exh_drive_out out = by_axis(&a, parts, t, mon_raw, &now);
            const struct exh_drive_out same = by_hand(&b, parts, t, mon_raw, &want);
            CHECK(memcmp(&a, &b, sizeof a) == 0, "state, parts %u, tick %u", parts, (unsigned)t);
            CHECK(now.cnt == want.cnt && now.pos_m_q30 == want.pos_m_q30 &&
                      now.vel_mps_q27 == want.vel_mps_q27 && now.mon_A_q26 == want.mon_A_q26 &&
                      now.raised == want.raised && now.limits == want.limits,
                "sensed, parts %u, tick %u", parts, (unsigned)t);
            CHECK(out.dac_raw[0] == same.dac_raw[0] && out.enable == same.enable &&
                      out.alive == same.alive,
                "out, parts %u, tick %u", parts, (unsigned)t);
            seen |= now.raised;
            code = out.dac_raw[0];
        }
        /* The run meets what each part is there for. A speed fault ends the force, and so what
         * tracking compares. */
        CHECK(seen & EXH_FAULT_ENCODER, "encoder, parts %u", parts);
        CHECK(((seen & EXH_FAULT_SPEED) != 0) == fast, "speed, parts %u", parts);
        CHECK(((seen & EXH_FAULT_TRACKING) != 0) == ((parts & TRACK) && !fast),
            "tracking, parts %u", parts);
    }
}

/* The first part that refuses ends it, and names its own cause. */
TEST(setup_refuses_as_its_parts_do)
{
    static struct finger a;
    const struct exh_axis_setup good = parts_of(&a, VELOCITY | WATCH | TRACK | CHATTER);
    static const struct exh_velocity_par no_window = {5};
    static const struct exh_motion_par no_speed = {0, 1, 0, EXH_Q(1, 4, EXH_Q_CUR)};
    static const struct exh_tracking_par no_time = {EXH_Q(1, 4, EXH_Q_CUR), 0};
    static const struct exh_drive_par no_drive;
    static const struct exh_quad_par no_step = {0, EXH_Q(10, 1, EXH_Q_VEL)};
    static const struct exh_chatter_par no_power;
    struct exh_axis_setup bad[6] = {good, good, good, good, good, good};
    bad[0].quad_par = &no_step;
    bad[1].velocity_par = &no_window;
    bad[2].watch_par = &no_speed;
    bad[3].track_par = &no_time;
    bad[4].drive_par = &no_drive;
    bad[5].chatter_par = &no_power;
    CHECK_EQ_I64(exh_axis_setup(&good, T, 24, to_cur(), no_table), 0);
    for (size_t k = 0; k < 6; k++) {
        CHECK_EQ_I64(exh_axis_setup(&bad[k], T, 24, to_cur(), no_table), -EXH_E_RANGE);
    }
    /* A part that is left out is not asked. */
    bad[2].watch = NULL;
    CHECK_EQ_I64(exh_axis_setup(&bad[2], T, 24, to_cur(), no_table), 0);
    CHECK_EQ_I64(exh_axis_setup(&good, T, 8, to_cur(), no_table), -EXH_E_RANGE);
}

/* Causes of all fingers in use come to safety, none of the others; one lost encoder takes the step
 * of arming away. */
TEST(permit_hears_every_finger)
{
    for (unsigned n = 1; n <= EXH_FINGERS; n++) {
        for (unsigned k = 0; k < EXH_FINGERS; k++) {
            struct exh_safety_cfg cfg;
            struct exh_safety s = {0};
            struct exh_axis_now now[EXH_FINGERS] = {{0}};
            struct exh_safety_in box = box_of(3, EXH_FAULT_LINK, 0x7u);
            box.din |= 0x1Fu * EXH_DIN_DRIVE0;
            CHECK_EQ_I64(exh_safety_setup(&cfg, &safety_par, T), 0);
            now[k].raised = EXH_FAULT_ENCODER;
            (void)exh_axis_permit(&s, &cfg, now, n, box);
            CHECK_EQ_I64(s.present, EXH_FAULT_LINK | (k < n ? EXH_FAULT_ENCODER : 0u));
            CHECK_EQ_I64(s.fingers, n);
            CHECK_EQ_I64(s.refused, k < n ? EXH_ARM_ENCODER : EXH_ARM_DEADMAN);
        }
    }
}

TEST_MAIN("unit/axis", each_subset_of_parts_is_its_modules_in_order, setup_refuses_as_its_parts_do,
    permit_hears_every_finger);
