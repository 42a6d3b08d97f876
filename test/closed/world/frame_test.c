/* SPDX-License-Identifier: MIT */
/* Frames: the hand, the planes, what is left out, and that the bits never vary. */
#include "check.h"

#include "world/pace.h"
#include "world/rpy.h"
#include "world/solo.h"
#include "world/world.h"

#include "exhand/hand.h"

#include <stdio.h>
#include <string.h>

static struct world *load(const char *text)
{
    char why[700];
    struct world *w = world_load("t", text, why, sizeof why);
    CHECK(w != NULL, "%s", why);
    return w;
}

static int32_t turn(double rad) { return (int32_t)(rad / RAD_PER_TURN_Q32); }

static double real_in(double lo, double hi)
{
    return lo + (hi - lo) * (double)(check_u64() >> 11) * 0x1p-53;
}

static void random_state(struct exh_wire_state *in)
{
    memset(in, 0, sizeof *in);
    in->fingers = (uint8_t)(check_u64() & 31);
    for (int i = 0; i < FINGERS * 3; i++) {
        in->joint_turn_q32[i / 3][i % 3] =
            turn(real_in(finger_lo_rad[i % 3], finger_hi_rad[i % 3]));
    }
}

/* --- the hand --- */

TEST(the_fingertips_are_where_the_published_chain_has_them)
{
    static const struct {
        unsigned finger;
        double q[3], tip[3];
    } known[] = {
        {0, {0, 0, 0}, {0.107226, 0.064026, 0.171521}},
        {0, {0.2, 0, 0}, {0.094416, 0.080619, 0.171857}},
        {0, {-0.15, 0.7, 0.5}, {0.028130, 0.001506, 0.157946}},
        {1, {0, 0, 0}, {-0.002530, 0.036800, 0.212784}},
        {1, {0, 0, 1.0}, {0.041073, 0.032985, 0.165887}},
        {1, {-0.15, 0.7, 0.5}, {0.081301, 0.036652, 0.155150}},
        {2, {0, 1.0, 0}, {0.084654, 0.010000, 0.174515}},
        {2, {0.261799, 1.48353, 1.13446}, {0.049252, 0.019663, 0.081720}},
        {3, {-0.15, 0.7, 0.5}, {0.082583, -0.002389, 0.159950}},
        {4, {0.261799, 1.48353, 1.13446}, {0.051441, -0.024685, 0.057520}},
    };
    struct hand h;
    hand_hit2(&h);
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        const double *q = known[i].q, *p = known[i].tip;
        const int32_t joint[3] = {turn(q[0]), turn(q[1]), turn(q[2])};
        struct finger f;
        finger_at(&f, &h, known[i].finger, joint);
        CHECK(v3_len(v3_sub(f.tip, v3(p[0], p[1], p[2]))) < 1e-6, "%d: %.6f %.6f %.6f", (int)i,
            f.tip.x, f.tip.y, f.tip.z);
    }
}

TEST(the_controllers_hand_is_the_same_one)
{
    const struct exh_hand_par par = {10737418, 10737418, 10737418, 11274289};
    struct hand h;
    double most = 0;
    hand_hit2(&h);
    while (check_case(1000)) {
        struct exh_wire_state in;
        random_state(&in);
        for (unsigned i = 0; i < FINGERS; i++) {
            struct exh_hand_finger lib;
            struct exh_vec3 tip;
            struct finger f;
            CHECK_EQ_I64(exh_hand_setup(&lib, &exh_hit2_bones[i], &par), 0);
            exh_hand_tip(&lib, in.joint_turn_q32[i], &tip);
            finger_at(&f, &h, i, in.joint_turn_q32[i]);
            most = fmax(
                most, v3_len(v3_sub(f.tip, v3(tip.x * 0x1p-30, tip.y * 0x1p-30, tip.z * 0x1p-30))));
        }
    }
    CHECK(most < 100e-9, "%g m apart", most); /* the published angles have six digits */
    check_note("world's and controller's fingertips: %.1f nm apart at most", most * 1e9);
}

/* --- planes --- */

#define TABLE "hand at 0 0 0.1\nmaterial m\nplane table at 0 0 0.03 normal 0.1 0.05 1 material m\n"

