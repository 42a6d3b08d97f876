/* SPDX-License-Identifier: MIT */
/* The exact stability test against what is known without it: closed forms, matrices of
 * known eigenvalues, published-in-theory radii, its own limits. */
#include "check.h"

#include "sim/linear.h"
#include "sim/plant.h"

#include <math.h>

static double between(double lo, double hi)
{
    return lo + (hi - lo) * (double)(check_u64() >> 11) / 9007199254740992.0;
}

/* ---- Matrix exponential --------------------------------------------------------- */

/* Phi and Gamma of one mass behind a lag, in closed form. */
TEST(the_flow_is_the_closed_form)
{
    while (check_case(200)) {
        const double m = between(0.01, 2), c = between(0.5, 20), tau = between(1e-4, 2e-3);
        const double t = between(0, 0.02), p = c / m, q = 1 / tau;
        const double ep = sim_exp_neg(p * t), eq = sim_exp_neg(q * t);
        const struct linear_plant plant = linear_one_mass(m, c, tau);
        const struct linear_flow f = linear_flow(&plant, t);
        const struct {
            double got, want;
        } row[] = {
            {f.phi[0][0], 1},
            {f.phi[0][1], (1 - ep) / p},
            {f.phi[1][1], ep},
            {f.phi[2][2], eq},
            {f.phi[1][2], -(eq - ep) / (p - q) / m},
            {f.phi[0][2], -((1 - eq) / q - (1 - ep) / p) / (p - q) / m},
            {f.gamma[2], 1 - eq},
            {f.phi[1][0], 0},
            {f.phi[2][0], 0},
            {f.phi[2][1], 0},
        };
        if (fabs(p - q) < 0.01 * q) { continue; } /* there the closed form cancels */
        for (size_t i = 0; i < LEN(row); i++) {
            CHECK(fabs(row[i].got - row[i].want) <= 1e-10 * (1e-3 + fabs(row[i].want)),
                "m %g c %g tau %g t %g, entry %zu: %.15g, want %.15g", m, c, tau, t, i, row[i].got,
                row[i].want);
        }
    }
}

TEST(the_flow_without_lag_is_the_closed_form)
{
    while (check_case(200)) {
        const double m = between(0.01, 2), c = between(0.5, 20), t = between(0, 0.02), p = c / m;
        const struct linear_plant damped = linear_one_mass(m, c, 0),
                                  free = linear_one_mass(m, 0, 0);
        const struct linear_flow f = linear_flow(&damped, t), g = linear_flow(&free, t);
        const double e = 1 - sim_exp_neg(p * t);
        CHECK(fabs(f.gamma[0] + (t - e / p) / c) <= 1e-12, "%.15g", f.gamma[0]);
        CHECK(fabs(f.gamma[1] + e / c) <= 1e-12, "%.15g", f.gamma[1]);
        CHECK(fabs(g.gamma[0] + t * t / (2 * m)) <= 1e-15, "%.15g", g.gamma[0]);
        CHECK(fabs(g.gamma[1] + t / m) <= 1e-13 && g.phi[0][1] == t, "%.15g", g.gamma[1]);
    }
}

/* e^(A(s+t)) = e^(As) e^(At) for the device, whose flow has no handy closed form. */
TEST(flows_follow_each_other)
{
    while (check_case(100)) {
        const struct sim_device d = sim_device_default();
        const struct linear_plant p = linear_two_mass(&d);
        const double s = between(0, 0.011), t = between(0, 0.011);
        const struct linear_flow a = linear_flow(&p, s), b = linear_flow(&p, t);
        const struct linear_flow both = linear_flow(&p, s + t);
        for (int i = 0; i < p.n; i++) {
            double g = b.gamma[i];
            for (int j = 0; j < p.n; j++) {
                double sum = 0;
                g += b.phi[i][j] * a.gamma[j];
                for (int k = 0; k < p.n; k++) { sum += b.phi[i][k] * a.phi[k][j]; }
                CHECK(fabs(sum - both.phi[i][j]) <= 1e-9 * (1 + fabs(sum)), "%d %d: %.15g %.15g", i,
                    j, sum, both.phi[i][j]);
            }
            CHECK(fabs(g - both.gamma[i]) <= 1e-9 * (1 + fabs(g)), "%d: %.15g", i, g);
        }
    }
}

