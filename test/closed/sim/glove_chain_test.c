/* SPDX-License-Identifier: MIT */
/* The simulated glove: its analog chain against closed form, and the hand in it. References
 * are computed in long double, by series. */
#include "check.h"
#include "exp_neg.h"

#include "sim/operator.h"

#include "exhand/glove.h"

#include <math.h>
#include <string.h>

#define PI_L    3.141592653589793238462643383279L
#define PI      3.141592653589793238
#define LSB_V   (10.0 / 32768)
#define SENSORS SIM_GLOVE_SENSORS

/* Taylor after taking off whole turns; quarter 1: cosine. */
static long double wide_sin(long double x, int quarter)
{
    long double term = 1, sum = 0;
    x += quarter * PI_L / 2;
    x -= 2 * PI_L * (long double)(long long)(x / (2 * PI_L));
    term = x;
    for (int i = 1; i < 60; i++) {
        sum += term;
        term *= -x * x / ((2 * i) * (2 * i + 1));
    }
    return sum;
}

/* No noise, no multiplexer, no coupling: a test adds what it looks at. */
static struct sim_glove_par clean(void)
{
    struct sim_glove_par p = sim_glove_default();
    p.noise_V = p.settle_s = p.couple = 0;
    return p;
}

static struct sim_glove settled(const struct sim_glove_par *p, double rad)
{
    double angle[SENSORS];
    struct sim_glove g;
    for (int i = 0; i < SENSORS; i++) { angle[i] = rad; }
    sim_glove_start(&g, p, 1, angle);
    return g;
}

/* Volt of an angle, by the sensor's two end points. */
static double static_V(const struct sim_glove_par *p, unsigned i, double rad)
{
    const struct sim_glove_sensor *s = &sim_glove_sensor[i];
    const double deg = rad * 180 / PI;
    const double share = s->lo + (deg - s->lo_deg) / (s->hi_deg - s->lo_deg) * (s->hi - s->lo);
    return p->offset_V + p->gain * p->excite_V * (p->dead + (1 - 2 * p->dead) * share);
}

/* ---- Series ------------------------------------------------------------------------ */

TEST(sine_and_cosine_are_good_to_their_bound)
{
    double worst = 0;
    CHECK(sim_sin(0) == 0 && sim_cos(0) == 1, "at 0");
    for (int i = -200000; i <= 200000; i++) {
        const double x = i < 0 ? i * 4.987654321 : i * 1e-4;
        const double bound = 1e-15 + 1e-16 * fabs(x);
        const double s = fabs((double)((long double)sim_sin(x) - wide_sin((long double)x, 0)));
        const double c = fabs((double)((long double)sim_cos(x) - wide_sin((long double)x, 1)));
        const double e = (s > c ? s : c) / bound;
        if (e > worst) { worst = e; }
        CHECK(e <= 1, "sin %.3g cos %.3g at %.9g", s, c, x);
    }
    CHECK(worst > 0.01, "the bound is no bound: %.3g of it", worst);
}

/* ---- Static ------------------------------------------------------------------------ */

/* By hand: 0.429 of the live part is 0.1 + 0.8 * 0.429 of 5 V, times 4.5, less 11.25 V. */
TEST(volt_and_code_of_an_angle)
{
    const struct sim_glove_par p = clean();
    struct sim_glove g = settled(&p, 0);
    CHECK(fabs(sim_glove_volt(&g, 4, 0) - -1.278) < 1e-12, "%.9f", sim_glove_volt(&g, 4, 0));
    CHECK_EQ_I64(sim_glove_convert(&g, 4, 0), -4188); /* -1.278 * 3276.8 = -4187.75 */
    g = settled(&p, PI / 2);
    CHECK(fabs(sim_glove_volt(&g, 4, 0) - 2.772) < 1e-12, "%.9f", sim_glove_volt(&g, 4, 0));
    CHECK_EQ_I64(sim_glove_convert(&g, 4, 0), 9083); /* 9083.29 */
}

