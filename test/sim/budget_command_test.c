/* exhand budget: its arithmetic by hand, and the goals at the stated times. */
#include "said.h"

static struct said s;

TEST(figures_by_hand)
{
    char *dir = said_dir();
    /* 5486 * 2 / 1600 + 5 * 0.25 = 8.1075; 12 accesses; 50 us less 8.1075 are 12 of 3.491. */
    said(&s, dir, cli_budget, WORDS("budget", "--csv"));
    CHECK(s.status == 0 && strstr(s.out, "\"drop, in turn\",20000,11,0,5486,8.107,12.000,25.000,10.000,0.000,40000,A/D,3.491\n"),
          "%s", s.out);
    /* 63.09625 and 32: 10516 Hz. */
    CHECK(strstr(s.out, ",63.096,32.000,25.000,10.000,16.923,10516,instructions,1.153\n") != NULL, "%s", s.out);
    said(&s, dir, cli_budget, WORDS("budget", "--access-us", "2", "--csv"));
    CHECK(strstr(s.out, ",63.096,64.000,25.000,10.000,16.923,7868,bus,1.153\n") != NULL, "%s", s.out);
    said_clean(dir);
}

TEST(bad_usage)
{
    char *dir = said_dir();
    said(&s, dir, cli_budget, WORDS("budget", "--access-us", "0"));
    CHECK_EQ_I64(s.status, 2);
    said_clean(dir);
}

TEST_MAIN("sim/budget command", figures_by_hand, bad_usage);
