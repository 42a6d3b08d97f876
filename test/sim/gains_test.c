/* exhand advise gains: the model of a fall, the lattice, and a rule that lies inside of it. */
#include "cli/gains.h"
#include "said.h"

#include "sim/random.h"

#include <stdlib.h>

static struct said s;

static struct settle_wall wall(double rate_Hz, double k, double b)
{
    return (struct settle_wall){1 / rate_Hz, k, b, 0.107, 2e-4, 40, 200000, 2};
}

static int rests(const struct sim_device *d, double rate_Hz, double k, double b, int cases)
{
    const struct settle_wall w = wall(rate_Hz, k, b);
    int n = 0;
    for (int i = 0; i < cases; i++) { n += settle_run(d, &w, settle_case_at(i)) == SETTLE_REST; }
    return n;
}

/* The device was fitted so that the paper's points come to rest; twice their gains do not, nor do
 * they without friction where the linear test says so. */
TEST(the_papers_points)
{
    static const double row[][3] = {{90, 1500, 0},   {100, 2000, 0},    {200, 2000, 15},
                                    {500, 6000, 20}, {1000, 10000, 40}, {2000, 20000, 60}};
    const struct sim_device d = sim_device_default();
    struct sim_device smooth = d;
    smooth.mu_motor = smooth.mu_mass = smooth.coulomb_n = 0;
    for (int i = 0; i < 6; i++) {
        const double *r = row[i];
        CHECK(rests(&d, r[0], r[1], r[2], 10) == 10, "%g Hz", r[0]);
        CHECK(rests(&d, r[0], 2 * r[1], 2 * r[2], 10) < 10, "%g Hz, twice", r[0]);
        CHECK(rests(&smooth, r[0], r[1], r[2], 10) < 10, "%g Hz, no friction", r[0]);
    }
}

TEST(cases_fill_all_phases)
{
    int hit[4][8] = {{0}};
    for (int i = 0; i < 32; i++) {
        const struct settle_case c = settle_case_at(i);
        const double v[4] = {c.grid, c.tick, c.servo, c.height};
        for (int k = 0; k < 4; k++) {
            CHECK(v[k] >= 0 && v[k] < 1, "case %d: %g", i, v[k]);
            hit[k][(int)(8 * v[k])]++;
        }
    }
    for (int k = 0; k < 4; k++) {
        for (int n = 0; n < 8; n++) { CHECK(hit[k][n] >= 1, "%d, eighth %d: %d", k, n, hit[k][n]); }
    }
}

/* --- the rule --- */

enum { COLUMNS = 24, ROWS = 16 };
static signed char node[(COLUMNS + 1) * (ROWS + 1)];

/* A lattice whose nodes are all known: nothing is simulated. */
static struct region drawn(struct sim_random *r)
{
    struct region g;
    const int kind = (int)(4 * sim_random_unit(r));
    double top = COLUMNS * sim_random_unit(r);
    memset(&g, 0, sizeof g);
    g.o.columns = COLUMNS;
    g.o.rows = ROWS;
    g.o.wall.T_s = 1.0 / 2000;
    g.k_top_Npm = 100 + 5e5 * sim_random_unit(r);
    g.b_top_Nspm = 1 + 900 * sim_random_unit(r);
    g.node = node;
    for (int j = 0; j <= ROWS; j++) {
        top += (kind == 0 ? 1 : 8) * (sim_random_unit(r) - 0.5);
        for (int i = 0; i <= COLUMNS; i++) {
            const int hole = kind >= 2 && sim_random_unit(r) < (kind == 2 ? 0.02 : 0.15);
            node[j * (COLUMNS + 1) + i] = (signed char)(i <= top && !hole);
        }
    }
    return g;
}

TEST(the_rule_is_inside_everywhere)
{
    struct sim_random r = {7};
    int rules = 0;
    long asked = 0;
    for (int n = 0; n < 150; n++) {
        struct region g = drawn(&r);
        struct exh_gains_par rule;
        int pieces = 0;
        for (int i = 0; i < COLUMNS * ROWS; i++) {
            pieces += region_piece(&g, i % COLUMNS, i / COLUMNS);
        }
        if (pieces == 0 || gains_rule(&rule, &g)) { continue; }
        rules++;
        CHECK(exh_gains_setup(&rule, (struct exh_period){1, 2000}) == 0, "lattice %d", n);
        for (int j = 0; j <= 200; j++) {
            for (int i = 0; i <= 200; i++) {
                const double k = g.k_top_Npm * (i + sim_random_unit(&r)) / 200;
                const double b = g.b_top_Nspm * (j + sim_random_unit(&r)) / 200;
                const int32_t k_q10 = (int32_t)(k * 1024), b_q20 = (int32_t)(b * 1048576);
                if (!exh_gains_ok(&rule, k_q10, b_q20)) { continue; }
                asked++;
                CHECK(region_allows(&g, k_q10 / 1024.0, b_q20 / 1048576.0), "lattice %d: k %g b %g",
                      n, k, b);
            }
        }
        /* The knots themselves, where the line is nearest. */
        for (int i = 0; i < rule.knots; i++) {
            CHECK(exh_gains_ok(&rule, rule.k_Npm_q10[i], rule.b_Nspm_q20[i]) ==
                      (rule.k_Npm_q10[i] >= rule.k_min_Npm_q10),
                  "lattice %d: knot %d", n, i);
        }
    }
    CHECK(rules > 40 && asked > 100000, "only %d rules, %ld pairs", rules, asked);
}

