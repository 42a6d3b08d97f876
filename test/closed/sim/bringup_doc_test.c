/* SPDX-License-Identifier: MIT */
/* What docs/BRINGUP.md says the scene prints is what it prints now: every block that begins with a
 * command. EXH_UPDATE=1 writes them anew. */
#include "said.h"

#define DOC    "docs/BRINGUP.md"
#define BEGINS "```\n$ exhand bringup"
#define DOC_B  65536

static struct said s;
static char doc[DOC_B], made[DOC_B], carded[SAID_B];

/* Words of a command line, "two words" kept together, in place. How many. */
static int split(char *line, const char *word[17])
{
    int n = 0;
    while (*line != '\0' && n < 15) {
        const char end = *line == '"' ? '"' : ' ';
        if (*line == '"') { line++; }
        word[n++] = line;
        while (*line != '\0' && *line != end) { line++; }
        if (*line != '\0') { *line++ = '\0'; }
        while (*line == ' ') { line++; }
    }
    word[n] = NULL;
    return n;
}

/* more: one more option, or NULL. */
static void run(const char *line, size_t len, const char *more)
{
    static const char program[] = "$ exhand ";
    char words[200], *dir = said_dir();
    const char *word[17];
    int n;
    CHECK(len < sizeof words, "a long line");
    memcpy(words, line, len);
    words[len] = '\0';
    n = split(words + strlen(program), word);
    CHECK(n > 0, "no words");
    word[n] = more;
    word[n + 1] = NULL;
    said(&s, dir, cli_bringup, word);
    CHECK(s.err[0] == '\0' && s.status >= 0 && s.status <= 1, "status %d: %s", s.status, s.err);
    said_clean(dir);
}

TEST(expected_prints_are_what_is_printed_now)
{
    FILE *f = fopen(DOC, "r");
    char *at = doc, *from;
    size_t n = 0;
    int blocks = 0;
    CHECK(f != NULL, DOC ": not there");
    doc[fread(doc, 1, sizeof doc - 1, f)] = '\0';
    fclose(f);
    while ((from = strstr(at, BEGINS)) != NULL) {
        char *const line = from + strlen("```\n"), *const body = strchr(line, '\n') + 1;
        char *const end = strstr(body - 1, "\n```") + 1;
        run(line, (size_t)(body - 1 - line), "--cards");
        strcpy(carded, s.out);
        run(line, (size_t)(body - 1 - line), NULL);
        CHECK(strcmp(carded, s.out) == 0, "through the cards: %s", carded);
        n += (size_t)snprintf(made + n, sizeof made - n, "%.*s%s", (int)(body - at), at, s.out);
        if (getenv("EXH_UPDATE") == NULL) {
            CHECK((size_t)(end - body) == strlen(s.out) && memcmp(body, s.out, strlen(s.out)) == 0,
                "stale (EXH_UPDATE=1 build/test/sim/bringup_doc_test):\n%.*s%s", (int)(body - line),
                line, s.out);
        }
        at = end;
        blocks++;
    }
    CHECK(blocks == 8, "%d blocks", blocks);
    if (getenv("EXH_UPDATE") == NULL) { return; }
    snprintf(made + n, sizeof made - n, "%s", at);
    f = fopen(DOC, "w");
    CHECK(f != NULL, DOC ": cannot be written");
    fputs(made, f);
    fclose(f);
}

TEST_MAIN("sim/bringup_doc", expected_prints_are_what_is_printed_now);
