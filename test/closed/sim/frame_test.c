/* SPDX-License-Identifier: MIT */
/* Scene bilateral: a glove frame that is computed in parts, tick by tick. */
#include "check.h"

#include "bilateral/bilateral.h"

#include "exhand/error.h"

#include <string.h>

#define N       BILATERAL_FINGERS
#define RATE_HZ 10000
#define PARTS   7

struct rig {
    struct bilateral_par par;
    struct bilateral_cfg cfg;
    struct bilateral box;
    struct bilateral_signals sig;
    struct exh_scene_in in;
};

/* Abduction sensors have two cross terms each. */
static void start_with(struct rig *r, int every, int fingers, int order)
{
    static const struct rig none;
    static const uint8_t abduction[] = {3, 10, 14, 18};
    *r = none;
    exh_scene_bilateral.defaults();
    memcpy(&r->par, exh_scene_bilateral.params->active, sizeof r->par);
    r->par.calib.uncalibrated = 1;
    r->par.own.session = 7;
    r->par.own.fingers = fingers;
    r->par.glove_own.every = every;
    r->par.glove.order = order;
    for (unsigned i = 0; i < LEN(abduction); i++) {
        struct glove_sensor_par *s = &r->par.sensor[abduction[i]];
        s->of[0] = abduction[i] - 3;
        s->of[1] = abduction[i] - 2;
        s->cross_q30[0] = s->cross_q30[1] = INT32_C(1) << 29;
    }
    r->in.glove.age_ticks = UINT16_MAX;
    CHECK_EQ_I64(bilateral_setup(
                     &r->cfg, &r->box, &r->par, (struct exh_scene_board){{1, RATE_HZ}, 16}, NULL),
        0);
}

/* Without a low-pass, which is another for another time between frames. */
static void start(struct rig *r, int every) { start_with(r, every, 31, 0); }

/* All knuckles bent by so many codes. */
static void tick(struct rig *r, int glove_new, int bent_raw)
{
    static struct exh_scene_mail none;
    struct exh_drive_out out;
    r->in.glove_new = (uint8_t)glove_new;
    if (r->in.glove.age_ticks < UINT16_MAX) { r->in.glove.age_ticks++; }
    for (unsigned i = 0; glove_new && i < EXH_GLOVE_SENSORS; i++) {
        r->in.glove.age_ticks = 3;
        r->in.glove.raw[i] =
            (int16_t)((exh_glove_cal_default.sensor[i].zero_raw_q15 >> 15) + bent_raw);
    }
    bilateral_tick(&r->box, &r->cfg, &r->in, &none, exh_scene_bilateral.params, &out, &r->sig);
}

static int same_tip(const struct rig *a, const struct rig *b, unsigned f)
{
    return memcmp(&a->box.finger[f].tip_m_q30, &b->box.finger[f].tip_m_q30,
               sizeof a->box.finger[f].tip_m_q30) == 0;
}

static uint32_t age(const struct rig *r, unsigned f)
{
    return bilateral_finger_age(&r->box, &r->cfg, f);
}

/* Two fingers are seen in the fifth tick of a frame, two in the sixth, one in the seventh; each is
 * as old as the frame it is of. What is seen in the end is what one tick would have made. */
TEST(fingers_are_seen_one_after_the_other)
{
    static const int at[N] = {4, 4, 5, 5, 6};
    static struct rig whole, parts;
    start(&whole, 1);
    start(&parts, 20);
    for (int frame = 0; frame < 10; frame++) {
        const uint32_t before = frame == 0 ? UINT32_MAX : 3 + 20;
        for (int k = 0; k < 20; k++) {
            if (k == 0) { tick(&whole, 1, 200 * frame); }
            tick(&parts, k == 0, 200 * frame);
            for (unsigned f = 0; f < N; f++) {
                const uint32_t old = before == UINT32_MAX ? before : before + (uint32_t)k;
                CHECK(k < at[f] || same_tip(&whole, &parts, f), "frame %d, %d: %u", frame, k, f);
                CHECK(k >= at[f] || !same_tip(&whole, &parts, f), "frame %d, %d: %u", frame, k, f);
                CHECK_EQ_I64(age(&parts, f), k >= at[f] ? 3 + (uint32_t)k : old);
            }
        }
    }
}

