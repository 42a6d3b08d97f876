/* The analysis of the falling mass: exact where the answer is known, two-sided
 * where it is random, explicit where there is none. */
#include "check.h"

#include "cli/analysis.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Synthetic logs -------------------------------------------------------- */

#define MAX_FALLS 64

struct log_builder {
    struct fall_sample *sample;
    size_t n, cap;
    size_t start[MAX_FALLS];
    size_t falls;
    double t_s;
};

static void begin_fall(struct log_builder *b)
{
    b->start[b->falls++] = b->n;
}

static void add(struct log_builder *b, double tick_s, double q_m, double f_N, int c)
{
    if (b->n == b->cap) {
        b->cap = b->cap ? 2 * b->cap : 1024;
        b->sample = realloc(b->sample, b->cap * sizeof *b->sample);
        if (!b->sample) { abort(); }
    }
    b->sample[b->n++] = (struct fall_sample){.t_s = b->t_s, .q_m = q_m, .f_mon_N = f_N, .c = c};
    b->t_s += tick_s;
}

static struct fall_log built(const struct log_builder *b)
{
    return (struct fall_log){b->sample, b->n, b->start, b->falls};
}

static void drop(struct log_builder *b)
{
    free(b->sample);
    memset(b, 0, sizeof *b);
    b->sample = NULL;
}

static double uniform(uint64_t *rng)
{
    uint64_t z = (*rng += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

static double normal(uint64_t *rng)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += uniform(rng);
    }
    return sum;
}

static double size_of(double x)
{
    return x < 0.0 ? -x : x;
}

static int near(double got, double want, double relative)
{
    return size_of(got - want) <= relative * size_of(want);
}

/* ---- A line without noise ----------------------------------------------------- */

static void ramp(struct log_builder *b, double k_Npm, size_t lag)
{
    for (int fall = 0; fall < 3; fall++) {
        double last[3] = {0.0, 0.0, 0.0};
        begin_fall(b);
        for (int i = 0; i < 5; i++) {
            add(b, 1e-3, 0.07, 2.0, 0);
        }
        for (int i = 0; i < 300; i++) {
            const double q_m = 0.07 + 6.0 / k_Npm * i / 300.0 + 1e-3 / k_Npm * fall;
            memmove(last + 1, last, 2 * sizeof last[0]);
            last[0] = q_m;
            add(b, 1e-3, q_m, k_Npm * (last[lag] - 0.07), 1);
        }
        add(b, 1e-3, 0.07, 2.0, 0);
    }
}

TEST(line_is_exact)
{
    static const double k_Npm[] = {1374.0, 1506.0, 7203.0, 11977.0, 18936.0, 50004.0, 1e6};

    for (size_t i = 0; i < sizeof k_Npm / sizeof k_Npm[0]; i++) {
        for (size_t lag = 0; lag < 3; lag++) {
            struct log_builder b = {0};
            struct fall_opt opt = fall_opt_default;
            struct fall_stiffness s;
            ramp(&b, k_Npm[i], lag);
            const struct fall_log log = built(&b);
            opt.lag = lag;
            opt.force = FALL_FORCE_MEAN; /* exact whatever the spacing of the forces */
            opt.replicates = 40;
            CHECK(fall_stiffness(&log, &opt, &s) == FALL_OK, "k %g", k_Npm[i]);
            CHECK(s.fit.status == FALL_OK && s.contacts == 3, "k %g: %zu", k_Npm[i], s.contacts);
            CHECK(near(s.fit.a_Npm, k_Npm[i], 1e-9), "A %.12g of %g", s.fit.a_Npm, k_Npm[i]);
            CHECK(near(s.fit.b_Npm, k_Npm[i], 1e-9), "B %.12g of %g", s.fit.b_Npm, k_Npm[i]);
            CHECK(near(s.fit.r2, 1.0, 1e-12), "r2 %.17g", s.fit.r2);
            CHECK(near(s.a.lo_Npm, k_Npm[i], 1e-9) && near(s.a.hi_Npm, k_Npm[i], 1e-9), "%g",
                  s.a.lo_Npm);
            CHECK(near(s.b.lo_Npm, k_Npm[i], 1e-9) && near(s.b.hi_Npm, k_Npm[i], 1e-9), "%g",
                  s.b.lo_Npm);
            fall_stiffness_free(&s);
            drop(&b);
        }
    }
}