TEST(a_static_plane_has_the_same_bits_whatever_the_fingers_do)
{
    static const char *const text[] = {
        TABLE, ("hand at 0 0 0.1\nmaterial m\nbox b at 0 0.1 0.0 rpy 3 4 5 size "
                "0.4 0.4 0.06 material m\n")};
    for (int k = 0; k < 2; k++) {
        struct world *w = load(text[k]);
        struct exh_wire_plane first[6];
        int n = 0, hits = 0;
        double t_s = 0;
        while (check_case(1000)) {
            struct exh_wire_state in;
            struct exh_wire_planes out;
            random_state(&in);
            world_frame(w, &in, NULL, t_s += 0.0025, &out, NULL);
            for (int f = 0; f < FINGERS; f++) {
                const struct exh_wire_plane *p = &out.plane[f];
                int same = 0;
                if (p->kind != EXH_PLANE_HIT) { continue; }
                hits++;
                for (int i = 0; i < n; i++) {
                    same |= !memcmp(first[i].normal_q30, p->normal_q30, sizeof p->normal_q30) &&
                            !memcmp(first[i].point_m_q30, p->point_m_q30, sizeof p->point_m_q30);
                }
                if (!same && n < 6) { first[n++] = *p; }
            }
        }
        CHECK(hits > 10 || hits == 0, "%d hits", hits);
        CHECK(
            n <= (k == 0 ? 1 : 5), "%d different planes of %s", n, k == 0 ? "one plane" : "a box");
        world_free(w);
    }
}

TEST(the_canonical_point_is_the_planes_nearest_to_the_origin)
{
    struct world *w = load(TABLE);
    struct exh_wire_state in = {.fingers = 31};
    struct exh_wire_planes out;
    world_frame(w, &in, NULL, 0, &out, NULL);
    for (int f = 1; f < FINGERS; f++) {
        const struct exh_wire_plane *p = &out.plane[f];
        const struct v3 n =
            v3(p->normal_q30[0] * 0x1p-30, p->normal_q30[1] * 0x1p-30, p->normal_q30[2] * 0x1p-30);
        const struct v3 q = v3(
            p->point_m_q30[0] * 0x1p-30, p->point_m_q30[1] * 0x1p-30, p->point_m_q30[2] * 0x1p-30);
        const struct v3 c =
            v3(p->hit_m_q30[0] * 0x1p-30, p->hit_m_q30[1] * 0x1p-30, p->hit_m_q30[2] * 0x1p-30);
        const double off = (0.07 - 0) / sqrt(1 + 0.01 + 0.0025);
        CHECK_EQ_I64(p->kind, EXH_PLANE_HIT);
        CHECK(fabs(v3_len(n) - 1) < 2e-9, "%.12g", v3_len(n));
        CHECK(v3_len(v3_cross(n, q)) < 2e-9, "not along the normal");
        CHECK(fabs(v3_dot(n, v3_sub(c, q))) < 3e-9, "P_C is not in it");
        CHECK(fabs(v3_len(q) - off) < 2e-9, "%.12g, not %.12g", v3_len(q), off);
        CHECK(n.x < 0, "not outward: the palm looks down at the table");
    }
    world_free(w);
}

TEST(fingers_that_are_off_are_untold_and_cost_nothing)
{
    struct world *w = load("fingers index ring\n" TABLE);
    struct exh_wire_state in = {.fingers = 1 << 1 | 1 << 2};
    struct exh_wire_planes out;
    struct world_stats s = {0};
    world_frame(w, &in, NULL, 0, &out, &s);
    CHECK_EQ_I64(out.fingers, 1 << 1);
    CHECK_EQ_I64((int64_t)s.looks, 1);
    CHECK(s.tests > 0 && s.tests < 100, "%lu bodies asked", s.tests);
    for (int f = 0; f < FINGERS; f++) {
        CHECK(out.plane[f].kind == (f == 1 ? EXH_PLANE_HIT : EXH_PLANE_UNTOLD), "%d: %d", f,
            out.plane[f].kind);
    }
    world_free(w);
}

