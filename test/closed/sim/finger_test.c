/* SPDX-License-Identifier: MIT */
/* Finger and path against closed form and against the commands. References in long double, by
 * series. */
#include "check.h"

#include "sim/exo.h"
#include "sim/finger.h"

#include "exhand/hand.h"

#include <math.h>
#include <string.h>

/* No friction but what the hand reckons with. */
static struct sim_device smooth(void)
{
    struct sim_device d = sim_device_default();
    d.mu_motor = d.mu_mass = d.coulomb_n = 0;
    return d;
}

static struct sim_path_par steady_path(void)
{
    struct sim_path_par p = sim_path_default();
    p.vary = 0;
    return p;
}

/* ---- The hand's spring ------------------------------------------------------------------ */

/* m y'' + b y' + k y = 0 from y0, v0: Taylor, far below the cancellation that hurts. */
static double swing_m(double m_, double k_, double b_, double y0_m, double v0_mps, double t_s)
{
    const long double m = (long double)m_, k = (long double)k_, b = (long double)b_;
    const long double t = (long double)t_s;
    long double y = (long double)y0_m, v = (long double)v0_mps, sum = y;
    for (int i = 1; i < 100; i++) {
        const long double dy = v, dv = -(k * y + b * v) / m;
        y = dy * t / i;
        v = dv * t / i;
        sum += y;
    }
    return (double)sum;
}

TEST(a_finger_without_string_swings_in_closed_form)
{
    static const struct {
        double m, k, b;
    } row[] = {{0.1, 300, 5}, {0.05, 600, 2}, {0.2, 150, 10}, {0.1, 300, 0}, {0.02, 100, 3}};
    for (size_t i = 0; i < LEN(row); i++) {
        double last = 0;
        for (int halved = 0; halved < 5; halved++) {
            struct sim_device d = smooth();
            struct sim_finger_par par = sim_finger_default();
            struct sim_path_par path = steady_path();
            struct sim_finger f;
            double want, err;
            par.mass_kg = row[i].m;
            par.k_Npm = row[i].k;
            par.b_Nspm = row[i].b;
            path.first_s = 100;
            path.start_m = 0.03;
            d.substep_s = 200e-6 / (1 << halved) * 1.0000001;
            d.servo_hz = 625; /* pieces of 250 us but for few */
            sim_finger_start(&f, &par, &path, NULL, &d, 1);
            f.plant.x_m += 0.01;
            f.plant.q_m = 1; /* slack */
            sim_finger_advance(&f, 0.05);
            want = path.start_m + swing_m(row[i].m, row[i].k, row[i].b, 0.01, 0, 0.05);
            err = fabs(f.plant.x_m - want);
            CHECK(err < 300 * d.substep_s * d.substep_s, "row %zu, %.3g s: off by %.3g m", i,
                d.substep_s, err);
            if (halved > 2) { /* pieces of 250 us are 5, 10, 20 steps */
                CHECK(last / err > 3.5 && last / err < 4.5, "row %zu, %.3g s: error falls by %.2f",
                    i, d.substep_s, last / err);
            }
            last = err;
        }
    }
}

/* The target runs away at v in one piece: as the same swing, seen from the target. */
TEST(a_moving_target_moves_within_a_piece)
{
    double last = 0;
    for (int halved = 0; halved < 5; halved++) {
        const struct plant_hand hand = {300, 5, 0, 1, -1};
        struct plant p = {0, 0, 1, 0, 0, 0}; /* slack */
        struct sim_device d = smooth();
        double err;
        d.mass_kg = 0.1;
        d.substep_s = 100e-6 / (1 << halved) * 1.0000001;
        plant_advance_hand(&p, &d, 0.03, 0, &hand);
        err = fabs(p.x_m - (0.03 + swing_m(0.1, 300, 5, 0, -1, 0.03)));
        CHECK(err < 300 * d.substep_s * d.substep_s, "%.3g s: off by %.3g m", d.substep_s, err);
        CHECK(halved == 0 || (last / err > 3.6 && last / err < 4.4), "%.3g s: error falls by %.2f",
            d.substep_s, last / err);
        last = err;
    }
}