/* One force kept for ten positions: exact where the forces are evenly spaced. */
TEST(even_forces_are_exact)
{
    struct fall_pair at[200];
    const struct fall_pairs in = {at, 200};

    for (size_t i = 0; i < in.n; i++) {
        at[i] = (struct fall_pair){(double)i * 0.0125 / 20000.0, 0.8 + (double)i * 0.0125, 0};
    }
    for (int force = FALL_FORCE_CENTRE; force <= FALL_FORCE_MEAN; force++) {
        struct fall_pairs averaged;
        struct fall_fit fit;
        CHECK(fall_average(&in, (enum fall_force)force, &averaged) == FALL_OK, "%d", force);
        fall_fit_line(&averaged, &fit);
        CHECK(near(fit.a_Npm, 20000.0, 1e-9), "A %.12g", fit.a_Npm);
        CHECK(near(fit.b_Npm, 20000.0, 1e-9), "B %.12g", fit.b_Npm);
        fall_pairs_free(&averaged);
    }
}

/* ---- Average: computed by hand --------------------------------------------------- */

TEST(twelve_rows_by_hand)
{
    /* 3+1+4+1+5+9+2+6+5+3 = 39, then -3+5 = 41, then -1+8 = 48. */
    static const double q_m[12] = {3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5, 8};
    static const double mean_m[3] = {3.9, 4.1, 4.8};
    static const double f_N[3][3] = {{1.5, 1.6, 1.7}, {1.9, 2.0, 2.1}, {1.45, 1.55, 1.65}};
    struct fall_pair at[12];
    struct fall_pairs shuffled = {at, 12}, sorted, averaged;
    struct fall_fit fit;

    for (size_t i = 0; i < 12; i++) { /* 7 and 12 have no common factor: all rows, mixed */
        const size_t row = i * 7 % 12;
        at[i] = (struct fall_pair){q_m[row], (double)(10 + row) / 10.0, 0};
    }
    CHECK(fall_band(&shuffled, 0.8, 4.5, &sorted) == FALL_OK, "%zu", sorted.n);
    for (int force = FALL_FORCE_CENTRE; force <= FALL_FORCE_MEAN; force++) {
        CHECK(fall_average(&sorted, (enum fall_force)force, &averaged) == FALL_OK, "%d", force);
        CHECK(averaged.n == 3, "%zu rows", averaged.n);
        for (size_t i = 0; i < averaged.n; i++) {
            CHECK(near(averaged.at[i].q_m, mean_m[i], 1e-14), "row %zu: %.17g", i,
                  averaged.at[i].q_m);
            CHECK(near(averaged.at[i].f_N, f_N[force][i], 1e-14), "row %zu: %.17g", i,
                  averaged.at[i].f_N);
        }
        /* dq = -11/30 -5/30 16/30, dF = -0.1 0 0.1: qf 0.09, qq 402/900, ff 0.02. */
        fall_fit_line(&averaged, &fit);
        CHECK(near(fit.a_Npm, 0.09 * 900.0 / 402.0, 1e-12), "A %.17g", fit.a_Npm);
        CHECK(near(fit.b_Npm, 0.02 / 0.09, 1e-12), "B %.17g", fit.b_Npm);
        CHECK(near(fit.r2, 0.09 * 0.09 * 900.0 / 402.0 / 0.02, 1e-12), "r2 %.17g", fit.r2);
        fall_pairs_free(&averaged);
    }
    fall_pairs_free(&sorted);
}

/* ---- Band and sort ------------------------------------------------------------ */