/* The library's default calibration is of the same sensors. */
TEST(end_points_span_what_the_default_calibration_says)
{
    const struct sim_glove_par p = clean();
    for (unsigned i = 0; i < SENSORS; i++) {
        const struct sim_glove_sensor *s = &sim_glove_sensor[i];
        const double lo_V = -9 + 18 * s->lo, hi_V = -9 + 18 * s->hi;
        struct sim_glove g = settled(&p, s->lo_deg * PI / 180);
        CHECK(fabs(sim_glove_volt(&g, i, 0) - lo_V) < 1e-12, "%s: %.9f", s->name, lo_V);
        g = settled(&p, s->hi_deg * PI / 180);
        CHECK(fabs(sim_glove_volt(&g, i, 0) - hi_V) < 1e-12, "%s: %.9f", s->name, hi_V);
    }
    CHECK_EQ_I64(SENSORS, EXH_GLOVE_SENSORS);
}

TEST(codes_round_and_saturate)
{
    static const struct {
        double v;
        int code;
    } row[] = {{0, 0}, {LSB_V * 0.499, 0}, {LSB_V * 0.501, 1}, {-LSB_V * 0.501, -1},
        {9.99969, 32767}, {10, 32767}, {12, 32767}, {1e9, 32767}, {-10, -32768}, {-10.0001, -32768},
        {-1e9, -32768}, {-LSB_V * 0.499, 0}, {10 - LSB_V * 1.6, 32766}};
    const struct sim_glove_par p = clean();
    for (size_t i = 0; i < LEN(row); i++) {
        CHECK(sim_glove_code(&p, row[i].v) == row[i].code, "%.9g V: %d", row[i].v,
            sim_glove_code(&p, row[i].v));
    }
}

/* An abduction sensor sees its share of both knuckles, and nothing else does. */
TEST(abduction_is_bent_by_its_neighbours)
{
    struct sim_glove_par p = clean();
    double angle[SENSORS] = {0};
    struct sim_glove g;
    p.couple = 0.1;
    angle[4] = 0.8;
    angle[7] = 0.4;
    angle[10] = 0.3;
    sim_glove_start(&g, &p, 1, angle);
    CHECK(fabs(sim_glove_volt(&g, 10, 0) - static_V(&p, 10, 0.3 + 0.06)) < 1e-12, "10");
    CHECK(fabs(sim_glove_volt(&g, 14, 0) - static_V(&p, 14, 0.02)) < 1e-12, "14");
    CHECK(fabs(sim_glove_volt(&g, 4, 0) - static_V(&p, 4, 0.8)) < 1e-12, "4");
    CHECK(fabs(sim_glove_volt(&g, 18, 0) - static_V(&p, 18, 0)) < 1e-12, "18");
}

/* ---- Low-pass ---------------------------------------------------------------------- */

TEST(a_step_is_an_exponential)
{
    static const double cutoff_hz[] = {1, 15.9, 159, 5000, 1e6};
    for (size_t k = 0; k < LEN(cutoff_hz); k++) {
        struct sim_glove_par p = clean();
        struct sim_glove g;
        const struct sim_curve step = {0.01, {1.2}, 0, 0, 0};
        p.cutoff_Hz = cutoff_hz[k];
        g = settled(&p, 0.2);
        sim_glove_move(&g, 5, &step);
        for (int n = 0; n <= 100; n++) {
            const double t_s = 0.01 + n * n * 1e-6;
            const long double x =
                2 * PI_L * (long double)p.cutoff_Hz * ((long double)t_s - (long double)0.01);
            const double want_rad = (double)(1.2L - exp_neg(x));
            const double got_V = sim_glove_volt(&g, 5, t_s);
            CHECK(fabs(got_V - static_V(&p, 5, want_rad)) < 1e-11, "%g Hz, %.6f s: %.12f V",
                p.cutoff_Hz, t_s, got_V);
        }
    }
}

