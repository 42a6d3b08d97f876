/* SPDX-License-Identifier: MIT */
/* exhand advise gains: the model of a fall, rows of gains, and a rule that lies inside of it. */
#include "advise/gains.h"
#include "said.h"
#include "lab/lab.h"

#include "sim/random.h"

#include "guarded/guarded.h"

#include "exhand/error.h"
#include "exhand/wire.h"

#include <stdlib.h>

static struct said s;

static struct settle_wall wall(double rate_Hz, double k, double b)
{
    return (struct settle_wall){
        1 / rate_Hz, k, b, 0.107, 2e-4, 40, 200000, {ESTIMATE_WINDOW, 2, 0}};
}

static int rests(const struct sim_device *d, double rate_Hz, double k, double b, int cases)
{
    const struct settle_wall w = wall(rate_Hz, k, b);
    int n = 0;
    for (int i = 0; i < cases; i++) { n += settle_run(d, &w, settle_case_at(i)) == SETTLE_REST; }
    return n;
}

/* The device was fitted so that 95 % of falls come to rest at the paper's points. At twice the
 * gains they do not. Without friction they do not either, as the linear test predicts. */
TEST(the_papers_points)
{
    static const double row[][3] = {{90, 1500, 0}, {100, 2000, 0}, {200, 2000, 15}, {500, 6000, 20},
        {1000, 10000, 40}, {2000, 20000, 60}};
    const struct sim_device d = sim_device_default();
    struct sim_device smooth = d;
    smooth.mu_motor = smooth.mu_mass = smooth.coulomb_n = 0;
    for (int i = 0; i < 6; i++) {
        const double *r = row[i];
        CHECK(rests(&d, r[0], r[1], r[2], 1000) >= 950, "%g Hz", r[0]);
        CHECK(rests(&d, r[0], 2 * r[1], 2 * r[2], 10) < 10, "%g Hz, twice", r[0]);
        CHECK(rests(&smooth, r[0], r[1], r[2], 10) < 10, "%g Hz, no friction", r[0]);
    }
}

TEST(cases_fill_all_phases)
{
    int hit[5][8] = {{0}};
    for (int i = 0; i < 32; i++) {
        const struct settle_case c = settle_case_at(i);
        const double v[5] = {c.grid, c.tick, c.servo, c.height, c.wall};
        for (int k = 0; k < 5; k++) {
            CHECK(v[k] >= 0 && v[k] < 1, "case %d: %g", i, v[k]);
            hit[k][(int)(8 * v[k])]++;
        }
    }
    for (int k = 0; k < 5; k++) {
        for (int n = 0; n < 8; n++) { CHECK(hit[k][n] >= 1, "%d, eighth %d: %d", k, n, hit[k][n]); }
    }
}

/* How far behind the wall the first tick comes: the fall's time, which the height moves by some
 * ticks, less the tick's. Multiples of irrational steps once met it: all cases of a device had
 * their tick within a quarter of the way. */
TEST(cases_hold_no_two_phases_together)
{
    for (int a = 0; a <= 160; a++) {
        int hit[4] = {0};
        for (int i = 0; i < 256; i++) {
            const struct settle_case c = settle_case_at(i);
            const double behind = 0.1 * a * c.height - c.tick + 1;
            hit[(int)(4 * (behind - (double)(int)behind))]++;
        }
        for (int n = 0; n < 4; n++) {
            CHECK(hit[n] >= 40, "height by %g ticks, quarter %d: %d of 256", 0.1 * a, n, hit[n]);
        }
    }
}

/* --- the rule --- */

