/* SPDX-License-Identifier: MIT */
/* Steps through a drive and its monitor, integrated a microsecond at a time. The fit finds their
 * lag and delay at any loop rate that can show them, and finds nothing where nothing shows. */
#include "check.h"

#include "identify/lag.h"
#include "identify/model.h"

#include "sim/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct identify_data data;
/* From a tick until the drive looked, mean over the steps of the last run. */
static double waited_s;

struct chain {
    double T_s, wait_s, drive_s, monitor_s;
    double clock;   /* the drive's period, of its nominal one */
    double noise_A; /* peak to peak */
    double gain;    /* of the monitor */
};

/* A square wave whose half periods are chance: so long as an answer lasts, or a few times that. */
static void command(double T_s, size_t n, struct sim_random *chance)
{
    double A = 0.3, until_s = 0;
    for (size_t i = 0; i < n; i++) {
        if ((double)i * T_s >= until_s) {
            until_s += 0.01 + 0.04 * sim_random_unit(chance);
            A = A > 0.5 ? 0.3 : 0.8;
        }
        data.sample[i].coded_A = (float)A;
    }
}

static void run(const struct chain *c, double length_s, uint64_t seed)
{
    const double step_s = 1e-6, period_s = c->clock / MODEL_SERVO_HZ;
    struct sim_random chance = {seed};
    double steps = 0, sum_s = 0;
    double look_s = period_s * sim_random_unit(&chance), ref_A = 0, cur_A = 0, mon_A = 0, now_s = 0;
    data.n = (size_t)(length_s / c->T_s);
    free(data.sample);
    data.sample = calloc(data.n, sizeof *data.sample);
    data.T_s = c->T_s;
    data.servo_Hz = MODEL_SERVO_HZ;
    command(c->T_s, data.n, &chance);
    for (size_t i = 0; i < data.n; i++) {
        const double noise_A = c->noise_A * sim_random_bell(&chance);
        data.sample[i].mon_A = (float)(0.02 + c->gain * mon_A + noise_A);
        for (; now_s < (double)(i + 1) * c->T_s; now_s += step_s) {
            if (now_s >= look_s) {
                const double at = floor((now_s - c->wait_s) / c->T_s);
                const double A = at < 0 ? 0 : (double)data.sample[(size_t)at].coded_A;
                if (A != ref_A && at > 0) {
                    size_t began = (size_t)at;
                    while (began > 0 && (double)data.sample[began - 1].coded_A == A) { began--; }
                    sum_s += now_s - (double)began * c->T_s;
                    steps++;
                }
                ref_A = A;
                look_s += period_s;
            }
            mon_A += step_s / c->monitor_s * (cur_A - mon_A);
            cur_A += step_s / c->drive_s * (ref_A - cur_A);
        }
    }
    waited_s = sum_s / steps;
}

static double delay_s(const struct chain *c)
{
    return c->wait_s + 0.5 / MODEL_SERVO_HZ + c->drive_s;
}

TEST(a_chain_is_found_again)
{
    static const struct chain chain[] = {
        {500e-6, 350e-6, 250e-6, 450e-6, 1.0003, 0.047, 0.97},
        {500e-6, 20e-6, 400e-6, 30e-6, 0.9992, 0.047, 1.03},
        {500e-6, 700e-6, 150e-6, 1e-3, 1.0001, 0.047, 1},
        {500e-6, 200e-6, 150e-6, 115e-6, 1.0007, 0.047, 1}, /* nearly the same */
        {500e-6, 300e-6, 200e-6, 300e-6, 1.0001, 0.047, 1}, /* a clock that hardly drifts */
        {100e-6, 60e-6, 250e-6, 450e-6, 1.0003, 0.047, 0.97},
        {50e-6, 60e-6, 133e-6, 300e-6, 1.0003, 0.047, 0.97},
    };
    for (size_t i = 0; i < LEN(chain); i++) {
        const struct chain *c = &chain[i];
        struct lag lag;
        run(c, 20, 10 + i);
        CHECK_EQ_I64(lag_tell(&lag, &data, delay_s(c)), 0);
        CHECK(fabs(lag.drive_s / c->drive_s - 1) < 0.04, "%zu: drive %g s", i, lag.drive_s);
        if (c->monitor_s < 50e-6) {
            CHECK(lag.monitor_error_s > 50e-6, "%zu: error %g s", i, lag.monitor_error_s);
            continue;
        }
        CHECK(fabs(lag.monitor_s / c->monitor_s - 1) < 0.06, "%zu: monitor %g s", i, lag.monitor_s);
        CHECK(fabs(lag.wait_s - c->wait_s) < 5e-6, "%zu: wait %g s", i, lag.wait_s);
        CHECK(fabs(lag.run_s - waited_s) < 5e-6, "%zu: %g s, waited %g s", i, lag.run_s, waited_s);
        CHECK(lag.monitor_error_s < 20e-6, "%zu: error %g s", i, lag.monitor_error_s);
    }
}

