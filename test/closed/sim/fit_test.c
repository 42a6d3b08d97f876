/* SPDX-License-Identifier: MIT */
/* The search for a plant: equal effort for every velocity estimator, the same again from the same
 * seed, and on from where it was cut off. */
#include "said.h"
#include "lab/lab.h"

#include "lab/fit/search.h"
#include "sim/ln.h"
#include "sim/plant.h"

static double gap(double a, double b) { return a < b ? b - a : a - b; }

TEST(values_and_units_are_inverse)
{
    for (int i = 0; i < SPACE_ROWS; i++) {
        const struct space_row *r = &space_row[i];
        CHECK(r->start >= r->lo && r->start <= r->hi, "%s starts at %g", r->name, r->start);
        for (int k = 0; k <= 10; k++) {
            const double u = k / 10.0, v = space_value(i, u);
            CHECK(v >= r->lo * (1 - 1e-12) && v <= r->hi * (1 + 1e-12), "%s: %g", r->name, v);
            if (r->scale == SPACE_WHOLE) {
                CHECK(space_value(i, space_unit(i, v)) == v, "%s: %g", r->name, v);
            } else {
                CHECK(gap(space_unit(i, v), u) < 1e-9, "%s: %g at %g", r->name, v, u);
            }
        }
        CHECK(space_find(r->name) == i, "%s", r->name);
    }
    CHECK(space_find("no such row") == -1, "found");
}

TEST(logarithm_undoes_the_exponential)
{
    for (int i = -400; i <= 400; i++) {
        const double x = 0.05 * i, e = x < 0 ? sim_exp_neg(-x) : 1 / sim_exp_neg(x);
        CHECK(gap(sim_ln(e), x) < 1e-11, "ln e^%g = %.17g", x, sim_ln(e));
    }
}

/* Every value reaches the device, or the model of the box. */
TEST(a_plant_becomes_a_model)
{
    struct plant_point p = space_start();
    struct sim_device d;
    struct settle_wall w;
    for (int i = 0; i < SPACE_ROWS; i++) { p.u[i] = 0.1 + 0.8 * i / SPACE_ROWS; }
    CHECK_EQ_I64(space_apply(&p, ESTIMATE_TRACK, &d, &w), 0);
    for (int i = 0; i < SPACE_ROWS; i++) {
        const double want = space_value(i, p.u[i]);
        double got = w.f0_N;
        if (space_row[i].kind == SPACE_WINDOW) { got = want; }
        if (space_row[i].kind == SPACE_TAU) { got = w.velocity.tau_s; }
        for (int k = 0; space_row[i].kind == SPACE_DEVICE && k < sim_device_rows; k++) {
            if (strcmp(sim_device_row[k].name, space_row[i].name) != 0) { continue; }
            memcpy(&got, (const char *)&d + (size_t)k * sizeof got, sizeof got);
        }
        CHECK(got == want, "%s: %.12g, want %.12g", space_row[i].name, got, want);
    }
    CHECK(w.velocity.kind == ESTIMATE_TRACK && w.velocity.window >= 1 && w.velocity.window <= 16,
        "window %d", w.velocity.window);
}

/* A plant that is given up would have cost more than the bound; one that is not costs what it does
 * without one. */
TEST(giving_up_early_changes_nothing)
{
    const struct score_plan plan = {6, 4, 0};
    struct sim_random rng = {5};
    int gave_up = 0;
    for (int n = 0; n < 12; n++) {
        struct plant_point p = space_start();
        struct score all, some;
        for (int i = 0; i < SPACE_ROWS; i++) {
            p.u[i] += 0.1 * (sim_random_unit(&rng) - 0.5);
            if (p.u[i] < 0 || p.u[i] > 1) { p.u[i] = 0.5; }
        }
        all = score_plant(&p, ESTIMATE_WINDOW, &plan, 1e9);
        some = score_plant(&p, ESTIMATE_WINDOW, &plan, 20);
        CHECK(all.done && (some.done ? some.cost == all.cost : all.cost > 20.0f),
            "%d: %g, given up %d", n, (double)all.cost, !some.done);
        gave_up += !some.done;
    }
    CHECK(gave_up > 0 && gave_up < 12, "%d of 12 were given up", gave_up);
}

/* The velocity of a ramp of counts is its slope, by each estimator, after its lag. */
TEST(every_estimator_finds_a_slope)
{
    for (int kind = 0; kind < ESTIMATES; kind++) {
        const struct estimate_par p = {(enum estimate_kind)kind, 8, 2e-3};
        struct estimate s;
        double v = 0;
        estimate_start(&s, 10);
        CHECK(estimate_step(&s, &p, 1e-3, 10) == 0, "%s: moves at rest", estimate_name[kind]);
        for (int i = 1; i <= 200; i++) { v = estimate_step(&s, &p, 1e-3, 10 + 3 * i); }
        CHECK(gap(v, 3) < 1e-9, "%s: %.12g", estimate_name[kind], v);
    }
}

/* A landscape instead of a simulation: each velocity's best plant lies elsewhere. */
static double height(const struct plant_point *p, int kind)
{
    double sum = 0;
    for (int i = 0; i < SPACE_ROWS; i++) {
        const double d = p->u[i] - (0.2 + 0.15 * kind);
        sum += d * d / SPACE_ROWS;
    }
    return sum;
}