/* Rows that are all known: nothing is simulated. */
static struct region drawn(struct sim_random *r)
{
    struct region g;
    const int kind = (int)(4 * sim_random_unit(r));
    const double b_top = 1 + 900 * sim_random_unit(r), scale = 100 + 5e5 * sim_random_unit(r);
    double top = sim_random_unit(r);
    memset(&g, 0, sizeof g);
    g.o.wall.T_s = 1.0 / 2000;
    for (int j = 0; j <= REGION_ROWS; j++) {
        struct region_row *row = &g.row[j];
        const int none = (kind >= 2 && sim_random_unit(r) < 0.05) || (kind == 3 && j < 5);
        row->b_Nspm = b_top * j / REGION_ROWS;
        top += (kind == 0 ? 0.05 : 0.3) * (sim_random_unit(r) - 0.5);
        if (none || top <= 0) { continue; }
        row->low_Npm = scale * 0.01 * (1 + (int)(3 * sim_random_unit(r)));
        row->high_Npm = row->low_Npm + scale * top;
    }
    return g;
}

/* Whether the rows on both sides have it, straight in between. */
static int has(const struct region *g, double k, double b)
{
    const double step = g->row[1].b_Nspm;
    const int j = (int)(b / step);
    const struct region_row *low = &g->row[j], *high = j < REGION_ROWS ? low + 1 : low;
    const double share = (b - low->b_Nspm) / step;
    return low->high_Npm > 0 && k >= low->low_Npm && high->high_Npm > 0 && k >= high->low_Npm &&
           k <= low->high_Npm + (high->high_Npm - low->high_Npm) * share;
}

TEST(the_rule_is_inside_everywhere)
{
    struct sim_random r = {7};
    int rules = 0, later = 0;
    long asked = 0;
    for (int n = 0; n < 150; n++) {
        struct region g = drawn(&r);
        struct exh_gains_par rule;
        int next = 0;
        double most = 0;
        for (int j = 0; j < REGION_ROWS; j++) {
            next += g.row[j].high_Npm > 0 && g.row[j + 1].high_Npm > 0;
            most = g.row[j].high_Npm > most ? g.row[j].high_Npm : most;
        }
        if (next < 10 || gains_rule(&rule, &g)) { continue; }
        rules++;
        later += rule.b_Nspm_q20[0] > 0;
        CHECK(exh_gains_setup(&rule, (struct exh_period){1, 2000}) == 0, "rows %d", n);
        for (int j = 0; j <= 200; j++) {
            for (int i = 0; i <= 200; i++) {
                const double k = most * (i + sim_random_unit(&r)) / 200;
                const double b = g.row[REGION_ROWS].b_Nspm * (j + sim_random_unit(&r)) / 201;
                const int32_t k_q10 = (int32_t)(k * 1024), b_q20 = (int32_t)(b * 1048576);
                if (!exh_gains_ok(&rule, k_q10, b_q20)) { continue; }
                asked++;
                CHECK(gains_allows(&rule, k, b), "rows %d: k %g b %g", n, k, b);
                CHECK(k <= gains_k_max(&rule, b) + 0.01, "rows %d: k %g b %g", n, k, b);
                CHECK(has(&g, k_q10 / 1024.0, b_q20 / 1048576.0), "rows %d: k %g b %g", n, k, b);
            }
        }
        /* The knots themselves, where the line is nearest. */
        for (int i = 0; i < rule.knots; i++) {
            CHECK(exh_gains_ok(&rule, rule.k_Npm_q10[i], rule.b_Nspm_q20[i]) ==
                      (rule.k_Npm_q10[i] >= rule.k_min_Npm_q10),
                "rows %d: knot %d", n, i);
        }
    }
    CHECK(rules > 40 && later > 5 && asked > 100000, "only %d rules, %d later, %ld pairs", rules,
        later, asked);
}

