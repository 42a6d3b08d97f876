/* SPDX-License-Identifier: MIT */
/* --cards: the same bytes through drivers, bus and emulated cards as without; and it does go
 * through them. */
#include "said.h"
#include "lab/lab.h"

#include "box/run.h"
#include "posix.h"

#include "exhand/error.h"

static struct said with, without;
static char *dir;
static FILE *log_to;

static char *whole(const char *path, long *size_B)
{
    FILE *f = fopen(path, "rb");
    char *p;
    *size_B = said_size(path);
    CHECK(f != NULL && *size_B > 0, "%s: not there", path);
    p = malloc((size_t)*size_B);
    CHECK(p != NULL && fread(p, 1, (size_t)*size_B, f) == (size_t)*size_B, "%s", path);
    fclose(f);
    return p;
}

static void same_file(const char *a, const char *b)
{
    long n[2];
    char *p[2] = {whole(a, &n[0]), whole(b, &n[1])};
    CHECK(n[0] == n[1] && memcmp(p[0], p[1], (size_t)n[0]) == 0, "%s and %s differ", a, b);
    free(p[0]);
    free(p[1]);
}

/* The command, with --cards too: exit status, words and the files named. */
static void same(int (*command)(int, char **), const char *const *word, const char *const *file)
{
    const char *more[32];
    char out[2][512];
    int n = 0;
    for (; word[n] != NULL; n++) { more[n] = word[n]; }
    snprintf(out[0], sizeof out[0], "%s/without", dir);
    snprintf(out[1], sizeof out[1], "%s/with", dir);
    more[n] = "--out";
    more[n + 1] = out[0];
    more[n + 2] = NULL;
    said(&without, dir, command, more);
    more[n + 1] = out[1];
    more[n + 2] = "--cards";
    more[n + 3] = NULL;
    said(&with, dir, command, more);
    CHECK(without.status == 0 && with.status == 0, "%d %d %s%s", without.status, with.status,
        without.err, with.err);
    CHECK(strcmp(without.out, with.out) == 0, "not the same words");
    for (int i = 0; file[i] != NULL; i++) {
        char path[2][640];
        snprintf(path[0], sizeof path[0], "%s/%s", out[0], file[i]);
        snprintf(path[1], sizeof path[1], "%s/%s", out[1], file[i]);
        same_file(path[0], path[1]);
    }
}

TEST(drop_at_every_rate)
{
    dir = said_dir();
    same(cli_drop,
        WORDS("drop", "--falls", "2", "--rate", "90,200,500,1000,2000,20000", "--jobs", "2"),
        WORDS("drop_90Hz.exh", "drop_200Hz.exh", "drop_500Hz.exh", "drop_1000Hz.exh",
            "drop_2000Hz.exh", "drop_20000Hz.exh", "table2.csv"));
    same(cli_drop, WORDS("drop", "--falls", "1", "--period", "597/1193182", "--seed", "7"),
        WORDS("table2.csv"));
    said_clean(dir);
}

TEST(bilateral_with_five_fingers)
{
    static const char *const rate[] = {"500", "2000", "20000"};
    dir = said_dir();
    for (size_t i = 0; i < LEN(rate); i++) {
        same(cli_bilateral,
            WORDS("bilateral", "--fingers", "all", "--approaches", "1", "--speed", "fast", "--rate",
                rate[i]),
            WORDS("bilateral_fast.exh", "contacts.csv"));
    }
    same(cli_bilateral,
        WORDS("bilateral", "--fingers", "little", "--approaches", "1", "--speed", "fast"),
        WORDS("bilateral_fast.exh", "contacts.csv"));
    said_clean(dir);
}

