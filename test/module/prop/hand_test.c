/* SPDX-License-Identifier: MIT */
/* hand.h against exact kinematics in wider integers, and slopes against differences of tips. */
#include "exhand/hand.h"

#include "exhand/angle.h"
#include "exhand/fix.h"
#include "exhand/units.h"

#include "check.h"
#include "turn.h"
#include "wide.h"

/* Bounds of hand.h, in hundredths of an LSB. */
#define TIP_LSB   215  /* of the hand's own bones */
#define LONG_LSB  300  /* of any */
#define SLOPE_LSB 400  /* up to PULL_USUAL */
#define STEEP_LSB 1600 /* of any arms */

#define PULL_USUAL_Q20 (40 << 20)

/* --- what is exact --- */

/* A length of q34 times a sine or cosine of q60. */
static struct wide bone(int32_t len_m_q34, int64_t dir_q60) { return wide_mul(len_m_q34, dir_q60); }

static int64_t q60_of(struct wide q94) { return wide_sat64(wide_shr_half_up(q94, 34)); }

/* In the plane the finger bends in, m, q60: the tip, and the tip as seen from q2 with the
 * last bone twice as long, for q3 = q2. */
struct plane {
    int64_t out, up, out2, up2;
};

static struct plane plane_of(const int32_t len[3], const int32_t q[3])
{
    const struct turn a = turn_of(q[1]), b = turn_of(exh_wrap_add(q[1], q[2]));
    const struct turn c = turn_of(exh_wrap_add(exh_wrap_add(q[1], q[2]), q[2]));
    const struct wide out2 = wide_add(bone(len[1], b.cos_q60), bone(len[2], c.cos_q60));
    const struct wide up2 = wide_add(bone(len[1], b.sin_q60), bone(len[2], c.sin_q60));
    const struct plane p = {q60_of(wide_add(bone(len[0], a.cos_q60), out2)),
        q60_of(wide_add(bone(len[0], a.sin_q60), up2)),
        q60_of(wide_add(out2, bone(len[2], c.cos_q60))),
        q60_of(wide_add(up2, bone(len[2], c.sin_q60)))};
    return p;
}

/* (out, up) turned by q0 and into the palm: row i, 30 bits finer than they are. */
static struct wide palm(
    const struct exh_hand_bones *b, unsigned i, int32_t q0, int64_t out, int64_t up)
{
    const struct turn side = turn_of(q0);
    const int64_t x = wide_sat64(wide_shr_half_up(wide_mul(side.cos_q60, out), 60));
    const int64_t y = wide_sat64(wide_shr_half_up(wide_mul(side.sin_q60, out), 60));
    return wide_add(wide_add(wide_mul(b->rot_q30[i][0], x), wide_mul(b->rot_q30[i][1], y)),
        wide_mul(b->rot_q30[i][2], up));
}

/* |got * 2^n - want| <= bound/100 * 2^n. */
static int within(int32_t got, struct wide want, unsigned n, int64_t bound)
{
    const struct wide off = wide_sub(wide_shl(wide_of(got), n), want);
    return wide_cmp(wide_mulu((uint64_t)wide_sat64(wide_shr_floor(wide_abs(off), n - 40)), 100),
               wide_shl(wide_of(bound), 40)) <= 0;
}

static int32_t of_vec(const struct exh_vec3 *v, unsigned i)
{
    return i == 0 ? v->x : i == 1 ? v->y : v->z;
}

/* --- cases --- */

/* Three lengths that add up to at most 0.12 m. */
static void any_lengths(int32_t len[3])
{
    int32_t left = EXH_Q(120, 1000, 34) - 3;
    for (unsigned i = 0; i < 3; i++) {
        const unsigned at = (unsigned)(check_u64() % 3);
        len[i] = 1 + check_i32_in(0, left);
        left -= len[i] - 1;
        if (at < i) {
            const int32_t was = len[i];
            len[i] = len[at];
            len[at] = was;
        }
    }
}

static struct exh_hand_par any_arms(void)
{
    const int32_t most = EXH_Q(50, 1000, EXH_Q_POS);
    const struct exh_hand_par par = {check_i32_in(0, most), check_i32_in(0, most),
        check_i32_in(0, most), check_i32_in(0, most / 2)};
    return par;
}

