/* SPDX-License-Identifier: MIT */
/* What moved into the lab's program: its old place says so, in one line, and ends with status 2. */
#include "said.h"

#include "commands.h"
#include "lab/lab.h"

static const struct {
    int (*was)(int, char **), (*is)(int, char **);
    const char *name, *option[9];
} moved[] = {
    {cli_drop, lab_drop, "drop",
        {"gates", "readings", "sweep", "grid", "shard", "border-check", "friction", "preset"}},
    {cli_bilateral, lab_bilateral, "bilateral", {"preset", "sweep", "check", "hands", "crisp"}},
    {cli_glove, lab_glove, "glove",
        {"selftest", "skew", "log", "from", "to", "span", "travel", "span-current"}},
    {cli_advise, lab_advise, "advise", {"judge", "out"}},
};

TEST(an_option_says_where_it_went)
{
    static struct said s;
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(moved); i++) {
        const int gains = moved[i].was == cli_advise;
        for (const char *const *o = moved[i].option; *o; o++) {
            char word[40], says[100];
            snprintf(word, sizeof word, "--%s", *o);
            snprintf(says, sizeof says, "exhand %s: %s: a study: `exhand-lab %s` has it",
                moved[i].name, word, moved[i].name);
            said(&s, dir, moved[i].was,
                gains ? WORDS(moved[i].name, "gains", word) : WORDS(moved[i].name, word));
            CHECK(s.status == 2 && strncmp(s.err, says, strlen(says)) == 0, "%d: %s", s.status,
                s.err);
            CHECK(strchr(s.err, '\n') == s.err + strlen(s.err) - 1, "%s", s.err);
            said(&s, dir, moved[i].is,
                gains ? WORDS(moved[i].name, "gains", "--help") : WORDS(moved[i].name, "--help"));
            CHECK(s.status == 0 && strstr(s.out, word), "%s: %s", word, s.out);
        }
    }
    said_clean(dir);
}

static int as_exhand(int argc, char **argv)
{
    static const struct program exhand = {
        "exhand", {&exhand_commands}, "budget cards diagram faults fit"};
    return program_main(&exhand, argc, argv);
}

TEST(a_command_says_where_it_went)
{
    static const char *const gone[] = {"budget", "cards", "diagram", "faults", "fit"};
    static struct said s;
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(gone); i++) {
        said(&s, dir, as_exhand, WORDS("exhand", gone[i], "--help"));
        CHECK(s.status == 2 && strstr(s.err, "a study: `exhand-lab") && s.out[0] == '\0', "%d: %s",
            s.status, s.err);
    }
    said(&s, dir, as_exhand, WORDS("exhand", "fault"));
    CHECK(s.status == 2 && strstr(s.err, "fault: no such command"), "%d: %s", s.status, s.err);
    CHECK(strchr(s.err, '\n') == s.err + strlen(s.err) - 1, "%s", s.err);
    said(&s, dir, as_exhand, WORDS("exhand", "--help"));
    CHECK(s.status == 0 && strstr(s.out, "  drop ") && !strstr(s.out, "  faults "), "%s", s.out);
    said_clean(dir);
}

/* What people type first. */
TEST(help_and_version_wherever_they_are_asked_for)
{
    static const struct {
        const char *word[3], *out, *err;
        int status;
    } row[] = {
        {{"help"}, "  drop ", "", 0},
        {{"help", "drop"}, "exhand drop [options]", "", 0},
        {{"help", "advise", "gains"}, "exhand advise gains [options]", "", 0},
        {{"help", "dorp"}, "", "dorp: no such command: did you mean drop?", 2},
        {{"--version"}, "exhand ", "", 0},
        {{"drop", "--version"}, "exhand ", "", 0},
        {{"--verison"}, "", "--verison: no such command: did you mean --version?", 2},
        {{"dorp"}, "", "dorp: no such command: did you mean drop?", 2},
        {{"replya"}, "", "did you mean replay?", 2},
        {{"zzzzzz"}, "", "zzzzzz: no such command: `exhand help`", 2},
        {{"replay"}, "", "LOG: this word is missing", 2},
        {{"drop", "--mass", "1"}, "", "--mass: no such option: give --device mass=VALUE", 2},
    };
    static struct said s;
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        const char *const *w = row[i].word;
        said(&s, dir, as_exhand, WORDS("exhand", w[0], w[1], w[2]));
        CHECK(s.status == row[i].status && strstr(s.out, row[i].out) && strstr(s.err, row[i].err),
            "row %zu: %d: %s%s", i, s.status, s.out, s.err);
        CHECK((s.status == 0) == (s.err[0] == '\0') && (s.status == 0) == (s.out[0] != '\0'),
            "row %zu: %s%s", i, s.out, s.err);
    }
    said_clean(dir);
}

TEST(the_glove_wants_a_mode)
{
    static struct said s;
    const char *dir = said_dir();
    said(&s, dir, cli_glove, WORDS("glove"));
    CHECK(s.status == 2 && strstr(s.err, "what to do is missing: --csv, --record or --serial"),
        "%d: %s", s.status, s.err);
    said(&s, dir, cli_glove, WORDS("glove", "--csv", "x", "--rate", "5", "--record", "y"));
    CHECK(s.status == 2 && strstr(s.err, "one at a time"), "%d: %s", s.status, s.err);
    said_clean(dir);
}

TEST_MAIN("lab", an_option_says_where_it_went, a_command_says_where_it_went,
    help_and_version_wherever_they_are_asked_for, the_glove_wants_a_mode);
