/* SPDX-License-Identifier: MIT */
/* The simulated plant against closed form: what it is sold for must be provable
 * without the controller. References are computed in long double, by series. */
#include "check.h"
#include "exp_neg.h"

#include "sim/grid.h"
#include "sim/lanes.h"
#include "sim/plant.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define TWO_PI_L 6.283185307179586476925286766559L

static double root_of(double v)
{
    double r = v > 1 ? v : 1;
    for (int i = 0; i < 100; i++) { r = 0.5 * (r + v / r); }
    return r;
}

static long double wide(double v) { return (long double)v; }

/* A device without friction, noise or delay; a test adds what it looks at. */
static struct sim_device smooth(void)
{
    struct sim_device d = sim_device_default();
    d.mu_motor = d.mu_mass = d.coulomb_n = d.viscous_nspm = 0;
    return d;
}

static uint64_t below(uint64_t n) { return check_u64() % n; }

/* Uniform between two ends. */
static double between(double lo, double hi)
{
    return lo + (hi - lo) * (double)below(1u << 30) / (double)(1u << 30);
}

/* ---- Free fall --------------------------------------------------------------- */

/* Speed with which a mass let go at -h crosses 0. */
static double impact_mps(const struct sim_device *d, double h_m, double step_s)
{
    struct plant p = {-h_m, 0, -h_m, 0, 0, 0};
    struct plant last = p;
    while (p.x_m < 0) {
        last = p;
        plant_advance(&p, d, step_s, 0, 0);
    }
    return last.v_mps + (p.v_mps - last.v_mps) * (0 - last.x_m) / (p.x_m - last.x_m);
}

TEST(impact_speed_is_that_of_a_free_fall)
{
    static const struct {
        double mass_kg, h_m, cable_npm, cable_nspm;
    } row[] = {
        {0.5, 0.07, 1e5, 1},
        {0.5, 0.07, 1e6, 1},
        {0.5, 0.07, 2302, 7},
        {0.5, 0.5, 1e5, 1},
        {5, 0.07, 1e5, 1},
        {0.1, 0.001, 1e5, 1},
        {0.02, 0.07, 1e5, 1},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct sim_device d = smooth();
        double ideal, got;
        d.rotor_kg = 0.0001; /* the lightest that may be set: dragged along */
        d.substep_s = 1e-6;
        d.mass_kg = row[i].mass_kg;
        d.cable_npm = row[i].cable_npm;
        d.cable_nspm = row[i].cable_nspm;
        ideal = root_of(2 * SIM_GRAVITY * row[i].h_m);
        got = impact_mps(&d, row[i].h_m, 1e-4);
        CHECK(fabs(got - ideal) <= 0.005 * ideal, "row %zu: %.6f m/s, want %.6f", i, got, ideal);
    }
}

/* The rotor's share of the inertia is not lost: both fall as one. */
TEST(a_rotor_slows_the_fall_by_its_share)
{
    static const double rotor_kg[] = {0.0495, 0.5, 1};
    for (size_t i = 0; i < LEN(rotor_kg); i++) {
        struct sim_device d = smooth();
        double ideal, got;
        d.rotor_kg = rotor_kg[i];
        d.cable_npm = 1e5;
        d.substep_s = 1e-6;
        ideal = root_of(2 * SIM_GRAVITY * 0.07 * d.mass_kg / (d.mass_kg + d.rotor_kg));
        got = impact_mps(&d, 0.07, 1e-4);
        CHECK(fabs(got - ideal) <= 0.005 * ideal, "rotor %.4f kg: %.6f m/s, want %.6f", rotor_kg[i],
            got, ideal);
    }
}

TEST(what_is_held_does_not_move)
{
    struct sim_device d = sim_device_default();
    struct plant p = {-0.07, 0, -0.07, 0, 0, 0};
    plant_advance(&p, &d, 1, 3.3, 1);
    CHECK(p.x_m == -0.07 && p.q_m == -0.07 && p.v_mps == 0 && p.w_mps == 0, "x %.9g q %.9g", p.x_m,
        p.q_m);
    CHECK(fabs(p.cur_A - 3.3) < 1e-9, "its current flows all the same: %.12f A", p.cur_A);
}