/* From rest: the sine behind one pole, and the transient that takes it there. */
TEST(a_sine_comes_smaller_and_later)
{
    static const double hz[] = {0.1, 1, 10, 159, 2000};
    for (size_t k = 0; k < LEN(hz); k++) {
        const struct sim_glove_par p = clean();
        const double w = 2 * PI * hz[k];
        const struct sim_curve x = {0, {0.5}, 0.25, w, 0.3};
        const long double tau = 1 / (2 * PI_L * 159), wt = (long double)w * tau;
        const long double start =
            0.25L / (1 + wt * wt) * (wide_sin(0.3L, 0) - wt * wide_sin(0.3L, 1));
        struct sim_glove g = settled(&p, 0.5);
        double top = 0;
        sim_glove_move(&g, 8, &x);
        for (int n = 0; n <= 4000; n++) {
            const double t_s = n / hz[k] / 1000 * 3;
            const long double a = (long double)w * (long double)t_s + 0.3L;
            const long double settled_rad =
                0.25L / (1 + wt * wt) * (wide_sin(a, 0) - wt * wide_sin(a, 1));
            const double want_rad =
                (double)(0.5L + settled_rad - start * exp_neg((long double)t_s / tau));
            const double got_V = sim_glove_volt(&g, 8, t_s);
            CHECK(fabs(got_V - static_V(&p, 8, want_rad)) < 1e-11, "%g Hz, %.6f s", hz[k], t_s);
            if (n > 2000 && fabs(got_V - static_V(&p, 8, 0.5)) > top) {
                top = fabs(got_V - static_V(&p, 8, 0.5));
            }
        }
        if (hz[k] == 159) { /* half the power at the cut-off */
            const double ratio = top / fabs(static_V(&p, 8, 0.25) - static_V(&p, 8, 0));
            CHECK(ratio > 0.70700 && ratio < 0.70711, "%.6f", ratio);
        }
    }
}

/* A ramp comes tau late; and a curve of all six terms satisfies tau y' = x - y. */
TEST(polynomials_come_as_the_equation_says)
{
    const struct sim_glove_par p = clean();
    const double tau = 1 / (2 * PI * 159);
    const struct sim_curve ramp = {0, {0, 2}, 0, 0, 0};
    const struct sim_curve all = {0.5, {0.1, 1, -2, 3, -5, 7}, 0.1, 40, 1};
    struct sim_glove g = settled(&p, 0);
    sim_glove_move(&g, 5, &ramp);
    CHECK(fabs(sim_lag_at(&g.angle_rad[5], 0.4) - 2 * (0.4 - tau)) < 1e-14, "ramp: %.15f",
        sim_lag_at(&g.angle_rad[5], 0.4));
    CHECK(fabs(sim_lag_at(&g.angle_rad[5], tau) - 2 * tau * 0.36787944117144233) < 1e-15, "knee");
    sim_glove_move(&g, 5, &all);
    for (int n = 1; n < 1000; n++) {
        const double t_s = 0.5 + n * 0.5e-3, h = 1e-7;
        const struct sim_lag *l = &g.angle_rad[5];
        const double slope = (sim_lag_at(l, t_s + h) - sim_lag_at(l, t_s - h)) / (2 * h);
        const double left = tau * slope - (sim_curve_at(&all, t_s) - sim_lag_at(l, t_s));
        CHECK(fabs(left) < 1e-9, "%.4f s: %.3g", t_s, left);
    }
    CHECK(fabs(sim_lag_at(&g.angle_rad[5], 0.5) - 2 * (0.5 - tau)) < 1e-13,
        "it goes on from where it is");
}

/* ---- Scan, multiplexer, noise ---------------------------------------------------------- */

