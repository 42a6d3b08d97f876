/* SPDX-License-Identifier: MIT */
/* exhand-lab drop --sweep: whatever way its cells came about, the file is the same. */
#include "said.h"
#include "lab/lab.h"

#include "lab/drop/ray.h"
#include "sim/plant.h"
#include "sim/random.h"

#include <signal.h>
#include <time.h>

/* A sweep of the smallest size: two rates, one fall a cell, watched for 1 s. */
#define SMALL(dir) \
    "drop", "--sweep", "--rate", "90,500", "--falls", "1", "--grid", "3x2", "--jobs", "2", \
        "--device", "observe=0.9", "--out", dir

static char whole[SAID_B], again[SAID_B];

static void copy(const char *from, const char *to, long bytes)
{
    static char text[SAID_B];
    FILE *f;
    said_read(text, from);
    f = fopen(to, "a");
    CHECK(f != NULL && fwrite(text, 1, (size_t)bytes, f) == (size_t)bytes && fclose(f) == 0, "%s",
        to);
}

/* All that a sweep leaves, and its words on standard output. */
static const char *const left[] = {
    "stability.csv", "stiffness.csv", "border.csv", "rho.csv", "sweep.gp", "said.out"};
static uint64_t left_then[LEN(left)];

static uint64_t hash_of(const char *path)
{
    uint64_t hash = 14695981039346656037u; /* FNV-1a */
    FILE *f = fopen(path, "r");
    CHECK(f != NULL, "%s: not there", path);
    for (int c; (c = getc(f)) != EOF;) { hash = (hash ^ (uint64_t)c) * 1099511628211u; }
    fclose(f);
    return hash;
}

/* Every file in DIR is as one go leaves it, byte by byte. */
static void as_by_one_go(const char *dir, const char *how, long at)
{
    for (size_t i = 0; i < LEN(left); i++) {
        CHECK(hash_of(said_path(dir, left[i])) == left_then[i], "%s %ld: another %s", how, at,
            left[i]);
    }
}

/* The sweep at one go, into `whole`. */
static void one_go(const char *dir, struct said *s)
{
    said(s, dir, lab_drop, WORDS(SMALL(dir)));
    CHECK(s->status == 0 && s->err[0] == '\0', "%d: %s", s->status, s->err);
    said_read(whole, said_path(dir, "stability.csv"));
    CHECK(strlen(whole) > 1500 && strlen(whole) < SAID_B - 1, "%zu bytes", strlen(whole));
    for (size_t i = 0; i < LEN(left); i++) { left_then[i] = hash_of(said_path(dir, left[i])); }
}

/* What it left in DIR/stability.csv, for tests that begin there; run once. */
static void after_one_go(const char *dir, struct said *s)
{
    FILE *f;
    if (whole[0] == '\0') { one_go(dir, s); }
    f = fopen(said_path(dir, "stability.csv"), "w");
    CHECK(f != NULL && fputs(whole, f) >= 0 && fclose(f) == 0, "%s", dir);
}

static int lines(const char *text)
{
    int n = 0;
    for (; *text; text++) { n += *text == '\n'; }
    return n;
}

static double gap(double a, double b) { return a < b ? b - a : a - b; }

TEST(a_sweep_finds_a_border_and_says_so)
{
    const char *dir = said_dir();
    static struct said s;
    one_go(dir, &s);
    CHECK(strncmp(whole, "# exhand drop --sweep version=2 falls=1 seed=1 rays=3 per_octave=2 ",
              66) == 0,
        "%s", whole);
    CHECK(
        strstr(whole, "\nrate_hz,ray,gain,k_n_per_m,b_ns_per_m,resting_falls,falls,rho\n90,0,0.1,"),
        "%s", whole);
    CHECK(strstr(s.out, "largest stable k") && strstr(s.out, "\n    90 |") &&
              strstr(s.out, "\n   500 |"),
        "%s", s.out);
    said_read(again, said_path(dir, "border.csv"));
    CHECK(strstr(again, "\n90,1,") && strstr(again, "\n90,2,") && strstr(again, "\n500,1,"), "%s",
        again);
    CHECK(said_size(said_path(dir, "rho.csv")) > 100000 &&
              said_size(said_path(dir, "sweep.gp")) > 100,
        "pictures");
    said_clean(dir);
}

