/* SPDX-License-Identifier: MIT */
/* The intervals of the analysis cover the mean of the estimator in 95 % of runs. How far that mean
 * is from k is another question, and printed separately.
 *
 * `make coverage` runs 10^4 runs of ten falls of each model, `make test` a tenth. Only the former
 * also prints the coverage of bootstrap percentiles, which takes nearly all of the time and decides
 * nothing. */
#include "check.h"

#include "falls/analysis.h"
#include "sim/random.h"

#include <stdlib.h>

#define FALLS        10
#define RUNS_MAX     100000
#define PAIRS_MAX    (FALLS * 256)
#define MANY         10000 /* runs: the shares are judged without an allowance for chance */
#define BOOTSTRAPPED 1000  /* of many runs, those of which the percentiles are made too */
#define REPLICATES   300

/* Falls differ by slope, offset and how much they ring; within one, position scatters,
 * force is noisy, and the damper's force is correlated from tick to tick. */
struct model {
    const char *name;
    double k_Npm;
    int pairs_lo, pairs_hi; /* in one fall, most of them in the band */
    double slope, offset_m, ring_N, q_noise_m, f_noise_N;
};

static const struct model model[] = {
    {"clean", 10000, 20, 60, 0.05, 10e-6, 0, 20e-6, 0.03},
    {"noisy force", 10000, 20, 60, 0.05, 10e-6, 0, 20e-6, 0.3},
    {"ringing", 10000, 15, 80, 0.15, 40e-6, 0.6, 150e-6, 0.05},
    {"sparse", 2000, 2, 14, 0.2, 100e-6, 0.4, 400e-6, 0.05},
};
#define MODELS (sizeof model / sizeof model[0])

static double bell(struct sim_random *r) { return 6.9 * sim_random_bell(r); }

static void draw_run(const struct model *m, struct sim_random *r, struct fall_pairs *out)
{
    out->n = 0;
    for (size_t fall = 0; fall < FALLS; fall++) {
        const int n = m->pairs_lo + (int)(sim_random_unit(r) * (m->pairs_hi - m->pairs_lo + 1));
        const double k = m->k_Npm * (1 + m->slope * bell(r)), offset = m->offset_m * bell(r);
        const double ring = m->ring_N * (0.5 + sim_random_unit(r));
        double damper = ring * bell(r);
        for (int i = 0; i < n; i++) {
            const double q = (0.4 + 4.4 * sim_random_unit(r)) / m->k_Npm;
            damper = 0.6 * damper + 0.8 * ring * bell(r);
            out->at[out->n++] = (struct fall_pair){
                q + offset + m->q_noise_m * bell(r), k * q + damper + m->f_noise_N * bell(r), fall};
        }
    }
}

static struct fall_pair raw_at[PAIRS_MAX], drawn_at[FALLS * PAIRS_MAX],
    averaged_at[FALLS * PAIRS_MAX];

static void estimate(const struct fall_pairs *sorted, double *a, double *slope)
{
    struct fall_pairs averaged = {averaged_at, 0};
    struct fall_fit fit;
    fall_average_into(sorted, FALL_FORCE_CENTRE, &averaged);
    fall_fit_line(&averaged, &fit);
    *a = fit.a_Npm;
    *slope = fit.r2 > 0 ? fit.r2 / fit.a_Npm : 0;
}

static int by_value(const void *left, const void *right)
{
    const double l = *(const double *)left, r = *(const double *)right;
    return (l > r) - (l < r);
}

/* What fall_jackknife() replaced: falls drawn with replacement, 2.5 % and 97.5 %. */
static void percentiles(
    const struct fall_pairs *sorted, struct sim_random *r, double a[2], double slope[2])
{
    static double all[2][REPLICATES];
    for (int i = 0; i < REPLICATES; i++) {
        struct fall_pairs drawn = {drawn_at, 0};
        int times[FALLS] = {0};
        for (int f = 0; f < FALLS; f++) { times[(int)(FALLS * sim_random_unit(r))]++; }
        for (size_t k = 0; k < sorted->n; k++) {
            for (int t = 0; t < times[sorted->at[k].fall]; t++) {
                drawn.at[drawn.n++] = sorted->at[k];
            }
        }
        estimate(&drawn, &all[0][i], &all[1][i]);
    }
    for (int d = 0; d < 2; d++) {
        double *to = d ? slope : a;
        qsort(all[d], REPLICATES, sizeof all[d][0], by_value);
        to[0] = all[d][REPLICATES * 25 / 1000];
        to[1] = all[d][REPLICATES - 1 - REPLICATES * 25 / 1000];
    }
}