TEST(band_has_both_ends)
{
    /* The doubles next to the ends on either side. */
    static const double f_N[] = {4.5 + 9e-16, 4.5, 0.8 - 1.2e-16, 0.8, 2.0, -1.0, 0.0, 1e6};
    struct fall_pair at[8];
    const struct fall_pairs in = {at, 8};
    struct fall_pairs out;

    for (size_t i = 0; i < in.n; i++) {
        at[i] = (struct fall_pair){(double)i, f_N[i], i};
    }
    CHECK(fall_band(&in, 0.8, 4.5, &out) == FALL_OK, "%zu", out.n);
    CHECK(out.n == 3, "%zu kept", out.n);
    CHECK(out.at[0].fall == 3 && out.at[1].fall == 4 && out.at[2].fall == 1, "order %zu %zu %zu",
          out.at[0].fall, out.at[1].fall, out.at[2].fall);
    fall_pairs_free(&out);
}

TEST(ties_keep_their_order)
{
    static struct fall_pair at[400];
    uint64_t rng = 7;

    for (size_t n = 0; n <= 400; n += n < 40 ? 1 : 37) {
        const struct fall_pairs in = {at, n};
        struct fall_pairs out;
        for (size_t i = 0; i < n; i++) {
            at[i] = (struct fall_pair){(double)i, 1.0 + (double)(int)(uniform(&rng) * 5.0), 0};
        }
        CHECK(fall_band(&in, 0.0, 10.0, &out) == FALL_OK && out.n == n, "%zu of %zu", out.n, n);
        for (size_t i = 1; i < n; i++) {
            const struct fall_pair *p = &out.at[i - 1];
            CHECK(p[0].f_N < p[1].f_N || (p[0].f_N == p[1].f_N && p[0].q_m < p[1].q_m),
                  "n %zu at %zu", n, i);
        }
        fall_pairs_free(&out);
    }
}

/* ---- Contacts ------------------------------------------------------------------ */

/* One sample per character: # contact, . none, | a fall begins here. */
static void draw_log(struct log_builder *b, const char *picture)
{
    for (; *picture; picture++) {
        if (*picture == '|') {
            begin_fall(b);
        } else {
            add(b, 1e-3, (double)b->n, 100.0 + (double)b->n, *picture == '#');
        }
    }
}

static void check_contacts(const char *picture, size_t min_samples, const char *want)
{
    struct log_builder b = {0};
    struct fall_contacts got;
    char text[256] = "";
    size_t used = 0;

    draw_log(&b, picture);
    const struct fall_log log = built(&b);
    CHECK(fall_dissect(&log, min_samples, &got) == FALL_OK, "%s", picture);
    for (size_t i = 0; i < got.n && used < sizeof text - 32; i++) {
        used += (size_t)snprintf(text + used, sizeof text - used, "%zu:%zu-%zu%s ", got.at[i].fall,
                                 got.at[i].first, got.at[i].end, got.at[i].open ? "+" : "");
    }
    CHECK(strcmp(text, want) == 0, "%s: got %s, want %s", picture, text, want);
    fall_contacts_free(&got);
    drop(&b);
}

TEST(contacts_are_cut)
{
    check_contacts("|....", 1, "");
    check_contacts("|.###..", 1, "0:1-4 ");
    check_contacts("|###", 1, "0:0-3+ ");
    check_contacts("|.###|..##|....|#", 1, "0:1-4+ 1:6-8+ 3:12-13+ ");
    check_contacts("|.#.###.#", 1, "0:1-2 0:3-6 0:7-8+ ");
    check_contacts("|.#.###.#", 2, "0:3-6 "); /* glitches, also an open one */
    check_contacts("|.##.###", 3, "0:4-7+ ");
    check_contacts("|###.###", 1, "0:0-3 0:4-7+ "); /* a gap of one tick separates */
    check_contacts("##|.##", 1, "0:3-5+ ");         /* before the first fall       */
    check_contacts("|##|##", 0, "0:0-2+ 1:2-4+ ");  /* never across two falls      */
    check_contacts("|##|##", 3, "");
}

