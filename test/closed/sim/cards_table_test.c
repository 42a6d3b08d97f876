/* SPDX-License-Identifier: MIT */
/* The table of docs/CARDS.md is what `exhand-lab cards` says now (make cards), and nothing in it is
 * undefined. */
#include "said.h"
#include "lab/lab.h"

static struct said s;

TEST(the_documented_table_is_the_one_made_now)
{
    char *dir = said_dir();
    said(&s, dir, cli_cards, WORDS("cards", "--jobs", "2"));
    CHECK(s.status == 0 && s.err[0] == '\0', "status %d: %s", s.status, s.err);
    CHECK(strstr(s.out, " 0 undefined, ") != NULL, "%s", s.out);
    said_as_document(&s, "docs/CARDS.md", "exhand cards");
    said_clean(dir);
}

TEST_MAIN("sim/cards_table", the_documented_table_is_the_one_made_now);