/* All of a rectangle is taken, but for a rounding. */
TEST(a_rectangle_is_taken)
{
    struct region g;
    struct exh_gains_par rule;
    memset(&g, 0, sizeof g);
    g.o.wall.T_s = 1.0 / 2000;
    for (int j = 0; j <= REGION_ROWS; j++) { g.row[j] = (struct region_row){2.5 * j, 40, 9000}; }
    CHECK(gains_rule(&rule, &g) == 0, "no rule");
    CHECK(rule.knots == 2 && rule.b_Nspm_q20[0] == 0, "%d knots", (int)rule.knots);
    CHECK(gains_allows(&rule, 8998, 99.999) && gains_allows(&rule, 40.1, 0), "a corner is missing");
    CHECK(!gains_allows(&rule, 9000, 0) && !gains_allows(&rule, 39.9, 5) &&
              !gains_allows(&rule, 500, 100.1) && !gains_allows(&rule, -1, 5) &&
              !gains_allows(&rule, 500, 1e9),
        "what is outside is inside");
}

/* Nothing is allowed farther than three rows' mean. */
TEST(luck_is_left_out)
{
    static const struct {
        double high[3], most[3]; /* of rows 19 .. 21; at them */
    } row[] = {{{9000, 3000, 9000}, {7000, 3000, 9000}}, {{9000, 6000, 9000}, {8000, 6000, 9000}},
        {{9000, 9000, 9000}, {9000, 9000, 9000}}, {{8000, 9000, 8500}, {8000, 8334, 8500}}};
    for (size_t n = 0; n < sizeof row / sizeof row[0]; n++) {
        struct region g;
        struct exh_gains_par rule;
        memset(&g, 0, sizeof g);
        g.o.wall.T_s = 1.0 / 2000;
        for (int j = 0; j <= REGION_ROWS; j++) {
            const double high = j < 19 ? row[n].high[0] : row[n].high[j > 21 ? 2 : j - 19];
            g.row[j] = (struct region_row){2.5 * j, 40, high};
        }
        CHECK(gains_rule(&rule, &g) == 0, "no rule");
        for (int j = 19; j < REGION_ROWS; j++) {
            const double k = gains_k_max(&rule, 2.5 * j), most = row[n].most[j > 21 ? 2 : j - 19];
            CHECK(k <= most && k > 0.75 * most - 2, "rows %zu, %d: %g, at most %g", n, j, k, most);
        }
    }
}

/* A second hill behind a dip: allowed if five rows or more have it, and a tenth of area comes in.
 */
TEST(a_second_hill_is_broad_or_left_out)
{
    static const struct {
        double dip;
        int rows;
        double most; /* in the middle of the hill */
    } hill[] = {{3000, 4, 3000}, {3000, 15, 9000}, {8500, 15, 8500}};
    for (size_t n = 0; n < sizeof hill / sizeof hill[0]; n++) {
        struct region g;
        struct exh_gains_par rule;
        double k;
        memset(&g, 0, sizeof g);
        g.o.wall.T_s = 1.0 / 2000;
        for (int j = 0; j <= REGION_ROWS; j++) {
            const int behind = j >= 21 + hill[n].rows;
            const double high = behind ? 2000 : j < 19 || j > 20 ? 9000 : hill[n].dip;
            g.row[j] = (struct region_row){2.5 * j, 40, high};
        }
        CHECK(gains_rule(&rule, &g) == 0, "no rule");
        k = gains_k_max(&rule, 2.5 * (21 + hill[n].rows / 2));
        CHECK(k <= hill[n].most && k > 0.75 * hill[n].most, "hill %zu: %g", n, k);
        CHECK(gains_k_max(&rule, 2.5 * 20) <= hill[n].dip, "hill %zu: over the dip", n);
    }
}

/* At 79 and 93 Ns/m a fall onto a weak wall does not rest: two rows end at 1000 N/m, those beside
 * them at 7000. The rule ended there. What begins behind that fall is allowed, from a larger k on.
 */
