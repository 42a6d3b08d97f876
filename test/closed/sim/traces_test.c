/* SPDX-License-Identifier: MIT */
/* Whether a fall came to rest, on traces whose answer is known because they were made so:
 * none of some thousands may be mistaken.
 *
 * Guard bands, in which the rule (0.25 mm, 4 N, peak to peak over the last 0.5 s) and a
 * label could honestly differ, and no trace is made:
 *   swings of 0.94 .. 1.06 times a limit; of position, with the device's own encoder, 3 to
 *   5 counts: floor() takes or gives a count, and 0.25 mm are 3.8 of them
 *   creep over one or two counts: on the encoder it is no different from a buzz
 *   swings below 3 Hz or above a twelfth of the rate: a window need not show their peaks */
#include "falls.h"

#include "sim/eigen.h"
#include "sim/plant.h"

#define STEP_M  66.32e-6 /* the device's */
#define FINE_M  1e-6
#define LIMIT_M 0.25e-3
#define LIMIT_N 4.0
#define START_S 4.5  /* of the window */
#define TRACES  1200 /* a label */

struct trace {
    double rate_Hz, step_m, freq_Hz;
    double swing_m, swing_N; /* peak to peak at the start of the window */
    double growth_per_s;     /* e-fold; < 0: it decays */
    double creep_mps, noise_N;
    int toggle;      /* counts to and fro */
    double toggle_s; /* half a period of it */
    double place;    /* within a count */
};

static uint64_t rng = 77;

static double between(double lo, double hi) { return lo + (hi - lo) * uniform(&rng); }

static int one_of(int n) { return (int)(uniform(&rng) * n); }

/* e^x, either sign. */
static double grown(double x) { return x < 0 ? sim_exp_neg(-x) : 1 / sim_exp_neg(x); }

static double counted(double q_m, double step_m)
{
    return step_m * (double)(int64_t)(q_m / step_m); /* q > 0 */
}

static enum fall_rest_class judged(const struct trace *t)
{
    struct log_builder b = {0};
    struct fall_rest_opt opt = fall_rest_opt_default;
    struct fall_contacts contacts;
    struct fall_rest rest = {0};
    const double half = 3.14159265358979323846 * t->freq_Hz / t->rate_Hz; /* of the angle a tick */
    const double tan_half =
        half + half * half * half / 3 + 2 * half * half * half * half * half / 15;
    const double u2 = tan_half * tan_half;
    const double c1 = (1 - u2) / (1 + u2), s1 = 2 * tan_half / (1 + u2);
    double s = between(-0.7, 0.7), c = 0.7; /* a phase of chance */
    const double size = sim_sqrt(s * s + c * c);
    const double still_m = 0.08 + t->step_m * t->place - (0.08 - counted(0.08, t->step_m));

    s /= size;
    c /= size;
    begin_fall(&b);
    for (int i = 0; i < (int)(5.2 * t->rate_Hz); i++) {
        const double t_s = i / t->rate_Hz;
        double e = grown(t->growth_per_s * (t_s - START_S));
        const int flip = t->toggle > 0 && (int64_t)(t_s / t->toggle_s) % 2;
        if (e > 1e3) { e = 1e3; }
        const double q_m = still_m + 0.5 * e * t->swing_m * s + t->creep_mps * (t_s - START_S) +
                           flip * t->toggle * t->step_m;
        const double f_N = 4.9 + 0.5 * e * t->swing_N * c + t->noise_N * (uniform(&rng) - 0.5);
        const double next = c * c1 - s * s1;
        add(&b, 1 / t->rate_Hz, counted(q_m > 0 ? q_m : 0, t->step_m), f_N, 1);
        s = s * c1 + c * s1;
        c = next;
    }
    const struct fall_log log = built(&b);
    opt.encoder_step_m = t->step_m;
    CHECK(fall_dissect(&log, 1, &contacts) == FALL_OK, "dissect");
    CHECK(fall_rest(&log, &contacts, &opt, &rest) == FALL_OK, "rest");
    fall_contacts_free(&contacts);
    drop(&b);
    return rest.rest;
}

static struct trace any(void)
{
    static const double rate_Hz[] = {90, 100, 200, 500, 1000, 2000};
    struct trace t = {.rate_Hz = rate_Hz[one_of(6)], .step_m = one_of(2) ? STEP_M : FINE_M};
    const double most_Hz = t.rate_Hz / 12 < 120 ? t.rate_Hz / 12 : 120;
    t.freq_Hz = between(3, most_Hz);
    t.noise_N = between(0, 0.3);
    t.place = between(0.1, 0.9);
    return t;
}

/* Peak to peak in the window, of what is `swing` at its start. */
static double shown(const struct trace *t, double swing)
{
    return t->growth_per_s >= 0 ? swing * grown(t->growth_per_s * (0.5 - 1 / t->freq_Hz))
                                : swing * grown(t->growth_per_s / t->freq_Hz);
}

