/* SPDX-License-Identifier: MIT */
/* --preset original: the glove of 8 bits a frame late is one, and what is said of it beside this
 * box follows from that. */
#include "said.h"
#include "lab/lab.h"

#include "posix.h"

#include "exhand/run/loop.h"

#include "exhand/board.h"

#define SENSORS    SIM_GLOVE_SENSORS
#define TICKS      300
#define RATE_HZ    90
#define IMPACT_MPS 0.76 /* measured: 1.17 in free fall, less the rotor and dry friction */

/* ---- The glove ------------------------------------------------------------------------- */

static struct {
    int16_t raw[TICKS][SENSORS];
    uint16_t age[TICKS];
    uint8_t is_new[TICKS];
    unsigned ticks;
} seen[2], *now;

static int setup(struct exh_scene_board board)
{
    (void)board;
    now->ticks = 0;
    return 0;
}

static void tick(const struct exh_scene_in *in, struct exh_drive_out *out)
{
    memset(out, 0, sizeof *out);
    if (now->ticks == TICKS) { return; }
    memcpy(now->raw[now->ticks], in->glove.raw, sizeof now->raw[0]);
    now->age[now->ticks] = in->glove.age_ticks;
    now->is_new[now->ticks++] = in->glove_new;
}

/* Of 255 samples at -9 .. 9 V of the card the nearest, in the middle of its codes. */
static int is_nearest(int16_t coarse, int16_t fine)
{
    const double step = 58982.4 / 254, off = coarse - fine;
    const double n = (coarse + 29491.2) / step, whole = (double)(long)(n + 0.5);
    const int on_grid = n - whole < 0.6 / step && whole - n < 0.6 / step;
    const int beyond = fine < -29491 || fine > 29491;
    return on_grid && n > -0.1 && n < 254.1 &&
           (beyond || (off <= step / 2 + 0.6 && off >= -step / 2 - 0.6));
}

TEST(its_samples_have_8_bits_and_come_a_frame_late)
{
    static const struct exh_scene scene = {.name = "seen",
        .rate_Hz = RATE_HZ,
        .read_glove = exh_board_read_glove,
        .setup = setup,
        .tick = tick};
    int moved = 0;
    for (int stock = 0; stock < 2; stock++) {
        struct posix_config c = posix_config_default();
        c.glove = c.bench = 1;
        c.stock = stock;
        c.hand.does = SIM_WAVE;
        c.max_ticks = TICKS;
        now = &seen[stock];
        posix_configure(&c);
        CHECK_EQ_I64(exh_loop(&scene, 0, NULL), 0);
        CHECK_EQ_I64(now->ticks, TICKS);
    }
    for (int n = 2; n < TICKS; n++) { /* before there was none that was late */
        CHECK(seen[1].age[n] == seen[0].age[n] + 1 && seen[1].is_new[n], "tick %d: %d", n,
            seen[1].age[n]);
        for (int i = 0; i < SENSORS; i++) {
            CHECK(is_nearest(seen[1].raw[n][i], seen[0].raw[n - 1][i]),
                "tick %d, sensor %d: %d of %d", n, i, seen[1].raw[n][i], seen[0].raw[n - 1][i]);
            moved += seen[0].raw[n][i] - seen[0].raw[n - 1][i] > 400;
        }
    }
    CHECK(moved > TICKS, "%d: too little moves for that to tell a frame from the next", moved);
}

/* ---- The tables ------------------------------------------------------------------------- */

static struct said s;

/* Of the row that begins with `what`, column n. */
static double value(const char *what, int n)
{
    const char *at = strstr(s.out, what);
    double v = -1e9;
    char *end = NULL;
    CHECK(at != NULL, "no \"%s\" in %s", what, s.out);
    for (n += 2; at != NULL && n > 0; n--) {
        at = strchr(at, '|');
        at = at ? at + 1 : NULL;
    }
    if (at != NULL) { v = strtod(at, &end); }
    return end == at ? -1e9 : v; /* a dash */
}