/* Else a plant that went beyond all numbers would look as if it rested. */
TEST(what_is_no_number_stays_none)
{
    const struct sim_device d = sim_device_default();
    struct plant p = {0.01, (double)NAN, 0.01, (double)NAN, 0, 0};
    plant_advance(&p, &d, 1e-3, 0, 0);
    CHECK(isnan(p.v_mps) && isnan(p.w_mps), "%g, %g m/s", p.v_mps, p.w_mps);
}

/* ---- Stiction ---------------------------------------------------------------- */

/* The mass is on a string stretched for `tension`, and the rotor is stuck. The load of the mass is
 * m g - tension, its friction mu times tension. */
static struct plant hanging(struct sim_device *d, double tension_N, double mu)
{
    struct plant p = {0, 0, 0, 0, 0, 0};
    *d = smooth();
    d->coulomb_n = 10;
    d->mu_mass = mu;
    p.x_m = tension_N / d->cable_npm;
    return p;
}

TEST(stiction_holds_without_creep)
{
    const double weight_N = 0.5 * SIM_GRAVITY;
    static const struct {
        double tension; /* share of the weight */
        double mu;      /* times the tension must be above the load */
        double substep_s;
    } row[] = {
        {0.90, 0.2, 25e-6},
        {0.90, 0.1123, 25e-6},
        {1.10, 0.0920, 25e-6},
        {0.60, 0.7, 25e-6},
        {0.90, 0.1123, 1e-3},
        {0.90, 0.1123, 1e-6},
        {1, 0.0001, 25e-6},
        {0.999, 0.002, 100e-6},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct sim_device d;
        struct plant p = hanging(&d, row[i].tension * weight_N, row[i].mu);
        const double x = p.x_m;
        d.substep_s = row[i].substep_s;
        for (int ms = 0; ms < 10000; ms++) {
            plant_advance(&p, &d, 1e-3, 0, 0);
            CHECK(p.v_mps == 0 && p.x_m == x && p.w_mps == 0 && p.q_m == 0,
                "row %zu, %d ms: v %.3g w %.3g, crept %.3g", i, ms, p.v_mps, p.w_mps, p.x_m - x);
        }
    }
}

/* The other side of the same edge: one per cent less friction lets go. */
TEST(stiction_lets_go_at_its_limit)
{
    static const double tension[] = {0.9, 1.1, 0.6};
    for (size_t i = 0; i < LEN(tension); i++) {
        const double load = fabs(1 - tension[i]) / tension[i];
        for (int more = 0; more <= 1; more++) {
            struct sim_device d;
            struct plant p =
                hanging(&d, tension[i] * 0.5 * SIM_GRAVITY, load * (0.99 + 0.02 * more));
            const double x = p.x_m;
            plant_advance(&p, &d, 0.02, 0, 0);
            CHECK((p.x_m == x) == more, "tension %.1f, friction %s its load: moved %.3g m",
                tension[i], more ? "above" : "below", p.x_m - x);
        }
    }
}

/* Coulomb friction alone stops a rotor after v m / F, never turns it, and keeps it. */
TEST(friction_stops_in_closed_form)
{
    static const double speed_mps[] = {0.1, 1, -1, 0.003};
    for (size_t i = 0; i < LEN(speed_mps); i++) {
        struct sim_device d = smooth();
        struct plant p = {-1, 0, 0, speed_mps[i], 0, 0}; /* the string is slack */
        double stop_s, path_m, q_m;
        d.coulomb_n = 0.05;
        stop_s = fabs(speed_mps[i]) * d.rotor_kg / d.coulomb_n;
        path_m = 0.5 * speed_mps[i] * stop_s;
        for (double t = 0; t < 1.2 * stop_s; t += stop_s / 100) {
            p.x_m = -1;
            plant_advance(&p, &d, stop_s / 100, 0, 0);
            CHECK(p.w_mps * speed_mps[i] >= 0, "turned at %.4f s: %.3g m/s", t, p.w_mps);
        }
        q_m = p.q_m;
        CHECK(p.w_mps == 0, "still %.3g m/s", p.w_mps);
        CHECK(fabs(q_m - path_m) <= fabs(speed_mps[i]) * d.substep_s, "path %.9f, want %.9f", q_m,
            path_m);
        p.x_m = -1;
        p.v_mps = 0;
        plant_advance(&p, &d, 0.1, 0, 0);
        CHECK(p.q_m == q_m, "moved again by %.3g", p.q_m - q_m);
    }
}

