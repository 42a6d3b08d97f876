/* SPDX-License-Identifier: MIT */
/* A model that remembers, reusable, in single precision, at any rate by its inport T. */
#include "rig.h"

TEST(holds_a_mass_at_any_rate)
{
    static const double rate_Hz[] = {200, 500, 1000, 2000};
    for (size_t i = 0; i < sizeof rate_Hz / sizeof rate_Hz[0]; i++) {
        const struct run_cfg c = rig(rate_Hz[i], 1000, 0);
        const struct fall_sample *end;
        struct run r;
        CHECK_EQ_I64(run_drop(&c, &r), 0);
        CHECK(r.faults == 0 && r.log.falls == 2, "%g Hz: faults %lx", rate_Hz[i],
            (unsigned long)r.faults);
        /* At rest its spring alone is left, but for a mass that still creeps. */
        end = &r.log.sample[r.log.samples - 1];
        CHECK(end->f_des_N > 1 && end->f_des_N > 950 * (end->q_m - c.board.device.height_m) &&
                  end->f_des_N < 1050 * (end->q_m - c.board.device.height_m),
            "%g Hz: %g N at %g m", rate_Hz[i], end->f_des_N, end->q_m - c.board.device.height_m);
        run_free(&r);
    }
}

/* A second run in the process begins where the first did. */
TEST(two_runs_are_one)
{
    const struct run_cfg c = rig(500, 1000, 0);
    struct run r[2];
    for (int i = 0; i < 2; i++) { CHECK_EQ_I64(run_drop(&c, &r[i]), 0); }
    CHECK(r[0].log.samples > 500 && r[0].log.samples == r[1].log.samples, "%zu, %zu",
        r[0].log.samples, r[1].log.samples);
    for (size_t i = 0; i < r[0].log.samples; i++) {
        const struct fall_sample *a = &r[0].log.sample[i], *b = &r[1].log.sample[i];
        CHECK(a->q_m == b->q_m && a->f_des_N == b->f_des_N, "sample %zu: %g and %g N", i,
            a->f_des_N, b->f_des_N);
    }
    for (int i = 0; i < 2; i++) { run_free(&r[i]); }
}

TEST(its_log_replays) { rig_replays(rig(2000, 1000, 0)); }

TEST_MAIN("slot/pad", holds_a_mass_at_any_rate, two_runs_are_one, its_log_replays);