static void offer(struct search *s, const struct search_child *c, int n)
{
    for (int i = 0; i < n; i++) {
        const struct score score = {.done = 1, .cost = (float)height(&c[i].p, c[i].kind)};
        search_offer(s, &c[i], &score);
    }
}

static struct search_child child[SEARCH_BATCH];

static void search_for(struct search *s, uint64_t seed, int rounds)
{
    search_init(s, seed);
    offer(s, child, search_first(s, child));
    for (int r = 0; r < rounds; r++) {
        const int n = search_round(s, child);
        CHECK_EQ_I64(n, ESTIMATES * SEARCH_BROOD); /* equal effort */
        offer(s, child, n);
    }
}

TEST(every_velocity_finds_its_own_best)
{
    static struct search s;
    search_for(&s, 1, 100);
    for (int k = 0; k < ESTIMATES; k++) {
        const struct search_member *m = s.of[k].member;
        CHECK((double)m->s.cost < 0.006, "%s: %g off", estimate_name[k], (double)m->s.cost);
        for (int i = 1; i < s.of[k].members; i++) {
            CHECK(m[i - 1].s.cost <= m[i].s.cost, "member %d", i);
        }
    }
}

TEST(the_same_seed_is_the_same_search)
{
    static struct search a, b, other;
    search_for(&a, 7, 20);
    search_for(&b, 7, 20);
    search_for(&other, 8, 20);
    CHECK(memcmp(&a.of, &b.of, sizeof a.of) == 0, "seed 7 twice");
    CHECK(memcmp(&a.of, &other.of, sizeof a.of) != 0, "seeds 7 and 8");
}

TEST(what_is_pinned_stays)
{
    static struct search s;
    search_init(&s, 3);
    s.pinned[2] = 1;
    for (int r = 0; r < 20; r++) {
        const int n = r == 0 ? search_first(&s, child) : search_round(&s, child);
        for (int i = 0; i < n; i++) {
            CHECK(child[i].p.u[2] == s.start.u[2], "round %d", r);
            for (int k = 0; k < SPACE_ROWS; k++) {
                CHECK(child[i].p.u[k] >= 0 && child[i].p.u[k] <= 1, "%s: %g", space_row[k].name,
                    child[i].p.u[k]);
            }
        }
        offer(&s, child, n);
    }
}

/* The program: a budget of a few plants; a search cut off goes on as if it had not been. */
TEST(a_search_goes_on_where_it_was_cut_off)
{
    static struct said whole, again, refused;
    const char *dir = said_dir();
    char out[300], journal[300];
    long size;
    snprintf(out, sizeof out, "%s/fit", dir);
    snprintf(journal, sizeof journal, "%s/fit/journal", dir);
    said(&whole, dir, cli_fit,
        WORDS("fit", "--budget", "9", "--falls", "10", "--velocity", "window", "--out", out));
    CHECK(whole.status == 0, "status %d: %s", whole.status, whole.err);
    CHECK(strstr(whole.out, "exhand-lab drop --gates --device rotor=") != NULL, "%s", whole.out);
    size = said_size(journal);
    CHECK(size > 0 && truncate(journal, size - size / 3) == 0, "%ld bytes", size);
    said(&again, dir, cli_fit,
        WORDS("fit", "--budget", "9", "--falls", "10", "--velocity", "window", "--out", out));
    CHECK(again.status == 0 && strcmp(again.out, whole.out) == 0, "%s", again.out);
    CHECK_EQ_I64(said_size(journal), size);
    said(&refused, dir, cli_fit, WORDS("fit", "--budget", "9", "--seed", "2", "--out", out));
    CHECK(refused.status == 2 && strstr(refused.err, "holds another search") != NULL, "%s",
        refused.err);
    snprintf(journal, sizeof journal, "%s/fit/progress.csv", dir);
    CHECK(said_size(journal) > 0, "a refused search wrote over the progress of another");
    for (int i = 0; i < 3; i++) { /* vel_p is whole, 0..4 */
        static const char *const pin[] = {"vel_p=5", "vel_p=0.5", "vel_p=-1"};
        said(&refused, dir, cli_fit, WORDS("fit", "--pin", pin[i]));
        CHECK(refused.status == 2 && strstr(refused.err, pin[i]) != NULL, "%s", refused.err);
    }
    said(&refused, dir, cli_fit, WORDS("fit", "--pin", "rotor=9"));
    CHECK(refused.status == 2 && strstr(refused.err, "--pin: rotor=9") != NULL, "%s", refused.err);
    said(&refused, dir, cli_fit, WORDS("fit", "--velocity", "c"));
    CHECK(refused.status == 2 && strstr(refused.err, "--velocity: c: window, pole") != NULL, "%s",
        refused.err);
    said_clean(dir);
}

TEST_MAIN("fit", values_and_units_are_inverse, logarithm_undoes_the_exponential,
    a_plant_becomes_a_model, giving_up_early_changes_nothing, every_estimator_finds_a_slope,
    every_velocity_finds_its_own_best, the_same_seed_is_the_same_search, what_is_pinned_stays,
    a_search_goes_on_where_it_was_cut_off);