/* ---- String ------------------------------------------------------------------ */

static double law_N(const struct sim_device *d, double stretch_m, double opening_mps)
{
    const double T = d->cable_npm * stretch_m + d->cable_nspm * opening_mps;
    return stretch_m < 0 || T < 0 ? 0 : T;
}

/* Tension at the mass and at the rotor in one sub-step without friction. It is that of the stretch
 * half a step later. The speeds are those that the law's own tension gives by then. */
TEST(the_string_only_pulls_and_pulls_both_ends_alike)
{
    while (check_case(10)) {
        struct sim_device d = smooth();
        struct plant p = {between(-0.05, 0.05), between(-10, 10), 0, between(-10, 10), 0, 0};
        const double v = p.v_mps, w = p.w_mps;
        const double h = d.substep_s * 0.999; /* one step */
        const double mid_m = p.x_m - p.q_m + h / 2 * (v - w);
        double mass_N, rotor_N, first_N, want_N, tiny_N;
        d.cable_npm = between(100, 1e6);
        d.cable_nspm = between(0, 1000);
        plant_advance(&p, &d, h, 0, 0);
        mass_N = d.mass_kg * (SIM_GRAVITY - (p.v_mps - v) / h);
        rotor_N = d.rotor_kg * (p.w_mps - w) / h;
        first_N = law_N(&d, mid_m, v - w);
        want_N = law_N(
            &d, mid_m, v - w + h / 2 * (SIM_GRAVITY - first_N / d.mass_kg - first_N / d.rotor_kg));
        tiny_N = 1e-9 * (1 + want_N + first_N + d.mass_kg * fabs(v) / h * 1e-6);
        CHECK(mass_N >= -tiny_N && rotor_N >= -tiny_N, "pushes: %.9g N, %.9g N", mass_N, rotor_N);
        CHECK(fabs(mass_N - rotor_N) <= tiny_N, "%.9g N at the mass, %.9g at the rotor", mass_N,
            rotor_N);
        CHECK(fabs(rotor_N - want_N) <= tiny_N, "%.9g N, law %.9g", rotor_N, want_N);
        if (mid_m < 0) { CHECK(p.w_mps == w, "slack, yet the rotor feels %.3g N", rotor_N); }
    }
}

/* ---- First-order lags ---------------------------------------------------------- */

/* 1 ms of a 1 A step in pieces of every size: 1 - exp(-t/tau) at each. */
TEST(current_loop_is_exact_at_any_substep)
{
    static const double substep_s[] = {1e-7, 1e-6, 7.3e-6, 25e-6, 100e-6, 1e-3};
    static const double piece_s[] = {1e-3, 123.4e-6, 50e-6, 3e-6};
    static const double band_hz[] = {50, 1154, 20000};
    for (size_t i = 0; i < LEN(substep_s) * LEN(piece_s) * LEN(band_hz); i++) {
        struct sim_device d = smooth();
        struct plant p = {0};
        const double piece = piece_s[i / LEN(substep_s) % LEN(piece_s)];
        d.substep_s = substep_s[i % LEN(substep_s)];
        d.current_hz = band_hz[i / LEN(substep_s) / LEN(piece_s)];
        for (int n = 1; n * piece <= 1.0001e-3; n++) {
            const long double x = TWO_PI_L * wide(d.current_hz) * n * wide(piece);
            const double want = (double)(1 - exp_neg(x));
            plant_advance(&p, &d, piece, 1, 1);
            CHECK(fabs(p.cur_A - want) <= 1e-9, "substep %.3g, %.1f Hz, %.3g s: %.12f, want %.12f",
                d.substep_s, d.current_hz, n * piece, p.cur_A, want);
        }
    }
}

/* Behind the loop, the monitor's lag: both poles in closed form, at any sub-step. */
TEST(monitor_lags_behind_the_current)
{
    static const double lag_s[] = {566e-6, 50e-6, 1e-5, 0.01};
    for (size_t i = 0; i < LEN(lag_s); i++) {
        struct sim_device d = smooth();
        struct plant p = {0};
        d.substep_s = 30e-6;
        d.mon_lag_s = lag_s[i];
        for (int n = 1; n <= 100; n++) {
            const long double t = n * 50e-6L, b = wide(lag_s[i]);
            const long double a = 1 / (TWO_PI_L * wide(d.current_hz));
            const double want = (double)(1 - (b * exp_neg(t / b) - a * exp_neg(t / a)) / (b - a));
            plant_advance(&p, &d, 50e-6, 1, n % 2); /* held or not, in one piece or two */
            CHECK(fabs(p.mon_A - want) <= 1e-9, "lag %.3g s, %d: %.12f, want %.12f", lag_s[i], n,
                p.mon_A, want);
        }
        d.mon_lag_s = 0;
        plant_advance(&p, &d, 50e-6, 2, 1);
        CHECK(p.mon_A == p.cur_A, "without lag it is the current");
    }
}

