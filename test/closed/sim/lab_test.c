/* SPDX-License-Identifier: MIT */
/* What moved into the lab's program: its old place says so, in one line, and ends with status 2. */
#include "said.h"

#include "commands.h"
#include "lab/lab.h"

#define LEN(a) (sizeof(a) / sizeof((a)[0]))

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
    said(&s, dir, as_exhand, WORDS("exhand", "--help"));
    CHECK(s.status == 0 && strstr(s.out, "  drop ") && !strstr(s.out, "  faults "), "%s", s.out);
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

TEST_MAIN(
    "lab", an_option_says_where_it_went, a_command_says_where_it_went, the_glove_wants_a_mode);