/* All of a rectangle is taken, but for a piece's rounding. */
TEST(a_full_lattice_is_taken)
{
    struct region g;
    struct exh_gains_par rule;
    struct sim_random r = {1};
    g = drawn(&r);
    memset(node, 1, sizeof node);
    CHECK(gains_rule(&rule, &g) == 0, "no rule");
    CHECK(rule.knots == 2 && rule.b_Nspm_q20[0] == 0, "%d knots", (int)rule.knots);
    CHECK(exh_gains_ok(&rule, (int32_t)(1024 * (g.k_top_Npm - 2)),
                       (int32_t)(1048576 * (g.b_top_Nspm - 0.001))),
          "the corner is missing");
    CHECK(!exh_gains_ok(&rule, (int32_t)(1024 * g.k_top_Npm), 0), "the border is inside");
}

/* --- the command --- */

#define SMALL "--grid", "12x6", "--cases", "4", "--jobs", "1"

TEST(a_pair_is_judged)
{
    char *dir = said_dir();
    said(&s, dir, cli_advise,
         WORDS("advise", "gains", "--rate", "500", "--k", "4000", "--b", "15", SMALL));
    CHECK(s.status == 0 && strstr(s.out, ": allowed (") && strstr(s.out, "margin: k "), "%d\n%s%s",
          s.status, s.out, s.err);
    said(&s, dir, cli_advise,
         WORDS("advise", "gains", "--rate", "500", "--k", "14000", "--b", "15", SMALL));
    CHECK(s.status == 1 && strstr(s.out, "NOT allowed") && strstr(s.out, "largest k at this b"),
          "%d\n%s%s", s.status, s.out, s.err);
    said(&s, dir, cli_advise,
         WORDS("advise", "gains", "--rate", "500", "--k", "1000000", "--b", "15", SMALL));
    CHECK(s.status == 1 && strstr(s.out, "beyond all"), "%d\n%s%s", s.status, s.out, s.err);
    said(&s, dir, cli_advise, WORDS("advise", "gains", "--rate", "500", "--rule", SMALL));
    CHECK(s.status == 0 && strncmp(s.out, "--set rule_rate=500 --set rule_n=", 33) == 0, "%d\n%s%s",
          s.status, s.out, s.err);
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
        {{"--grid", "9"}, 2, "--grid"},
        {{"--judge", "no/file"}, 1, "no/file"},
        {{"--judge", "/dev/null"}, 1, "no cell in it"},
        {{"--rate", "20000", "--device", "delay=0.0099"}, 0, ""},
    };
    char *dir = said_dir();
    for (size_t i = 0; i + 1 < sizeof row / sizeof row[0]; i++) {
        const char *word[7] = {"advise", "gains"};
        for (int k = 0; k < 4 && row[i].word[k]; k++) { word[k + 2] = row[i].word[k]; }
        said(&s, dir, cli_advise, word);
        CHECK(s.status == row[i].status && strstr(s.err, row[i].says), "row %d: %d %s", (int)i,
              s.status, s.err);
    }
    said_clean(dir);
}

/* A map of 2 x 2 cells with one unstable cell inside, and cells of no grid: counted, and told. */
TEST(a_map_is_judged)
{
    char *dir = said_dir(), path[300];
    FILE *f;
    snprintf(path, sizeof path, "%s/map.csv", dir);
    f = fopen(path, "w");
    CHECK(f != NULL, "%s", path);
    fprintf(f,
            "# exhand drop --sweep falls=10 columns=2 rows=2 more=1\nrate_hz,k\n"
            "500,3000,0,10,10,,1\n500,14000,0,10,10,,1\n500,3000,15,8,10,,1\n500,14000,15,0,10,,1\n"
            "500,4000,12,10,10,,1\n");
    fclose(f);
    said(&s, dir, cli_advise, WORDS("advise", "gains", "--judge", path, "--out", dir, SMALL));
    CHECK(s.status == 1 && strstr(s.out, "   500 |      2      2 |  50.0 %   50.0 % |  50.0 % |"),
          "%d\n%s%s", s.status, s.out, s.err);
    CHECK(strstr(s.out, "|       3        1 |     30            2\n"), "%s", s.out);
    remove(path);
    said_clean(dir);
}

TEST_MAIN("gains", the_papers_points, cases_fill_all_phases, the_rule_is_inside_everywhere,
          a_full_lattice_is_taken, a_pair_is_judged, bad_usage_is_named, a_map_is_judged);