/* Two equal poles: 1 - (1 + t/a) e^(-t/a), and nothing jumps where they are nearly equal. */
TEST(a_monitor_as_fast_as_the_current)
{
    static const double off[] = {0, 1e-12, 1e-8, -1e-6, 0.99e-4, 1.01e-4, -0.99e-4, -1.01e-4};
    for (size_t i = 0; i < LEN(off); i++) {
        struct sim_device d = smooth();
        struct plant p = {0};
        const long double a = 1 / (TWO_PI_L * wide(d.current_hz));
        d.mon_lag_s = (double)a * (1 + off[i]);
        for (int n = 1; n <= 20; n++) {
            const long double t = n * 50e-6L / a;
            const double want = (double)(1 - (1 + t) * exp_neg(t));
            const double shift = (double)(t * t * exp_neg(t)) * -off[i] / 2; /* first order */
            plant_advance(&p, &d, 50e-6, 1, 1);
            CHECK(fabs(p.mon_A - want - shift) <= 2e-8, "%g apart, %d: %.12f, want %.12f", off[i],
                n, p.mon_A, want + shift);
        }
    }
}

TEST(exp_neg_is_good_to_1e_12)
{
    double worst = 0, at = 0;
    CHECK(exp_neg(1) - 0.367879441171442321595524L < 1e-18L &&
              exp_neg(1) - 0.367879441171442321595524L > -1e-18L,
        "the reference itself");
    for (int i = 0; i <= 700000; i++) {
        const double x = i < 350000 ? i * (1.0 / 350000) : (i - 350000) * (700.0 / 350000);
        const long double want = exp_neg(wide(x));
        const double err = fabs((double)((wide(sim_exp_neg(x)) - want) / want));
        if (err > worst) {
            worst = err;
            at = x;
        }
    }
    CHECK(sim_exp_neg(0) == 1, "exp(0)");
    CHECK(sim_exp_neg(1e9) == 0, "exp(-1e9)");
    CHECK(worst <= 1e-12, "relative error %.3g at %.6g", worst, at);
}

/* ---- Energy ------------------------------------------------------------------ */

/* Leapfrog does not conserve the energy E. It conserves D = E - h^2/8 dU''(v, v), exactly if the
 * force is linear. Otherwise E changes by h times the mean speed times the forces outside U, and by
 * h^2/8 U'' of the speeds.
 *
 * So D must not grow, with three exceptions. A sub-step in which the string becomes slack or taut
 * may add 5/8 k (v h)^2. A loss Fl at another speed than the mean may add h^2/2 (1/m + 1/mr) F Fl,
 * where F is the sum of all forces. Rounding is the third. */
struct energy {
    double e_J, d_J; /* energy, and the one that the method keeps */
    double may_J;    /* how much D may grow in the sub-step that begins here */
    double edge_J;   /* and more if the string goes slack or taut in it */
    int taut, taut_mid;
};

static struct energy energy_of(const struct plant *p, const struct sim_device *d, double h)
{
    const double stretch = p->x_m - p->q_m, s = stretch > 0 ? stretch : 0;
    const double opening = p->v_mps - p->w_mps, mid = stretch + h / 2 * opening;
    const double weight_N = d->mass_kg * SIM_GRAVITY, elastic_N = d->cable_npm * s;
    const double damper_N = s > 0 || mid > 0 ? d->cable_nspm * fabs(opening) : 0;
    const double loss_N = damper_N + (d->mu_mass + d->mu_motor) * (elastic_N + damper_N) +
                          d->coulomb_n + d->viscous_nspm * fabs(p->w_mps);
    const double all_N = elastic_N + d->cable_npm * h / 2 * fabs(opening) + weight_N + loss_N;
    struct energy e;
    e.e_J = 0.5 * (d->mass_kg * p->v_mps * p->v_mps + d->rotor_kg * p->w_mps * p->w_mps +
                      elastic_N * s) -
            weight_N * p->x_m;
    e.edge_J = 0.625 * d->cable_npm * h * h * opening * opening;
    e.d_J = e.e_J - (s > 0 ? e.edge_J / 5 : 0);
    e.may_J =
        h * h / 2 * (1 / d->mass_kg + 1 / d->rotor_kg) * all_N * loss_N + 1e-13 * (1 + fabs(e.e_J));
    e.taut = s > 0;
    e.taut_mid = mid > 0;
    return e;
}