TEST(lag_stays_in_the_contact)
{
    static const size_t pairs[] = {7, 4, 2, 1, 0}; /* 4 + 1 + 2 samples in contact */

    for (size_t lag = 0; lag < sizeof pairs / sizeof pairs[0]; lag++) {
        struct log_builder b = {0};
        struct fall_contacts contacts;
        struct fall_pairs got;
        draw_log(&b, "|.####.#.|##");
        const struct fall_log log = built(&b);
        CHECK(fall_dissect(&log, 1, &contacts) == FALL_OK, "lag %zu", lag);
        CHECK(fall_pool(&log, &contacts, lag, &got) == FALL_OK, "lag %zu", lag);
        CHECK(got.n == pairs[lag], "lag %zu: %zu pairs", lag, got.n);
        for (size_t i = 0; i < got.n; i++) {
            const size_t at = (size_t)got.at[i].q_m; /* draw_log() numbers the samples */
            CHECK(got.at[i].f_N == 100.0 + (double)(at + lag), "lag %zu, q of %zu", lag, at);
            CHECK(log.sample[at].c && log.sample[at + lag].c, "lag %zu, q of %zu", lag, at);
            CHECK(got.at[i].fall == (at >= 8), "fall %zu", got.at[i].fall);
        }
        fall_pairs_free(&got);
        fall_contacts_free(&contacts);
        drop(&b);
    }
}

/* ---- Bootstrap ------------------------------------------------------------------- */

#define SLOPE_NPM 8000.0

/* Falls whose compliance scatters by 10 % around 1/k, some noise on each position. */
static void scattered_falls(struct log_builder *b, size_t falls, size_t pairs, double noise_m,
                            uint64_t *rng)
{
    for (size_t fall = 0; fall < falls; fall++) {
        const double slope_mpN = (1.0 + 0.1 * normal(rng)) / SLOPE_NPM;
        begin_fall(b);
        for (size_t i = 0; i < pairs; i++) {
            const double f_N = 0.5 + 4.5 * uniform(rng);
            add(b, 1e-3, f_N * slope_mpN + noise_m * normal(rng), f_N, 1);
        }
    }
}

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

TEST(bootstrap_width)
{
    struct tally a = {0}, b = {0};
    struct fall_opt opt = fall_opt_default;
    uint64_t rng = 1;

    opt.lag = 0;
    opt.replicates = 200;
    for (uint64_t run = 0; run < 300; run++) {
        struct log_builder lb = {0};
        struct fall_stiffness s;
        scattered_falls(&lb, 20, 20, 5e-6, &rng);
        const struct fall_log log = built(&lb);
        opt.seed = run;
        CHECK(fall_stiffness(&log, &opt, &s) == FALL_OK, "run %d", (int)run);
        CHECK(s.a.status == FALL_OK && s.b.status == FALL_OK, "run %d", (int)run);
        CHECK(s.a.replicates == 200 && s.b.replicates == 200, "run %d", (int)run);
        CHECK(s.b.lo_Npm < s.b.mid_Npm && s.b.mid_Npm < s.b.hi_Npm, "run %d", (int)run);
        count(&a, s.fit.a_Npm, &s.a);
        count(&b, s.fit.b_Npm, &s.b);
        fall_stiffness_free(&s);
        drop(&lb);
    }
    check_tally(&a, "A");
    check_tally(&b, "B");
}

