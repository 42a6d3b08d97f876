/* The table of docs/FAULTS.md is what `exhand faults` says now, and nothing in it is wrong; nor is
 * anything at a few thousand random times (`make faults`: 10^5). */
#include "said.h"

static struct said s;

TEST(the_documented_table_is_the_one_made_now)
{
    char *dir = said_dir();
    said(&s, dir, cli_faults, WORDS("faults", "--jobs", "2"));
    CHECK(s.status == 0 && s.err[0] == '\0', "status %d: %s%s", s.status, s.err, s.out);
    CHECK(strstr(s.out, " 0 wrong.") != NULL, "%s", s.out);
    said_as_document(&s, "docs/FAULTS.md", "exhand faults");
    said_clean(dir);
}

/* DESIGN.md has its first table; the names are those of SAFETY.md (sim/safety_doc). */
TEST(the_documented_states_are_the_librarys)
{
    char *dir = said_dir(), *rest;
    said(&s, dir, cli_faults, WORDS("faults", "--states"));
    CHECK(s.status == 0 && s.err[0] == '\0', "status %d: %s", s.status, s.err);
    CHECK(strstr(s.out, "\n| deadman | release | ") && strstr(s.out, "\n| estop | cut | ") &&
              strstr(s.out, "\n| i2t | ") && strstr(s.out, "\n| small_force | ") &&
              strstr(s.out, "\n| limit | "),
          "%s", s.out);
    CHECK(strstr(s.out, "?") == NULL && strstr(s.out, "|  |") == NULL, "a name is missing: %s", s.out);
    rest = strstr(s.out, "\n\n");
    CHECK(rest != NULL, "%s", s.out);
    rest[1] = '\0';
    said_as_document(&s, "docs/DESIGN.md", "exhand faults --states");
    said_clean(dir);
}

TEST(nothing_is_wrong_at_random_times)
{
    char *dir = said_dir();
    said(&s, dir, cli_faults, WORDS("faults", "--times", "2004", "--jobs", "2"));
    CHECK(s.status == 0 && s.err[0] == '\0', "status %d: %s%s", s.status, s.err, s.out);
    CHECK(strstr(s.out, "2004 times: 0 wrong.") != NULL, "%s", s.out);
    said_clean(dir);
}

TEST_MAIN("sim/faults", the_documented_table_is_the_one_made_now,
          the_documented_states_are_the_librarys, nothing_is_wrong_at_random_times);