/* A ramp on all channels: each code shows its instant. */
TEST(channels_are_held_one_interval_apart)
{
    static const double interval_s[] = {4e-6, 5e-6, 10e-6, 15e-6, 20e-6};
    for (size_t k = 0; k < LEN(interval_s); k++) {
        struct sim_glove_par p = clean();
        const double speed = 50; /* rad/s: faster than a hand, so that a code is short */
        int16_t raw[SENSORS];
        double row[2][SENSORS];
        struct sim_operator_par o = sim_operator_default();
        struct sim_operator op;
        struct sim_glove g;
        p.interval_s = interval_s[k];
        for (int i = 0; i < SENSORS; i++) {
            row[0][i] = -0.5;
            row[1][i] = -0.5 + 0.02 * speed;
        }
        o.does = SIM_RECORD;
        o.row_rad = (const double(*)[SENSORS])row;
        o.rows = 2;
        o.row_hz = 50;
        sim_operator_start(&op, &o, &g, &p, 1);
        sim_operator_frame(&op, &g, 0.01, raw);
        for (unsigned i = 0; i < SENSORS; i++) {
            const double per_rad = (static_V(&p, i, 1) - static_V(&p, i, 0)) / LSB_V;
            const double lag_s = 1 / (2 * PI * p.cutoff_Hz);
            const double at_0 = static_V(&p, i, -0.5) / LSB_V;
            const double held_s = (raw[i] - at_0) / (per_rad * speed) + lag_s; /* code to instant */
            const double want_s = 0.01 - (22 - i) * interval_s[k];
            const double code_s = 0.5 / fabs(per_rad * speed) + lag_s * 5e-5; /* e^-10 is left */
            CHECK(fabs(held_s - want_s) <= code_s, "%g us, channel %u: %.3f us, want %.3f",
                interval_s[k] * 1e6, i, held_s * 1e6, want_s * 1e6);
            CHECK(code_s < interval_s[k], "channel %u is too coarse to tell: %.3g s", i, code_s);
            CHECK(fabs(sim_glove_held_s(&p, i, 0.01) - want_s) < 1e-15, "channel %u", i);
        }
    }
}

/* What is left of the channel before decays over one slot, for channel 0 over the pause. */
TEST(the_multiplexer_keeps_some_of_the_channel_before)
{
    static const double settle_s[] = {0.36e-6, 1e-6, 4e-6, 50e-6};
    for (size_t k = 0; k < LEN(settle_s); k++) {
        struct sim_glove_par p = clean();
        struct sim_glove g;
        double before, at_s = 1 - 22 * p.interval_s;
        p.settle_s = settle_s[k];
        g = settled(&p, 0.3);
        before = sim_glove_volt(&g, 0, 0);
        for (unsigned i = 0; i < SENSORS; i++) {
            const double v = sim_glove_volt(&g, i, 1);
            const double left = i == 0 ? 0 : (double)exp_neg(4e-6L / (long double)settle_s[k]);
            const double want = v + (before - v) * left;
            at_s = sim_glove_held_s(&p, i, 1);
            CHECK(fabs(sim_glove_convert(&g, i, at_s) * LSB_V - want) <= LSB_V * 0.501,
                "%g us, channel %u", settle_s[k] * 1e6, i);
            CHECK(fabs(g.held_V - want) < 1e-9, "%g us, channel %u: %.9f V, want %.9f",
                settle_s[k] * 1e6, i, g.held_V, want);
            before = want;
        }
    }
}

/* By default full scale settles to a code: more than half of one, less than two. */
TEST(the_default_card_settles_to_a_code)
{
    const struct sim_glove_par p = sim_glove_default();
    const double left = (double)exp_neg((long double)p.interval_s / (long double)p.settle_s);
    CHECK(left * 65536 < 2 && left * 65536 > 0.5, "%.3f codes", left * 65536);
}