TEST(what_no_finger_reaches_is_no_plane)
{
    struct world *w = load("look ahead 0.02\nhand at 0 0 0.3\nmaterial m\nplane table at 0 0 0 "
                           "material m\n");
    struct exh_wire_state in = {.fingers = 4};
    struct exh_wire_planes out;
    world_frame(w, &in, NULL, 0, &out, NULL);
    CHECK_EQ_I64(out.plane[2].kind, EXH_PLANE_NONE);
    world_carry(w, v3(0, 0, -0.22)); /* now it would touch the table if it closed */
    world_frame(w, &in, NULL, 0, &out, NULL);
    CHECK_EQ_I64(out.plane[2].kind, EXH_PLANE_HIT);
    world_free(w);
}

TEST(a_hand_that_comes_down_sees_what_it_will_touch)
{
    struct world *w = load("look ahead 0.15\nhand at 0 0 0.3\nmaterial m\nplane table at 0 0 0 "
                           "material m\nmotion hand linear move 0 0 -0.5\n");
    struct exh_wire_state in = {.fingers = 4};
    struct exh_wire_planes out;
    world_frame(w, &in, NULL, 0.5, &out, NULL); /* 50 mm above: the palm looks down */
    CHECK_EQ_I64(out.plane[2].kind, EXH_PLANE_HIT);
    CHECK(out.plane[2].normal_q30[0] < -0.999 * 0x1p30, "%d", (int)out.plane[2].normal_q30[0]);
    world_free(w);
}

/* --- culling, and that nothing depends on the past --- */

#define OBJECTS 60

static int object(char *to, size_t to_B, int k, double far)
{
    static const char *const how[] = {"sphere o%d at %.3f %.3f %.3f radius 0.03 material m\n",
        "box o%d at %.3f %.3f %.3f rpy 10 20 30 size 0.03 0.05 0.04 material m\n",
        "capsule o%d at %.3f %.3f %.3f rpy 30 20 10 radius 0.02 length 0.05 material m\n"};
    const double x = real_in(-far, far), y = real_in(-far, far), z = real_in(-far, far);
    const double a = real_in(-far, far), b = real_in(-far, far), c = real_in(-far, far);
    int n;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    n = snprintf(to, to_B, how[k % 3], k, x, y, z);
#pragma GCC diagnostic pop
    switch (check_u64() % 4) {
    case 0: break;
    case 1:
        n += snprintf(to + n, to_B - (size_t)n,
            "motion o%d linear move %.3f %.3f %.3f turn 9 0 40\n", k, a, b, c);
        break;
    case 2:
        n += snprintf(
            to + n, to_B - (size_t)n, "motion o%d sine move %.3f %.3f %.3f hz 0.7\n", k, a, b, c);
        break;
    default:
        n += snprintf(to + n, to_B - (size_t)n,
            "motion o%d keys loop\nkey o%d t 0\nkey o%d t 1 move %.3f %.3f "
            "%.3f\nkey o%d t 1.5 move %.3f 0 0\nkey o%d t 4\n",
            k, k, k, a, b, c, k, c, k);
    }
    return n;
}

static void random_world(char *to, size_t to_B)
{
    int at = snprintf(to, to_B,
        "hand at 0 -0.1 0\nmaterial m\nplane low at 0 0 -0.2 normal 0.2 0 1 material m\n");
    if (check_u64() & 1) {
        at += snprintf(
            to + at, to_B - (size_t)at, "motion hand sine move 0.2 0.1 0 hz 0.3 turn 0 30 60\n");
    }
    if (check_u64() & 1) {
        at += snprintf(
            to + at, to_B - (size_t)at, "motion low sine turn 20 30 0 hz 0.4 move 0 0 0.1\n");
    }
    for (int k = 0; k < OBJECTS; k++) {
        at += object(to + at, to_B - (size_t)at, k, k < 20 ? 0.15 : 1);
    }
}