/* Of direction A in N/m, of B in m/N, in which its interval is made. */
struct side {
    double value[RUNS_MAX], lo[RUNS_MAX], hi[RUNS_MAX], plain[BOOTSTRAPPED][2];
};
static struct side side[2];

static double covered(const struct side *s, int runs, double mean, int plain)
{
    int in = 0;
    for (int i = 0; i < runs; i++) {
        const double lo = plain ? s->plain[i][0] : s->lo[i], hi = plain ? s->plain[i][1] : s->hi[i];
        in += lo <= mean && mean <= hi;
    }
    return (double)in / runs;
}

/* The pairs in the band of the next run. */
static struct fall_pairs next_run(const struct model *m, struct sim_random *r)
{
    struct fall_pairs raw = {raw_at, 0}, band;
    draw_run(m, r, &raw);
    CHECK(fall_band(&raw, 0.8, 4.5, &band) == FALL_OK, "no pairs");
    return band;
}

static int measure(const struct model *m)
{
    struct sim_random r = {2013};
    int runs = 0;
    while (check_case(1000) && runs < RUNS_MAX) {
        struct fall_pairs band = next_run(m, &r);
        struct fall_interval a, b;
        estimate(&band, &side[0].value[runs], &side[1].value[runs]);
        CHECK(fall_jackknife(&band, FALLS, FALL_FORCE_CENTRE, &a, &b) == FALL_OK, "run %d", runs);
        CHECK(a.status == FALL_OK, "run %d", runs);
        side[0].lo[runs] = a.lo_Npm;
        side[0].hi[runs] = a.hi_Npm;
        side[1].lo[runs] = b.lo_Npm > 0 ? 1 / b.lo_Npm : -1; /* turned round, as it is inverted */
        side[1].hi[runs] = b.hi_Npm > 0 ? 1 / b.hi_Npm : -1;
        if (side[1].lo[runs] > side[1].hi[runs]) {
            const double swap = side[1].lo[runs];
            side[1].lo[runs] = side[1].hi[runs];
            side[1].hi[runs] = swap;
        }
        fall_pairs_free(&band);
        runs++;
    }
    return runs;
}

/* The same runs once more, from their start. */
static void bootstrap(const struct model *m)
{
    struct sim_random r = {2013}, other = {1};
    for (int i = 0; i < BOOTSTRAPPED; i++) {
        struct fall_pairs band = next_run(m, &r);
        percentiles(&band, &other, side[0].plain[i], side[1].plain[i]);
        fall_pairs_free(&band);
    }
}

TEST(ninety_five_of_hundred_intervals_cover_the_mean)
{
    for (size_t i = 0; i < MODELS; i++) {
        const struct model *m = &model[i];
        const int runs = measure(m);
        const double chance = runs < MANY ? 0.02 : 0;
        if (runs >= MANY) { bootstrap(m); }
        for (int d = 0; d < 2; d++) {
            double mean = 0, share;
            for (int k = 0; k < runs; k++) { mean += side[d].value[k] / runs; }
            share = covered(&side[d], runs, mean, 0);
            check_note("%-12s %c: %.1f %% of %d intervals cover the estimator's mean; that mean is "
                       "%+.1f %% off k",
                m->name, "AB"[d], 100 * share, runs, 100 * ((d ? 1 / mean : mean) / m->k_Npm - 1));
            if (runs >= MANY) {
                check_note("%-12s %c: percentiles of a bootstrap: %.1f %% of %d", m->name, "AB"[d],
                    100 * covered(&side[d], BOOTSTRAPPED, mean, 1), BOOTSTRAPPED);
            }
            /* A's error is over-estimated where averages of ten depend on how dense pairs lie. */
            CHECK(share >= 0.93 - chance && share <= (d ? 0.97 : 0.985) + chance,
                "%s %c: %.2f %% of %d", m->name, "AB"[d], 100 * share, runs);
        }
    }
}

TEST_MAIN("coverage", ninety_five_of_hundred_intervals_cover_the_mean);