/* In each second at 2 kHz; by codes, which add up to one either way. */
TEST(noise_is_the_papers_peak_to_peak)
{
    const struct sim_glove_par p = sim_glove_default();
    const int want = (int)(0.0061 / LSB_V); /* 19.98 codes */
    double angle[SENSORS] = {0}, sum = 0, squares = 0;
    struct sim_glove g;
    double worst_V = 1;
    int lo[SENSORS], hi[SENSORS];
    sim_glove_start(&g, &p, 7, angle);
    for (int n = 0; n < 5 * 2000; n++) {
        for (unsigned i = 0; i < SENSORS; i++) {
            const int code = sim_glove_convert(&g, i, sim_glove_held_s(&p, i, (n + 1) / 2000.0));
            const double off = code * LSB_V - static_V(&p, i, 0);
            sum += off;
            squares += off * off;
            if (n % 2000 == 0) { lo[i] = hi[i] = code; }
            if (code < lo[i]) { lo[i] = code; }
            if (code > hi[i]) { hi[i] = code; }
            if (n % 2000 == 1999 && (hi[i] - lo[i]) * LSB_V < worst_V) {
                worst_V = (hi[i] - lo[i]) * LSB_V;
            }
            CHECK(n % 2000 != 1999 || hi[i] - lo[i] <= want + 2, "channel %u: %d codes", i,
                hi[i] - lo[i]);
        }
    }
    CHECK(worst_V > 0.0052, "least in a second: %.2f mV", worst_V * 1e3);
    sum /= 22e4;
    squares /= 22e4;
    CHECK(fabs(sum) < 0.02e-3, "mean %.4f mV", sum * 1e3); /* settling and rounding are in it */
    CHECK(squares > 0.98e-6 && squares < 1.08e-6, "deviation^2 %.4f mV^2", squares * 1e6);
    check_note("noise: least peak to peak of a second and channel %.2f mV, mean square %.3f mV^2",
        worst_V * 1e3, squares * 1e6);
}

/* ---- Faults -------------------------------------------------------------------------- */

TEST(faults_read_as_they_would)
{
    static const struct {
        unsigned char fault;
        int code;
    } row[] = {{SIM_GLOVE_OPEN, 32767}, {SIM_GLOVE_SHORT, -32768}, {SIM_GLOVE_RAIL_HIGH, 32767},
        {SIM_GLOVE_RAIL_LOW, -32768}};
    const struct sim_glove_par p = sim_glove_default();
    for (size_t k = 0; k < LEN(row); k++) {
        struct sim_glove g = settled(&p, 0.2), well = settled(&p, 0.2);
        g.fault[9] = row[k].fault;
        for (int n = 1; n < 100; n++) {
            for (unsigned i = 0; i < SENSORS; i++) {
                const double at_s = sim_glove_held_s(&p, i, n * 1e-3);
                const int code = sim_glove_convert(&g, i, at_s);
                const int want = sim_glove_convert(&well, i, at_s);
                if (i == 9) {
                    CHECK_EQ_I64(code, row[k].code);
                } else { /* its neighbour sees at most a code of it through the multiplexer */
                    CHECK(code - want <= (i == 10) && want - code <= (i == 10), "%u: %d, want %d",
                        i, code, want);
                }
            }
        }
    }
}

TEST(a_stuck_code_stays)
{
    const struct sim_glove_par p = sim_glove_default();
    const struct sim_curve ramp = {0, {0, 1}, 0, 0, 0};
    struct sim_glove g = settled(&p, 0);
    int16_t first;
    sim_glove_move(&g, 5, &ramp);
    first = sim_glove_convert(&g, 5, 0.1);
    g.fault[5] = SIM_GLOVE_STUCK;
    for (int n = 1; n < 100; n++) { CHECK_EQ_I64(sim_glove_convert(&g, 5, 0.1 + n * 1e-3), first); }
    g.fault[5] = SIM_GLOVE_WELL;
    CHECK(sim_glove_convert(&g, 5, 0.3) > first + 1000, "it goes on");
}

TEST(parameters_are_refused_by_range)
{
    struct sim_glove_par p = sim_glove_default();
    const struct sim_device_row *row;
    CHECK_EQ_I64(sim_glove_set(&p, "noise", 0.01, &row), 0);
    CHECK(p.noise_V == 0.01 && sim_glove_set(&p, "noise", -1, &row) == -1 && row != NULL, "noise");
    CHECK(sim_glove_set(&p, "nosie", 0, &row) == -1 && row == NULL, "no such");
    CHECK(p.noise_V == 0.01 && p.span_V == 10 && p.excite_V == 5, "the others stay");
    for (int i = 0; i < sim_glove_rows; i++) {
        const struct sim_device_row *r = &sim_glove_row[i];
        CHECK(r->min <= r->value && r->value <= r->max, "%s", r->name);
    }
}