/* Against a stuck rotor: string and hand share the way to the target as springs in a row do. */
TEST(pressing_stretches_hand_and_string)
{
    static const double k_Npm[] = {150, 300, 600, 3000};
    for (size_t i = 0; i < LEN(k_Npm); i++) {
        struct sim_device d = smooth();
        struct sim_finger_par par = sim_finger_default();
        struct sim_path_par path = steady_path();
        struct sim_finger f;
        double force_N, want_N;
        par.k_Npm = k_Npm[i];
        par.learned = 0;
        d.coulomb_n = 1000;
        path.hold_s = 10;
        sim_finger_start(&f, &par, &path, NULL, &d, 1);
        sim_finger_advance(&f, 5);
        CHECK(f.path.phase == SIM_PATH_HOLD, "phase %d", (int)f.path.phase);
        force_N = d.cable_npm * (f.plant.x_m - f.plant.q_m);
        want_N = (path.believed_m + path.push_m - path.start_m) / (1 / k_Npm[i] + 1 / d.cable_npm);
        CHECK(fabs(force_N - want_N) < 1e-6 * want_N, "K %g: %.9f N, want %.9f", k_Npm[i], force_N,
            want_N);
        CHECK(fabs(sim_finger_push_N(&f) - want_N) < 1e-6 * want_N, "K %g: the hand feels %.9f N",
            k_Npm[i], sim_finger_push_N(&f));
        CHECK(f.plant.q_m == path.start_m, "the rotor moved");
    }
}

/* Pulled by all that the drive has, a finger straightens and no more; let go, it comes back. */
TEST(the_straight_finger_is_the_end)
{
    const struct sim_device d = sim_device_default();
    const struct sim_finger_par par = sim_finger_default();
    struct sim_path_par path = steady_path();
    struct sim_finger f;
    path.first_s = 100;
    sim_finger_start(&f, &par, &path, NULL, &d, 1);
    sim_finger_latch(&f, 0, 6);
    for (int n = 1; n <= 5000; n++) {
        sim_finger_advance(&f, n * 1e-4);
        CHECK(
            f.plant.x_m >= 0 && f.plant.q_m >= 0, "%d: %.6f, %.6f m", n, f.plant.x_m, f.plant.q_m);
    }
    CHECK(f.plant.q_m == 0, "string %.6f m", f.plant.q_m); /* the hand stretches it a little */
    CHECK(
        fabs(f.plant.x_m - 0.005 * 300 / (300 + d.cable_npm)) < 5e-5, "finger %.6f m", f.plant.x_m);
    sim_finger_latch(&f, f.now_s, 0);
    sim_finger_advance(&f, 2);
    CHECK(fabs(f.plant.x_m - path.start_m) < 0.5e-3, "%.6f m", f.plant.x_m);
}

/* ---- The script -------------------------------------------------------------------------- */

/* Speed where the object is believed to be, of the finger and of the wanted place. */
struct passed {
    double finger_mps, wanted_mps, late_m; /* late: wanted less finger at most, up to there */
};

static struct passed pass(
    const struct sim_device *d, const struct sim_finger_par *par, const struct sim_path_par *path)
{
    struct passed p = {0, 0, 0};
    struct sim_finger f;
    const double h = 50e-6;
    double x = 0, w = 0;
    sim_finger_start(&f, par, path, NULL, d, 7);
    for (double t = h; f.path.phase <= SIM_PATH_APPROACH; t += h) {
        double now_w;
        sim_finger_advance(&f, t);
        CHECK(fabs(f.hand.x_m - sim_path_at(&f.path, t)) < 1e-12, "%.6f s: not on its path", t);
        if (f.path.phase > SIM_PATH_APPROACH) { break; }
        now_w = sim_path_wanted(&f.path, t);
        if (x < path->believed_m && f.plant.x_m >= path->believed_m) {
            p.finger_mps = (f.plant.x_m - x) / h;
        }
        if (w < path->believed_m && now_w >= path->believed_m) { p.wanted_mps = (now_w - w) / h; }
        if (now_w < path->believed_m && fabs(now_w - f.plant.x_m) > p.late_m) {
            p.late_m = fabs(now_w - f.plant.x_m);
        }
        x = f.plant.x_m;
        w = now_w;
    }
    return p;
}

