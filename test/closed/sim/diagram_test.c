/* SPDX-License-Identifier: MIT */
/* Diagrams: every name in them is a row of a table, and docs/ holds what is drawn now. */
#include "check.h"

#include "lab/diagram/diagram.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static void slurp(FILE *f, char *to, size_t cap)
{
    size_t n;
    CHECK(f != NULL, "not there: make diagrams");
    rewind(f);
    n = fread(to, 1, cap, f);
    fclose(f);
    CHECK(n < cap, "too long");
    to[n] = '\0';
}

/* The text as it is printed now, and the picture in docs/, if a page shows it. */
static bool both(const char *name, const char *ending, char ours[32768], char theirs[32768])
{
    char path[64];
    FILE *in, *out = tmpfile();
    snprintf(path, sizeof path, "test/lab/diagram/%s.%s", name, ending);
    in = fopen(path, "r");
    CHECK(in != NULL && out != NULL && diagram_expand(in, out) == 0,
        "%s names a row that does not exist", path);
    fclose(in);
    slurp(out, ours, 32768);
    snprintf(path, sizeof path, "docs/%s.svg", name);
    in = fopen(path, "r");
    if (in != NULL) slurp(in, theirs, 32768);
    return in != NULL;
}

/* `make diagrams` draws them anew: a picture by Graphviz has its text's CRC as its id. */
TEST(docs_hold_what_is_drawn_now)
{
    static const char *const name[] = {
        "overview", "setup", "identification", "principle", "bilateral", "whole"};
    static char ours[32768], theirs[32768];
    int shown = 0;
    for (size_t i = 0; i < sizeof name / sizeof name[0]; i++) {
        char id[16] = "";
        const bool here = both(name[i], "dot", ours, theirs);
        CHECK(strstr(ours, "id=\"") != NULL, "%s has no id", name[i]);
        if (!here) continue;
        shown++;
        snprintf(id, sizeof id, "%.13s", strstr(ours, "id=\""));
        CHECK(strstr(theirs, id) != NULL, "docs/%s.svg: stale, %s: make diagrams", name[i], id);
    }
    CHECK(shown == 3, "%d diagrams in docs/", shown);
    CHECK(both("geometry", "svg", ours, theirs), "docs/geometry.svg: missing");
    CHECK(strcmp(ours, theirs) == 0, "docs/geometry.svg: stale: make diagrams");
}

TEST(a_name_that_is_no_row_is_told)
{
    static const char *const text[] = {
        "{p:k}", "{p:no_such}", "{s:no_such}", "{d:no_such}", "{#:no_such}"};
    for (int i = 0; i < 5; i++) {
        FILE *in = tmpfile(), *out = tmpfile();
        CHECK(in != NULL && out != NULL, "no temporary file");
        fputs(text[i], in);
        rewind(in);
        CHECK(diagram_expand(in, out) == (i != 0), "%s", text[i]);
        fclose(in);
        fclose(out);
    }
}

TEST_MAIN("sim/diagram", docs_hold_what_is_drawn_now, a_name_that_is_no_row_is_told);