/* Positions that have nothing to do with force: B must not invent an upper end. */
TEST(bootstrap_unbounded)
{
    struct log_builder b = {0};
    struct fall_opt opt = fall_opt_default;
    struct fall_stiffness s;
    uint64_t rng = 3;

    for (size_t fall = 0; fall < 10; fall++) {
        begin_fall(&b);
        for (int i = 0; i < 40; i++) {
            add(&b, 1e-3, uniform(&rng), 1.0 + uniform(&rng), 1);
        }
    }
    const struct fall_log log = built(&b);
    opt.lag = 0;
    CHECK(fall_stiffness(&log, &opt, &s) == FALL_OK, "%d", (int)s.fit.status);
    CHECK(s.b.status == FALL_UNBOUNDED && s.b.hi_Npm == 0.0, "%s", fall_status_text(s.b.status));
    CHECK(s.a.status == FALL_OK && s.a.lo_Npm < 0.0 && s.a.hi_Npm > 0.0, "%g", s.a.lo_Npm);
    fall_stiffness_free(&s);
    drop(&b);
}

/* ---- What the choices cost ----------------------------------------------------- */

TEST(kept_force_matters_little)
{
    struct log_builder b = {0};
    struct fall_opt opt = fall_opt_default;
    struct fall_fit fit[3];
    uint64_t rng = 11;

    scattered_falls(&b, 10, 40, 20e-6, &rng);
    const struct fall_log log = built(&b);
    opt.replicates = 0;
    opt.lag = 0;
    for (int force = FALL_FORCE_CENTRE; force <= FALL_FORCE_MEAN; force++) {
        struct fall_stiffness s;
        opt.force = (enum fall_force)force;
        CHECK(fall_stiffness(&log, &opt, &s) == FALL_OK, "%d", force);
        fit[force] = s.fit;
        CHECK(near(s.fit.a_Npm, fit[0].a_Npm, 0.01), "A %g %g", s.fit.a_Npm, fit[0].a_Npm);
        CHECK(near(s.fit.b_Npm, fit[0].b_Npm, 0.01), "B %g %g", s.fit.b_Npm, fit[0].b_Npm);
        fall_stiffness_free(&s);
    }
    drop(&b);
}

/* ---- No answer is an answer -------------------------------------------------------- */

static int all_finite(const struct fall_stiffness *s)
{
    const double v[] = {s->fit.a_Npm,    s->fit.b_Npm,   s->fit.r2,      s->fit.q_mean_m,
                        s->fit.f_mean_N, s->fit.q_min_m, s->fit.q_max_m, s->fit.f_min_N,
                        s->fit.f_max_N,  s->a.lo_Npm,    s->a.mid_Npm,   s->a.hi_Npm,
                        s->b.lo_Npm,     s->b.mid_Npm,   s->b.hi_Npm};
    for (size_t i = 0; i < sizeof v / sizeof v[0]; i++) {
        if (!(v[i] > -1e300 && v[i] < 1e300)) { return 0; }
    }
    return 1;
}

/* n pairs per fall, q = q0 + i * dq, F = f0 + i * df. */
static void check_degenerate(size_t falls, size_t n, double dq, double df, enum fall_status want)
{
    struct log_builder b = {0};
    struct fall_opt opt = fall_opt_default;
    struct fall_stiffness s;

    for (size_t fall = 0; fall < falls; fall++) {
        begin_fall(&b);
        add(&b, 1e-3, 0.0, 0.0, 0);
        for (size_t i = 0; i < n; i++) {
            add(&b, 1e-3, 0.1 + (double)i * dq, 2.1 + (double)i * df, 1);
        }
    }
    const struct fall_log log = built(&b);
    opt.lag = 0;
    opt.replicates = 40;
    CHECK(fall_stiffness(&log, &opt, &s) == FALL_OK, "%zu x %zu", falls, n);
    CHECK(s.fit.status == want, "%zu x %zu: %s", falls, n, fall_status_text(s.fit.status));
    CHECK(all_finite(&s), "%zu x %zu, dq %g, dF %g", falls, n, dq, df);
    CHECK(want == FALL_OK || s.fit.b_Npm == 0.0, "B %g", s.fit.b_Npm);
    CHECK(falls > 1 || s.a.status == FALL_FEW_FALLS, "%s", fall_status_text(s.a.status));
    fall_stiffness_free(&s);
    fall_stiffness_free(&s); /* twice is allowed */
    drop(&b);
}

