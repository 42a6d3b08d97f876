/* SPDX-License-Identifier: MIT */
/* Whether a fall came to rest: labelled traces, limits, slow rates, runaways. */
#include "falls.h"

/* ---- Rest ------------------------------------------------------------------------- */

#define STEP_M 66.3e-6

/* A labelled trace from the first contact on. The position is A*sin + creep + a
 * number of encoder counts, the force A*sin + noise; each part stops at its time. */
struct trace {
    const char *name;
    enum fall_rest_class label;
    double swing_m, swing_N; /* peak-to-peak */
    double from_s, until_s;  /* when they swing */
    double decay_per_s;      /* relative loss of the swing, 1/s */
    double creep_mps;
    int counts;      /* random counts 0 .. counts on the position */
    double noise_N;  /* peak-to-peak of the monitor's noise */
    double length_s; /* of the log, from the first contact */
};

static const struct trace traces[] = {
    {"lies still", FALL_AT_REST, 0, 0, 0, 9, 0, 0, 0, 0, 5.5},
    {"monitor noise", FALL_AT_REST, 0, 0, 0, 9, 0, 0, 0, 3.9, 5.5},
    {"rings, then stops", FALL_AT_REST, 8e-3, 20, 0, 4.3, 0.1, 0, 0, 0.3, 5.5},
    {"decays in time", FALL_AT_REST, 8e-3, 20, 0, 9, 2, 0, 0, 0.3, 5.5},
    {"swings below the limit", FALL_AT_REST, 0.22e-3, 3, 0, 9, 0, 0, 0, 0.3, 5.5},
    {"creeps", FALL_AT_REST, 0, 0, 0, 9, 0, 0.4e-3, 0, 0.3, 5.5},
    {"starts after the window", FALL_AT_REST, 8e-3, 20, 5.0, 9, 0, 0, 0, 0.3, 6.5},
    {"observed just long enough", FALL_AT_REST, 0, 0, 0, 9, 0, 0, 0, 0.3, 5.0},
    {"one count", FALL_BUZZ, 0, 0, 0, 9, 0, 0, 1, 0.3, 5.5},
    {"two counts", FALL_BUZZ, 0, 0, 0, 9, 0, 0, 2, 3.9, 5.5},
    {"swings on", FALL_OSCILLATES, 0.3e-3, 0, 0, 9, 0, 0, 0, 0.3, 5.5},
    {"swings on widely", FALL_OSCILLATES, 12e-3, 27, 0, 9, 0, 0, 0, 0.3, 5.5},
    {"only the force swings", FALL_OSCILLATES, 0, 4.5, 0, 9, 0, 0, 0, 0, 5.5},
    {"decays too slowly", FALL_OSCILLATES, 8e-3, 20, 0, 9, 0.4, 0, 0, 0.3, 5.5},
    {"starts in the window", FALL_OSCILLATES, 0.5e-3, 8, 4.8, 9, 0, 0, 0, 0.3, 5.5},
    {"four counts", FALL_OSCILLATES, 0, 0, 0, 9, 0, 0, 4, 0.3, 5.5},
    {"one count shakes the force", FALL_OSCILLATES, 0, 4.5, 0, 9, 0, 0, 1, 0.3, 5.5},
    {"creeps fast", FALL_OSCILLATES, 0, 0, 0, 9, 0, 0.6e-3, 0, 0.3, 5.5},
    {"still, cut off", FALL_INCOMPLETE, 0, 0, 0, 9, 0, 0, 0, 0.3, 4.97},
    {"swinging, cut off", FALL_INCOMPLETE, 12e-3, 27, 0, 9, 0, 0, 0, 0.3, 4.6},
    {"hardly touched", FALL_INCOMPLETE, 0, 0, 0, 9, 0, 0, 0, 0.3, 0.02},
    {"never touched", FALL_INCOMPLETE, 0, 0, 0, 9, 0, 0, 0, 0.3, 0},
};
#define TRACES (sizeof traces / sizeof traces[0])

static void play(
    struct log_builder *b, const struct trace *tr, double rate_Hz, double freq_Hz, uint64_t *rng)
{
    const size_t ticks = (size_t)(tr->length_s * rate_Hz + 0.5);
    const double u = 3.14159265358979 * freq_Hz / rate_Hz; /* tan of half the angle, nearly */
    const double cos_1 = (1.0 - u * u) / (1.0 + u * u), sin_1 = 2.0 * u / (1.0 + u * u);
    const double shrink = 1.0 - tr->decay_per_s / rate_Hz;
    double sin_t = 0.0, cos_t = 1.0, left = 1.0;