TEST(culling_changes_no_plane_and_spares_work)
{
    static char text[OBJECTS * 400];
    struct world_stats a = {0}, b = {0};
    while (check_case(20000)) {
        struct world *culled, *all;
        double t_s = real_in(0, 5);
        random_world(text, sizeof text);
        culled = load(text), all = load(text);
        world_cull(all, 0);
        for (int k = 0; k < 200 && culled && all; k++) {
            struct exh_wire_state in;
            struct exh_wire_planes x = {0}, y = {0};
            random_state(&in);
            t_s += check_u64() % 50 ? real_in(0, 0.02) : real_in(-3, 3);
            if (check_u64() % 40 == 0) {
                const struct v3 by = v3(real_in(-0.2, 0.2), real_in(-0.2, 0.2), 0);
                world_carry(culled, by), world_carry(all, by);
            }
            world_frame(culled, &in, NULL, t_s, &x, &a);
            world_frame(all, &in, NULL, t_s, &y, &b);
            CHECK(memcmp(&x, &y, sizeof x) == 0, "frame %d at %g s: planes differ", k, t_s);
        }
        world_free(culled), world_free(all);
    }
    CHECK(a.looks == b.looks && a.hits == b.hits && a.hits > 0, "%lu looks, %lu hits", a.looks,
        a.hits);
    CHECK(b.slept == 0 && a.slept > 0 && a.moved < b.moved, "asleep %lu, placed %lu of %lu",
        a.slept, a.moved, b.moved);
    CHECK(3 * (a.tests - a.culled) < b.tests, "%lu of %lu", a.tests - a.culled, b.tests);
    check_note("culling: %.1f bodies a look instead of %.1f; %lu places computed instead of %lu",
        (double)(a.tests - a.culled) / (double)a.looks, (double)b.tests / (double)b.looks, a.moved,
        b.moved);
}

TEST(an_object_out_of_reach_costs_nothing)
{
    struct world *w = load("hand at 0 0 0\nmaterial m\nsphere far at 5 0 0 radius 1 material "
                           "m\nsphere coming at 3 0.1 "
                           "0 radius 0.05 material m\nmotion coming linear move -1 0 0\n");
    struct exh_wire_state in = {.fingers = 31};
    struct exh_wire_planes out;
    struct world_stats s = {0};
    for (int k = 0; k < 1000; k++) { world_frame(w, &in, NULL, k * 0.0025, &out, &s); }
    CHECK_EQ_I64((int64_t)s.tests, 0);
    CHECK(s.moved < 10, "%lu places computed", s.moved);
    for (int k = 1000; k < 1500; k++) { world_frame(w, &in, NULL, k * 0.0025, &out, &s); }
    CHECK(s.tests > 0, "it came and was not seen");
    world_free(w);
}

TEST(a_hand_that_only_turns_finds_what_it_turns_to)
{
    static const char text[] =
        "hand at 0 0 0\nmaterial m\nbox b at 0 -0.34 -0.03 size 0.1 0.3 0.02 material m\n"
        "motion hand linear turn 0 0 90\n";
    struct world *culled = load(text), *all = load(text);
    struct world_stats s = {0};
    world_cull(all, 0);
    for (int k = 0; k < 1600; k++) {
        struct exh_wire_state in = {.fingers = 31};
        struct exh_wire_planes x = {0}, y = {0};
        for (int f = 0; f < FINGERS; f++) { in.joint_turn_q32[f][1] = turn(0.3); }
        world_frame(culled, &in, NULL, k * 0.0025, &x, &s);
        world_frame(all, &in, NULL, k * 0.0025, &y, NULL);
        CHECK(memcmp(&x, &y, sizeof x) == 0, "frame %d: planes differ", k);
    }
    CHECK(s.slept > 0 && s.hits > 0, "asleep %lu, hits %lu: tells nothing", s.slept, s.hits);
    world_free(culled), world_free(all);
}

TEST(the_same_inputs_give_the_same_bits)
{
    char why[700];
    struct world *a = world_load_file("ports/posix/world/scenes/explore.world", why, sizeof why);
    struct world *b = world_load_file("ports/posix/world/scenes/explore.world", why, sizeof why);
    struct exh_wire_state in[300];
    struct exh_wire_planes first[300], again;
    CHECK(a && b, "%s", why);
    if (!a || !b) { return; }
    memset(first, 0, sizeof first), memset(&again, 0, sizeof again);
    (void)check_case(1000000);
    for (int k = 0; k < 300; k++) {
        random_state(&in[k]);
        world_frame(a, &in[k], NULL, k * 0.03, &first[k], NULL);
    }
    for (int k = 299; k >= 0; k--) { /* backwards, by the other one */
        world_frame(b, &in[k], NULL, k * 0.03, &again, NULL);
        CHECK(memcmp(&again, &first[k], sizeof again) == 0, "frame %d", k);
    }
    while (check_case(1000000)) {}
    world_free(a), world_free(b);
}

/* --- the scripted hand --- */