TEST(degenerate)
{
    check_degenerate(1, 0, 0.0, 0.0, FALL_TOO_FEW);
    check_degenerate(1, 11, 1e-4, 0.1, FALL_TOO_FEW);
    check_degenerate(1, 12, 1e-4, 0.1, FALL_OK);
    check_degenerate(2, 6, 1e-4, 0.1, FALL_OK);
    check_degenerate(4, 3, 1e-4, 0.1, FALL_FLAT);       /* twelve, but three kept forces are one */
    check_degenerate(1, 1000, 1e-4, 1.0, FALL_TOO_FEW); /* out of the band */
    check_degenerate(3, 50, 0.0, 0.01, FALL_FLAT);
    check_degenerate(3, 50, 1e-4, 0.0, FALL_FLAT);
    check_degenerate(3, 50, 0.0, 0.0, FALL_FLAT);
    check_degenerate(3, 50, 1e-18, 0.01, FALL_FLAT); /* rounding is no position */
    check_degenerate(3, 50, -1e-4, 0.01, FALL_NO_RISE);
}

static enum fall_status status_of(const struct fall_log *log, const struct fall_opt *opt)
{
    struct fall_stiffness s;
    const enum fall_status status = fall_stiffness(log, opt, &s);
    CHECK(all_finite(&s), "%s", fall_status_text(status));
    fall_stiffness_free(&s);
    return status;
}

TEST(damaged_logs)
{
    static const double bad[] = {1e9, -1e9, 1e300};
    const double zero = size_of(0.0);
    const double nan_or_inf[] = {zero / zero, 1.0 / zero, -1.0 / zero};
    struct log_builder b = {0};

    draw_log(&b, "|.#####|.#####");
    struct fall_log log = built(&b);
    CHECK(status_of(&log, &fall_opt_default) == FALL_OK, "%zu", log.samples);
    for (size_t i = 0; i < 3; i++) {
        b.sample[3].f_mon_N = bad[i];
        CHECK(status_of(&log, &fall_opt_default) == FALL_BAD_LOG, "%g", bad[i]);
        b.sample[3].f_mon_N = nan_or_inf[i];
        CHECK(status_of(&log, &fall_opt_default) == FALL_BAD_LOG, "%zu", i);
        b.sample[3].f_mon_N = 1.0;
        b.sample[8].q_m = nan_or_inf[i];
        CHECK(status_of(&log, &fall_opt_default) == FALL_BAD_LOG, "%zu", i);
        b.sample[8].q_m = 1.0;
    }
    b.sample[6].t_s = 0.0; /* a new fall may begin at 0 again, if it goes on from there */
    for (size_t i = 7; i < b.n; i++) {
        b.sample[i].t_s = (double)(i - 6) * 1e-3;
    }
    CHECK(status_of(&log, &fall_opt_default) == FALL_OK, "%g", b.sample[7].t_s);
    b.sample[8].t_s = b.sample[7].t_s;
    CHECK(status_of(&log, &fall_opt_default) == FALL_BAD_LOG, "%g", b.sample[8].t_s);
    b.sample[8].t_s = 1.5e-3;
    b.start[1] = 0;
    CHECK(status_of(&log, &fall_opt_default) == FALL_BAD_LOG, "%zu", b.start[1]);
    b.start[1] = b.n;
    CHECK(status_of(&log, &fall_opt_default) == FALL_BAD_LOG, "%zu", b.start[1]);
    log.falls = 0;
    CHECK(status_of(&log, &fall_opt_default) == FALL_BAD_LOG, "%zu", log.falls);
    drop(&b);
}