    begin_fall(b);
    for (int i = 0; i < 20; i++) { add(b, 1.0 / rate_Hz, -0.01 + 5e-4 * i, 0.1, 0); }
    for (size_t i = 0; i < ticks; i++) {
        const double t_s = ((double)i + 0.25) / rate_Hz;
        const double on = t_s >= tr->from_s && t_s < tr->until_s ? 0.5 * left : 0.0;
        const double cnt = (double)(int)(uniform(rng) * (tr->counts + 1));
        const double q_m = 0.01 + on * tr->swing_m * sin_t + cnt * STEP_M + t_s * tr->creep_mps;
        const double f_N = 4.9 + on * tr->swing_N * cos_t + (uniform(rng) - 0.5) * tr->noise_N;
        const double next = cos_t * cos_1 - sin_t * sin_1;
        add(b, 1.0 / rate_Hz, q_m, f_N, t_s > 0.1 || i % 7 != 6); /* bounces at first */
        sin_t = sin_t * cos_1 + cos_t * sin_1;
        cos_t = next;
        left *= shrink;
    }
}

static void check_traces(double rate_Hz, double freq_Hz, uint64_t *rng)
{
    struct log_builder b = {0};
    struct fall_rest_opt opt = fall_rest_opt_default;
    struct fall_contacts contacts;
    struct fall_rest rest[TRACES];

    for (size_t i = 0; i < TRACES; i++) { play(&b, &traces[i], rate_Hz, freq_Hz, rng); }
    const struct fall_log log = built(&b);
    opt.encoder_step_m = STEP_M;
    CHECK(fall_dissect(&log, 1, &contacts) == FALL_OK, "%g Hz", rate_Hz);
    CHECK(fall_rest(&log, &contacts, &opt, rest) == FALL_OK, "%g Hz", rate_Hz);
    for (size_t i = 0; i < TRACES; i++) {
        CHECK(rest[i].rest == traces[i].label, "%g Hz, %g Hz, %s: %s (%g m, %g N)", rate_Hz,
            freq_Hz, traces[i].name, fall_rest_text(rest[i].rest), rest[i].travel_m,
            rest[i].force_N);
    }
    fall_contacts_free(&contacts);
    drop(&b);
}

TEST(rest_is_never_mistaken)
{
    static const double rate_Hz[] = {90.0, 100.0, 200.0, 500.0, 1000.0, 2000.0};
    static const double freq_Hz[] = {5.3, 7.7, 12.1};
    uint64_t rng = 5;

    for (size_t r = 0; r < sizeof rate_Hz / sizeof rate_Hz[0]; r++) {
        for (size_t f = 0; f < sizeof freq_Hz / sizeof freq_Hz[0]; f++) {
            check_traces(rate_Hz[r], freq_Hz[f], &rng);
        }
    }
}

/* Peak-to-peak exactly at the limit is rest; times off by rounding change nothing. */
TEST(rest_at_the_limits)
{
    for (int over = 0; over < 2; over++) {
        struct log_builder b = {0};
        struct fall_contacts contacts;
        struct fall_rest rest;
        begin_fall(&b);
        for (int i = 0; i < 500; i++) { /* 4 N and 2^-12 m are exact in binary */
            add(&b, 0.01, i % 2 ? 0x1p-12 : 0.0, i % 2 ? 1.0 : 5.0 + over * 1e-9, 1);
        }
        const struct fall_log log = built(&b);
        struct fall_rest_opt opt = fall_rest_opt_default;
        opt.travel_m = 0x1p-12;
        CHECK(fall_dissect(&log, 1, &contacts) == FALL_OK, "%d", over);
        CHECK(fall_rest(&log, &contacts, &opt, &rest) == FALL_OK, "%d", over);
        CHECK(
            rest.rest == (over ? FALL_OSCILLATES : FALL_AT_REST), "%s", fall_rest_text(rest.rest));
        CHECK(rest.t_contact_s == 0.0 && rest.travel_m == 0x1p-12, "%g", rest.travel_m);
        opt.window_s = 6.0;
        CHECK(fall_rest(&log, &contacts, &opt, &rest) == FALL_BAD_OPT, "%g", opt.window_s);
        fall_contacts_free(&contacts);
        drop(&b);
    }
}

