/* SPDX-License-Identifier: MIT */
/* exhand-lab budget: its arithmetic by hand, and the goals at the stated times. */
#include "said.h"
#include "lab/lab.h"

#include <stdlib.h>

static struct said s;

/* The whole number behind the n-th comma; -1: there is none. */
static int csv_int(const char *line, int n)
{
    for (; n > 0 && line != NULL; n--) {
        line = strchr(line, ',');
        if (line != NULL) { line++; }
    }
    return line ? atoi(line) : -1;
}

TEST(figures_by_hand)
{
    char *dir = said_dir();
    /* 3911 * 2 / 1600 + 5 * 0.25 = 6.139; 12 accesses; 50 us less 6.139 are 12 of 3.655. */
    said(&s, dir, cli_budget, WORDS("budget", "--csv"));
    CHECK(
        s.status == 0 &&
            strstr(s.out,
                "\"drop, in "
                "turn\",20000,11,0,3911,6.139,12.000,25.000,10.000,0.000,40000,A/D,40000,3.655\n"),
        "%s", s.out);
    /* 13448 * 2 / 1600 + 5 * 0.25 = 18.060; and 32: 19976 Hz; and 32 of 0.7: 24716. */
    CHECK(strstr(s.out, ",18.060,32.000,25.000,10.000,27.500,19976,bus,24716,2.561\n") != NULL,
        "%s", s.out);
    said(&s, dir, cli_budget, WORDS("budget", "--access-us", "2", "--csv"));
    CHECK(strstr(s.out, ",18.060,64.000,25.000,10.000,27.500,12186,bus,24716,2.561\n") != NULL,
        "%s", s.out);
    /* The fast access alone: 1e6 / (18.060 + 32 * 0.5). */
    said(&s, dir, cli_budget, WORDS("budget", "--fast-us", "0.5", "--csv"));
    CHECK(strstr(s.out, ",19976,bus,29360,2.561\n") != NULL, "%s", s.out);
    said_clean(dir);
}

/* The figures are compiled in, from `make hil`: docs/REPORT.md has them too, and one of them alone
 * is stale. */
TEST(the_reports_table_is_the_same)
{
    static const struct {
        const char *here, *report;
    } row[] = {{"\n\"drop\",", "| drop | "}, {"\n\"drop, in turn\",", "| drop, in turn | "},
        {"\n\"bilateral, frame in a tick\",", "| full box, frame in a tick | "},
        {"\n\"bilateral, in turn, frame\",", "| full box, in turn, frame | "},
        {"\n\"bilateral, in turn, part\",", "| full box, in turn, part | "}};
    static char report[200000];
    char *dir = said_dir();
    FILE *f = fopen("docs/REPORT.md", "r");
    CHECK(f != NULL, "docs/REPORT.md: run it at the top of the tree");
    report[f ? fread(report, 1, sizeof report - 1, f) : 0] = '\0';
    if (f) { (void)fclose(f); }
    said(&s, dir, cli_budget, WORDS("budget", "--csv"));
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        const char *csv = strstr(s.out, row[i].here), *table = strstr(report, row[i].report);
        char want[64];
        int words, bytes, insns, n;
        CHECK(csv != NULL && table != NULL, "%s: not in both", row[i].report);
        csv += strlen(row[i].here);
        table += strlen(row[i].report);
        words = csv_int(csv, 1);
        bytes = csv_int(csv, 2);
        insns = csv_int(csv, 3);
        n = bytes ? snprintf(want, sizeof want, "%d + %d | %d |", words, bytes, insns)
                  : snprintf(want, sizeof want, "%d | %d |", words, insns);
        CHECK(strncmp(table, want, (size_t)n) == 0,
            "%s: stale: exhand-lab budget has %s, docs/REPORT.md %.30s", row[i].report, want,
            table);
    }
    said_clean(dir);
}

TEST(bad_usage)
{
    char *dir = said_dir();
    said(&s, dir, cli_budget, WORDS("budget", "--access-us", "0"));
    CHECK_EQ_I64(s.status, 2);
    said_clean(dir);
}

TEST_MAIN("sim/budget command", figures_by_hand, the_reports_table_is_the_same, bad_usage);
