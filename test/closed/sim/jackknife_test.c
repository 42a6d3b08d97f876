/* SPDX-License-Identifier: MIT */
/* The interval of the analysis: two-sided where it is random. */
#include "falls.h"

struct tally {
    double sum, square, width;
    int inside, runs;
};

static void count(struct tally *t, double value, const struct fall_interval *i)
{
    t->sum += value / SLOPE_NPM;
    t->square += value / SLOPE_NPM * value / SLOPE_NPM;
    t->width += (i->hi_Npm - i->lo_Npm) / SLOPE_NPM;
    t->inside += i->lo_Npm <= SLOPE_NPM && SLOPE_NPM <= i->hi_Npm;
    t->runs++;
}

/* Width against the scatter of the estimate itself over many runs: a normal
 * estimate's 95 % interval is 3.92 standard deviations wide. */
static void check_tally(const struct tally *t, const char *name)
{
    const double mean = t->sum / t->runs;
    const double variance = t->square / t->runs - mean * mean;
    const double width = t->width / t->runs;
    const double ratio2 = width * width / (3.92 * 3.92 * variance);

    CHECK(mean > 0.99 && mean < 1.01, "%s: mean %g of the slope", name, mean);
    CHECK(ratio2 > 0.8 * 0.8 && ratio2 < 1.2 * 1.2, "%s: width^2 is %g of expected", name, ratio2);
    CHECK(t->inside > 0.86 * t->runs && t->inside < 0.99 * t->runs, "%s: %d of %d contain it", name,
        t->inside, t->runs);
}

TEST(jackknife_width)
{
    struct tally a = {0}, b = {0};
    struct fall_opt opt = fall_opt_default;
    uint64_t rng = 1;

    opt.lag = 0;
    for (uint64_t run = 0; run < 300; run++) {
        struct log_builder lb = {0};
        struct fall_stiffness s;
        scattered_falls(&lb, 20, 20, 5e-6, &rng);
        const struct fall_log log = built(&lb);
        CHECK(fall_stiffness(&log, &opt, &s) == FALL_OK, "run %d", (int)run);
        CHECK(s.a.status == FALL_OK && s.b.status == FALL_OK, "run %d", (int)run);
        CHECK(s.a.falls == 20 && s.b.falls == 20, "run %d", (int)run);
        CHECK(s.b.lo_Npm < s.fit.b_Npm && s.fit.b_Npm < s.b.hi_Npm, "run %d", (int)run);
        count(&a, s.fit.a_Npm, &s.a);
        count(&b, s.fit.b_Npm, &s.b);
        fall_stiffness_free(&s);
        drop(&lb);
    }
    check_tally(&a, "A");
    check_tally(&b, "B");
}

/* Positions that have nothing to do with force: B must not invent an upper end. */
TEST(jackknife_unbounded)
{
    struct log_builder b = {0};
    struct fall_opt opt = fall_opt_default;
    struct fall_stiffness s;
    uint64_t rng = 3;

    for (size_t fall = 0; fall < 10; fall++) {
        begin_fall(&b);
        for (int i = 0; i < 40; i++) { add(&b, 1e-3, uniform(&rng), 1.0 + uniform(&rng), 1); }
    }
    const struct fall_log log = built(&b);
    opt.lag = 0;
    CHECK(fall_stiffness(&log, &opt, &s) == FALL_OK, "%d", (int)s.fit.status);
    CHECK(s.b.status == FALL_UNBOUNDED && s.b.hi_Npm == 0.0, "%s", fall_status_text(s.b.status));
    CHECK(s.a.status == FALL_OK && s.a.lo_Npm < 0.0 && s.a.hi_Npm > 0.0, "%g", s.a.lo_Npm);
    fall_stiffness_free(&s);
    drop(&b);
}

TEST_MAIN("jackknife", jackknife_width, jackknife_unbounded);