TEST(a_learned_hand_passes_at_the_speed_that_was_asked)
{
    static const double speed_mps[] = {0.02, 0.1, 0.87, 1.2};
    static const struct {
        double m, k, b;
    } hand[] = {{0.05, 600, 2}, {0.1, 300, 5}, {0.2, 150, 10}};
    for (size_t i = 0; i < LEN(speed_mps) * LEN(hand); i++) {
        struct sim_device d = smooth();
        struct sim_finger_par par = sim_finger_default();
        struct sim_path_par path = steady_path();
        const double want = speed_mps[i % LEN(speed_mps)];
        struct passed p;
        par.mass_kg = hand[i / LEN(speed_mps)].m;
        par.k_Npm = hand[i / LEN(speed_mps)].k;
        par.b_Nspm = hand[i / LEN(speed_mps)].b;
        d.cable_npm = 1e5; /* an elastic one stretches, which no hand reckons with */
        d.cable_nspm = 50;
        path.speed_mps = want;
        p = pass(&d, &par, &path);
        CHECK(fabs(p.wanted_mps - want) < 0.005 * want, "%g m/s: wanted %.5f", want, p.wanted_mps);
        CHECK(fabs(p.finger_mps - want) < 0.02 * want, "%g m/s, K %g: the finger has %.5f", want,
            par.k_Npm, p.finger_mps);
        CHECK(p.late_m < 0.0015, "%g m/s, K %g: %.3g m off", want, par.k_Npm, p.late_m);
        par.learned = 0;
        CHECK(pass(&d, &par, &path).late_m > 3 * p.late_m || want < 0.05,
            "%g m/s, K %g: a hand that has learned nothing is as good", want, par.k_Npm);
    }
}

/* With the device's own friction, which the hand does not reckon with. */
TEST(friction_costs_little_of_it)
{
    static const char *const name[] = {"slow", "natural", "fast"};
    const struct sim_device d = sim_device_default();
    for (size_t i = 0; i < LEN(name); i++) {
        const struct sim_finger_par par = sim_finger_default();
        struct sim_path_par path = steady_path();
        struct passed p;
        path.speed_mps = sim_path_speed(name[i]);
        p = pass(&d, &par, &path);
        check_note("%s: asked %.2f m/s, the finger passes at %.4f, at most %.2f mm off", name[i],
            path.speed_mps, p.finger_mps, 1e3 * p.late_m);
        CHECK(fabs(p.finger_mps / path.speed_mps - 1) < 0.1, "%.4f m/s", p.finger_mps);
    }
    CHECK(sim_path_speed("natural") == 0.87 && sim_path_speed("") == 0, "names");
}

TEST(approaches_are_counted_varied_and_the_seeds)
{
    const struct sim_path_load load = {0.16, 3.6, 0.06, 0.1, 300, 5};
    struct sim_path_par par = sim_path_default();
    struct sim_path p, same, other;
    double hold_lo = 9, hold_hi = 0, begun = 0;
    long differ = 0;
    par.approaches = 200;
    sim_path_start(&p, &par, &load, NULL, 5);
    sim_path_start(&same, &par, &load, NULL, 5);
    sim_path_start(&other, &par, &load, NULL, 6);
    while (p.phase != SIM_PATH_DONE) {
        const enum sim_path_phase was = p.phase;
        const double t = p.end_s, at = sim_path_at(&p, t);
        sim_path_advance(&p, t);
        sim_path_advance(&same, t);
        sim_path_advance(&other, t);
        CHECK(sim_path_at(&same, t) == sim_path_at(&p, t), "the same seed, at %.6f s", t);
        differ += sim_path_at(&other, t) != sim_path_at(&p, t);
        CHECK(fabs(sim_path_at(&p, t) - at) < 1e-12, "jumps by %.3g at %.6f s",
            sim_path_at(&p, t) - at, t);
        if (was == SIM_PATH_HOLD) {
            hold_lo = t - begun < hold_lo ? t - begun : hold_lo;
            hold_hi = t - begun > hold_hi ? t - begun : hold_hi;
        }
        begun = t;
    }
    CHECK_EQ_I64(p.number, 200);
    CHECK(differ > 700, "another seed: %ld of 800 phases differ", differ);
    CHECK(hold_lo >= 0.9 && hold_lo < 0.91 && hold_hi <= 1.1 && hold_hi > 1.09, "held %.4f..%.4f s",
        hold_lo, hold_hi);
    CHECK(
        sim_path_next_s(&p) > 1e20 && sim_path_at(&p, p.x.start_s + 1e6) <= 0.0055 + 1e-12, "done");
}