TEST(bad_options)
{
    struct log_builder b = {0};
    struct fall_opt opt = fall_opt_default;

    draw_log(&b, "|.#####|.#####");
    const struct fall_log log = built(&b);
    opt.band_lo_N = 5.0;
    CHECK(status_of(&log, &opt) == FALL_BAD_OPT, "%g", opt.band_lo_N);
    opt = fall_opt_default;
    opt.replicates = 39;
    CHECK(status_of(&log, &opt) == FALL_BAD_OPT, "%zu", opt.replicates);
    opt = fall_opt_default;
    opt.lag = (size_t)-1;
    CHECK(status_of(&log, &opt) == FALL_OK, "%zu", opt.lag); /* no pairs, no overflow */
    drop(&b);
}

/* ---- The same digits, always --------------------------------------------------------- */

static void digits(char *text, size_t cap)
{
    struct log_builder b = {0};
    struct fall_opt opt = fall_opt_default;
    struct fall_stiffness s;
    uint64_t rng = 2013;

    scattered_falls(&b, 10, 60, 60e-6, &rng);
    const struct fall_log log = built(&b);
    opt.replicates = 200;
    opt.lag = 0;
    CHECK(fall_stiffness(&log, &opt, &s) == FALL_OK, "%d", (int)s.fit.status);
    snprintf(text, cap, "%.17g %.17g %.17g | %.17g %.17g %.17g | %.17g %.17g %.17g", s.fit.a_Npm,
             s.fit.b_Npm, s.fit.r2, s.a.lo_Npm, s.a.mid_Npm, s.a.hi_Npm, s.b.lo_Npm, s.b.mid_Npm,
             s.b.hi_Npm);
    fall_stiffness_free(&s);
    drop(&b);
}

TEST(same_digits)
{
    /* Not an oracle: the other tests say the values are right. This line says that
     * another compiler, level or word size gives them to the last bit. */
    static const char want[] = "7778.3207706899457 8004.6724337967971 0.97172255767129656 | "
                               "7074.3961805961662 7645.507566040822 8006.9342424571414 | "
                               "7358.201505256422 8025.7680488431424 8566.146446966879";
    char once[400], twice[400];

    digits(once, sizeof once);
    digits(twice, sizeof twice);
    CHECK(strcmp(once, twice) == 0, "%s\n%s", once, twice);
    CHECK(strcmp(once, want) == 0, "got  %s\nwant %s", once, want);
}

/* ---- Files ----------------------------------------------------------------------- */

static size_t lines_of(const char *path, const char *header)
{
    char line[128];
    size_t n = 0;
    FILE *f = fopen(path, "r");

    if (!f) { return 0; }
    while (fgets(line, sizeof line, f)) {
        double q_m, f_N;
        if (n == 0) {
            CHECK(strcmp(line, header) == 0, "%s: %s", path, line);
        } else {
            CHECK(sscanf(line, "%lf,%lf", &q_m, &f_N) == 2, "%s: %s", path, line);
        }
        n++;
    }
    fclose(f);
    return n;
}

TEST(plot_files)
{
    char dir[] = "/tmp/analysis_test.XXXXXX";
    char path[3][64];
    struct log_builder b = {0};
    struct fall_stiffness s;

    CHECK(mkdtemp(dir) != NULL, "%s", dir);
    for (int i = 0; i < 3; i++) {
        snprintf(path[i], sizeof path[i], "%s/%d.csv", dir, i);
    }
    ramp(&b, 5000.0, 1);
    const struct fall_log log = built(&b);
    struct fall_plot_paths paths = {path[0], path[1], path[2]};
    CHECK(fall_stiffness(&log, &fall_opt_default, &s) == FALL_OK, "%zu", s.contacts);
    for (int direction = FALL_A; direction <= FALL_B; direction++) {
        CHECK(fall_write_plot(&s, (enum fall_direction)direction, &paths) == FALL_OK, "%s", dir);
        CHECK(lines_of(path[0], "q_m,f_mon_n\n") == 1 + s.raw.n, "%zu", s.raw.n);
        CHECK(lines_of(path[1], "q_m,f_mon_n\n") == 1 + s.averaged.n, "%zu", s.averaged.n);
        CHECK(lines_of(path[2], "q_m,f_mon_n\n") == 3, "%d", direction);
    }
    s.fit.status = FALL_FLAT;
    CHECK(fall_write_plot(&s, FALL_A, &paths) == FALL_OK, "%s", dir);
    CHECK(lines_of(path[2], "q_m,f_mon_n\n") == 1, "%s", path[2]);
    paths.line = dir;
    CHECK(fall_write_plot(&s, FALL_A, &paths) == FALL_IO, "%s", dir);
    for (int i = 0; i < 3; i++) {
        remove(path[i]);
    }
    rmdir(dir);
    fall_stiffness_free(&s);
    drop(&b);
}