/* 2000 sub-steps; the worst growth of D beyond what it may, J, and E at both ends. */
static void run_free(
    struct plant p, const struct sim_device *d, struct energy *first, struct energy *last)
{
    const double h = 0.999 * d->substep_s; /* one sub-step a call */
    *first = *last = energy_of(&p, d, h);
    for (int i = 0; i < 2000; i++) {
        double may_J = last->may_J;
        struct energy now;
        plant_advance(&p, d, h, 0, 0);
        now = energy_of(&p, d, h);
        if (now.taut != last->taut || now.taut != last->taut_mid) {
            may_J += now.edge_J > last->edge_J ? now.edge_J : last->edge_J;
        }
        CHECK(now.d_J - last->d_J <= may_J, "step %d: grew by %.3g J, may by %.3g", i,
            now.d_J - last->d_J, may_J);
        *last = now;
    }
}

TEST(energy_never_grows_with_the_motor_off)
{
    int slack = 0;
    while (check_case(5000)) {
        const struct sim_device full = sim_device_default();
        const struct plant p = {between(-0.01, 0.01), between(-1, 1), 0, between(-1, 1), 0, 0};
        struct sim_device d = below(2) ? full : smooth();
        struct energy first, last;
        d.cable_nspm = below(2) ? full.cable_nspm : 0;
        d.cable_npm = below(2) ? full.cable_npm : 1e5;
        d.substep_s = below(2) ? 100e-6 : 25e-6;
        run_free(p, &d, &first, &last);
        CHECK(last.e_J <= first.e_J + 0.02 * fabs(first.e_J) + 1e-3, "from %.6f J to %.6f J",
            first.e_J, last.e_J);
        slack += !last.taut;
    }
    CHECK(slack > 0, "no case ended slack: the bound at the edge was not tried");
}

/* ---- Convergence --------------------------------------------------------------- */

/* The mass on the damped string over a stuck rotor, as a linear flow: e^(At) of the
 * offset from where it hangs. */
static double swing_m(const struct sim_device *d, double x0_m, double t_s)
{
    const long double m = wide(d->mass_kg), t = wide(t_s);
    const long double rest = m * wide(SIM_GRAVITY) / wide(d->cable_npm);
    const long double k = wide(d->cable_npm) / m, b = wide(d->cable_nspm) / m;
    long double y = wide(x0_m) - rest, v = 0, y_sum = y;
    for (int i = 1; i < 100; i++) { /* Taylor; 7 rad, far below the cancellation that hurts */
        const long double dy = v, dv = -k * y - b * v;
        y = dy * t / i;
        v = dv * t / i;
        y_sum += y;
    }
    return (double)(rest + y_sum);
}

TEST(a_quarter_of_the_error_with_half_the_substep)
{
    struct sim_device d = smooth();
    double last = 0;
    d.coulomb_n = 100; /* the rotor is stuck */
    for (int i = 0; i < 6; i++) {
        struct plant p = {0.0015, 0, 0, 0, 0, 0}; /* 2.1 mm is rest: it never goes slack */
        double err;
        d.substep_s = 1e-3 / (1 << i) * 1.0000001;
        plant_advance(&p, &d, 0.1, 0, 0);
        err = fabs(p.x_m - swing_m(&d, 0.0015, 0.1));
        CHECK(err > 0 && err < 0.5 * d.substep_s * d.substep_s, "substep %.3g s: error %.3g m",
            d.substep_s, err);
        if (i > 0) {
            CHECK(last / err > 3.6 && last / err < 4.4, "substep %.3g s: error falls by %.3f",
                d.substep_s, last / err);
        }
        last = err;
    }
}

/* Both bodies slide one way on a taut string that damps, each with a separate friction. The loss by
 * friction is also of second order. */