/* ---- Spectral radius -------------------------------------------------------------- */

/* The companion matrix of (z - r1)(z - r2)... with n real roots, then pairs re +- im i. */
static struct matrix companion(const double *real, int reals, const double (*pair)[2], int pairs)
{
    static struct matrix M;
    double c[EIGEN_MAX + 1] = {1}; /* highest power first */
    int n = 0;
    for (int i = 0; i < reals; i++, n++) {
        for (int j = n + 1; j > 0; j--) { c[j] -= real[i] * c[j - 1]; }
    }
    for (int i = 0; i < pairs; i++, n += 2) {
        const double s = 2 * pair[i][0], p = pair[i][0] * pair[i][0] + pair[i][1] * pair[i][1];
        for (int j = n + 2; j > 0; j--) { c[j] += -s * c[j - 1] + (j > 1 ? p * c[j - 2] : 0); }
    }
    memset(&M, 0, sizeof M);
    M.n = n;
    for (int j = 0; j < n; j++) { M.m[0][j] = -c[j + 1]; }
    for (int i = 1; i < n; i++) { M.m[i][i - 1] = 1; }
    return M;
}

TEST(the_radius_of_known_eigenvalues)
{
    static const struct {
        double real[4];
        int reals;
        double pair[3][2];
        int pairs;
        double rho, error;
    } row[] = {
        {{0.5, -0.25}, 2, {{0, 0}}, 0, 0.5, 1e-13},
        {{0.5, -0.5}, 2, {{0, 0}}, 0, 0.5, 1e-13}, /* of one size, apart */
        {{-1.25, 1}, 2, {{0, 0}}, 0, 1.25, 1e-13},
        {{0}, 0, {{0.6, 0.8}}, 1, 1, 1e-13}, /* a pair on the circle */
        {{0.99}, 1, {{0.6, 0.8}}, 1, 1, 1e-12},
        {{0.3}, 1, {{-0.3, 0.4}, {0.1, 1.0}}, 2, 1.004987562112089, 1e-12},
        {{0.3, 0.1}, 2, {{0.96, 0.28}, {0.28, -0.96}, {0, 0.5}}, 3, 1, 1e-11},
        {{1e-3, 1e3}, 2, {{0, 0}}, 0, 1e3, 1e-9},
        {{0.9, 0.9, 0.9}, 3, {{0, 0}}, 0, 0.9, 1e-5},   /* triple: rounding parts it */
        {{0}, 0, {{0.6, 0.8}, {0.6, 0.8}}, 2, 1, 1e-7}, /* a double pair */
        {{0, 0, 0, 0}, 4, {{0, 0}}, 0, 0, 0},           /* nilpotent */
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const struct matrix M = companion(row[i].real, row[i].reals, row[i].pair, row[i].pairs);
        const double rho = eigen_radius(&M);
        CHECK(fabs(rho - row[i].rho) <= row[i].error, "row %zu: %.15g, want %.15g", i, rho,
            row[i].rho);
    }
}

TEST(the_root_squared_is_the_number)
{
    while (check_case(2000)) {
        double v = between(0.1, 10);
        for (int e = (int)(check_u64() % 200); e > 0; e--) { v *= check_u64() % 2 ? 3 : 1 / 3.0; }
        CHECK(fabs(sim_sqrt(v) * sim_sqrt(v) - v) <= 5e-16 * v, "%.17g: %.17g", v, sim_sqrt(v));
    }
    CHECK(sim_sqrt(0) == 0 && sim_sqrt(1) == 1 && sim_sqrt(1e-300) > 0, "ends");
}