TEST(a_frame_is_whole_by_the_next)
{
    static struct rig r;
    for (int every = 1; every < 10; every++) {
        start(&r, every);
        for (int k = 0; k < 50; k++) {
            const int left = every < PARTS ? every : PARTS;
            tick(&r, k % every == 0, 10 * k);
            CHECK_EQ_I64(r.box.frame.left, k % every + 1 < left ? left - 1 - k % every : 0);
        }
    }
    start(&r, 20);
    tick(&r, 1, 0);
    tick(&r, 0, 0);
    CHECK_EQ_I64(r.box.frame.left, PARTS - 2);
    tick(&r, 1, 3000); /* before its time: the one before is whole first */
    CHECK_EQ_I64(r.box.frame.left, PARTS - 1);
    CHECK_EQ_I64(age(&r, 4), UINT32_MAX);
    CHECK(r.box.finger[4].tip_m_q30.x != 0, "a finger has never been seen");
}

/* A fault holds from the first tick of the frame that has it to the last tick of the first frame
 * without it. Until then a finger may still be computed from a held angle. */
TEST(a_fault_begins_at_once_and_ends_with_the_last_finger)
{
    static struct rig r;
    int told = 0;
    start(&r, 20);
    r.par.glove.debounce_frames = 1;
    CHECK_EQ_I64(
        exh_glove_setup(&r.cfg.glove, &r.par.glove, &r.cfg.cal, (struct exh_period){20, RATE_HZ}),
        0);
    for (int k = 0; k < 20; k++) { tick(&r, k == 0, 0); }
    for (int k = 0; k < 20; k++) {
        tick(&r, k == 0, 32767);
        told += r.box.glove_faults != 0;
        CHECK_EQ_I64(age(&r, 2), UINT32_MAX);
    }
    CHECK_EQ_I64(told, 20);
    for (int k = 0; k < 20; k++) {
        tick(&r, k == 0, 0);
        CHECK(age(&r, 2) == (k < PARTS - 1 ? UINT32_MAX : 3u + (uint32_t)k), "%d", k);
    }
}

/* A finger alone has the position that it has in a whole hand. The wrist has no angle there: its
 * code stays. */
TEST(a_finger_alone_needs_few_sensors)
{
    static const int every[] = {1, 3, 20};
    static struct rig hand, alone;
    for (unsigned f = 0; f < N; f++) {
        for (unsigned e = 0; e < LEN(every); e++) {
            start_with(&hand, every[e], 31, 2);
            start_with(&alone, every[e], 1 << f, 2);
            CHECK(alone.cfg.sensors >> EXH_GLOVE_PALM_ARCH == 0, "%u", (unsigned)alone.cfg.sensors);
            for (int k = 0; k < 20 * every[e]; k++) {
                const int bent_raw = check_i32_in(-3000, 3000), last = (k + 1) % every[e] == 0;
                tick(&hand, k % every[e] == 0, bent_raw);
                tick(&alone, k % every[e] == 0, bent_raw);
                CHECK(!last || same_tip(&hand, &alone, f), "%u, %d: tick %d", f, every[e], k);
            }
            CHECK_EQ_I64(alone.box.frame.angle_turn_q32[EXH_GLOVE_WRIST_YAW],
                alone.in.glove.raw[EXH_GLOVE_WRIST_YAW] * 65536);
        }
    }
}

/* The position of a finger that rests is kept. It is the one of its joints in every frame, also
 * after a change of the rule for s; a damaged one heals within 8 frames. */