/* The columns of the linear test in the table, of the row that begins with `rate`. */
static void linear_columns(const char *out, const char *rate, char to[40])
{
    const char *at = strstr(out, rate);
    for (int i = 0; i < 3 && at != NULL; i++) { at = strchr(at + (i > 0), '|') + (i == 2); }
    CHECK(at != NULL && strcspn(at, "|") < 40, "%s", out);
    snprintf(to, 40, "%.*s", (int)strcspn(at, "|"), at);
}

TEST(the_linear_border_does_not_hang_on_the_grid)
{
    static const char *const grid[] = {"2x2", "5x3"};
    char text[2][2][40];
    double k, b;
    for (int i = 0; i < 2; i++) {
        static struct said s;
        const char *dir = said_dir();
        said(&s, dir, lab_drop,
            WORDS("drop", "--sweep", "--rate", "90,2000", "--falls", "1", "--grid", grid[i],
                "--device", "observe=0.6", "--device", "substep=0.0001", "--out", dir));
        CHECK(s.status == 0, "%d: %s", s.status, s.err);
        linear_columns(s.out, "\n    90 |", text[i][0]);
        linear_columns(s.out, "\n  2000 |", text[i][1]);
        said_clean(dir);
    }
    CHECK(strcmp(text[0][0], text[1][0]) == 0, "%s, %s", text[0][0], text[1][0]);
    CHECK(strcmp(text[0][1], text[1][1]) == 0, "%s, %s", text[0][1], text[1][1]);
    /* By an exhaustive scan, k in 1 % and b in 0.5 steps: 2243 and 58, 22118 and 63.5. */
    CHECK(sscanf(text[0][0], "%lf %lf", &k, &b) == 2 && k > 2230 && k < 2290 && b > 57.9 && b < 59,
        "%s", text[0][0]);
    CHECK(sscanf(text[0][1], "%lf %lf", &k, &b) == 2 && k > 22000 && k < 22600 && b > 63 && b < 65,
        "%s", text[0][1]);
}

TEST(a_slow_rate_has_a_border)
{
    static struct said s;
    const char *dir = said_dir();
    double k = 0;
    said(&s, dir, lab_drop,
        WORDS("drop", "--sweep", "--rate", "5", "--falls", "1", "--grid", "3x3", "--device",
            "observe=2", "--out", dir));
    for (const char *at = strstr(s.out, "\n     5 |"); at != NULL; at = NULL) { k = atof(at + 9); }
    CHECK(s.status == 0 && k > 5 && k < 60, "%d: %s%s", s.status, s.err, s.out);
    said_clean(dir);
}

/* ---- The border ------------------------------------------------------------------- */

/* Falls whose tolerance is logistic in octaves, about 3 with width 0.15, and one in a hundred odd;
 * nodes an octave, falls a node. */
static struct logistic draw(struct sim_random *r, int per_octave, int falls)
{
    struct logistic_node node[64];
    int n = 0;
    for (; n <= 5 * per_octave; n++) {
        const double x = (double)n / per_octave, z = (x - 3) / 0.15;
        const double p = z > 0 ? 1 - 1 / (1 + sim_exp_neg(z)) : 1 / (1 + sim_exp_neg(-z));
        node[n] = (struct logistic_node){x, 0, falls};
        for (int i = 0; i < falls; i++) {
            const int odd = sim_random_unit(r) < 0.01;
            node[n].rest += (sim_random_unit(r) < p) != odd;
        }
    }
    return logistic_fit(node, n);
}

/* Fine and coarse have the same border, and their intervals hold it as often as they say. */
TEST(the_intervals_of_a_border_cover_it)
{
    static const struct {
        int per_octave, falls;
    } how[] = {{6, 10}, {3, 3}};
    double width[2] = {0, 0};
    for (int h = 0; h < 2; h++) {
        struct sim_random r = {11};
        int covers = 0;
        double mean = 0;
        for (int i = 0; i < 400; i++) {
            const struct logistic x = draw(&r, how[h].per_octave, how[h].falls);
            CHECK(x.status == LOGISTIC_OK && x.low < x.at && x.at < x.high, "%d", (int)x.status);
            covers += x.low <= 3 && x.high >= 3;
            mean += x.at / 400;
            width[h] += (x.high - x.low) / 400;
        }
        CHECK(covers >= 360 && covers < 400, "%d an octave: %d of 400 cover", how[h].per_octave,
            covers);
        CHECK(gap(mean, 3) < 0.03, "%d an octave: mean %g", how[h].per_octave, mean);
        check_note(
            "%d nodes an octave, %d falls: %.1f %% of the intervals cover, %.2f octaves wide",
            how[h].per_octave, how[h].falls, covers / 4.0, width[h]);
    }
    CHECK(width[1] > 1.5 * width[0], "%g and %g", width[0], width[1]);
}

