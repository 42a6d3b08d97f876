/* The table of docs/CARDS.md is what `exhand cards` says now, and nothing in it is undefined. */
#include "said.h"

#define BEGINS "<!-- exhand cards -->\n"
#define ENDS   "<!-- end -->\n"

static struct said s;
static char doc[65536];

TEST(the_documented_table_is_the_one_made_now)
{
    char *dir = said_dir(), *from, *to;
    FILE *f = fopen("docs/CARDS.md", "r");
    CHECK(f != NULL, "docs/CARDS.md: not there");
    doc[fread(doc, 1, sizeof doc - 1, f)] = '\0';
    fclose(f);
    from = strstr(doc, BEGINS);
    CHECK(from != NULL, "docs/CARDS.md: no " BEGINS);
    from += strlen(BEGINS);
    to = strstr(from, ENDS);
    CHECK(to != NULL, "docs/CARDS.md: no " ENDS);
    *to = '\0';
    said(&s, dir, cli_cards, WORDS("cards", "--jobs", "2"));
    CHECK(s.status == 0 && s.err[0] == '\0', "status %d: %s", s.status, s.err);
    CHECK(strstr(s.out, " 0 undefined, ") != NULL, "%s", s.out);
    CHECK(strcmp(from, s.out) == 0, "stale: make cards:\n%s", s.out);
    said_clean(dir);
}

TEST_MAIN("sim/cards_table", the_documented_table_is_the_one_made_now);