TEST(a_position_is_kept_while_the_joints_stay)
{
    static struct rig r;
    struct bilateral_finger *s = &r.box.finger[1];
    int32_t *sloped = &r.par.precontact[1].from_slope;
    int bent_raw = 0, kept = 0;
    start(&r, 1);
    for (int k = 0; k < 5000; k++) {
        struct exh_hand_finger hand = r.cfg.finger[1].hand;
        struct exh_vec3 tip, slope;
        if (k % 50 == 15) { *sloped = !*sloped; }
        if (k % 50 == 30) { bent_raw = check_i32_in(-6000, 6000); }
        if (k % 50 == 49) { s->tip_m_q30.y ^= 1 << check_i32_in(0, 30); }
        tick(&r, 1, bent_raw);
        for (unsigned i = 0; i < 2; i++) {
            if (s->clamped >> (i + 1) & 1) { hand.pull_radpm_q20[i] = 0; }
        }
        exh_hand_tip_slope(&hand, s->joint_turn_q32, &tip, &slope);
        kept += memcmp(&tip, &s->tip_m_q30, sizeof tip) != 0;
        CHECK((k + 1) % 50 < 7 || memcmp(&tip, &s->tip_m_q30, sizeof tip) == 0, "tick %d", k);
        CHECK(!*sloped || memcmp(&slope, &s->slope_q24, sizeof slope) == 0, "tick %d", k);
    }
    CHECK(kept > 0, "no damage outlived a frame: nothing is kept here");
}

/* A position from bytes is computed again, whatever was kept before. Here they are of a finger
 * without a frame, whose joints are 0 as those of a straight one. */
TEST(a_position_from_bytes_is_not_kept)
{
    static struct rig r;
    struct bilateral_finger fresh = {.keep_frames = 0}, old = {.keep_frames = 0};
    int32_t straight_turn_q32[EXH_GLOVE_SENSORS];
    uint8_t byte[1024];
    struct exh_bytes to = exh_bytes_writer(byte, sizeof byte), from;
    start(&r, 1);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { straight_turn_q32[i] = -EXH_DEG(60, 1); }
    bilateral_finger_bytes(&to, &fresh);
    bilateral_finger_see(&old, &r.cfg, EXH_MIDDLE, straight_turn_q32);
    from = exh_bytes_reader(byte, to.at);
    bilateral_finger_bytes(&from, &old);
    CHECK(exh_bytes_ok(&from) && old.tip_m_q30.x == 0, "the bytes");
    bilateral_finger_see(&fresh, &r.cfg, EXH_MIDDLE, straight_turn_q32);
    bilateral_finger_see(&old, &r.cfg, EXH_MIDDLE, straight_turn_q32);
    CHECK(memcmp(&fresh.tip_m_q30, &old.tip_m_q30, sizeof old.tip_m_q30) == 0, "kept");
}

/* A state from its bytes in the middle of a frame goes on as the other. */
TEST(a_frame_goes_on_from_bytes)
{
    static struct rig a, b;
    static uint8_t byte[2][65536];
    start(&a, 20);
    start(&b, 20);
    for (int k = 0; k < 60; k++) {
        struct exh_bytes to = exh_bytes_writer(byte[0], sizeof byte[0]), from;
        struct exh_bytes again = exh_bytes_writer(byte[1], sizeof byte[1]);
        tick(&a, k % 20 == 0, 30 * k);
        tick(&b, k % 20 == 0, 30 * k);
        bilateral_bytes(&to, &a.box);
        bilateral_bytes(&again, &b.box);
        CHECK(to.at == again.at && memcmp(byte[0], byte[1], to.at) == 0, "tick %d", k);
        memset(&b.box.frame, 0, sizeof b.box.frame);
        from = exh_bytes_reader(byte[0], to.at);
        bilateral_bytes(&from, &b.box);
        CHECK(exh_bytes_ok(&from), "tick %d", k);
    }
}

TEST_MAIN("bilateral, a frame in parts", fingers_are_seen_one_after_the_other,
    a_frame_is_whole_by_the_next, a_fault_begins_at_once_and_ends_with_the_last_finger,
    a_finger_alone_needs_few_sensors, a_position_is_kept_while_the_joints_stay,
    a_position_from_bytes_is_not_kept, a_frame_goes_on_from_bytes);