/* ---- Rest ------------------------------------------------------------------------- */

#define STEP_M 66.3e-6

/* A labelled trace from the first contact on. The position is A*sin + creep + a
 * number of encoder counts, the force A*sin + noise; each part stops at its time. */
struct trace {
    const char *name;
    enum fall_rest_class label;
    double swing_m, swing_N; /* peak-to-peak                                  */
    double from_s, until_s;  /* when they swing                               */
    double decay_per_s;      /* relative loss of the swing, 1/s                */
    double creep_mps;
    int counts;      /* random counts 0 .. counts on the position      */
    double noise_N;  /* peak-to-peak of the monitor's noise            */
    double length_s; /* of the log, from the first contact             */
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

static void play(struct log_builder *b, const struct trace *tr, double rate_Hz, double freq_Hz,
                 uint64_t *rng)
{
    const size_t ticks = (size_t)(tr->length_s * rate_Hz + 0.5);
    const double u = 3.14159265358979 * freq_Hz / rate_Hz; /* tan of half the angle, nearly */
    const double cos_1 = (1.0 - u * u) / (1.0 + u * u), sin_1 = 2.0 * u / (1.0 + u * u);
    const double shrink = 1.0 - tr->decay_per_s / rate_Hz;
    double sin_t = 0.0, cos_t = 1.0, left = 1.0;

    begin_fall(b);
    for (int i = 0; i < 20; i++) {
        add(b, 1.0 / rate_Hz, -0.01 + 5e-4 * i, 0.1, 0);
    }
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

    for (size_t i = 0; i < TRACES; i++) {
        play(&b, &traces[i], rate_Hz, freq_Hz, rng);
    }
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
        CHECK(rest.rest == (over ? FALL_OSCILLATES : FALL_AT_REST), "%s",
              fall_rest_text(rest.rest));
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

/* Position saturates at 2 m, where a mass that fell past it seems to stand still. */
TEST(a_mass_that_ran_away_is_not_at_rest)
{
    static const struct {
        double q0_m, q1_m;
        enum fall_rest_class want;
    } row[] = {{2 - 0x1p-30, 2 - 0x1p-30, FALL_INCOMPLETE}, {-2, -2, FALL_INCOMPLETE},
               {2 - 0x1p-30, 1.2, FALL_OSCILLATES},         {1.98, 1.98, FALL_AT_REST},
               {-1.98, -1.98, FALL_AT_REST},                {-2, -1.9999, FALL_INCOMPLETE}};
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        const enum fall_rest_class got = rest_between(0.002, row[i].q0_m, row[i].q1_m);
        CHECK(got == row[i].want, "%g and %g m: %s", row[i].q0_m, row[i].q1_m, fall_rest_text(got));
    }
}

TEST_MAIN("analysis", line_is_exact, even_forces_are_exact, twelve_rows_by_hand, band_has_both_ends,
          ties_keep_their_order, contacts_are_cut, lag_stays_in_the_contact, bootstrap_width,
          bootstrap_unbounded, kept_force_matters_little, degenerate, damaged_logs, bad_options,
          same_digits, plot_files, rest_is_never_mistaken, rest_at_the_limits,
          slow_rates_are_judged_too, a_mass_that_ran_away_is_not_at_rest);