TEST(the_radius_does_not_hang_on_units)
{
    static struct matrix M;
    while (check_case(50)) {
        double want, got;
        M.n = 9;
        for (int i = 0; i < M.n; i++) {
            for (int j = 0; j < M.n; j++) { M.m[i][j] = between(-1, 1); }
        }
        want = eigen_radius(&M);
        for (int i = 0; i < M.n; i++) { /* D M D^-1: other units, the same eigenvalues */
            for (int j = 0; j < M.n; j++) {
                for (int e = i; e < j; e++) { M.m[i][j] *= 10; }
                for (int e = j; e < i; e++) { M.m[i][j] /= 10; }
            }
        }
        got = eigen_radius(&M);
        CHECK(fabs(got - want) <= 1e-9 * want, "%.15g, want %.15g", got, want);
    }
}

/* ---- Radii of theory ---------------------------------------------------------------- */

static double one_mass(double rate_Hz, double k, double b, double m, double c, double h, double tau)
{
    static struct matrix M;
    const struct linear_plant p = linear_one_mass(m, c, tau);
    const struct linear_wall w = {1 / rate_Hz, k, b, h / rate_Hz, 1};
    CHECK(linear_monodromy(&M, &p, &w) == 0, "%g Hz", rate_Hz);
    return eigen_radius(&M);
}

TEST(one_mass_has_the_radii_of_theory)
{
    static const struct {
        double rate, k, b, rho[5];
    } row[] = {
        {90, 1500, 0, {1.085385958, 1.200231354, 1.202651111, 1.153347685, 0.980933171}},
        {100, 2000, 0, {1.091928428, 1.212801192, 1.215523995, 1.171046600, 0.997194152}},
        {200, 2000, 15, {0.951087675, 1.014896101, 1.019976291, 0.992533507, 0.899020080}},
        {500, 6000, 20, {0.972579419, 0.999370544, 1.004940358, 0.994429633, 0.952589324}},
        {1000, 10000, 40, {0.964704877, 0.974454319, 0.979246387, 0.973672150, 0.954669702}},
        {2000, 20000, 60, {0.972503807, 0.976712589, 0.981011634, 0.978257510, 0.967542683}},
    };
    static const struct {
        double c, h, tau;
    } column[] = {{0, 0, 0}, {0, 1, 0}, {0, 1, 0.4e-3}, {5, 1, 0.4e-3}, {10, 0, 0}};
    for (size_t i = 0; i < LEN(row); i++) {
        for (size_t j = 0; j < LEN(column); j++) {
            const double rho = one_mass(
                row[i].rate, row[i].k, row[i].b, 0.52, column[j].c, column[j].h, column[j].tau);
            CHECK(fabs(rho - row[i].rho[j]) <= 0.6e-9, "%g Hz, column %zu: %.10f, want %.9f",
                row[i].rate, j, rho, row[i].rho[j]);
        }
    }
}

/* The stability limit at each damping, without delay and with one tick of it. */
TEST(one_mass_has_the_border_of_theory)
{
    static const double border[2][7] = {{.1810, .3273, .4435, .5333, .6000, .6462, .6857},
        {.0592, .1032, .1316, .1440, .1397, .1181, .0202}};
    static const double beta[7] = {.1, .2, .3, .4, .5, .6, .8};
    for (int d = 0; d < 2; d++) {
        for (int i = 0; i < 7; i++) {
            const double in = border[d][i] - 1e-4, out = border[d][i] + 1e-4;
            const double rho_in = one_mass(1, in, beta[i], 1, 0, d, 0);
            const double rho_out = one_mass(1, out, beta[i], 1, 0, d, 0);
            CHECK(rho_in < 1 && rho_out > 1, "delay %d, beta %g: %.9f %.9f", d, beta[i], rho_in,
                rho_out);
        }
    }
}