TEST(a_dip_does_not_end_the_rule)
{
    static struct gains_options a;
    static struct gains_rate x;
    struct sim_device *d = &a.o.device[0];
    gains_defaults(&a);
    a.jobs = 1;
    a.margin_percent = 0;
    CHECK(gains_refuse(&a) == 0, "refused");
    a.o.wall.T_s = 1.0 / 2000;
    d->rotor_kg = 0.182711;
    d->cable_npm = 40307;
    d->cable_nspm = 1.0727;
    d->mu_motor = 0.268723;
    d->mu_mass = 0.19892;
    d->coulomb_n = 0.101525;
    d->viscous_nspm = 4.20624;
    d->kf_npa = 7.72818;
    d->current_hz = 1071.53;
    d->delay_tick = 0.242341;
    d->delay_s = 82.2552e-6;
    d->mon_lag_s = 82.6481e-6;
    d->step_m = 82.3518e-6;
    CHECK(plant_take_step(d, 0, 0) == 0, "no step");
    CHECK(region_fill(&x.region, &a.o) == 0 && gains_proved(&x) == 0, "no rule");
    CHECK(gains_allows(&x.rule, 4000, 130), "of %g N/m at 130 Ns/m", gains_k_max(&x.rule, 130));
}

/* Rows that are twice as long as what holds: what is tried along the rule's line cuts them. */
TEST(what_does_not_hold_is_cut)
{
    static struct gains_options a;
    static struct gains_rate x;
    static double high[REGION_ROWS + 1];
    gains_defaults(&a);
    a.cases = 8;
    a.jobs = 1;
    CHECK(gains_refuse(&a) == 0, "refused");
    a.o.wall.T_s = 1.0 / 1000;
    CHECK(region_fill(&x.region, &a.o) == 0, "no region");
    for (int j = 0; j <= REGION_ROWS; j++) {
        high[j] = x.region.row[j].high_Npm;
        x.region.row[j].high_Npm *= 2;
    }
    CHECK(gains_proved(&x) == 0, "no rule");
    for (int j = 2; j < REGION_ROWS / 2; j++) {
        const double k = gains_k_max(&x.rule, x.region.row[j].b_Nspm);
        CHECK(k < 1.3 * high[j], "row %d: %g, %g holds", j, k, high[j]);
    }
    CHECK(gains_k_max(&x.rule, x.region.row[2].b_Nspm) > 0.4 * high[2], "nothing is left");
}

static double area_of(const struct exh_gains_par *rule)
{
    double sum = 0;
    for (int i = 0; i < 1000; i++) { sum += gains_k_max(rule, i * 0.1); }
    return sum;
}

/* Rules of any shape: whatever the new one allows, the old one allowed with 3 % more of k. */
TEST(a_rule_moves_inwards)
{
    while (check_case(50)) {
        struct exh_gains_par old, now;
        double last;
        memset(&old, 0, sizeof old);
        old.knots = check_i32_in(2, EXH_GAINS_KNOTS);
        old.k_min_Npm_q10 = check_i32_in(0, 500 * 1024);
        for (int i = 0; i < old.knots; i++) {
            const int32_t before = i > 0 ? old.b_Nspm_q20[i - 1] : 0;
            old.b_Nspm_q20[i] = before + check_i32_in(i > 0 ? 1 << 17 : 0, 12 << 20);
            old.k_Npm_q10[i] = check_i32_in(600 * 1024, 20000 * 1024);
        }
        now = old;
        gains_rule_inwards(&now, 0.03);
        for (int i = 0; i < 1000; i++) {
            const double b = i * 0.1, k = gains_k_max(&now, b);
            CHECK(
                k <= 0.97 * gains_k_max(&old, b) + 1, "b %g: %g of %g", b, k, gains_k_max(&old, b));
        }
        last = old.b_Nspm_q20[old.knots - 1] - old.b_Nspm_q20[0];
        CHECK(now.b_Nspm_q20[now.knots - 1] - now.b_Nspm_q20[0] <= 0.97 * last, "last b");
        CHECK(old.knots > 2 || last < 2 << 20 || area_of(&now) > 0.85 * area_of(&old),
            "%g of %g is left", area_of(&now), area_of(&old));
    }
}