TEST(what_is_no_border_is_none)
{
    struct logistic_node weak[] = {{0, 0, 4}, {1, 1, 4}, {2, 4, 4}, {3, 4, 4}, {4, 0, 4}};
    struct logistic x = logistic_fit(weak, 5);
    CHECK(x.status == LOGISTIC_OK && x.at > 3 && x.at < 4, "a wall too weak: %d %g", (int)x.status,
        x.at);
    x = logistic_fit(weak, 4);
    CHECK(x.status == LOGISTIC_OPEN && x.at == 3, "open: %d %g", (int)x.status, x.at);
    x = logistic_fit(weak, 2);
    CHECK(x.status == LOGISTIC_NONE, "none: %d", (int)x.status);
    CHECK(logistic_fit(weak, 0).status == LOGISTIC_NONE, "of nothing");
}

/* Of one ray at 200 Hz, b alone 0: as `border.csv` has it, "low..high". */
static void interval_of(const char *text, const char *key, double *low, double *high)
{
    const char *at = strstr(text, key);
    CHECK(at && sscanf(at + strlen(key), "%*f,%*f,%lf,%*f,%lf", low, high) == 2, "%s", text);
}

TEST(a_coarse_map_agrees_with_a_fine_one)
{
    static const char *const grid[] = {"2x3", "4x6"}, *const falls[] = {"3", "8"},
                             *const seed[] = {"1", "2"},
                             *const ray[2][2] = {
                                 {"\n200,0,", "\n200,1,"}, {"\n200,0,", "\n200,2,"}};
    double low[2][2], high[2][2];
    static struct said s;
    for (int i = 0; i < 2; i++) {
        const char *dir = said_dir();
        said(&s, dir, lab_drop,
            WORDS("drop", "--sweep", "--rate", "200", "--falls", falls[i], "--grid", grid[i],
                "--seed", seed[i], "--out", dir));
        CHECK(s.status == 0, "%s", s.err);
        said_read(again, said_path(dir, "border.csv"));
        for (int j = 0; j < 2; j++) { interval_of(again, ray[i][j], &low[i][j], &high[i][j]); }
        said_clean(dir);
    }
    for (int j = 0; j < 2; j++) {
        CHECK(low[0][j] < high[1][j] && low[1][j] < high[0][j], "ray %d: %g..%g, %g..%g", j,
            low[0][j], high[0][j], low[1][j], high[1][j]);
        CHECK(high[0][j] < 2 * low[0][j], "ray %d: %g..%g says nothing", j, low[0][j], high[0][j]);
    }
}

/* Cut off anywhere: in the settings, in the header, in a cell, after one, before the last. */
TEST(a_resumed_sweep_gives_the_same_file)
{
    char dir[64], rest[64];
    static struct said s;
    strcpy(dir, said_dir());
    after_one_go(dir, &s);
    for (size_t i = 0; i < 8; i++) {
        const long size = (long)strlen(whole);
        const long cut[] = {0, 30, (long)(strchr(whole, '\n') - whole) + 5, size / 3, size / 2,
            size - 1, size, (long)(strstr(whole, "\n500,") - whole) + 1};
        strcpy(rest, said_dir());
        copy(said_path(dir, "stability.csv"), said_path(rest, "stability.csv"), cut[i]);
        said(&s, rest, lab_drop, WORDS(SMALL(rest)));
        CHECK(s.status == 0, "cut at %ld: %d: %s", cut[i], s.status, s.err);
        as_by_one_go(rest, "cut at", cut[i]);
        CHECK(cut[i] < size / 3 || strstr(s.err, "goes on from"), "cut at %ld: %s", cut[i], s.err);
        said_clean(rest);
    }
    said_clean(dir);
}