static double two_masses(double m1, double kc, double h)
{
    static struct matrix M;
    struct sim_device d = sim_device_default();
    struct linear_plant p;
    struct linear_wall w = {1 / 2000.0, 20000, 60, h / 2000, 1};
    d.mass_kg = 0.5;
    d.rotor_kg = m1;
    d.cable_npm = kc;
    d.cable_nspm = 5;
    d.viscous_nspm = 2;
    d.current_hz = 1 / (0.4e-3 * 6.283185307179586);
    p = linear_two_mass(&d);
    CHECK(linear_monodromy(&M, &p, &w) == 0, "m1 %g", m1);
    return eigen_radius(&M);
}

TEST(two_masses_have_the_radii_of_theory)
{
    static const struct {
        double m1, kc, rho[2];
    } row[] = {{.02, 20e3, {1.119, 1.268}}, {.02, 100e3, {1.189, 1.253}},
        {.02, 500e3, {1.075, .982}}, {.1, 20e3, {.993, .995}}, {.1, 100e3, {.984, 1.039}},
        {.1, 500e3, {1.030, 1.057}}};
    for (size_t i = 0; i < LEN(row); i++) {
        for (int h = 0; h < 2; h++) {
            const double rho = two_masses(row[i].m1, row[i].kc, h);
            CHECK(fabs(rho - row[i].rho[h]) <= 0.6e-3, "row %zu, h %d: %.4f, want %.3f", i, h, rho,
                row[i].rho[h]);
        }
    }
}

/* The radii at the paper's points of an earlier device, computed by other means. */
TEST(the_device_has_the_radii_found_before)
{
    static const struct {
        double rate, k, b, rho;
    } row[] = {{90, 1500, 0, 1.031}, {100, 2000, 0, 1.023}, {200, 2000, 15, 1.144},
        {500, 6000, 20, 1.100}, {1000, 10000, 40, 1.060}, {2000, 20000, 60, 1.023}};
    struct sim_device d = sim_device_default();
    d.rotor_kg = 0.056392025322190724;
    d.cable_npm = 1791.4934353071067;
    d.cable_nspm = 5.3467230145693545;
    d.viscous_nspm = 3.7491904556329145;
    d.current_hz = 1037.9075566919134;
    d.delay_tick = 0.3855153699748721;
    d.delay_s = 0.00015784175067843915;
    for (size_t i = 0; i < LEN(row); i++) {
        const double rho = linear_rho(&d, 1 / row[i].rate, row[i].k, row[i].b, 2);
        CHECK(fabs(rho - row[i].rho) <= 0.6e-3, "%g Hz: %.4f, want %.3f", row[i].rate, rho,
            row[i].rho);
    }
}

/* ---- Its own limits -------------------------------------------------------------------- */

/* A string that does not stretch makes one mass of two. */
TEST(a_stiff_string_is_one_mass)
{
    struct sim_device d = sim_device_default();
    struct linear_plant p;
    static struct matrix M;
    const struct linear_wall w = {1e-3, 5000, 30, 0.4e-3, 2};
    double two, one;
    d.cable_npm = 1e9;
    d.cable_nspm = 1e4;
    p = linear_two_mass(&d);
    CHECK(linear_monodromy(&M, &p, &w) == 0, "two");
    two = eigen_radius(&M);
    p = linear_one_mass(
        d.mass_kg + d.rotor_kg, d.viscous_nspm, 1 / (6.283185307179586 * d.current_hz));
    CHECK(linear_monodromy(&M, &p, &w) == 0, "one");
    one = eigen_radius(&M);
    CHECK(fabs(two - one) < 1e-6, "%.9f, want %.9f", two, one);
}

