/* SPDX-License-Identifier: MIT */
/* The scene identify keeps its limits at any rate, and ends with a cause whatever is wrong. */
#include "identify_rig.h"

#include "identify/identify.h"

static double most_A(void)
{
    double most = 0;
    for (size_t i = 0; i < data.n; i++) {
        if ((double)data.sample[i].coded_A > most) { most = (double)data.sample[i].coded_A; }
    }
    return most;
}

/* From where its stage began, counts; in is positive. */
static void ways(int32_t *in, int32_t *out)
{
    int32_t from = 0;
    *in = *out = 0;
    for (size_t i = 1; i < data.n; i++) {
        const struct identify_sample *x = &data.sample[i];
        if (x->busy && !data.sample[i - 1].busy) { from = x->cnt; }
        if (!x->busy) { continue; }
        if (from - x->cnt > *in) { *in = from - x->cnt; }
        if (x->cnt - from > *out) { *out = x->cnt - from; }
    }
}

TEST(it_runs_at_any_rate_within_its_limits)
{
    static const uint32_t rate_Hz[] = {200, 500, 1000, 2000, 5000, 20000};
    for (size_t i = 0; i < LEN(rate_Hz); i++) {
        struct identify_session c = session(i + 1);
        const double step_m = c.board.device.step_m;
        int32_t in, out;
        c.rate_Hz = rate_Hz[i];
        run(&c);
        ways(&in, &out);
        CHECK(data.result == EXH_PROBE_DONE, "%u Hz: %s", rate_Hz[i],
            identify_result_text(data.result));
        CHECK(most_A() > 1 && most_A() < 3.301, "%u Hz: %.3f A", rate_Hz[i], most_A());
        CHECK(in * step_m < 0.135 && out * step_m < 0.014, "%u Hz: %.1f mm in, %.1f mm out",
            rate_Hz[i], in * step_m * 1e3, out * step_m * 1e3);
        CHECK(!data.sample[data.n - 1].busy && data.sample[data.n - 1].coded_A <= 0, "it goes on");
    }
}

TEST(whatever_is_wrong_ends_it)
{
    static const struct {
        unsigned wrong, result;
        double most_s, most_A;
    } row[] = {
        {BENCH_MOTOR_REVERSED, EXH_PROBE_TRAVEL, 3, 0.5},
        {BENCH_ENCODER_REVERSED, EXH_PROBE_TRAVEL, 3, 0.5},
        {BENCH_STUCK, EXH_PROBE_STILL, 23, 3.301},
        {BENCH_NO_MASS, IDENTIFY_NO_MASS, 8, 0.5},
        {BENCH_FIXED_MASS, EXH_PROBE_STILL, 28, 3.301},
        {BENCH_PULLED, EXH_PROBE_TRAVEL, 3, 0.5},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct identify_session c = session(i + 1);
        c.board.wrong = row[i].wrong;
        run(&c);
        CHECK(data.result == row[i].result, "wrong %x: %s", row[i].wrong,
            identify_result_text(data.result));
        CHECK((double)data.n * data.T_s < row[i].most_s && most_A() < row[i].most_A,
            "wrong %x: %.1f s, %.3f A", row[i].wrong, (double)data.n * data.T_s, most_A());
        CHECK(data.sample[data.n - 1].coded_A <= 0, "wrong %x: current flows", row[i].wrong);
    }
}

TEST(a_dead_man_let_go_ends_it)
{
    for (int i = 0; i < 4; i++) {
        struct identify_session c = session(7);
        c.board.let_go_s = 2 + 2.3 * i;
        run(&c);
        CHECK(data.result == IDENTIFY_OFF, "%g s: %s", c.board.let_go_s,
            identify_result_text(data.result));
        CHECK((double)data.n * data.T_s < c.board.let_go_s + 0.01, "%g s: goes on for %g s",
            c.board.let_go_s, (double)data.n * data.T_s);
    }
}

TEST(bad_parameters_are_refused)
{
    static const struct identify_setting bad[] = {
        {"i_max", 4}, {"mass", 0}, {"travel", 0.6}, {"repeats", 0}, {"ramp", 0}, {"v_max", 0.01}};
    for (size_t i = 0; i < LEN(bad); i++) {
        struct identify_session c = session(1);
        c.setting = &bad[i];
        c.settings = 1;
        CHECK(identify_session(&c, &data) < 0, "%s=%g was taken", bad[i].name, bad[i].value);
    }
}

TEST_MAIN("sim/identify_scene", it_runs_at_any_rate_within_its_limits, whatever_is_wrong_ends_it,
    a_dead_man_let_go_ends_it, bad_parameters_are_refused);