TEST(an_interrupted_sweep_keeps_its_cells)
{
    const struct timespec moment = {0, 2000000};
    char dir[64];
    static struct said s;
    const char *path;
    pid_t pid;
    int known = 0;
    strcpy(dir, said_dir());
    after_one_go(dir, &s);
    path = said_path(dir, "stability.csv");
    for (int i = 0; i < 100; i++) { /* a busy machine may look too late: again */
        remove(path);
        again[0] = '\0';
        pid = said_start(dir, lab_drop, WORDS(SMALL(dir)));
        for (int ms = 0; ms < 20000 && lines(again) < lines(whole) / 2; ms += 2) {
            nanosleep(&moment, NULL);
            said_read(again, path);
        }
        CHECK(kill(pid, SIGINT) == 0, "gone");
        said_end(&s, dir, pid);
        said_read(again, path);
        known = lines(again) - 2;
        if (s.status != 0 && known > 10 && known < lines(whole) - 2) { break; }
    }
    CHECK(s.status == 130 && strstr(s.err, "the same command goes on"), "%d: %s", s.status, s.err);
    CHECK(known > 10 && known < lines(whole) - 2, "%d cells", known);
    said(&s, dir, lab_drop, WORDS(SMALL(dir)));
    CHECK(s.status == 0 && strstr(s.err, "goes on from"), "%d: %s", s.status, s.err);
    as_by_one_go(dir, "interrupted with cells:", known);
    said_clean(dir);
}

/* By the kernel, or a power failure: with cells in progress, and without a message. */
TEST(a_killed_sweep_goes_on)
{
    const struct timespec moment = {0, 2000000};
    char dir[64];
    static struct said s;
    const char *path;
    strcpy(dir, said_dir());
    after_one_go(dir, &s);
    path = said_path(dir, "stability.csv");
    for (int part = 4; part > 1; part--) { /* three times, each further on */
        pid_t pid;
        if (part == 4) { remove(path); }
        pid = said_start(dir, lab_drop, WORDS(SMALL(dir)));
        for (int ms = 0; ms < 20000 && said_size(path) < (long)strlen(whole) / part; ms += 2) {
            nanosleep(&moment, NULL);
        }
        kill(-pid, SIGKILL);
        said_end(&s, dir, pid);
    }
    said(&s, dir, lab_drop, WORDS(SMALL(dir)));
    CHECK(s.status == 0 && strstr(s.err, "goes on from"), "%d: %s", s.status, s.err);
    as_by_one_go(dir, "killed at part", 2);
    said_clean(dir);
}

TEST(shards_make_the_whole)
{
    static const char *const part[] = {"1/3", "2/3", "3/3"};
    static const char *const file[] = {
        "stability.1-of-3.csv", "stability.2-of-3.csv", "stability.3-of-3.csv"};
    char dir[64], shards[64], strung[64];
    static struct said s;
    strcpy(dir, said_dir());
    strcpy(shards, said_dir());
    strcpy(strung, said_dir());
    after_one_go(dir, &s);
    for (int i = 0; i < 3; i++) {
        said(&s, shards, lab_drop, WORDS(SMALL(shards), "--shard", part[i]));
        CHECK(s.status == 0, "%d: %s", s.status, s.err);
        said_read(again, said_path(shards, file[i]));
        CHECK(lines(again) < lines(whole), "part %d has %d lines of %d", i, lines(again),
            lines(whole));
        copy(said_path(shards, file[i]), said_path(strung, "stability.csv"),
            said_size(said_path(shards, file[i])));
    }
    for (int i = 0; i < 2; i++) { /* beside each other, and strung together */
        const char *to = i ? strung : shards, *goes_on;
        int known = 0;
        said(&s, to, lab_drop, WORDS(SMALL(to)));
        CHECK(s.status == 0, "%d: %s", s.status, s.err);
        as_by_one_go(to, "shards", i);
        goes_on = strstr(s.err, "goes on from");
        CHECK(goes_on && sscanf(goes_on, "goes on from %d", &known) == 1, "%s", s.err);
        CHECK_EQ_I64(known, lines(whole) - 2); /* nothing is left to run */
    }
    said_clean(dir);
    said_clean(shards);
    said_clean(strung);
}

