/* SPDX-License-Identifier: MIT */
/* Contacts, pairs, band and averages of the analysis: by hand, to the last sample. */
#include "falls.h"

/* ---- Contacts ------------------------------------------------------------------ */

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
    check_contacts("##|.##", 1, "0:3-5+ ");         /* before the first fall */
    check_contacts("|##|##", 0, "0:0-2+ 1:2-4+ ");  /* never across two falls */
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

/* ---- Band and sort ------------------------------------------------------------ */

TEST(band_has_both_ends)
{
    /* The doubles next to the ends on either side. */
    static const double f_N[] = {4.5 + 9e-16, 4.5, 0.8 - 1.2e-16, 0.8, 2.0, -1.0, 0.0, 1e6};
    struct fall_pair at[8];
    const struct fall_pairs in = {at, 8};
    struct fall_pairs out;

    for (size_t i = 0; i < in.n; i++) { at[i] = (struct fall_pair){(double)i, f_N[i], i}; }
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

TEST_MAIN("dissect", contacts_are_cut, lag_stays_in_the_contact, band_has_both_ends,
    ties_keep_their_order, twelve_rows_by_hand);