/* What leads the script obeys its equation, by differences of what is said. */
TEST(the_lead_is_what_the_load_takes)
{
    static const double b_Nspm[] = {0, 2, 5, 100};
    for (size_t i = 0; i < LEN(b_Nspm); i++) {
        const struct sim_path_load load = {0.16, 3.6, 0.06, 0.1, 300, b_Nspm[i]};
        const struct sim_path_par par = steady_path();
        const double h = 1e-5;
        struct sim_path p;
        sim_path_start(&p, &par, &load, NULL, 1);
        sim_path_advance(&p, par.first_s);
        for (double t = p.x.start_s + 2 * h; t < p.end_s - 2 * h; t += 37 * h) {
            const double w0 = sim_path_wanted(&p, t - h), w1 = sim_path_wanted(&p, t),
                         w2 = sim_path_wanted(&p, t + h);
            const double e0 = sim_path_at(&p, t - h) - w0, e1 = sim_path_at(&p, t) - w1,
                         e2 = sim_path_at(&p, t + h) - w2;
            const double left = load.k_Npm * e1 + load.b_Nspm * (e2 - e0) / (2 * h);
            const double right = load.out_kg * (w2 - 2 * w1 + w0) / (h * h) +
                                 load.out_Nspm * (w2 - w0) / (2 * h) + load.out_N;
            CHECK(fabs(left - right) < 1e-3, "B %g, %.5f s: %.6f N, want %.6f", b_Nspm[i], t, left,
                right);
        }
    }
}

/* ---- Joints ------------------------------------------------------------------------------ */

TEST(joints_share_the_string_as_the_library_has_it)
{
    static const double arm_mm[][3] = {{20, 16, 12}, {10, 25, 0}, {50, 50, 50}, {5, 2, 3}};
    for (size_t i = 0; i < LEN(arm_mm); i++) {
        const struct sim_device d = sim_device_default();
        struct sim_finger_par par = sim_finger_default();
        const struct sim_path_par path = sim_path_default();
        struct exh_hand_par lib = {0, 0, 0, 0};
        struct exh_hand_finger hand;
        struct sim_finger f;
        double paid;
        lib.arm1_m_q30 = (int32_t)(arm_mm[i][0] * 1e-3 * 1073741824 + 0.5);
        lib.arm2_m_q30 = (int32_t)(arm_mm[i][1] * 1e-3 * 1073741824 + 0.5);
        lib.arm3_m_q30 = (int32_t)(arm_mm[i][2] * 1e-3 * 1073741824 + 0.5);
        for (int j = 0; j < 3; j++) { par.arm_m[j] = arm_mm[i][j] * 1e-3; }
        sim_finger_start(&f, &par, &path, NULL, &d, 1);
        CHECK_EQ_I64(exh_hand_setup(&hand, &exh_hit2_bones[1], &lib), 0);
        for (int j = 0; j < 2; j++) {
            const double want = hand.pull_radpm_q20[j] / 1048576.0;
            CHECK(fabs(f.bend_radpm[j] - want) < 2e-6 * want, "row %zu: %.9f, want %.9f", i,
                f.bend_radpm[j], want);
        }
        paid = par.arm_m[0] * f.bend_radpm[0] + (par.arm_m[1] + par.arm_m[2]) * f.bend_radpm[1];
        CHECK(fabs(paid - 1) < 1e-12, "row %zu: a metre of string is %.12f", i, paid);
    }
    CHECK(exh_hand_rows[0].dflt == (int32_t)(sim_finger_default().arm_m[0] * 1073741824 + 0.5) ||
              fabs(exh_hand_rows[0].dflt / 1073741824.0 - sim_finger_default().arm_m[0]) < 1e-8,
        "the default arms differ");
}

/* ---- Recordings ---------------------------------------------------------------------------- */

TEST(a_recording_is_smooth_and_stays_within_its_rows)
{
    static double string_m[300];
    const struct sim_path_load load = {0, 0, 0, 0, 300, 5};
    const struct sim_path_par par = sim_path_default();
    const struct sim_path_record r = {string_m, 300, 60, 0};
    const double h = 1e-4;
    struct sim_path p;
    double v = 0, a = 0, last = 0;
    for (int n = 0; n < 300; n++) {
        string_m[n] = 0.03 + 0.03 * ((double)(check_u64() % 1000) / 500 - 1);
    }
    sim_path_start(&p, &par, &load, &r, 1);
    last = sim_path_at(&p, 0);
    CHECK(last == string_m[0], "begins at %.9f, want %.9f", last, string_m[0]);
    for (int n = 1; p.phase != SIM_PATH_DONE; n++) {
        const double t = n * h;
        const double row = t * 60 - 1;
        double now, v_now, a_now, lo = 1, hi = 0;
        sim_path_advance(&p, t);
        now = sim_path_at(&p, t);
        v_now = (now - last) / h;
        a_now = (v_now - v) / h;
        for (int k = (int)row - 2; k <= (int)row + 3; k++) {
            const double c = string_m[k < 0 ? 0 : k > 299 ? 299 : k];
            lo = c < lo ? c : lo;
            hi = c > hi ? c : hi;
        }
        CHECK(now >= lo - 1e-12 && now <= hi + 1e-12, "%.4f s: %.6f, rows %.6f..%.6f", t, now, lo,
            hi);
        /* the third derivative is at most 8 times the rows' span, by 60^3 */
        CHECK(fabs(a_now - a) <= 8 * 0.06 * 216000 * h * 2 + 1e-3,
            "%.4f s: acceleration jumps by %.3g", t, a_now - a);
        v = v_now;
        a = a_now;
        last = now;
    }
    CHECK(fabs(last - string_m[299]) < 1e-12, "ends at %.9f, want %.9f", last, string_m[299]);
    CHECK(fabs(p.x.start_s - 301.0 / 60) < 1e-9, "ends at %.6f s", p.x.start_s);
}