TEST(friction_is_of_second_order)
{
    static const double mu[][2] = {{0.4, 0}, {0, 0.4}, {0.3, 0.1}};
    for (size_t n = 0; n < LEN(mu); n++) {
        const struct plant start = {0.002, 0.5, 0, 0.3, 0, 0};
        struct sim_device d = smooth();
        struct plant exact = start;
        double last = 0;
        d.cable_nspm = 20;
        d.mu_mass = mu[n][0];
        d.mu_motor = mu[n][1];
        d.substep_s = 1e-7;
        plant_advance(&exact, &d, 0.004, 0, 0);
        CHECK(exact.v_mps > 0.1 && exact.w_mps > 0.1 && exact.x_m > exact.q_m, "a body stops");
        for (int i = 0; i < 4; i++) {
            struct plant p = start;
            double err;
            d.substep_s = 2.5e-4 / (1 << i) * 1.0000001;
            plant_advance(&p, &d, 0.004, 0, 0);
            err = fabs(p.q_m - exact.q_m);
            if (i > 0) {
                CHECK(last / err > 3.4 && last / err < 4.6,
                    "row %zu, substep %.3g s: falls by %.3f", n, d.substep_s, last / err);
            }
            last = err;
        }
    }
}

/* ---- Steps that are short enough ------------------------------------------------ */

/* The force error of a taut string after 2000 steps, and that of its damping, as multiples of the
 * first deviation. The motor carries the mass's weight, or a hand at rest holds the mass. */
static double grown(const struct sim_device *d, double hand_npm, double hand_nspm, double step_s)
{
    const double weight_N = d->mass_kg * SIM_GRAVITY, rest_m = weight_N / d->cable_npm;
    const struct plant_hand hand = {
        hand_npm, hand_nspm, weight_N / (hand_npm > 0 ? hand_npm : 1), 0, -1};
    struct sim_device fixed = *d;
    struct plant p = {1.1 * rest_m, 0, 0, 0, weight_N / d->kf_npa, 0};
    double most = 0, off_N;
    fixed.substep_s = step_s * 1.0001;
    p.x_m -= hand_npm > 0 ? 0.1 * rest_m : 0;
    p.q_m -= hand_npm > 0 ? 0.1 * rest_m : 0;
    for (int i = 0; i < 200; i++) {
        if (hand_npm > 0) {
            struct plant_hand h = hand;
            h.x_m += rest_m; /* so that it is at rest where x = rest, q = 0 */
            plant_advance_hand(&p, &fixed, 10 * step_s, weight_N / d->kf_npa, &h);
        } else {
            plant_advance(&p, &fixed, 10 * step_s, weight_N / d->kf_npa, 0);
        }
        off_N =
            d->cable_npm * fabs(p.x_m - p.q_m - rest_m) + d->cable_nspm * fabs(p.v_mps - p.w_mps);
        if (!(off_N < 1e6 * weight_N)) { return 1e6; }
        if (i > 150 && off_N > most) { most = off_N; }
    }
    return most / (0.1 * weight_N);
}

/* The longest that will do, to 1 %. */
static double longest_s(struct sim_device d, double hand_npm, double hand_nspm)
{
    d.substep_s = 1;
    while (!plant_step_will_do(&d, hand_npm, hand_nspm)) { d.substep_s /= 1.01; }
    return d.substep_s;
}