TEST(five_fingers_hold_the_ball)
{
    char why[700];
    struct world *w = world_load_file("ports/posix/world/scenes/grasp.world", why, sizeof why);
    struct exh_wire_planes out;
    struct exh_wire_state in;
    struct solo s;
    CHECK(w != NULL, "%s", why);
    if (w == NULL) { return; }
    memset(&out, 0, sizeof out), memset(&in, 0, sizeof in), memset(&s, 0, sizeof s);
    for (int k = 0; k < 1600; k++) {
        solo_script(&s, k * 0.0025);
        solo_step(&s, w, &out, 0.0025, &in);
        world_frame(w, &in, NULL, k * 0.0025, &out, NULL);
    }
    CHECK_EQ_I64(in.touching, 31);
    for (int f = 0; f < FINGERS; f++) {
        CHECK_EQ_I64(out.plane[f].object, 0);
        CHECK(in.d_m_q30[f] < 0.002 * 0x1p30 && in.d_m_q30[f] > -0.002 * 0x1p30, "%s: %g mm in",
            finger_name[f], in.d_m_q30[f] * 0x1p-30 * 1000);
    }
    world_free(w);
}

/* --- how fast joints turn --- */

/* By the definition: the oldest of the last 250 ms, kept 10 ms apart, behind which none is a turn
 * of 0.2 rad away. */
TEST(joints_turn_as_from_the_oldest_state_that_is_near)
{
    static struct exh_wire_state was[200];
    static uint32_t stamp[200];
    struct pace p;
    struct exh_wire_state in;
    uint32_t now_us = 1000;
    int n = 0, near = 0, turned = 0;
    memset(&p, 0, sizeof p);
    random_state(&in);
    in.fingers = (1 << FINGERS) - 1;
    for (int k = 0; k < 4000; k++) {
        int from = -1;
        for (int i = 0; i < FINGERS * 3; i++) {
            in.joint_turn_q32[i / 3][i % 3] +=
                turn(real_in(-0.004, 0.006)) * (k / 500 % 4) * (k / 250 % 2 ? -1 : 1);
        }
        pace_take(&p, &in, now_us);
        for (int back = n - 1; back >= 0 && back >= n - PACE_STATES; back--) {
            int far = now_us - stamp[back] > 250000;
            for (int i = 0; i < FINGERS * 3 && back < n - 1; i++) {
                const int64_t by = (int64_t)in.joint_turn_q32[i / 3][i % 3] -
                                   was[back].joint_turn_q32[i / 3][i % 3];
                if (by > 136000000 || by < -136000000) { far = 2; }
            }
            turned += far == 2;
            if (far) { break; }
            from = back;
        }
        for (int i = 0; from >= 0 && i < FINGERS * 3; i++) {
            const double want =
                ((double)in.joint_turn_q32[i / 3][i % 3] - was[from].joint_turn_q32[i / 3][i % 3]) /
                (1e-6 * (now_us - stamp[from]));
            CHECK(p.turn_q32ps[i / 3][i % 3] == want, "state %d, joint %d: %g, want %g", k, i,
                p.turn_q32ps[i / 3][i % 3], want);
        }
        near += from >= 0 && from < n - 10;
        if (n == 0 || now_us - stamp[n - 1] >= 10000) {
            if (n == 200) {
                memmove(was, was + 100, 100 * sizeof was[0]);
                memmove(stamp, stamp + 100, 100 * sizeof stamp[0]);
                n = 100;
            }
            was[n] = in;
            stamp[n++] = now_us;
        }
        now_us += 2500;
    }
    CHECK(near > 500 && turned > 500, "%d far back, %d turns", near, turned);
}

TEST_MAIN("world: frames", the_fingertips_are_where_the_published_chain_has_them,
    the_controllers_hand_is_the_same_one, a_static_plane_has_the_same_bits_whatever_the_fingers_do,
    the_canonical_point_is_the_planes_nearest_to_the_origin,
    fingers_that_are_off_are_untold_and_cost_nothing, what_no_finger_reaches_is_no_plane,
    a_hand_that_comes_down_sees_what_it_will_touch, culling_changes_no_plane_and_spares_work,
    an_object_out_of_reach_costs_nothing, a_hand_that_only_turns_finds_what_it_turns_to,
    the_same_inputs_give_the_same_bits, five_fingers_hold_the_ball,
    joints_turn_as_from_the_oldest_state_that_is_near);
