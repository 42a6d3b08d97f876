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

TEST(nothing_is_wrong_at_random_times)
{
    char *dir = said_dir();
    said(&s, dir, cli_faults, WORDS("faults", "--times", "2004", "--jobs", "2"));
    CHECK(s.status == 0 && s.err[0] == '\0', "status %d: %s%s", s.status, s.err, s.out);
    CHECK(strstr(s.out, "2004 times: 0 wrong.") != NULL, "%s", s.out);
    said_clean(dir);
}

TEST_MAIN("sim/faults", the_documented_table_is_the_one_made_now, nothing_is_wrong_at_random_times);