/* --- the scene that has a rule --- */

static int stage(uint16_t id, int32_t raw)
{
    return exh_params_stage(exh_scene_guarded.params, id, 0, raw);
}

/* 0: 8000, 20: 8000, 30: 2000 N/m; from 100 up, at 500 Hz. */
static int scene_with(int32_t k_Npm, int32_t b_Nspm, int on, uint32_t rate_Hz)
{
    static const int32_t b[] = {0, 20, 30}, k[] = {8000, 8000, 2000};
    const struct exh_scene_board board = {{1, rate_Hz}, 24};
    int err;
    exh_scene_guarded.defaults();
    err = stage(0x8203, on) | stage(0x1201, 500 * 256) | stage(0x1202, 3) |
          stage(0x1203, 100 * 1024) | stage(0x0401, k_Npm * 1024) | stage(0x0402, b_Nspm * 1048576);
    for (uint16_t i = 0; i < 3; i++) {
        err |= stage((uint16_t)(0x1210 + i), b[i] * 1048576) |
               stage((uint16_t)(0x1220 + i), k[i] * 1024);
    }
    CHECK(err == 0, "a value is refused");
    exh_params_apply(exh_scene_guarded.params);
    return exh_scene_guarded.setup(board);
}

TEST(the_scene_refuses_by_name)
{
    CHECK_EQ_I64(scene_with(8000, 20, 1, 500), 0);
    CHECK_EQ_I64(scene_with(8001, 20, 1, 500), -EXH_E_GAINS);
    CHECK_EQ_I64(scene_with(8001, 20, 0, 500), 0);
    CHECK_EQ_I64(scene_with(2000, 31, 1, 500), -EXH_E_GAINS);
    CHECK_EQ_I64(scene_with(8000, 20, 1, 1000), -EXH_E_RATE);
    CHECK_EQ_I64(scene_with(8000, 20, 0, 1000), 0);
}

/* A PARAM from outside: what is outside the rule is not staged, and the ACK says why. */
TEST(over_the_wire_too)
{
    static const struct {
        uint16_t id;
        int32_t raw;
        int result;
    } ask[] = {{0x0401, 8001 * 1024, -EXH_E_GAINS}, {0x0401, 8000 * 1024, 0},
        {0x0402, 25 * 1048576, -EXH_E_GAINS}, {0x0401, 5000 * 1024, 0}, {0x0402, 25 * 1048576, 0},
        {0x0401, -1, -EXH_E_RANGE}, {0x1220, 9000 * 1024, 0}}; /* not locked here */
    struct exh_wire_tx tx = {7, 0};
    struct exh_wire_rx rx;
    struct exh_wire_packet p, got;
    uint8_t buf[EXH_WIRE_MAX_B];
    int32_t n;
    memset(&rx, 0, sizeof rx);
    memset(&p, 0, sizeof p);
    CHECK_EQ_I64(scene_with(4000, 0, 1, 500), 0);
    p.type = EXH_WIRE_HELLO;
    n = exh_wire_encode(&tx, &p, 0, buf, sizeof buf);
    CHECK(n > 0 && exh_wire_decode(&rx, &got, buf, (size_t)n) == EXH_WIRE_HELLO, "no hello");
    for (size_t i = 0; i < sizeof ask / sizeof ask[0]; i++) {
        const struct exh_wire_param param = {ask[i].id, 0, ask[i].raw};
        const int result = guarded_stage(param.id, param.instance, param.value);
        p.type = EXH_WIRE_ACK;
        p.u.ack = (struct exh_wire_ack){param, (int16_t)result, 1};
        n = exh_wire_encode(&tx, &p, 0, buf, sizeof buf);
        CHECK(
            n > 0 && exh_wire_decode(&rx, &got, buf, (size_t)n) == EXH_WIRE_ACK, "ask %d", (int)i);
        CHECK(got.u.ack.result == ask[i].result, "ask %d: %d", (int)i, got.u.ack.result);
    }
    exh_params_apply(exh_scene_guarded.params);
    CHECK_EQ_I64(exh_scene_guarded.setup((struct exh_scene_board){{1, 500}, 24}), 0);
}