/* ---- Operator -------------------------------------------------------------------------- */

TEST(poses_lie_in_range_and_show_both_ends)
{
    for (unsigned i = 0; i < SENSORS; i++) {
        const struct sim_glove_sensor *s = &sim_glove_sensor[i];
        double lo = 1e9, hi = -1e9;
        for (int k = 0; k < sim_poses; k++) {
            const double deg = sim_pose[k].deg[i];
            CHECK(deg >= s->lo_deg && deg <= s->hi_deg, "%s in %s: %g", s->name, sim_pose[k].name,
                deg);
            if (deg < lo) { lo = deg; }
            if (deg > hi) { hi = deg; }
        }
        CHECK(hi - lo >= 0.6 * (s->hi_deg - s->lo_deg), "%s: only %g..%g", s->name, lo, hi);
    }
    for (int k = 0; k < sim_poses; k++) { CHECK_EQ_I64(sim_pose_find(sim_pose[k].name), k); }
    CHECK_EQ_I64(sim_pose_find("none"), -1);
}

/* Minimum jerk: half way at half time, fastest there with 15/8 of the mean speed, still at
 * both ends; the low-pass makes it 1 ms later. */
TEST(a_movement_is_minimum_jerk)
{
    const struct sim_glove_par p = clean();
    struct sim_operator_par o = sim_operator_default();
    struct sim_operator op;
    struct sim_glove g;
    const double lag_s = 1 / (2 * PI * 159);
    double fastest = 0, last = 0;
    o.move_s = 0.4;
    sim_operator_start(&op, &o, &g, &p, 1);
    sim_operator_advance(&op, &g, 1);
    CHECK(sim_operator_at_rest(&op, 1), "at rest");
    sim_operator_go(&op, sim_pose_find("fist"));
    CHECK(!sim_operator_at_rest(&op, 1), "asked");
    for (int n = 0; n <= 5000; n++) {
        const double t_s = 1 + n * 1e-4;
        double at;
        sim_operator_advance(&op, &g, t_s);
        at = sim_lag_at(&g.angle_rad[4], t_s);
        if (n > 0 && (at - last) / 1e-4 > fastest) { fastest = (at - last) / 1e-4; }
        CHECK(n == 0 || at >= last - 1e-12, "turns back at %.4f", t_s);
        CHECK(sim_operator_at_rest(&op, t_s) == (t_s >= op.end_s), "%.4f", t_s);
        last = at;
    }
    CHECK(fabs(op.end_s - 1.4) < 1e-12, "ends at %.6f", op.end_s);
    CHECK(fabs(last - PI / 2) < 1e-9, "%.9f", last);
    CHECK(fastest > 0.998 * 1.875 * PI / 2 / 0.4 && fastest < 1.875 * PI / 2 / 0.4, "%.4f rad/s",
        fastest);
    sim_operator_start(&op, &o, &g, &p, 1);
    sim_operator_go(&op, sim_pose_find("fist"));
    sim_operator_advance(&op, &g, 0);
    CHECK(fabs(sim_lag_at(&g.angle_rad[4], 0.2 + lag_s) - PI / 4) < 1e-4, "half way");
}

/* Through all poses and round again; grasping never rests. */
TEST(scripts_go_on_by_themselves)
{
    const struct sim_glove_par p = clean();
    struct sim_operator_par o = sim_operator_default();
    struct sim_operator op;
    struct sim_glove g;
    o.does = SIM_POSES;
    sim_operator_start(&op, &o, &g, &p, 1);
    for (int n = 1; n <= 2 * sim_poses; n++) {
        const int pose = n % sim_poses;
        sim_operator_advance(&op, &g, n * 1.0 + 0.45); /* in the rest behind the movement */
        CHECK(op.to == pose, "%d: in %s", n, sim_pose[op.to].name);
        for (unsigned i = 0; i < SENSORS; i++) {
            const double rad = sim_lag_at(&g.angle_rad[i], n * 1.0 + 0.45);
            CHECK(fabs(rad * 180 / PI - sim_pose[pose].deg[i]) < 1e-6, "%d, %u: %.9f", n, i, rad);
        }
    }
    o.does = SIM_GRASP;
    sim_operator_start(&op, &o, &g, &p, 1);
    sim_operator_advance(&op, &g, 0.5001);
    CHECK(fabs(sim_lag_at(&g.angle_rad[4], 0.5001) - PI / 2) < 1e-3, "a fist after 0.5 s");
    sim_operator_advance(&op, &g, 1.0001);
    CHECK(fabs(sim_lag_at(&g.angle_rad[4], 1.0001)) < 1e-3, "flat after 1 s");
}

