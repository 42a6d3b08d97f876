/* SPDX-License-Identifier: MIT */
/* What is chance in the simulated experiment is spread as its row says, and the 95 % of an interval
 * are 95 %: each against arithmetic of this test. */
#include "check.h"

#include "falls/jackknife.h"

#include "sim/codes.h"
#include "sim/mass.h"

#include <math.h>
#include <string.h>

/* The mean of four uniforms over p: standard deviation p / sqrt(48), and never beyond p / 2. */
TEST(the_monitors_noise_is_as_wide_as_its_row)
{
    enum { N = 100000 };
    struct sim_device d = sim_device_default();
    struct sim_random r = {11};
    double sum = 0, square = 0, most = 0;
    d.mon_apc = 1e-6; /* so that a code is no part of it */
    d.mon_noise_a = 0.03;
    for (int i = 0; i < N; i++) {
        const double off_A = sim_monitor_raw(&d, 0, &r) * d.mon_apc;
        sum += off_A;
        square += off_A * off_A;
        most = fabs(off_A) > most ? fabs(off_A) : most;
    }
    CHECK(fabs(sum / N) < 4 * 0.03 / sqrt(48.0 * N), "mean %g A", sum / N);
    CHECK(fabs(sqrt(square / N) / (0.03 / sqrt(48)) - 1) < 0.01, "standard deviation %g A, want %g",
        sqrt(square / N), 0.03 / sqrt(48));
    CHECK(most <= 0.015 + 1e-6 && most > 0.8 * 0.015, "%g A", most);
}

/* At each release the phase of the drive's clock and the height are random. Both are uniform: no
 * tenth of their range is empty, and the means are those of a uniform distribution. */
TEST(each_fall_has_its_own_clock_and_height)
{
    enum { FALLS = 300 };
    static struct sim_mass m;
    struct sim_device d = sim_device_default();
    double clock = 0, height = 0;
    int clocks[10] = {0}, heights[10] = {0};
    d.observe_s = 0.6;
    sim_mass_fall(&m, &d, 5, FALLS, 0.001);
    for (int n = 0; n < FALLS; n++) {
        double phase, share;
        while (m.fall.phase != FALL_HOLD && m.fall.phase != FALL_DONE) {
            sim_mass_advance(&m, m.now_s + 0.01); /* a hold is longer */
        }
        share = (-m.plant.x_m - d.height_m) / (2 * d.height_jitter_m) + 0.5;
        sim_mass_advance(&m, fall_next_s(&m.fall));
        phase = (m.servo_s - m.now_s) * d.servo_hz;
        CHECK(m.fall.phase == FALL_FREE && phase >= 0 && phase < 1 && share >= 0 && share <= 1,
            "fall %d: %g, %g", n, phase, share);
        clock += phase / FALLS;
        height += share / FALLS;
        clocks[(int)(9.999999 * phase)]++;
        heights[(int)(9.999999 * share)]++;
    }
    CHECK(fabs(clock - 0.5) < 4 / sqrt(12.0 * FALLS), "clock: mean %g", clock);
    CHECK(fabs(height - 0.5) < 4 / sqrt(12.0 * FALLS), "height: mean %g", height);
    for (int i = 0; i < 10; i++) {
        CHECK(clocks[i] >= 10 && clocks[i] <= 60 && heights[i] >= 10 && heights[i] <= 60,
            "tenth %d: %d clocks, %d heights", i, clocks[i], heights[i]);
    }
}

/* Student's density by Simpson: what lies between -t and t is 95 %. */
TEST(the_quantile_is_students)
{
    for (size_t n = 1; n <= 40; n++) {
        const double v = (double)n, t = fall_t(n);
        const double c =
            exp(lgamma((v + 1) / 2) - lgamma(v / 2)) / sqrt(v * 3.14159265358979323846);
        double sum = 0;
        enum { PARTS = 4000 };
        for (int i = 0; i <= PARTS; i++) {
            const double x = t * i / PARTS;
            const double weight = i == 0 || i == PARTS ? 1 : i % 2 ? 4 : 2;
            sum += weight * pow(1 + x * x / v, -(v + 1) / 2);
        }
        sum *= 2 * c * t / PARTS / 3;
        CHECK(fabs(sum - 0.95) < 2e-5, "%zu degrees: %.6f of it within %.5f", n, sum, t);
    }
}

/* A glove channel's noise: mean 0, deviation 1, and never beyond 8 * 127.5 of 209. */
TEST(eight_bytes_are_a_normal_of_deviation_1)
{
    enum { N = 100000 };
    struct sim_random r = {12};
    double sum = 0, square = 0, most = 0;
    for (int i = 0; i < N; i++) {
        const double x = sim_random_bytes(&r);
        sum += x;
        square += x * x;
        most = fabs(x) > most ? fabs(x) : most;
    }
    CHECK(fabs(sum / N) < 4 / sqrt(N), "mean %g", sum / N);
    CHECK(fabs(sqrt(square / N) - 1) < 0.01, "standard deviation %g", sqrt(square / N));
    CHECK(most < 4.9 && most > 3.5, "%g", most);
}

/* Counted from the first sample, one by one in wider arithmetic. */
TEST(the_servo_samples_at_its_next_instant)
{
    static const double hz[] = {800, 5000, 20000};
    struct sim_random r = {13};
    for (size_t k = 0; k < sizeof hz / sizeof hz[0]; k++) {
        const double first_s = 0.3 + sim_random_unit(&r) / hz[k];
        for (int i = 0; i < 1000; i++) {
            const double at_s = first_s + (sim_random_unit(&r) - 1e-3) / hz[k] * i;
            long double next_s = first_s;
            while (next_s <= at_s) { next_s += 1.0L / hz[k]; }
            CHECK(fabsl(sim_servo_s(first_s, hz[k], at_s) - next_s) < 1e-12L, "%g Hz: %.17g s",
                hz[k], at_s);
        }
        CHECK(sim_servo_s(first_s, hz[k], first_s) > first_s, "%g Hz: its own instant", hz[k]);
    }
}

TEST_MAIN("chance", the_monitors_noise_is_as_wide_as_its_row,
    eight_bytes_are_a_normal_of_deviation_1, the_servo_samples_at_its_next_instant,
    each_fall_has_its_own_clock_and_height, the_quantile_is_students);