/* --- the command --- */

#define SMALL "--cases", "4", "--jobs", "1"

TEST(a_pair_is_judged)
{
    char *dir = said_dir();
    said(&s, dir, lab_advise,
        WORDS("advise", "gains", "--rate", "500", "--k", "4000", "--b", "15", SMALL));
    CHECK(s.status == 0 && strstr(s.out, ": allowed (") && strstr(s.out, "margin: k "), "%d\n%s%s",
        s.status, s.out, s.err);
    said(&s, dir, lab_advise,
        WORDS("advise", "gains", "--rate", "500", "--k", "14000", "--b", "15", SMALL));
    CHECK(s.status == 1 && strstr(s.out, "NOT allowed") && strstr(s.out, "largest k at this b") &&
              strstr(s.out, "do not come to rest; the first has the wall"),
        "%d\n%s%s", s.status, s.out, s.err);
    said(&s, dir, lab_advise, WORDS("advise", "gains", "--rate", "500", "--rule", SMALL));
    CHECK(s.status == 0 &&
              strncmp(s.out, "--set rule_on=1 --set rule_rate=500 --set rule_n=", 49) == 0,
        "%d\n%s%s", s.status, s.out, s.err);
    said_clean(dir);
}

/* The C that --rule prints. */
static int rule_said(const char *out, struct exh_gains_par *rule)
{
    const char *at = strchr(out, '{');
    int32_t *const to[] = {&rule->rate_Hz_q8, &rule->knots, &rule->k_min_Npm_q10};
    int n = 0;
    for (; at != NULL && *at && n < 3 + 2 * EXH_GAINS_KNOTS; n++) {
        const size_t i = (size_t)n - 3;
        char *end;
        int32_t v;
        at += strcspn(at, "-0123456789");
        v = (int32_t)strtol(at, &end, 10);
        at = end;
        if (n < 3) {
            *to[n] = v;
        } else if (i < EXH_GAINS_KNOTS) {
            rule->b_Nspm_q20[i] = v;
        } else {
            rule->k_Npm_q10[i - EXH_GAINS_KNOTS] = v;
        }
    }
    return n == 3 + 2 * EXH_GAINS_KNOTS;
}

/* The answer to a pair is the rule's that is printed, next to its line on both sides. */
TEST(one_answer_by_every_path)
{
    char *dir = said_dir();
    struct exh_gains_par rule;
    memset(&rule, 0, sizeof rule);
    said(&s, dir, lab_advise, WORDS("advise", "gains", "--rate", "500", "--rule", SMALL));
    CHECK(s.status == 0 && rule_said(s.out, &rule), "%d %s", s.status, s.out);
    for (int i = 0; i < 4; i++) {
        const double b = 4.5 + 6 * (i / 2), k = gains_k_max(&rule, b) + (i % 2 ? 1 : -1);
        char k_text[32], b_text[32];
        snprintf(k_text, sizeof k_text, "%.6f", k);
        snprintf(b_text, sizeof b_text, "%.6f", b);
        said(&s, dir, lab_advise,
            WORDS("advise", "gains", "--rate", "500", "--k", k_text, "--b", b_text, SMALL));
        CHECK(s.status == i % 2 && s.status == !gains_allows(&rule, k, b), "k %s b %s: %d\n%s",
            k_text, b_text, s.status, s.out);
        CHECK(!strstr(s.out, "NOT") == !(i % 2), "k %s b %s: %s", k_text, b_text, s.out);
    }
    said_clean(dir);
}