TEST(steps_that_will_do_are_stable)
{
    int tried[2] = {0, 0};
    for (int i = 0; i < 300; i++) {
        const double hand_npm = i % 2 ? between(1, 4) * between(1, 2500) : 0;
        struct sim_device d = smooth();
        const double hand_nspm = i % 4 == 1 ? between(0, 100) : 0;
        double step_s, bad, good, damps;
        d.cable_npm = between(1, 10) * between(100, 100000);
        d.cable_nspm = below(2) ? 0 : between(0, 1000) * between(0, 1);
        d.rotor_kg = between(0.01, 1) * between(0.01, 1);
        d.viscous_nspm = i % 3 ? 0 : between(0, 100);
        d.mass_kg = between(0.001, 5) * between(0.1, 1);
        step_s = longest_s(d, hand_npm, hand_nspm);
        good = grown(&d, hand_npm, hand_nspm, step_s);
        CHECK(good <= 1.3,
            "string %g N/m %g Ns/m, rotor %g, mass %g kg, hand %g: grows by %g at %g s",
            d.cable_npm, d.cable_nspm, d.rotor_kg, d.mass_kg, hand_npm, good, step_s);
        /* Beyond the limit of the spring damping helps; beyond its own nothing does but friction.
         */
        damps = 2.05 * step_s * d.cable_nspm * (1 / d.mass_kg + 1 / d.rotor_kg);
        if (hand_npm > 0 || d.viscous_nspm > 0 || (damps > 0 && damps < 2.02)) { continue; }
        tried[damps > 0]++;
        bad = grown(&d, 0, 0, 2.05 * step_s);
        CHECK(bad >= 1.5, "string %g N/m, rotor %g, mass %g kg: %g at %g s", d.cable_npm,
            d.rotor_kg, d.mass_kg, bad, 2.05 * step_s);
    }
    CHECK(
        tried[0] > 20 && tried[1] > 20, "%d by the spring, %d by its damping", tried[0], tried[1]);
}

/* Where what is damped goes at a steady speed, dry friction takes its share of the force. */
static double off_steady(struct sim_device d, double hand_nspm, double step_s)
{
    const struct plant free = {0};
    struct plant p[2] = {free, free};
    double most = 0;
    for (int i = 0; i < 40; i++) {
        const double at_s = 250e-6 * i;
        const struct plant_hand hand = {300, hand_nspm, 0.1 * at_s, 0.1, -1};
        for (int k = 0; k < 2; k++) {
            d.substep_s = k ? 1e-6 : step_s;
            plant_advance_hand(&p[k], &d, 250e-6, 1, &hand);
        }
        if (i < 8) { continue; } /* what the beginning took */
        if (fabs(p[0].v_mps - p[1].v_mps) > most) { most = fabs(p[0].v_mps - p[1].v_mps); }
        if (fabs(p[0].w_mps - p[1].w_mps) > most) { most = fabs(p[0].w_mps - p[1].w_mps); }
    }
    return most;
}

TEST(friction_beside_strong_damping_takes_what_it_takes)
{
    struct sim_device finger = sim_device_default(), rotor = sim_device_default();
    double good, bad;
    finger.mass_kg = 0.005;
    good = off_steady(finger, 100, longest_s(finger, 300, 100));
    bad = off_steady(finger, 100, 250e-6);
    CHECK(good < 0.004 && bad > 0.01, "finger: off by %g m/s, by %g in steps that are too long",
        good, bad);
    rotor.rotor_kg = 0.001;
    rotor.viscous_nspm = 100;
    good = off_steady(rotor, 5, longest_s(rotor, 300, 5));
    bad = off_steady(rotor, 5, 250e-6);
    CHECK(good < 0.004 && bad > 0.01, "rotor: off by %g m/s, by %g in steps that are too long",
        good, bad);
}

TEST(the_step_that_is_named_will_do)
{
    struct sim_device d = sim_device_default();
    CHECK(plant_step_will_do(&d, 0, 0) && plant_step_that_will_do(&d, 0, 0) == 1e-3,
        "of the device itself");
    d.cable_npm = 1e6;
    d.rotor_kg = 1e-3;
    for (int i = 0; i < 60; i++) {
        const double limit_s = longest_s(d, 0, 0), named_s = plant_step_that_will_do(&d, 0, 0);
        if (limit_s < 0.99e-7) {
            CHECK(named_s == 0, "%g s is named where %g is the limit", named_s, limit_s);
        } else {
            CHECK((named_s == 0 && limit_s < 1.01e-7) ||
                      (named_s <= 1.02 * limit_s && (named_s > limit_s / 2.6 || named_s == 1e-3)),
                "%g s, limit %g", named_s, limit_s);
        }
        d.rotor_kg *= 0.93;
        d.cable_nspm *= 1.05;
        d.mu_motor = i % 3;
    }
}

/* The kept pieces equal those of a new computation, for any requests between. Ticks, outputs and
 * servo samples on the grid need few of them. */
