/* SPDX-License-Identifier: MIT */
/* exhand run --log-size: many files, each a whole log; together they hold what one would. */
#include "said.h"

#include "live/log_turn.h"

static struct said s;
static char *dir;

static const char *path(const char *name)
{
    static char at[4][512];
    static unsigned n;
    char *to = at[n++ % 4];
    snprintf(to, sizeof at[0], "%s/%s", dir, name);
    return to;
}

static const char *numbered(int k)
{
    char name[32];
    snprintf(name, sizeof name, k ? "a.exh.%d" : "a.exh", k);
    return path(name);
}

static void box(const char *seconds, const char *log, const char *size, const char *keep)
{
    const char *const *const words =
        size == NULL   ? WORDS("run", "--seconds", seconds, "--log", log)
        : keep == NULL ? WORDS("run", "--seconds", seconds, "--log", log, "--log-size", size)
                       : WORDS("run", "--seconds", seconds, "--log", log, "--log-size", size,
                             "--log-keep", keep);
    said(&s, dir, cli_run, words);
}

static int there(int k) { return said_size(numbered(k)) >= 0; }

/* Its rows at the end of a file: replays, and how many bytes it has. */
static void add_rows(int k, FILE *to)
{
    char line[512];
    FILE *f;
    said(&s, dir, cli_replay, WORDS("replay", numbered(k)));
    CHECK(s.status == 0 && strstr(s.out, " identical") && s.err[0] == '\0', "%d: %s%s", k, s.out,
        s.err);
    said(&s, dir, cli_csv, WORDS("csv", numbered(k), "--out", path("part.csv")));
    CHECK(s.status == 0 && s.err[0] == '\0', "%d: %s", k, s.err);
    f = fopen(path("part.csv"), "r");
    CHECK(f && fgets(line, sizeof line, f), "%d: no table", k);
    while (fgets(line, sizeof line, f)) { fputs(line, to); }
    fflush(to); /* or the next child would */
    fclose(f);
}

/* The last bytes of `whole`, behind its first line, are all of `parts`. */
static int ends_with(const char *whole, const char *parts, int all)
{
    const long n = said_size(parts);
    char a[512], b[512];
    FILE *f = fopen(whole, "r"), *g = fopen(parts, "r");
    int same = f && g && fgets(a, sizeof a, f) && n > 0;
    if (same && !all) { same = fseek(f, -n, SEEK_END) == 0; }
    while (same && fgets(b, sizeof b, g)) { same = fgets(a, sizeof a, f) && strcmp(a, b) == 0; }
    same = same && fgets(a, sizeof a, f) == NULL;
    fclose(f);
    fclose(g);
    return same;
}

static void compare(int files, int all)
{
    FILE *to = fopen(path("parts.csv"), "w");
    CHECK(to != NULL, "no table");
    for (int k = files - 1; k >= 0; k--) { add_rows(k, to); }
    fclose(to);
    CHECK(ends_with(path("whole.csv"), path("parts.csv"), all), "%d files", files);
}

TEST(many_files_hold_what_one_would)
{
    int n = 0;
    dir = said_dir();
    box("20", path("whole.exh"), NULL, NULL);
    said(&s, dir, cli_csv, WORDS("csv", path("whole.exh"), "--out", path("whole.csv")));
    CHECK_EQ_I64(s.status, 0);
    box("20", path("a.exh"), "512k", NULL);
    CHECK(s.status == 0 && s.err[0] == '\0', "%s", s.err);
    for (; there(n); n++) {
        CHECK(said_size(numbered(n)) <= 512 << 10, "%d: %ld", n, said_size(numbered(n)));
        CHECK(n == 0 || said_size(numbered(n)) > 300 << 10, "%d: %ld", n, said_size(numbered(n)));
    }
    CHECK(n >= 6, "%d files of %ld bytes", n, said_size(path("whole.exh")));
    compare(n, 1);
    box("20", path("a.exh"), "512k", "2");
    CHECK(there(0) && there(1) && there(2) && !there(3), "kept");
    compare(3, 0);
    box("20", path("a.exh"), "512k", "0");
    CHECK(there(0) && !there(1), "kept");
    compare(1, 0);
    said_clean(dir);
}

/* A run before is not written over. */
TEST(what_was_there_is_an_old_one)
{
    dir = said_dir();
    box("0.2", path("a.exh"), "1M", NULL);
    box("0.1", path("a.exh"), "1M", NULL);
    said(&s, dir, cli_replay, WORDS("replay", numbered(1)));
    CHECK(s.status == 0 && strstr(s.out, ": 400 ticks"), "%s", s.out);
    said(&s, dir, cli_replay, WORDS("replay", numbered(0)));
    CHECK(s.status == 0 && strstr(s.out, ": 200 ticks") && !there(2), "%s", s.out);
    said_clean(dir);
}

static uint64_t hardly_any(const char *at)
{
    (void)at;
    return UINT64_C(100) << 20;
}

TEST(a_disk_that_runs_low_is_told_once)
{
    uint64_t (*const real)(const char *) = log_turn_free_B;
    const char *word;
    dir = said_dir();
    log_turn_free_B = hardly_any;
    box("1", path("a.exh"), NULL, NULL);
    log_turn_free_B = real;
    word = strstr(s.err, "its disk has 100 MiB left");
    CHECK(s.status == 0 && word && !strstr(word + 30, "left"), "%d %s", s.status, s.err);
    box("1", "/dev/full", NULL, NULL);
    CHECK(s.status == 1 && strstr(s.err, "records lost, and ") &&
              strstr(s.err, " bytes that were taken before: make room"),
        "%d %s", s.status, s.err);
    said_clean(dir);
}

TEST(bad_usage)
{
    static const char *const bad[] = {"", "k", "63k", "65535", "1T", "1kk", "-1M", "1.5M", "2000G",
        "99999999999999999999", "0x10000", "1M "};
    dir = said_dir();
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        box("0.1", path("a.exh"), bad[i], NULL);
        CHECK(s.status == 2 && strstr(s.err, "--log-size: "), "%s: %d %s", bad[i], s.status, s.err);
        CHECK(!there(0), "%s", bad[i]);
    }
    box("0.1", "/dev/null", "1M", NULL);
    CHECK(s.status == 2 && strstr(s.err, "/dev/null is no regular file"), "%d %s", s.status, s.err);
    said(&s, dir, cli_run, WORDS("run", "--seconds", "0.1", "--log-size", "1M"));
    CHECK(s.status == 2 && strstr(s.err, "goes with"), "%d %s", s.status, s.err);
    said(&s, dir, cli_run, WORDS("run", "--seconds", "0.1", "--log-keep", "1"));
    CHECK(s.status == 2 && strstr(s.err, "goes with"), "%d %s", s.status, s.err);
    said_clean(dir);
}

TEST_MAIN("log_turn", many_files_hold_what_one_would, what_was_there_is_an_old_one,
    a_disk_that_runs_low_is_told_once, bad_usage);