TEST(a_run_is_refused_by_its_rule)
{
    char *dir = said_dir();
#define RULE \
    "--set", "rule_on=1", "--set", "rule_rate=500", "--set", "rule_b1=30", "--set", \
        "rule_k0=9000", "--set", "rule_k1=2000"
    said(&s, dir, lab_drop,
        WORDS(
            "drop", "--guarded", "--rate", "500", "--falls", "1", "--k", "9001", "--b", "0", RULE));
    CHECK(s.status == 2 && strstr(s.err, "outside the rule of gains"), "%d %s", s.status, s.err);
    said(&s, dir, lab_drop,
        WORDS("drop", "--guarded", "--rate", "500", "--falls", "1", "--k", "5000", "--b", "15",
            RULE));
    CHECK(s.status == 0, "%d %s", s.status, s.err);
    said_clean(dir);
}

TEST(bad_usage_is_named)
{
    static const struct {
        const char *word[4];
        int status;
        const char *says;
    } row[] = {
        {{"--rate", "0"}, 2, "1..20000 Hz"},
        {{"--rate", "500,"}, 2, "with commas"},
        {{"--k", "500"}, 2, "give both"},
        {{"--window", "3"}, 2, "1, 2, 4, 8 or 16"},
        {{"--device", "mas=3"}, 2, "mas: no such value"},
        {{"--device", "cable_k=1e6", "--device", "substep=0.001"}, 2, "substep=0.0001"},
        {{"--grid", "9x9"}, 2, "--grid"},
        {{"--judge", "no/file"}, 3, "no/file"},
        {{"--judge", "/dev/null"}, 2, "no cell in it"},
        {{"--device", "mass=5", "--cases", "4"}, 1, "nothing comes to rest"},
    };
    char *dir = said_dir();
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        const char *word[7] = {"advise", "gains"};
        for (int k = 0; k < 4 && row[i].word[k]; k++) { word[k + 2] = row[i].word[k]; }
        said(&s, dir, lab_advise, word);
        CHECK(s.status == row[i].status && strstr(s.err, row[i].says), "row %d: %d %s", (int)i,
            s.status, s.err);
    }
    said_clean(dir);
}

/* A map of two rays with one unstable node inside: shares by area, which is gain squared, and the
 * node is reported. */
TEST(a_map_is_judged)
{
    char *dir = said_dir(), path[300];
    FILE *f;
    snprintf(path, sizeof path, "%s/map.csv", dir);
    f = fopen(path, "w");
    CHECK(f != NULL, "%s", path);
    fprintf(f, "# exhand drop --sweep falls=10\nrate_hz,ray\n"
               "500,0,1,3000,0,10,10,1\n500,0,2,14000,0,10,10,1\n500,1,1,3000,15,8,10,1\n"
               "500,1,2,14000,15,0,10,1\n500,1,1,4000,12,10,10,1\n");
    fclose(f);
    said(&s, dir, lab_advise, WORDS("advise", "gains", "--judge", path, "--out", dir, SMALL));
    CHECK(s.status == 1 && strstr(s.out, "   500 |  33.3 %   33.3 % |"), "%d\n%s%s", s.status,
        s.out, s.err);
    CHECK(strstr(s.out, "|       3        1 |     30            2\n"), "%s", s.out);
    remove(path);
    said_clean(dir);
}

TEST_MAIN("gains", the_papers_points, cases_fill_all_phases, cases_hold_no_two_phases_together,
    the_rule_is_inside_everywhere, a_rectangle_is_taken, luck_is_left_out,
    a_second_hill_is_broad_or_left_out, a_dip_does_not_end_the_rule, what_does_not_hold_is_cut,
    a_rule_moves_inwards, the_scene_refuses_by_name, over_the_wire_too, a_pair_is_judged,
    one_answer_by_every_path, a_run_is_refused_by_its_rule, bad_usage_is_named, a_map_is_judged);