/* One big advance is many small ones. */
TEST(advance_does_not_depend_on_its_steps)
{
    static const enum sim_operator_does does[] = {SIM_POSES, SIM_GRASP, SIM_WAVE, SIM_RECORD};
    static double row[40][SENSORS];
    const struct sim_glove_par p = clean();
    for (int r = 0; r < 40; r++) {
        for (int i = 0; i < SENSORS; i++) { row[r][i] = (double)(check_u64() % 1000) * 1e-3; }
    }
    for (size_t k = 0; k < LEN(does); k++) {
        struct sim_operator_par o = sim_operator_default();
        struct sim_operator a, b;
        struct sim_glove ga, gb;
        o.does = does[k];
        o.row_rad = (const double(*)[SENSORS])row;
        o.rows = 40;
        o.row_hz = 60;
        o.off_rad = 0.05;
        sim_operator_start(&a, &o, &ga, &p, 3);
        sim_operator_start(&b, &o, &gb, &p, 3);
        for (int n = 0; n < 7000; n++) { sim_operator_advance(&a, &ga, n * 1e-3); }
        sim_operator_advance(&b, &gb, 6.999);
        for (unsigned i = 0; i < SENSORS; i++) {
            CHECK(sim_lag_at(&ga.angle_rad[i], 7) == sim_lag_at(&gb.angle_rad[i], 7), "%zu: %u", k,
                i);
        }
    }
}

TEST(a_recording_is_played_through_its_rows)
{
    static double row[3][SENSORS];
    const struct sim_glove_par p = clean();
    struct sim_operator_par o = sim_operator_default();
    struct sim_operator op;
    struct sim_glove g;
    row[0][5] = 0.2;
    row[1][5] = 0.6;
    row[2][5] = 0.1;
    o.does = SIM_RECORD;
    o.row_rad = (const double(*)[SENSORS])row;
    o.rows = 3;
    o.row_hz = 10;
    sim_operator_start(&op, &o, &g, &p, 3);
    for (int n = 0; n < 400; n++) {
        const double t_s = n * 1e-3;
        const double want = t_s < 0.1 ? 0.2 + 4 * t_s : t_s < 0.2 ? 0.6 - 5 * (t_s - 0.1) : 0.1;
        sim_operator_advance(&op, &g, t_s);
        CHECK(fabs(sim_curve_at(&g.angle_rad[5].x, t_s) - want) < 1e-12, "%.3f s", t_s);
    }
}

/* The same seed gives the same codes, another others. */
TEST(codes_hang_on_the_seed_alone)
{
    const struct sim_glove_par p = sim_glove_default();
    const struct sim_operator_par o = sim_operator_default();
    struct sim_operator a, b, c;
    struct sim_glove ga, gb, gc;
    int16_t ra[SENSORS], rb[SENSORS], rc[SENSORS];
    int other = 0;
    sim_operator_start(&a, &o, &ga, &p, 5);
    sim_operator_start(&b, &o, &gb, &p, 5);
    sim_operator_start(&c, &o, &gc, &p, 6);
    for (int n = 1; n < 100; n++) {
        sim_operator_frame(&a, &ga, n * 1e-3, ra);
        sim_operator_frame(&b, &gb, n * 1e-3, rb);
        sim_operator_frame(&c, &gc, n * 1e-3, rc);
        CHECK(memcmp(ra, rb, sizeof ra) == 0, "frame %d", n);
        other += memcmp(ra, rc, sizeof ra) != 0;
    }
    CHECK(other > 90, "%d", other);
}