/* The hand's own finger (1), or one of any lengths, arms and place (2; 0 if there is none). */
static int any_finger(struct exh_hand_finger *f, struct exh_hand_bones *own)
{
    const unsigned id = (unsigned)(check_u64() % EXH_FINGERS);
    struct exh_hand_par par = {
        exh_hand_rows[0].dflt, exh_hand_rows[1].dflt, exh_hand_rows[2].dflt, exh_hand_rows[3].dflt};
    const int any = (int)(check_u64() & 1);
    *own = exh_hit2_bones[id];
    if (any) {
        const int32_t far = EXH_Q(125, 1000, 32);
        any_lengths(own->len_m_q34);
        for (unsigned i = 0; i < 3; i++) { own->base_m_q32[i] = check_i32_in(-far, far); }
        par = any_arms();
    }
    return exh_hand_setup(f, own, &par) != 0 ? 0 : any ? 2 : 1;
}

/* Within a hand's limits or any angles at all. */
static void any_posture(int32_t q[3])
{
    const int bounded = (int)(check_u64() & 1);
    q[0] = bounded ? check_i32_in(EXH_DEG(-15, 1), EXH_DEG(15, 1)) : check_i32();
    q[1] = bounded ? check_i32_in(0, EXH_DEG(85, 1)) : check_i32();
    q[2] = bounded ? check_i32_in(0, EXH_DEG(65, 1)) : check_i32();
}

/* --- the claims --- */

TEST(tip_and_slope_are_within_their_bounds)
{
    while (check_case(1)) {
        struct exh_hand_bones b;
        struct exh_hand_finger f;
        struct exh_vec3 alone, tip, slope;
        struct plane p;
        int64_t w1, w2, out_q56, up_q56, bound;
        int32_t q[3];
        const int which = any_finger(&f, &b);
        if (which == 0) { continue; }
        any_posture(q);
        exh_hand_tip(&f, q, &alone);
        exh_hand_tip_slope(&f, q, &tip, &slope);
        CHECK(alone.x == tip.x && alone.y == tip.y && alone.z == tip.z, "two tips");
        p = plane_of(b.len_m_q34, q);
        w1 = f.pull_radpm_q20[0];
        w2 = f.pull_radpm_q20[1];
        bound = w1 <= PULL_USUAL_Q20 && w2 <= PULL_USUAL_Q20 ? SLOPE_LSB : STEEP_LSB;
        out_q56 =
            -wide_sat64(wide_shr_half_up(wide_add(wide_mul(p.up, w1), wide_mul(p.up2, w2)), 24));
        up_q56 =
            wide_sat64(wide_shr_half_up(wide_add(wide_mul(p.out, w1), wide_mul(p.out2, w2)), 24));
        for (unsigned i = 0; i < 3; i++) {
            const struct wide place = wide_shl(wide_of(b.base_m_q32[i]), 58);
            const struct wide at = wide_add(palm(&b, i, q[0], p.out, p.up), place);
            CHECK(within(of_vec(&tip, i), at, 60, which == 1 ? TIP_LSB : LONG_LSB),
                "tip %u of %" PRId32 " %" PRId32 " %" PRId32 ": %" PRId32, i, q[0], q[1], q[2],
                of_vec(&tip, i));
            CHECK(within(of_vec(&slope, i), palm(&b, i, q[0], out_q56, up_q56), 62, bound),
                "slope %u of %" PRId32 " %" PRId32 " %" PRId32 ": %" PRId32, i, q[0], q[1], q[2],
                of_vec(&slope, i));
        }
    }
}

/* What 0.1 mm of string turns, as an angle: 2^32/2pi = 683565275.58. */
static int32_t turned_by_string(int32_t pull_radpm_q20)
{
    return (int32_t)(((int64_t)pull_radpm_q20 * 683565276 / 10000 + (1 << 19)) >> 20);
}

/* 0.1 mm of string either way, which the slope knows nothing of: tips 0.2 mm of string apart.
 * Curvature adds (0.1 mm w)^2 / 6, 4e-6 of a slope below 7, the two tips' errors 2.1e-5. */
