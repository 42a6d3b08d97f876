/* SPDX-License-Identifier: MIT */
/* The analysis of the falling mass, whole: exact where the answer is known, explicit
 * where there is none, the same digits always. */
#include "falls.h"

/* ---- A line without noise ----------------------------------------------------- */

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

/* ---- What the choices cost ----------------------------------------------------- */

TEST(kept_force_matters_little)
{
    struct log_builder b = {0};
    struct fall_opt opt = fall_opt_default;
    struct fall_fit fit[3];
    uint64_t rng = 11;

    scattered_falls(&b, 10, 40, 20e-6, &rng);
    const struct fall_log log = built(&b);
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
    const double v[] = {s->fit.a_Npm, s->fit.b_Npm, s->fit.r2, s->fit.q_mean_m, s->fit.f_mean_N,
        s->fit.q_min_m, s->fit.q_max_m, s->fit.f_min_N, s->fit.f_max_N, s->a.lo_Npm, s->a.hi_Npm,
        s->b.lo_Npm, s->b.hi_Npm};
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
    static const double nan_or_inf[] = {NAN, INFINITY, -INFINITY};
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
    for (size_t i = 7; i < b.n; i++) { b.sample[i].t_s = (double)(i - 6) * 1e-3; }
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
    opt.scope = FALL_SCOPES;
    CHECK(status_of(&log, &opt) == FALL_BAD_OPT, "%d", (int)opt.scope);
    opt = fall_opt_default;
    opt.step_m = -1e-6;
    CHECK(status_of(&log, &opt) == FALL_BAD_OPT, "%g", opt.step_m);
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
    opt.lag = 0;
    CHECK(fall_stiffness(&log, &opt, &s) == FALL_OK, "%d", (int)s.fit.status);
    snprintf(text, cap, "%.17g %.17g %.17g | %.17g %.17g | %.17g %.17g", s.fit.a_Npm, s.fit.b_Npm,
        s.fit.r2, s.a.lo_Npm, s.a.hi_Npm, s.b.lo_Npm, s.b.hi_Npm);
    fall_stiffness_free(&s);
    drop(&b);
}

TEST(same_digits)
{
    /* Not an oracle: the other tests say the values are right. This line says that
     * another compiler, level or word size gives them to the last bit. */
    static const char want[] = "7778.3207706899457 8004.6724337967971 0.97172255767129656 | "
                               "7193.9752131815294 8362.666328198362 | "
                               "7368.3632053108513 8761.2687056279701";
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
    for (int i = 0; i < 3; i++) { snprintf(path[i], sizeof path[i], "%s/%d.csv", dir, i); }
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
    for (int i = 0; i < 3; i++) { remove(path[i]); }
    rmdir(dir);
    fall_stiffness_free(&s);
    drop(&b);
}

TEST_MAIN("analysis", line_is_exact, even_forces_are_exact, kept_force_matters_little, degenerate,
    damaged_logs, bad_options, same_digits, plot_files);