TEST(pieces_on_the_grid_are_few_and_what_they_would_be)
{
    static struct plant_pieces kept;
    const struct sim_device d = sim_device_default();
    const size_t values_B = sizeof(struct plant_piece) - offsetof(struct plant_piece, h_s);
    double sum_s = 0, at_s = 0, servo_s = 113e-6;
    int pieces = 0, anew = 0;
    for (int n = 1; n < 40000; n++) {
        const double tick_s = n / 2000.0;
        while (at_s < tick_s) {
            const double to_s = servo_s < tick_s ? servo_s : tick_s;
            const double dt_s = sim_grid_s(at_s, to_s);
            const struct plant_piece want = plant_piece_of(&d, dt_s);
            const int known = kept.dt_s[sim_grid_slot(dt_s, PLANT_PIECES)] == dt_s;
            const struct plant_piece *is = plant_pieces_find(&kept, &d, dt_s, 0);
            CHECK(fabs(dt_s - (to_s - at_s)) < 2e-14, "%g s is %g s off", dt_s, dt_s - to_s + at_s);
            CHECK(is->n == want.n && memcmp(&is->h_s, &want.h_s, values_B) == 0, "%.17g s", dt_s);
            pieces++;
            anew += !known;
            if (to_s == servo_s) { servo_s += 1 / 4000.0; }
            sum_s += dt_s;
            at_s = to_s;
        }
    }
    CHECK(sum_s == sim_grid(at_s), "the pieces are %g s off", sum_s - at_s);
    CHECK(pieces > 100000 && anew < pieces / 7, "%d of %d pieces anew", anew, pieces);
    CHECK(sim_grid(1e6) == 1e6 && sim_grid_s(70000.1, 70000.2) == 70000.2 - 70000.1, "later");
}

/* Plants with another number of sub-steps each, one with none, and lanes without a plant. */
TEST(side_by_side_they_go_as_alone)
{
    struct sim_lanes each;
    struct sim_lane_pieces pieces;
    struct sim_device d[6];
    struct plant alone[6];
    struct plant_piece piece[6];
    memset(&each, 0, sizeof each);
    memset(&pieces, 0, sizeof pieces);
    memset(alone, 0, sizeof alone);
    for (int k = 0; k < 6; k++) {
        d[k] = sim_device_default();
        d[k].rotor_kg *= 1 + 0.3 * k;
        d[k].substep_s = 100e-6 / (k + 1);
        piece[k] = plant_piece_of(&d[k], 200e-6 + 17e-6 * k);
        alone[k].x_m = 1e-3 * k;
        if (k == 3) { piece[k].n = 0; }
        sim_lanes_set(&each, k, &alone[k], &d[k]);
        sim_lane_pieces_set(&pieces, k, &piece[k]);
    }
    for (int n = 0; n < 20000; n++) {
        double ref_A[SIM_LANES] = {0};
        for (int k = 0; k < 6; k++) {
            ref_A[k] = n / 500 % 2 ? 0.4 + 0.1 * k : 0.05;
            if (piece[k].n) { plant_advance_piece(&alone[k], &d[k], &piece[k], ref_A[k]); }
        }
        sim_lanes_advance(&each, &pieces, ref_A, 6);
        for (int k = 0; k < 6; k++) {
            CHECK(each.x_m[k] == alone[k].x_m && each.v_mps[k] == alone[k].v_mps &&
                      each.q_m[k] == alone[k].q_m && each.w_mps[k] == alone[k].w_mps &&
                      each.cur_A[k] == alone[k].cur_A,
                "plant %d, step %d", k, n);
        }
    }
    CHECK(each.x_m[3] == 3e-3 && each.x_m[0] != each.x_m[1], "%g m", each.x_m[3]);
}

TEST_MAIN("plant", impact_speed_is_that_of_a_free_fall, a_rotor_slows_the_fall_by_its_share,
    what_is_held_does_not_move, what_is_no_number_stays_none, stiction_holds_without_creep,
    stiction_lets_go_at_its_limit, friction_stops_in_closed_form,
    the_string_only_pulls_and_pulls_both_ends_alike, current_loop_is_exact_at_any_substep,
    monitor_lags_behind_the_current, a_monitor_as_fast_as_the_current, exp_neg_is_good_to_1e_12,
    energy_never_grows_with_the_motor_off, a_quarter_of_the_error_with_half_the_substep,
    friction_is_of_second_order, steps_that_will_do_are_stable,
    friction_beside_strong_damping_takes_what_it_takes, the_step_that_is_named_will_do,
    pieces_on_the_grid_are_few_and_what_they_would_be, side_by_side_they_go_as_alone);