/* ---- What is refused -------------------------------------------------------------- */

TEST(a_file_of_other_settings_is_refused_by_name)
{
    static const struct {
        const char *word[2], *says;
    } row[] = {
        {{"--seed", "2"}, "made with seed=1, not with seed=2"},
        {{"--falls", "2"}, "made with falls=1, not with falls=2"},
        {{"--grid", "3x4"}, "made with per_octave=2, not with per_octave=4"},
        {{"--device", "mu_motor=0"}, "made with mu_motor=0.1835, not with mu_motor=0:"},
        {{"--seed", "12"}, "made with seed=1, not with seed=12:"},
        {{"--set", "f0=0"}, "made with nothing further, not with f0=0: "},
        {{"--device", "substep=0.000026"}, "made with substep=0.00025, not with substep=2.6e-05:"},
        {{"--set", "f0=0"}, "not with f0=0: choose another --out"},
    };
    const char *dir = said_dir();
    static struct said s;
    after_one_go(dir, &s);
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, lab_drop, WORDS(SMALL(dir), row[i].word[0], row[i].word[1]));
        CHECK(s.status == 2 && strstr(s.err, row[i].says), "row %zu: %d: %s", i, s.status, s.err);
        said_read(again, said_path(dir, "stability.csv"));
        CHECK(strcmp(whole, again) == 0, "row %zu: touched", i);
    }
    said_clean(dir);
}

TEST(a_damaged_file_is_refused_by_line)
{
    static const struct {
        const char *text, *says;
    } row[] = {
        {"rate,k\n1,2\n", "stability.csv: not a file of a sweep"},
        {"90,0,1,1000,abc,1,1,0.9\n", "stability.csv:3: 90,0,1,1000,abc"},
        {"90,0,1,1000,0,2,1,0.9\n", "stability.csv:3: 90,0,1,1000,0,2,1"}, /* two of one fall */
        {"90,0,1,1000,0,1,0.9\n", "stability.csv:3: "},                    /* a field is missing */
        {"90,0,1,1000,0,1,1,0.9,\n", "stability.csv:3: "},
        {"90,0,1,nan,0,1,1,0.9\n", "stability.csv:3: "},
        {"90,0,inf,1000,0,1,1,0.9\n", "stability.csv:3: "},
        {"90,-1,1,1000,0,1,1,0.9\n", "stability.csv:3: "},
        {"90,0,1,1000001,0,1,1,0.9\n", "stability.csv:3: "},
        {"90,0,1,1000,1001,1,1,0.9\n", "stability.csv:3: "},
        {"90,0,1,1000,0,1,1,nan\n", "stability.csv:3: "},
        {"\n", "stability.csv:3: "},
    };
    static struct said s;
    const char *dir = said_dir();
    after_one_go(dir, &s);
    for (size_t i = 0; i < LEN(row); i++) {
        FILE *f = fopen(said_path(dir, "stability.csv"), "w");
        const char *cells = strchr(strchr(whole, '\n') + 1, '\n') + 1;
        CHECK(f != NULL, "row %zu", i);
        if (i > 0) { fwrite(whole, 1, (size_t)(cells - whole), f); }
        fputs(row[i].text, f);
        fclose(f);
        said(&s, dir, lab_drop, WORDS(SMALL(dir)));
        CHECK(s.status == 2 && strstr(s.err, row[i].says), "row %zu: %d: %s", i, s.status, s.err);
    }
    said_clean(dir);
}