/* A delay of a whole tick is the end of a fraction and the start of the next. */
TEST(the_radius_has_no_step_at_a_whole_tick)
{
    const struct sim_device d = sim_device_default();
    const struct linear_plant p = linear_two_mass(&d);
    static struct matrix M;
    for (int tick = 1; tick <= 8; tick++) {
        double rho[3];
        for (int i = 0; i < 3; i++) {
            const struct linear_wall w = {0.5e-3, 5000, 20, (tick + (i - 1) * 1e-9) * 0.5e-3, 4};
            CHECK(linear_monodromy(&M, &p, &w) == 0, "%d", tick);
            rho[i] = eigen_radius(&M);
        }
        CHECK(fabs(rho[0] - rho[1]) < 1e-7 && fabs(rho[2] - rho[1]) < 1e-7, "%d: %.12f %.12f %.12f",
            tick, rho[0], rho[1], rho[2]);
    }
}

/* Ticks of the matrix are ticks of a simulation that knows no matrix: the plant of
 * plant.c in fine steps, the law and the delay beside it. */
TEST(the_matrix_does_what_the_plant_does)
{
    struct sim_device d = sim_device_default();
    const double T = 1e-3, k = 4000, b = 15, delay = 1.37e-3;
    const struct linear_wall w = {T, k, b, delay, 2};
    static struct matrix M;
    struct linear_plant linear;
    struct plant p = {0.00101, 0, 0.001, 0, 0, 0}; /* offsets; the string is kept taut below */
    double z[EIGEN_MAX] = {0}, u[3] = {0, 0, 0}, old[2] = {0, 0};
    const double taut_m = 0.5 * SIM_GRAVITY / d.cable_npm;

    d.mu_motor = d.mu_mass = d.coulomb_n = 0;
    d.substep_s = 1e-7;
    d.mon_lag_s = 0;
    linear = linear_two_mass(&d);
    CHECK(linear_monodromy(&M, &linear, &w) == 0, "order");
    z[0] = p.q_m;
    z[2] = p.x_m;
    p.x_m += taut_m;
    p.cur_A = 0.5 * SIM_GRAVITY / d.kf_npa; /* holds the weight: the offsets' zero */
    for (int tick = 0; tick < 30; tick++) {
        double next[EIGEN_MAX] = {0};
        const double zero_A = 0.5 * SIM_GRAVITY / d.kf_npa;
        u[2] = u[1];
        u[1] = u[0];
        u[0] = k * p.q_m + b * (p.q_m - old[1]) / (2 * T);
        old[1] = old[0];
        old[0] = p.q_m;
        plant_advance(&p, &d, delay - T, zero_A + u[2] / d.kf_npa, 0);
        plant_advance(&p, &d, 2 * T - delay, zero_A + u[1] / d.kf_npa, 0);
        for (int i = 0; i < M.n; i++) {
            for (int j = 0; j < M.n; j++) { next[i] += M.m[i][j] * z[j]; }
        }
        memcpy(z, next, sizeof z);
        CHECK(fabs(z[0] - p.q_m) < 1e-6 && fabs(z[2] - (p.x_m - taut_m)) < 1e-6,
            "tick %d: q %.9f and %.9f, x %.9f and %.9f", tick, z[0], p.q_m, z[2], p.x_m - taut_m);
    }
}

TEST(too_long_a_delay_is_refused)
{
    struct sim_device d = sim_device_default();
    CHECK(linear_rho(&d, 1 / 20000.0, 5000, 20, 16) > 0, "20 kHz");
    d.delay_s = 0.01;
    CHECK(linear_rho(&d, 1 / 20000.0, 5000, 20, 16) < 0, "200 ticks");
}

TEST_MAIN("linear", the_flow_is_the_closed_form, the_flow_without_lag_is_the_closed_form,
    flows_follow_each_other, the_radius_of_known_eigenvalues, the_root_squared_is_the_number,
    the_radius_does_not_hang_on_units, one_mass_has_the_radii_of_theory,
    one_mass_has_the_border_of_theory, two_masses_have_the_radii_of_theory,
    the_device_has_the_radii_found_before, a_stiff_string_is_one_mass,
    the_radius_has_no_step_at_a_whole_tick, the_matrix_does_what_the_plant_does,
    too_long_a_delay_is_refused);