TEST(a_fall_on_the_wall_of_before_is_soft_and_deep)
{
    char *dir = said_dir();
    said(&s, dir, lab_drop, WORDS("drop", "--preset", "original", "--out", dir));
    CHECK(s.status == 0 && s.err[0] == '\0', "%d: %s", s.status, s.err);
    CHECK(value("loop", 0) == 90 && value("loop", 2) == 2000, "%s", s.out);
    CHECK(value("stiffness", 2) > 10 * value("stiffness", 0) && value("stiffness", 0) > 1200 &&
              value("stiffness", 0) < 1800,
        "%s", s.out);
    CHECK(value("deepest", 0) > 4 * value("deepest", 2) && value("deepest", 2) > 0.5, "%s", s.out);
    /* It falls at IMPACT_MPS: half a tick of that, and no more than one. */
    CHECK(value("past the wall when", 0) > 1 && value("  at most", 0) < 1.3 * 1e3 * IMPACT_MPS / 90,
        "%s", s.out);
    CHECK(value("  at most", 2) < 1.3 * 1e3 * IMPACT_MPS / 2000 + 0.1, "%s", s.out);
    CHECK(value("falls that do not", 0) == 0 && value("falls that do not", 1) == 1 &&
              value("falls that do not", 2) == 0,
        "%s", s.out);
    said_as_document(&s, "docs/TABLES.md", "exhand drop --preset original");
    CHECK(said_size(said_path(dir, "original.csv")) > 300 &&
              said_size(said_path(dir, "original.gp")) > 100 &&
              said_size(said_path(dir, "original_0.csv")) > 500 &&
              said_size(said_path(dir, "original_2.csv")) > 10000,
        "%s", dir);
    said_clean(dir);
}

/* Contact is late by the way that a finger makes in a frame. */
TEST(a_finger_is_told_of_the_wall_late)
{
    char *dir = said_dir();
    said(&s, dir, lab_bilateral, WORDS("bilateral", "--preset", "original", "--out", dir));
    CHECK(s.status == 0 && s.err[0] == '\0', "%d: %s", s.status, s.err);
    CHECK(value("loop", 2) == 90 && value("loop", 3) == 2000 && value("approaches", 2) == 5, "%s",
        s.out);
    CHECK(value("contact less", 2) > 0.5 * 1e3 * 0.86 / 90 &&
              value("contact less", 2) < 1.5 * 1e3 * 0.86 / 90,
        "%s", s.out);
    CHECK(value("contact less", 3) < 1 && value("contact less", 0) < 1, "%s", s.out);
    CHECK(value("deepest", 2) > 2 * value("deepest", 3), "%s", s.out);
    CHECK(value("stiffness", 2) < 2000 && value("stiffness", 3) > 10000, "%s", s.out);
    said_as_document(&s, "docs/TABLES.md", "exhand bilateral --preset original");
    CHECK(said_size(said_path(dir, "original_0.csv")) > 500 &&
              said_size(said_path(dir, "original.csv")) > 300,
        "%s", dir);
    said_clean(dir);
}

TEST(what_says_otherwise_is_refused)
{
    static const struct {
        int (*run)(int, char **);
        const char *word[6], *says;
    } row[] = {
        {lab_drop, {"drop", "--preset", "modern"}, "--preset: modern: no such preset (original)"},
        {lab_drop, {"drop", "--preset", "original", "--rate", "90"}, "--preset: goes with --falls"},
        {lab_drop, {"drop", "--preset", "original", "--sweep"}, "--preset: goes with --falls"},
        {lab_bilateral, {"bilateral", "--preset", "Original"}, "no such preset"},
        {lab_bilateral, {"bilateral", "--preset", "original", "--rate", "1000"},
            "--preset: goes with up to three"},
        {lab_bilateral, {"bilateral", "--preset", "original", "--speed", "slow,natural,fast,1"},
            "--preset: goes with up to three"},
    };
    char *dir = said_dir();
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        said(&s, dir, row[i].run, row[i].word);
        CHECK(s.status == 2 && strstr(s.err, row[i].says), "%zu: %d: %s", i, s.status, s.err);
    }
    said_clean(dir);
}

TEST_MAIN("sim/original", its_samples_have_8_bits_and_come_a_frame_late,
    a_fall_on_the_wall_of_before_is_soft_and_deep, a_finger_is_told_of_the_wall_late,
    what_says_otherwise_is_refused);