TEST(bad_usage_is_refused_by_name)
{
    static const struct {
        const char *word[4], *says;
    } row[] = {
        {{"--grid", "20"}, "--grid: 20 (two numbers"},
        {{"--grid", "1x5"}, "--grid: 1x5"},
        {{"--grid", "5x201"}, "--grid: 5x201"},
        {{"--grid", "5x5x"}, "--grid: 5x5x"},
        {{"--grid", "5x25"}, "--grid: 5x25: at most 24 nodes"},
        {{"--shard", "0/2"}, "--shard: 0/2 (I/N"},
        {{"--shard", "3/2"}, "--shard: 3/2"},
        {{"--shard", "1"}, "--shard: 1 "},
        {{"--k", "500"}, "--sweep: chooses k and b"},
        {{"--gates"}, "--sweep: chooses k and b"},
        {{"--pace"}, "--sweep: chooses k and b"},
        {{"--out", "/dev/null"}, "--out: /dev/null: "},
        {{"--out", "/nowhere/at/all"}, "--out: /nowhere"},
    };
    const char *dir = said_dir();
    static struct said s;
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, lab_drop, WORDS(SMALL(dir), row[i].word[0], row[i].word[1]));
        CHECK(s.status == 2 && strstr(s.err, row[i].says), "row %zu: %d: %s", i, s.status, s.err);
    }
    said(&s, dir, lab_drop, WORDS("drop", "--sweep"));
    CHECK(s.status == 2 && strstr(s.err, "--sweep: needs --out DIR"), "%d: %s", s.status, s.err);
    said(&s, dir, lab_drop, WORDS("drop", "--grid", "5x5"));
    CHECK(s.status == 2 && strstr(s.err, "--grid and --shard: only with --sweep"), "%d: %s",
        s.status, s.err);
    said(&s, dir, lab_drop, WORDS("drop", "--border-check", "--falls", "5"));
    CHECK(
        s.status == 2 && strstr(s.err, "--falls and --border-check: "), "%d: %s", s.status, s.err);
    said_clean(dir);
}

/* ---- Border check and friction ------------------------------------------------------- */

/* Cells of check.csv's parts that came to rest; -1: there are none. */
static int at_rest(const char *csv, const char *start, const char *part, const char *rate)
{
    char head[64];
    int cells = 0, rest = 0;
    snprintf(head, sizeof head, "\nparts,%s,%s,%s,", start, part, rate);
    for (const char *at = csv; (at = strstr(at, head)) != NULL; at++) {
        cells++;
        rest += at[1 + strcspn(at + 1, "\n")] == '\n' && at[strcspn(at + 1, "\n")] == '1';
    }
    return cells > 0 ? rest : -1;
}

TEST(the_simulated_border_is_the_linear_one)
{
    char dir[64];
    static struct said s;
    int cells = 0, agree = 0;
    strcpy(dir, said_dir());
    said(&s, dir, lab_drop,
        WORDS("drop", "--border-check", "--rate", "500,2000", "--grid", "6x4", "--out", dir));
    CHECK(s.status == 0 && s.err[0] == '\0', "%d: %s", s.status, s.err);
    for (const char *at = strstr(s.out, "   all |"); at != NULL; at = NULL) {
        CHECK(sscanf(at, "   all | | %d of %d", &agree, &cells) == 2, "%s", at);
    }
    CHECK(cells > 30 && agree == cells, "%d of %d agree", agree, cells);
    CHECK(strstr(s.out, "\ndry friction ") && strstr(s.out, "\nall: the device "), "%s", s.out);
    check_note(
        "500 and 2000 Hz: simulated and linear border agree in %d of %d cells", agree, cells);
    said_read(again, said_path(dir, "check.csv"));
    for (int i = 0; i < 4; i++) { /* friction carries the border outwards, however it began */
        static const char *const rate[] = {"500", "2000"};
        const char *start = i < 2 ? "let_go" : "dropped";
        const int none = at_rest(again, start, "none", rate[i % 2]);
        const int friction = at_rest(again, start, "friction", rate[i % 2]);
        CHECK(none >= 0 && friction > none, "%s, %s Hz: %d with, %d without", start, rate[i % 2],
            friction, none);
    }
    said_clean(dir);
}

TEST(a_border_that_cannot_be_checked_is_refused)
{
    static const struct {
        const char *word[4], *says;
    } row[] = {
        {{"--rate", "1"}, "--border-check: 1 Hz: watches 2500 ticks"},
        {{"--rate", "20000", "--device", "delay=0.01"},
            "--border-check: 20000 Hz: no linear border"},
        {{"--rate", "25", "--grid", "200x4"}, "--border-check: 25 Hz: at k = 1."},
    };
    static struct said s;
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, lab_drop,
            WORDS("drop", "--border-check", row[i].word[0], row[i].word[1], row[i].word[2],
                row[i].word[3]));
        CHECK(s.status == 2 && strstr(s.err, row[i].says), "row %zu: %d: %s", i, s.status, s.err);
        CHECK(lines(s.err) == 1, "row %zu: %s", i, s.err);
    }
    said_clean(dir);
}

