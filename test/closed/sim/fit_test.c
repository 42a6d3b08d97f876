/* SPDX-License-Identifier: MIT */
/* The search for a plant: equal effort for every reading, the same again from the same
 * seed, and on from where it was cut off. */
#include "said.h"
#include "lab/lab.h"

#include "lab/fit/search.h"
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
        CHECK(gap(space_ln(e), x) < 1e-11, "ln e^%g = %.17g", x, space_ln(e));
    }
}

/* Every value reaches the device, or the box, under its name. */
TEST(a_plant_becomes_a_configuration)
{
    struct plant_point p = space_start();
    struct run_setting setting[SPACE_ROWS];
    struct run_cfg c;
    int settings = 0;
    memset(&c, 0, sizeof c);
    c.board = posix_config_default();
    for (int i = 0; i < SPACE_ROWS; i++) { p.u[i] = 0.1 + 0.8 * i / SPACE_ROWS; }
    space_apply(&p, &c, setting);
    for (int i = 0; i < SPACE_ROWS; i++) {
        const double want = space_value(i, p.u[i]);
        if (space_row[i].kind == SPACE_DEVICE) {
            double got = 0;
            for (int k = 0; k < sim_device_rows; k++) {
                if (strcmp(sim_device_row[k].name, space_row[i].name) != 0) { continue; }
                memcpy(&got, (const char *)&c.board.device + (size_t)k * sizeof got, sizeof got);
            }
            CHECK(got == want, "%s: %.12g, want %.12g", space_row[i].name, got, want);
        } else if (space_row[i].kind == SPACE_SCENE) {
            CHECK(strcmp(setting[settings].name, space_row[i].name) == 0 &&
                      setting[settings].value == want,
                "%s", space_row[i].name);
            settings++;
        }
    }
    CHECK(strcmp(setting[settings].name, "kf") == 0, "%s", setting[settings].name);
    CHECK(gap(setting[settings].value / c.board.device.kf_npa,
              space_value(space_find("kf_gain"), p.u[space_find("kf_gain")])) < 1e-12,
        "kf");
    CHECK(c.mon_gain == space_value(space_find("mon_gain"), p.u[space_find("mon_gain")]),
        "mon_gain %.12g", c.mon_gain);
    CHECK_EQ_I64(c.settings, settings + 1);
}

/* A landscape instead of a simulation: each reading's best plant lies elsewhere. */
static double height(const struct plant_point *p, int reading)
{
    double sum = 0;
    for (int i = 0; i < SPACE_ROWS; i++) {
        const double d = p->u[i] - (0.2 + 0.04 * reading);
        sum += d * d / SPACE_ROWS;
    }
    return sum;
}

static struct score score_of(const struct plant_point *p)
{
    struct score s;
    memset(&s, 0, sizeof s);
    s.done = 1;
    for (int k = 0; k < READINGS; k++) {
        for (int row = 0; row < TABLE2_ROWS; row++) {
            const double paper =
                space_ln(table2_paper[row].stiffness_Npm / table2_paper[row].k_Npm);
            s.ln_k[row][k] = (float)(paper + 2 * height(p, k));
        }
    }
    return s;
}

static void search_for(struct search *s, uint64_t seed, int rounds)
{
    search_init(s, seed);
    for (int i = 0; i < SEARCH_STARTS; i++) {
        const struct plant_point p = search_first(s, i);
        const struct score score = score_of(&p);
        search_offer(s, &p, &score);
    }
    for (int r = 0; r < rounds; r++) {
        struct plant_point child[READINGS];
        const int n = search_round(s, child);
        CHECK_EQ_I64(n, READINGS); /* one each: equal effort */
        for (int i = 0; i < n; i++) {
            const struct score score = score_of(&child[i]);
            search_offer(s, &child[i], &score);
        }
    }
}

TEST(every_reading_finds_its_own_best)
{
    static struct search s;
    search_for(&s, 1, 400);
    for (int i = 0; i < READINGS; i++) {
        const struct search_member *m = search_best(&s, i);
        CHECK(height(&m->p, i) < 0.006, "%s: %g off", reading_table[i].name, height(&m->p, i));
        for (int k = 1; k < s.of[i].members; k++) {
            CHECK(s.of[i].member[k - 1].cost <= s.of[i].member[k].cost, "member %d", k);
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
    struct plant_point child[READINGS];
    search_init(&s, 3);
    s.pinned[2] = 1;
    for (int i = 0; i < SEARCH_STARTS; i++) {
        const struct plant_point p = search_first(&s, i);
        const struct score score = score_of(&p);
        CHECK(p.u[2] == s.start.u[2], "start %d", i);
        search_offer(&s, &p, &score);
    }
    for (int r = 0; r < 20; r++) {
        const int n = search_round(&s, child);
        for (int i = 0; i < n; i++) {
            CHECK(child[i].u[2] == s.start.u[2], "round %d", r);
            for (int k = 0; k < SPACE_ROWS; k++) {
                CHECK(child[i].u[k] >= 0 && child[i].u[k] <= 1, "%s: %g", space_row[k].name,
                    child[i].u[k]);
            }
        }
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
        WORDS("fit", "--budget", "9", "--runs", "1", "--further", "0", "--variant", "b-aligned-all",
            "--out", out));
    CHECK(whole.status == 0, "status %d: %s", whole.status, whole.err);
    CHECK(strstr(whole.out, "b-aligned-all") != NULL, "%s", whole.out);
    size = said_size(journal);
    CHECK(size > 0 && truncate(journal, size - size / 3) == 0, "%ld bytes", size);
    said(&again, dir, cli_fit,
        WORDS("fit", "--budget", "9", "--runs", "1", "--further", "0", "--variant", "b-aligned-all",
            "--out", out));
    CHECK(again.status == 0 && strcmp(again.out, whole.out) == 0, "%s", again.out);
    CHECK_EQ_I64(said_size(journal), size);
    said(&refused, dir, cli_fit, WORDS("fit", "--budget", "9", "--seed", "2", "--out", out));
    CHECK(refused.status == 2 && strstr(refused.err, "holds another search") != NULL, "%s",
        refused.err);
    snprintf(journal, sizeof journal, "%s/fit/progress.csv", dir);
    CHECK(said_size(journal) > 0, "a refused search wrote over the progress of another");
    for (int i = 0; i < 3; i++) { /* vel_p is whole, 0..2 */
        static const char *const pin[] = {"vel_p=3", "vel_p=0.5", "vel_p=-1"};
        said(&refused, dir, cli_fit, WORDS("fit", "--pin", pin[i]));
        CHECK(refused.status == 2 && strstr(refused.err, pin[i]) != NULL, "%s", refused.err);
    }
    said(&refused, dir, cli_fit, WORDS("fit", "--pin", "rotor=9"));
    CHECK(refused.status == 2 && strstr(refused.err, "--pin: rotor=9") != NULL, "%s", refused.err);
    said(&refused, dir, cli_fit, WORDS("fit", "--variant", "c"));
    CHECK(refused.status == 2 && strstr(refused.err, "--variant: c") != NULL, "%s", refused.err);
    said_clean(dir);
}

TEST_MAIN("fit", values_and_units_are_inverse, logarithm_undoes_the_exponential,
    a_plant_becomes_a_configuration, every_reading_finds_its_own_best,
    the_same_seed_is_the_same_search, what_is_pinned_stays, a_search_goes_on_where_it_was_cut_off);