TEST(glove_at_several_rates)
{
    static const char *const rate[] = {"90", "1000", "2000", "20000"};
    static const char *const every[] = {"every=1", "every=3"};
    dir = said_dir();
    for (size_t i = 0; i < LEN(rate) * LEN(every); i++) {
        const char *a = said_path(dir, "a.exh"), *b = said_path(dir, "b.exh");
        const char *r = rate[i / LEN(every)], *e = every[i % LEN(every)];
        said(&without, dir, cli_glove,
            WORDS("glove", "--record", a, "--does", "grasp", "--seconds", "2", "--rate", r, "--set",
                e));
        said(&with, dir, cli_glove,
            WORDS("glove", "--record", b, "--does", "grasp", "--seconds", "2", "--rate", r, "--set",
                e, "--cards"));
        CHECK(without.status == with.status, "%s %s: %d %d %s", r, e, without.status, with.status,
            with.err);
        if (without.status == 0) { same_file(a, b); }
    }
    said(&without, dir, lab_glove, WORDS("glove", "--selftest", "--seconds", "2"));
    said(&with, dir, lab_glove, WORDS("glove", "--selftest", "--seconds", "2", "--cards"));
    CHECK(with.status == 0 && strcmp(without.out, with.out) == 0, "%s", with.err);
    said_clean(dir);
}

TEST(calibrate)
{
    dir = said_dir();
    same(cli_calibrate, WORDS("calibrate", "--day", "20000"), WORDS("calibration.bin"));
    said_clean(dir);
}

/* One fall with something wrong with a card: the loop's error. */
static int fall(struct posix_cards cards, struct run *r)
{
    struct run_cfg c;
    int err;
    memset(&c, 0, sizeof c);
    c.rate_Hz = 2000;
    c.k_Npm = 20000;
    c.b_Nspm = 60;
    c.board = posix_config_default();
    c.board.cards = cards;
    c.board.log = log_to;
    err = run_drop(&c, r);
    return err;
}

/* "A one-finger scene touches one S526 and no glove card." */
TEST(it_does_go_through_the_cards)
{
    struct posix_cards c = {.how = POSIX_CARDS_INSTANT, .quiet = 1};
    struct run r;
    CHECK_EQ_I64(fall(c, &r), 0);
    CHECK(posix_cards_box()->accesses > 10 * r.ticks, "%lu accesses",
        (unsigned long)posix_cards_box()->accesses);
    run_free(&r);
    c.fault.kind = EMU_ABSENT;
    CHECK_EQ_I64(fall(c, &r), -EXH_E_ABSENT);
    run_free(&r);
    c.fault.card = EMU_S526_B;
    CHECK_EQ_I64(fall(c, &r), 0);
    run_free(&r);
    c.fault.card = EMU_MM32XAT;
    CHECK_EQ_I64(fall(c, &r), 0);
    run_free(&r);
    c.fault = (struct emu_fault){.kind = EMU_BUSY, .phase = EMU_PHASE_READ, .after = 2000};
    CHECK_EQ_I64(fall(c, &r), -EXH_E_IO);
    CHECK(r.ticks > 50 && r.ticks < 2000, "%lu ticks", (unsigned long)r.ticks);
    run_free(&r);
}

/* With what accesses and conversions take: no bit is different, a tick being longer than they. */
TEST(timed_too)
{
    static const uint8_t how[2] = {POSIX_CARDS_NONE, POSIX_CARDS_TIMED};
    dir = said_dir();
    for (int i = 0; i < 2; i++) {
        struct run r;
        log_to = fopen(said_path(dir, i ? "b.exh" : "a.exh"), "wb");
        CHECK(log_to != NULL, "no log");
        CHECK_EQ_I64(fall((struct posix_cards){.how = how[i]}, &r), 0);
        run_free(&r);
        fclose(log_to);
    }
    log_to = NULL;
    same_file(said_path(dir, "a.exh"), said_path(dir, "b.exh"));
    said_clean(dir);
}

TEST_MAIN("sim/cards", drop_at_every_rate, bilateral_with_five_fingers, glove_at_several_rates,
    calibrate, it_does_go_through_the_cards, timed_too);