TEST(slope_is_what_tips_differ_by)
{
    const struct exh_hand_par par = {
        exh_hand_rows[0].dflt, exh_hand_rows[1].dflt, exh_hand_rows[2].dflt, exh_hand_rows[3].dflt};
    struct exh_hand_finger finger[EXH_FINGERS];
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        CHECK_EQ_I64(exh_hand_setup(&finger[i], &exh_hit2_bones[i], &par), 0);
    }
    while (check_case(20)) {
        const struct exh_hand_finger *f = &finger[check_u64() % EXH_FINGERS];
        int32_t q[3], more[3], less[3];
        struct exh_vec3 tip, slope, far, near;
        any_posture(q);
        exh_hand_tip_slope(f, q, &tip, &slope);
        more[0] = less[0] = q[0];
        for (unsigned i = 0; i < 2; i++) {
            const int32_t turned = turned_by_string(f->pull_radpm_q20[i]);
            more[i + 1] = exh_wrap_add(q[i + 1], turned);
            less[i + 1] = exh_wrap_add(q[i + 1], -turned);
        }
        exh_hand_tip(f, more, &far);
        exh_hand_tip(f, less, &near);
        for (unsigned i = 0; i < 3; i++) {
            /* (far - near) / 0.2 mm, q30 to q24 */
            const int64_t rate = ((int64_t)of_vec(&far, i) - of_vec(&near, i)) * 5000 / 64;
            const int64_t off = rate - of_vec(&slope, i);
            CHECK(off <= 1200 && off >= -1200,
                "slope %u of %" PRId32 " %" PRId32 " %" PRId32 ": %" PRId32 ", tips %" PRId64, i,
                q[0], q[1], q[2], of_vec(&slope, i), rate);
        }
    }
}

/* w1 arm1 + w2 (arm2 + arm3) = 1, and w is along the arms: both to 2^-20 rad/m. */
TEST(pull_pays_out_a_metre)
{
    while (check_case(20)) {
        const struct exh_hand_par par = any_arms();
        const int64_t arm[2] = {par.arm1_m_q30, (int64_t)par.arm2_m_q30 + par.arm3_m_q30};
        const int64_t square = arm[0] * arm[0] + arm[1] * arm[1];
        struct exh_hand_finger f;
        if (exh_hand_setup(&f, &exh_hit2_bones[0], &par) != 0) {
            CHECK(square < (int64_t)EXH_Q(4, 1000, 30) * EXH_Q(4, 1000, 30), "refused");
            continue;
        }
        for (unsigned i = 0; i < 2; i++) {
            const struct wide got = wide_mul(f.pull_radpm_q20[i], square);
            const struct wide off = wide_sub(got, wide_shl(wide_of(arm[i]), 50));
            CHECK(wide_within(wide_shl(off, 2), wide_mul(3, square)), "w%u = %" PRId32, i + 1,
                f.pull_radpm_q20[i]);
        }
    }
}

static void any_joint(struct exh_hand_joint *j)
{
    const int32_t a = check_i32(), b = check_i32();
    j->bias_turn_q32 = check_i32();
    for (unsigned t = 0; t < EXH_HAND_TERMS; t++) {
        j->gain_q24[t] = check_i32_in(-EXH_HAND_GAIN_MAX_Q24, EXH_HAND_GAIN_MAX_Q24);
        j->sensor[t] = (uint8_t)(check_u64() % EXH_GLOVE_SENSORS);
    }
    j->lo_turn_q32 = a < b ? a : b;
    j->hi_turn_q32 = a < b ? b : a;
}

TEST(joints_are_rounded_once_and_limited)
{
    static struct exh_hand_map map;
    while (check_case(1)) {
        const unsigned finger = (unsigned)(check_u64() % EXH_FINGERS);
        int32_t sensor[EXH_GLOVE_SENSORS], q[EXH_HAND_JOINTS];
        uint32_t limited;
        for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { sensor[i] = check_i32(); }
        for (unsigned i = 0; i < EXH_HAND_JOINTS; i++) { any_joint(&map.joint[finger][i]); }
        limited = exh_hand_joints(&map, finger, sensor, q);
        for (unsigned i = 0; i < EXH_HAND_JOINTS; i++) {
            const struct exh_hand_joint *j = &map.joint[finger][i];
            struct wide sum = wide_shl(wide_of(j->bias_turn_q32), 24);
            int64_t exact;
            for (unsigned t = 0; t < EXH_HAND_TERMS; t++) {
                sum = wide_add(sum, wide_mul(j->gain_q24[t], sensor[j->sensor[t]]));
            }
            exact = wide_sat64(wide_shr_half_up(sum, 24));
            CHECK((limited >> i & 1) == (exact < j->lo_turn_q32 || exact > j->hi_turn_q32),
                "joint %u: %" PRId64, i, exact);
            CHECK(q[i] == (exact < j->lo_turn_q32      ? j->lo_turn_q32
                              : exact > j->hi_turn_q32 ? j->hi_turn_q32
                                                       : exact),
                "joint %u: %" PRId32 ", exact %" PRId64, i, q[i], exact);
        }
    }
}

TEST_MAIN("prop/hand", tip_and_slope_are_within_their_bounds, slope_is_what_tips_differ_by,
    pull_pays_out_a_metre, joints_are_rounded_once_and_limited);