TEST(string_of_angles)
{
    static const double arm_m[3] = {0.02, 0.016, 0.012};
    double row[SIM_SENSORS] = {0};
    row[4] = 1;
    row[5] = 0.5;
    row[6] = 0.25;
    row[1] = -1;
    row[2] = 0.5;
    CHECK(fabs(sim_path_string(row, 1, 1, arm_m) - 0.031) < 1e-12, "index");
    CHECK(fabs(sim_path_string(row, 0, 1, arm_m) - 0.014) < 1e-12, "thumb, bent backwards");
    CHECK(fabs(sim_path_string(row, 0, -1, arm_m) - 0.02) < 1e-12, "counted down");
    CHECK(
        sim_path_string(row, 1, -1, arm_m) == 0 && sim_path_string(row, 4, 1, arm_m) == 0, "none");
    CHECK(sim_path_sign((const double(*)[SIM_SENSORS]) & row, 1) == 1, "sign");
    row[4] = -3;
    CHECK(sim_path_sign((const double(*)[SIM_SENSORS]) & row, 1) == -1, "sign");
}

/* ---- Five ------------------------------------------------------------------------------------ */

TEST(a_finger_does_what_it_does_alone)
{
    static struct sim_exo all, one;
    struct sim_exo_par par = sim_exo_default();
    const struct sim_device d = sim_device_default();
    const double amp[SIM_FINGERS] = {0.2, 0.4, 0.6, 0.8, 1};
    par.fingers = 0x1F;
    CHECK_EQ_I64(sim_exo_start(&all, &par, &d, 9, 1), 0);
    for (unsigned i = 0; i < SIM_FINGERS; i++) {
        par.fingers = 1u << i;
        memset(&one, 0, sizeof one);
        CHECK_EQ_I64(sim_exo_start(&one, &par, &d, 9, 0), 0);
        CHECK_EQ_I64(sim_exo_start(&all, &(struct sim_exo_par){.fingers = 0x20}, &d, 9, 1), -1);
        par.fingers = 0x1F;
        CHECK_EQ_I64(sim_exo_start(&all, &par, &d, 9, 1), 0);
        for (int n = 1; n < 4000; n++) {
            sim_exo_advance(&all, n * 0.0005);
            sim_exo_advance(&one, n * 0.0005);
            sim_exo_latch(&all, n * 0.0005, amp);
            sim_exo_latch(&one, n * 0.0005, amp);
            /* The glove cuts its time finer, so the last digits differ, no more. */
            CHECK(fabs(all.finger[i].plant.x_m - one.finger[i].plant.x_m) < 1e-4, "finger %u, %d",
                i, n);
            for (unsigned k = 0; k < SIM_FINGERS; k++) {
                CHECK(k == i || one.finger[k].now_s == 0, "an absent finger moved");
            }
        }
        CHECK(all.finger[i].path.number == 1, "finger %u: no approach", i);
    }
    for (unsigned i = 1; i < SIM_FINGERS; i++) {
        CHECK(all.finger[i].plant.x_m != all.finger[0].plant.x_m, "finger %u is the thumb", i);
    }
}

TEST_MAIN("finger", a_finger_without_string_swings_in_closed_form,
    a_moving_target_moves_within_a_piece, pressing_stretches_hand_and_string,
    the_straight_finger_is_the_end, a_learned_hand_passes_at_the_speed_that_was_asked,
    friction_costs_little_of_it, approaches_are_counted_varied_and_the_seeds,
    the_lead_is_what_the_load_takes, joints_share_the_string_as_the_library_has_it,
    a_recording_is_smooth_and_stays_within_its_rows, string_of_angles,
    a_finger_does_what_it_does_alone);