TEST(friction_moves_the_border_outwards)
{
    char dir[64];
    static struct said s;
    double most[3][3];
    const char *at;
    strcpy(dir, said_dir());
    said(&s, dir, lab_drop,
        WORDS("drop", "--friction", "3", "--falls", "1", "--rate", "200", "--out", dir));
    CHECK(s.status == 0 && s.err[0] == '\0', "%d: %s", s.status, s.err);
    said_read(again, said_path(dir, "friction.csv"));
    at = again;
    for (int i = 0; i < 9; i++) {
        at = strchr(at, '\n') + 1;
        most[i / 3][i % 3] = 0; /* an empty field: at no gain */
        CHECK(strncmp(at + strcspn(at, ","), ",200,", 5) == 0, "%s", at);
        (void)sscanf(at, "%*[^,],200,%*[^,],%lf,", &most[i / 3][i % 3]);
    }
    for (int i = 0; i < 3; i++) {
        CHECK(most[i][0] < most[i][1] && most[i][1] < most[i][2], "%d: %g %g %g", i, most[i][0],
            most[i][1], most[i][2]);
    }
    said(&s, dir, lab_drop, WORDS("drop", "--friction", "3"));
    CHECK(s.status == 2 && strstr(s.err, "--friction: needs --out DIR"), "%d: %s", s.status, s.err);
    said(&s, dir, lab_drop, WORDS("drop", "--friction", "3", "--sweep", "--out", dir));
    CHECK(s.status == 2 && strstr(s.err, "one at a time"), "%d: %s", s.status, s.err);
    said_clean(dir);
}

/* Falls that rest below a gain, handed in by address. */
static int rests_below(void *ctx, const struct ray *r, double gain, int *rest, int *falls)
{
    CHECK(gain * r->k_Npm <= 1e6 && gain * r->b_Nspm <= 1e3, "%g is beyond the scene", gain);
    *falls = 4;
    *rest = gain < *(const double *)ctx ? 4 : 0;
    return gain == 0 ? -1 : 0;
}

TEST(a_ray_ends_where_the_scene_does)
{
    const struct ray r = {2000, 20000, 60, 0.1, 3}, weak = {2000, 1, 0.01, 0.1, 24};
    double never = 0, always = 1e9, once = 2;
    struct ray_border x = ray_border(&r, rests_below, &always);
    /* b ends it: 1000 / 60 is 16.7 times. */
    CHECK(x.status == LOGISTIC_OPEN && x.gain > 13 && x.gain <= 16.667, "%d at %g", (int)x.status,
        x.gain);
    x = ray_border(&r, rests_below, &never);
    CHECK(x.status == LOGISTIC_NONE && x.nodes == 19, "%d nodes", x.nodes);
    x = ray_border(&r, rests_below, &once);
    CHECK(x.status == LOGISTIC_OK && x.low < 2 && x.high > 1.6 && x.gain > 1.5 && x.gain < 2.1,
        "%g in %g..%g", x.gain, x.low, x.high);
    CHECK(ray_gain(&r, x.nodes - 1) < 4.1, "an octave of unrest is enough: %g",
        ray_gain(&r, x.nodes - 1));
    x = ray_border(&weak, rests_below, &always);
    CHECK(x.status == LOGISTIC_OPEN && x.gain > 900, "%g", x.gain);
}

TEST_MAIN("sweep", a_sweep_finds_a_border_and_says_so, the_linear_border_does_not_hang_on_the_grid,
    a_slow_rate_has_a_border, the_intervals_of_a_border_cover_it, what_is_no_border_is_none,
    a_coarse_map_agrees_with_a_fine_one, a_resumed_sweep_gives_the_same_file,
    an_interrupted_sweep_keeps_its_cells, a_killed_sweep_goes_on, shards_make_the_whole,
    a_file_of_other_settings_is_refused_by_name, a_damaged_file_is_refused_by_line,
    bad_usage_is_refused_by_name, the_simulated_border_is_the_linear_one,
    a_border_that_cannot_be_checked_is_refused, friction_moves_the_border_outwards,
    a_ray_ends_where_the_scene_does);
