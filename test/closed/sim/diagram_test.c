/* SPDX-License-Identifier: MIT */
/* Diagrams: every name in them is a row of a table, and docs/ holds what is drawn now. */
#include "check.h"

#include "lab/diagram/diagram.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t slurp(FILE *f, char *to, size_t cap)
{
    const size_t n = fread(to, 1, cap - 1, f);
    to[n] = '\0';
    fclose(f);
    return n;
}

/* `make diagrams` draws them anew. */
TEST(docs_hold_what_is_drawn_now)
{
    static char ours[32768], theirs[32768];
    CHECK(diagrams_n > 0, "no diagram");
    for (int i = 0; i < diagrams_n; i++) {
        char path[64];
        FILE *f = tmpfile();
        CHECK(f != NULL, "no temporary file");
        CHECK(diagram_draw(f, &diagrams[i]) == 0, "%s names a row that does not exist",
              diagrams[i].name);
        rewind(f);
        CHECK(slurp(f, ours, sizeof ours) < sizeof ours - 1, "%s: too long", diagrams[i].name);
        snprintf(path, sizeof path, "docs/%s.svg", diagrams[i].name);
        f = fopen(path, "r");
        CHECK(f != NULL, "%s: not there: make diagrams", path);
        slurp(f, theirs, sizeof theirs);
        CHECK(strcmp(ours, theirs) == 0, "%s: stale: make diagrams", path);
    }
}

TEST(a_name_that_is_no_row_is_told)
{
    static const struct diagram_box box[] = {{0, 0, 9, 9, "a", {"{p:k}"}},
                                             {0, 0, 9, 9, "a", {"{p:no_such}"}},
                                             {0, 0, 9, 9, "a", {"{s:no_such}"}},
                                             {0, 0, 9, 9, "a", {"{d:no_such}"}}};
    for (int i = 0; i < 4; i++) {
        const struct diagram d = {"test", "test", 9, 9, &box[i], 1, NULL, 0, NULL};
        FILE *f = tmpfile();
        CHECK(f != NULL && diagram_draw(f, &d) == (i != 0), "box %d", i);
        fclose(f);
    }
}

TEST_MAIN("sim/diagram", docs_hold_what_is_drawn_now, a_name_that_is_no_row_is_told);