static void check_label(const char *kind, const struct trace *t, enum fall_rest_class label)
{
    const enum fall_rest_class got = judged(t);
    CHECK(got == label,
        "%s: %s: %g Hz, step %g, %g Hz, %g m, %g N, growth %g, creep %g, noise %g, "
        "toggle %d in %g s",
        kind, fall_rest_text(got), t->rate_Hz, t->step_m, t->freq_Hz, t->swing_m, t->swing_N,
        t->growth_per_s, t->creep_mps, t->noise_N, t->toggle, t->toggle_s);
}

TEST(what_rests_is_never_mistaken)
{
    for (int i = 0; i < TRACES; i++) {
        struct trace t = any();
        switch (i % 5) {
        case 0: /* noise alone, up to the limit */ t.noise_N = between(0, 0.94 * LIMIT_N); break;
        case 1: /* creep within a count, and over three of them or many fine ones */
            t.place = 0.1;
            t.creep_mps = between(-0.5, 0.5) * 0.1 * t.step_m;
            if (one_of(2)) {
                t.place = 0.5;
                t.creep_mps = (one_of(2) ? 1 : -1) *
                              (t.step_m == FINE_M ? between(10e-6, 0.94 * LIMIT_M) : 3.0 * STEP_M) /
                              0.5;
            }
            break;
        case 2: /* swings below the limits, on an encoder that shows them */
            t.step_m = FINE_M;
            t.swing_m = between(5e-6, 0.94 * LIMIT_M);
            t.swing_N = between(0, 0.94 * LIMIT_N - t.noise_N);
            break;
        case 3: /* rang down in time, from metres if need be */
            t.step_m = FINE_M;
            t.growth_per_s = -between(0.2, 20);
            t.swing_m = between(5e-6, 0.94 * LIMIT_M);
            t.swing_N = between(0, 0.94 * LIMIT_N - t.noise_N);
            break;
        default: /* grows, but is small yet at the end */
            t.step_m = FINE_M;
            t.growth_per_s = between(0.2, 8);
            t.swing_m = between(5e-6, 0.92 * LIMIT_M) * sim_exp_neg(0.5 * t.growth_per_s);
            t.swing_N = between(0, 0.94 * LIMIT_N - t.noise_N) * sim_exp_neg(0.5 * t.growth_per_s);
            if (t.swing_m < 4e-6) { t.swing_m = 4e-6; }
            break;
        }
        check_label("rest", &t, FALL_AT_REST);
    }
}

TEST(what_buzzes_is_never_mistaken)
{
    for (int i = 0; i < TRACES; i++) {
        struct trace t = any();
        t.step_m = i % 3 ? STEP_M : FINE_M;
        t.toggle = 1 + i % 2;
        /* From one change in the window to one every tick. */
        t.toggle_s = 1 / t.rate_Hz * between(1.01, 0.3 * t.rate_Hz);
        if (one_of(3) == 0) { t.toggle_s = 1.0 / t.rate_Hz; }
        t.noise_N = between(0, 0.94 * LIMIT_N);
        if (one_of(2)) { /* a small swing of force with it */
            t.swing_N = between(0, 0.94 * LIMIT_N - 0.1);
            t.noise_N = between(0, 0.94 * LIMIT_N - t.swing_N);
        }
        check_label("buzz", &t, FALL_BUZZ);
    }
}

TEST(what_oscillates_is_never_mistaken)
{
    for (int i = 0; i < TRACES; i++) {
        struct trace t = any();
        const double most = i % 7 == 0 ? 60 : 1.5; /* times the limit: mostly just above */
        const double least_m = t.step_m == STEP_M ? 5 * STEP_M * 1.06 : 1.06 * LIMIT_M;
        const int position = i % 3 != 0, force = i % 3 != 1;
        if (i % 4 == 1) { t.growth_per_s = between(0.1, 4); }
        if (i % 4 == 2) { t.growth_per_s = -between(0.1, 2); }
        if (position) { t.swing_m = between(1, most) * least_m; }
        if (force) { t.swing_N = between(1, most) * 1.06 * LIMIT_N; }
        /* The label is of what the window shows: at its worst once, of a swing that changes. */
        t.swing_m *= t.swing_m > 0 ? t.swing_m / shown(&t, t.swing_m) : 1;
        t.swing_N *= t.swing_N > 0 ? t.swing_N / shown(&t, t.swing_N) : 1;
        t.toggle = one_of(3) == 0;
        t.toggle_s = 0.037;
        if (t.toggle) { t.swing_m *= 1.3; } /* a count may take away from a swing */
        check_label("oscillates", &t, FALL_OSCILLATES);
    }
    check_note("%d traces, three labels, six rates, 3..120 Hz: none mistaken", 3 * TRACES);
}

TEST_MAIN("traces", what_rests_is_never_mistaken, what_buzzes_is_never_mistaken,
    what_oscillates_is_never_mistaken);