/* The values kept for a channel at rest equal those of a new computation. After movements, for
 * neighbours that see them, for joints that follow others, and after a fault. */
TEST(what_is_kept_is_what_is_so)
{
    struct sim_glove_par p = clean();
    struct sim_operator_par par = sim_operator_default();
    struct sim_operator o;
    struct sim_glove g;
    int16_t raw[SENSORS];
    int still = 0;
    p.couple = 0.08;
    par.does = SIM_GRASP;
    sim_operator_start(&o, &par, &g, &p, 3);
    sim_glove_follow(&g, 5, 4, 0.7);
    for (int n = 1; n < 3000; n++) {
        if (n % 700 == 0) { g.fault[10] = SIM_GLOVE_OPEN; }
        if (n % 700 == 60) { g.fault[10] = SIM_GLOVE_WELL; }
        if (n == 2000) { o.par.does = SIM_REST; }
        sim_operator_frame(&o, &g, n * 1e-3, raw);
        for (unsigned i = 0; i < SENSORS; i++) {
            const double held_s = sim_glove_held_s(&p, i, n * 1e-3);
            const double apart = raw[i] - sim_glove_volt(&g, i, held_s) / LSB_V;
            const int rails = raw[i] == 32767 || raw[i] == -32768;
            still += !(g.moves >> i & 1);
            CHECK(rails || fabs(apart) < 0.5001, "channel %u, frame %d: %.3f codes", i, n, apart);
        }
    }
    CHECK(still > 10000, "kept %d times", still);
}

/* Channels that are read have the codes of a glove of which all are; the others keep one code. */
TEST(a_channel_that_is_not_read_changes_no_other)
{
    const uint32_t reads = 0x4F0;
    const struct sim_glove_par p = sim_glove_default();
    struct sim_operator_par par = sim_operator_default();
    struct sim_operator oa, ob;
    struct sim_glove a, b;
    int16_t ra[SENSORS], rb[SENSORS], first[SENSORS];
    int moved = 0;
    par.does = SIM_GRASP;
    sim_operator_start(&oa, &par, &a, &p, 3);
    sim_operator_start(&ob, &par, &b, &p, 3);
    sim_glove_reads(&b, reads);
    memcpy(first, b.code, sizeof first);
    for (int n = 1; n < 1000; n++) {
        sim_operator_frame(&oa, &a, n * 1e-3, ra);
        sim_operator_frame(&ob, &b, n * 1e-3, rb);
        for (unsigned i = 0; i < SENSORS; i++) {
            const int is_read = (int)(reads >> i & 1);
            const int16_t want = is_read ? ra[i] : first[i];
            CHECK(rb[i] == want, "channel %u, frame %d: %d, not %d", i, n, rb[i], want);
            moved += !is_read && ra[i] != first[i];
        }
    }
    CHECK(moved > 10000, "%d codes of the others", moved);
}

TEST_MAIN("glove_chain", sine_and_cosine_are_good_to_their_bound, volt_and_code_of_an_angle,
    end_points_span_what_the_default_calibration_says, codes_round_and_saturate,
    abduction_is_bent_by_its_neighbours, a_step_is_an_exponential, a_sine_comes_smaller_and_later,
    polynomials_come_as_the_equation_says, channels_are_held_one_interval_apart,
    the_multiplexer_keeps_some_of_the_channel_before, the_default_card_settles_to_a_code,
    noise_is_the_papers_peak_to_peak, faults_read_as_they_would, a_stuck_code_stays,
    parameters_are_refused_by_range, poses_lie_in_range_and_show_both_ends,
    a_movement_is_minimum_jerk, scripts_go_on_by_themselves, advance_does_not_depend_on_its_steps,
    a_recording_is_played_through_its_rows, codes_hang_on_the_seed_alone,
    what_is_kept_is_what_is_so, a_channel_that_is_not_read_changes_no_other);