/* From behind no lag is the drive's: the motion says which. */
TEST(the_motion_says_which_lag_is_the_drives)
{
    const struct chain c = {500e-6, 350e-6, 250e-6, 450e-6, 1.0003, 0.047, 1};
    struct lag lag;
    run(&c, 20, 1);
    CHECK_EQ_I64(lag_tell(&lag, &data, delay_s(&c) + 60e-6), 0);
    CHECK(fabs(lag.drive_s - c.drive_s) < 15e-6, "%g s", lag.drive_s);
    CHECK_EQ_I64(lag_tell(&lag, &data, delay_s(&c) + c.monitor_s - c.drive_s), 0);
    CHECK(fabs(lag.drive_s - c.monitor_s) < 15e-6, "%g s", lag.drive_s);
    CHECK(fabs(lag.monitor_s - c.drive_s) < 15e-6, "%g s", lag.monitor_s);
    lag_order(&lag, delay_s(&c));
    CHECK(fabs(lag.drive_s - c.drive_s) < 15e-6, "%g s", lag.drive_s);
}

/* A drive's clock that hardly drifts shows a run a part of its period: the mean is this run's. */
TEST(the_mean_of_a_run_is_its_own)
{
    const struct chain c = {500e-6, 350e-6, 250e-6, 450e-6, 1 + 1.5e-5, 0.047, 1};
    struct lag lag;
    run(&c, 10, 4); /* 0.6 of a period seen */
    CHECK_EQ_I64(lag_tell(&lag, &data, delay_s(&c)), 0);
    CHECK(fabs(lag.drive_s / c.drive_s - 1) < 0.04, "%g s", lag.drive_s);
    CHECK(fabs(lag.monitor_s / c.monitor_s - 1) < 0.06, "%g s", lag.monitor_s);
    CHECK(fabs(waited_s - c.wait_s - 0.5 / MODEL_SERVO_HZ) > 20e-6, "waited %g s", waited_s);
    CHECK(fabs(lag.run_s - waited_s) < 5e-6, "%g s, waited %g s", lag.run_s, waited_s);
}

TEST(a_monitor_that_shows_nothing_tells_nothing)
{
    const struct chain dead = {500e-6, 350e-6, 250e-6, 450e-6, 1.0003, 0, 0},
                       noise = {500e-6, 350e-6, 250e-6, 450e-6, 1.0003, 5, 1},
                       slow = {11e-3, 350e-6, 250e-6, 450e-6, 1.0003, 0.047, 1},
                       soon = {500e-6, 350e-6, 250e-6, 450e-6, 1.0003, 0.047, 1};
    struct lag lag;
    run(&dead, 5, 1);
    CHECK_EQ_I64(lag_tell(&lag, &data, delay_s(&dead)), 1);
    run(&noise, 5, 1);
    CHECK_EQ_I64(lag_tell(&lag, &data, delay_s(&noise)), 1);
    run(&slow, 20, 1);
    CHECK_EQ_I64(lag_tell(&lag, &data, delay_s(&slow)), 1);
    run(&soon, 0.2, 1);
    CHECK_EQ_I64(lag_tell(&lag, &data, delay_s(&soon)), 1);
}

TEST_MAIN("lag", a_chain_is_found_again, the_motion_says_which_lag_is_the_drives,
    the_mean_of_a_run_is_its_own, a_monitor_that_shows_nothing_tells_nothing);