/* A fall of 6 s at T_s whose position alternates between two places, judged. */
static enum fall_rest_class rest_between(double T_s, double q0_m, double q1_m)
{
    struct log_builder b = {0};
    struct fall_contacts contacts;
    struct fall_rest rest;
    begin_fall(&b);
    for (int i = 0; i * T_s < 6; i++) { add(&b, T_s, i % 2 ? q1_m : q0_m, 5.0, 1); }
    const struct fall_log log = built(&b);
    CHECK(fall_dissect(&log, 1, &contacts) == FALL_OK, "%g s", T_s);
    CHECK(fall_rest(&log, &contacts, &fall_rest_opt_default, &rest) == FALL_OK, "%g s", T_s);
    fall_contacts_free(&contacts);
    drop(&b);
    return rest.rest;
}

/* What docs/REPORT.md calls rest: 0.25 mm and 4 N. */
TEST(the_limits_are_those_that_are_told)
{
    CHECK(rest_between(0.001, 0, 0.2499e-3) != FALL_OSCILLATES, "below 0.25 mm");
    CHECK(rest_between(0.001, 0, 0.2501e-3) == FALL_OSCILLATES, "above 0.25 mm");
    CHECK(fall_rest_opt_default.force_N == 4 && fall_rest_opt_default.window_s == 0.5 &&
              fall_rest_opt_default.observe_s == 5,
        "%g N, %g s, %g s", fall_rest_opt_default.force_N, fall_rest_opt_default.window_s,
        fall_rest_opt_default.observe_s);
}

/* Half a second holds no three samples of a rate below 6 Hz. */
TEST(slow_rates_are_judged_too)
{
    static const double T_s[] = {1, 2 / 3.0, 0.5, 1 / 3.0, 0.2, 1 / 7.0, 1 / 9.0, 0.1};
    for (size_t i = 0; i < sizeof T_s / sizeof T_s[0]; i++) {
        const enum fall_rest_class still = rest_between(T_s[i], 0.08, 0.08);
        const enum fall_rest_class swings = rest_between(T_s[i], 0.08, 0.081);
        CHECK(still == FALL_AT_REST, "%g s: %s", T_s[i], fall_rest_text(still));
        CHECK(swings == FALL_OSCILLATES, "%g s: %s", T_s[i], fall_rest_text(swings));
    }
}

/* Thrown up it leaves the string slack and the motor still, for longer than the window. */
TEST(a_mass_in_flight_is_not_at_rest)
{
    for (int lands = 0; lands < 2; lands++) {
        struct log_builder b = {0};
        struct fall_contacts contacts;
        struct fall_rest rest;
        begin_fall(&b);
        for (int i = 0; i < 3000; i++) {
            const int up = i * 0.002 > 4.3 && !(lands && i * 0.002 > 4.9);
            add(&b, 0.002, up || i * 0.002 > 4.9 ? 0.0698 : 0.08, up ? 0.1 : 1.0, !up);
        }
        const struct fall_log log = built(&b);
        CHECK(fall_dissect(&log, 1, &contacts) == FALL_OK, "%d", lands);
        CHECK(fall_rest(&log, &contacts, &fall_rest_opt_default, &rest) == FALL_OK, "%d", lands);
        CHECK(rest.rest == (lands ? FALL_AT_REST : FALL_INCOMPLETE), "%d: %s", lands,
            fall_rest_text(rest.rest));
        fall_contacts_free(&contacts);
        drop(&b);
    }
}

/* Position saturates at 2 m. A mass that fell past it seems to be at rest there. */
TEST(a_mass_that_ran_away_is_not_at_rest)
{
    static const struct {
        double q0_m, q1_m;
        enum fall_rest_class want;
    } row[] = {{2 - 0x1p-30, 2 - 0x1p-30, FALL_INCOMPLETE}, {-2, -2, FALL_INCOMPLETE},
        {2 - 0x1p-30, 1.2, FALL_OSCILLATES}, {1.98, 1.98, FALL_AT_REST},
        {-1.98, -1.98, FALL_AT_REST}, {-2, -1.9999, FALL_INCOMPLETE}};
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        const enum fall_rest_class got = rest_between(0.002, row[i].q0_m, row[i].q1_m);
        CHECK(got == row[i].want, "%g and %g m: %s", row[i].q0_m, row[i].q1_m, fall_rest_text(got));
    }
}

TEST_MAIN("rest", rest_is_never_mistaken, rest_at_the_limits, the_limits_are_those_that_are_told,
    slow_rates_are_judged_too, a_mass_that_ran_away_is_not_at_rest,
    a_mass_in_flight_is_not_at_rest);
