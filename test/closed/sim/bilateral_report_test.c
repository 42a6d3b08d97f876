/* SPDX-License-Identifier: MIT */
/* What exhand bilateral says of itself beside the paper: only what was measured, and the paper's
 * figures only beside the same. */
#include "said.h"

#define SCENES  "ports/posix/world/scenes/"
#define NATURAL "bilateral", "--speed", "natural", "--approaches", "1"

static long times(const char *text, const char *word)
{
    long n = 0;
    for (const char *at = text; (at = strstr(at, word)) != NULL; at++) { n++; }
    return n;
}

/* The paper has one wall, at one rate and one pair of gains, and a contact at one speed. */
TEST(the_papers_figures_stand_beside_the_same_alone)
{
    static const struct {
        const char *option, *value;
        long beside, local; /* lines with a figure of the paper; with any stiffness of falls */
        const char *says;
    } row[] = {
        {"--seed", "2", 4, 1, "positions (paper 50004)."},
        {"--link", "delay=0.01", 4, 1, "positions (paper 50004)."},
        {"--speed", "slow", 1, 1, "positions (paper 50004)."},
        {"--speed", "0.5", 1, 1, "positions (paper 50004)."},
        {"--rate", "500", 0, 1, "500 Hz, k 6000 N/m, b 25 Ns/m"},
        {"--k", "5000", 0, 1, "over the wall's positions.\n"},
        {"--set", "mat_k=5000", 0, 1, "over the wall's positions.\n"},
        {"--set", "mat_b=20", 0, 1, "2000 Hz, k 20000 N/m, b 20 Ns/m"},
        {"--scene", SCENES "rehabilitation.world", 0, 0, "own k and b"},
        {"--scene", SCENES "collision.world", 0, 0, "own k and b"},
    };
    const char *dir = said_dir();
    static struct said s;
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, cli_bilateral, WORDS(NATURAL, row[i].option, row[i].value));
        CHECK(s.status == 0, "row %zu: %d: %s", i, s.status, s.err);
        CHECK_EQ_I64(times(s.out, "paper "), row[i].beside);
        CHECK_EQ_I64(times(s.out, "Local: median of"), row[i].local);
        CHECK_EQ_I64(times(s.out, "bilateral / local"), row[i].local);
        CHECK(strstr(s.out, row[i].says) && !strstr(s.out, " 0 N/m"), "row %zu: %s", i, s.out);
        CHECK(strstr(s.out, "stiffness, all approaches"), "row %zu: %s", i, s.out);
    }
    said_clean(dir);
}

/* What pictures say of the gains: a scene's materials have their own. */
TEST(pictures_say_the_gains_there_are)
{
    static const struct {
        const char *option, *value, *says;
    } row[] = {
        {"--seed", "1", "\nk='20000'; b='60'; "},
        {"--set", "mat_k=5000", "\nk='5000'; b='60'; "},
        {"--scene", SCENES "rehabilitation.world", "\nk=''; b=''; "},
    };
    const char *dir = said_dir();
    static struct said s;
    static char script[SAID_B];
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, cli_bilateral, WORDS(NATURAL, row[i].option, row[i].value, "--out", dir));
        CHECK(s.status == 0, "row %zu: %d: %s", i, s.status, s.err);
        said_read(script, said_path(dir, "bilateral.gp"));
        CHECK(strstr(script, row[i].says), "row %zu: %s", i, script);
    }
    said_clean(dir);
}

/* All faults by default, of all fingers. A finger that presses for long and does not tremble looks
 * like a dead encoder. That fault is off unless an option turns it on. */
TEST(all_fingers_come_to_their_end)
{
    const char *dir = said_dir();
    static struct said s;
    said(&s, dir, cli_bilateral, WORDS("bilateral", "--fingers", "all"));
    CHECK(s.status == 0 && s.err[0] == '\0', "%d: %s", s.status, s.err);
    CHECK_EQ_I64(times(s.out, ": 40 approaches of 8 seeds, 0 missed, "), 15);
    said(&s, dir, cli_bilateral,
        WORDS(NATURAL, "--fingers", "all", "--device", "hold=6", "--set", "stuck_time=2000"));
    CHECK(s.status == 1 && strstr(s.err, "the box stopped with faults 0x40: stuck"), "%d: %s",
        s.status, s.err);
    said(&s, dir, cli_bilateral, WORDS(NATURAL, "--fingers", "all", "--device", "hold=6"));
    CHECK(s.status == 0 && s.err[0] == '\0', "%d: %s", s.status, s.err);
    said(&s, dir, cli_run,
        WORDS("run", "--scene", "bilateral", "--fingers", "all", "--speed", "slow", "--seconds",
            "60"));
    CHECK(s.status == 0 && strstr(s.out, "faults none"), "%d: %s%s", s.status, s.out, s.err);
    said_clean(dir);
}

/* What was saved is what is loaded: the experiment's own 40 N do not come behind it. */
TEST(an_image_of_parameters_is_not_overruled)
{
    const char *dir = said_dir(), *image = said_path(dir, "p");
    static struct said s;
    said(&s, dir, cli_bilateral, WORDS(NATURAL, "--set", "mat_f_max=7", "--save-params", image));
    CHECK(s.status == 0 && strstr(s.out, "   7.00 "), "%d: %s%s", s.status, s.out, s.err);
    said(&s, dir, cli_bilateral, WORDS(NATURAL, "--load-params", image));
    CHECK(s.status == 0 && strstr(s.out, "   7.00 "), "%d: %s%s", s.status, s.out, s.err);
    said_clean(dir);
}

TEST_MAIN("bilateral_report", the_papers_figures_stand_beside_the_same_alone,
    pictures_say_the_gains_there_are, all_fingers_come_to_their_end,
    an_image_of_parameters_is_not_overruled);
