/* SPDX-License-Identifier: MIT */
/* docs/SAFETY.md: every test it names is there, every fault, limit and step of arming has its row,
 * the checklist has its 26 lines. And what it says of the D/A: one file of the library makes codes,
 * and what else writes them moves codes that were made there. */
#include "exhand/safety.h"

#include "check.h"

#include <dirent.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DOC "docs/SAFETY.md"

static char doc[1 << 16], source[1 << 17];

static const char *read_into(char *buf, size_t cap, const char *path)
{
    FILE *f = fopen(path, "r");
    CHECK(f != NULL, "%s: not there", path);
    buf[fread(buf, 1, cap - 1, f)] = '\0';
    fclose(f);
    return buf;
}

static int matches(const char *before, const char *name, size_t len, const char *after)
{
    char pattern[200];
    glob_t found;
    snprintf(pattern, sizeof pattern, "%s%.*s%s", before, (int)len, name, after);
    const int there = glob(pattern, 0, NULL, &found) == 0;
    globfree(&found);
    return there;
}

/* folder/name is that path or folder/name_test.c, below test or below a subject of it. */
static int is_there(const char *name, size_t len)
{
    return matches("test/", name, len, "") || matches("test/", name, len, "_test.c") ||
           matches("test/*/", name, len, "") || matches("test/*/", name, len, "_test.c");
}

TEST(tests_that_are_named_are_there)
{
    static const char *const folder[] = {"unit/", "prop/", "sim/", "cards/", "stress/", "pc104/",
        "golden/", "port/", "proof/", "emu/", "size/"};
    int n = 0;
    for (const char *p = read_into(doc, sizeof doc, DOC); (p = strchr(p, '`')) != NULL; p++) {
        for (size_t k = 0; k < sizeof folder / sizeof folder[0]; k++) {
            const size_t len = strcspn(p + 1, "`");
            if (strncmp(p + 1, folder[k], strlen(folder[k])) != 0) { continue; }
            CHECK(is_there(p + 1, len), "test/%.*s is not there", (int)len, p + 1);
            n++;
        }
    }
    CHECK(n > 100, "%d tests are named", n);
    check_note("%d times a test is named", n);
}

/* The row of a table that begins with this name, behind a heading. */
static void must_have(const char *heading, const char *name)
{
    char row[80];
    const char *from = strstr(doc, heading), *to;
    CHECK(from != NULL, "no %s", heading);
    to = strstr(from + 1, "\n## ");
    snprintf(row, sizeof row, "\n| %s |", name);
    from = strstr(from, row);
    CHECK(from != NULL && (to == NULL || from < to), "%s: no row of %s", heading, name);
}

TEST(every_name_has_its_row)
{
    char line[8];
    (void)read_into(doc, sizeof doc, DOC);
    for (unsigned k = 0; k < EXH_FAULTS; k++) { must_have("\n## Faults", exh_fault_name(k)); }
    for (unsigned k = 0; k < EXH_LIMITS; k++) { must_have("\n## Limits", exh_limit_name(k)); }
    for (unsigned k = 0; k < EXH_ARMS; k++) { must_have("\n## Arming", exh_arm_name(k)); }
    for (int k = 1; k <= 26; k++) {
        snprintf(line, sizeof line, "%d", k);
        must_have("\n## A checklist", line);
    }
}

/* The row of a fault says what the library does with it. */
TEST(reactions_are_the_librarys)
{
    (void)read_into(doc, sizeof doc, DOC);
    for (unsigned k = 0; k < EXH_FAULTS; k++) {
        char row[80];
        const char *at;
        snprintf(row, sizeof row, "\n| %s |", exh_fault_name(k));
        at = strstr(strstr(doc, "\n## Faults"), row);
        CHECK(at != NULL, "no %s", exh_fault_name(k));
        at = strchr(at + strlen(row), '|');
        CHECK(at != NULL, "%s: no reaction", exh_fault_name(k));
        CHECK(strncmp(at, EXH_FAULT_CUT >> k & 1u ? "| cut |" : "| release |",
                  EXH_FAULT_CUT >> k & 1u ? 7 : 11) == 0,
            "%s: %.20s", exh_fault_name(k), at);
    }
}

/* --- one writer --- */

/* Lines outside the gate that put a code into a frame, and why none is made there. */
static const char *const moved[] = {
    "out->dac_raw[f] = placed->dac_raw[k];", /* the gate's, from place to finger */
    "out->dac_raw[0] = out->dac_raw[1];",    /* the gate's, of a finger not in use */
    "out->dac_raw[finger] = code;",          /* the gate's, of finger 0 */
    "out->dac_raw[0] = (uint16_t)par->drive.dac_zero_raw;",
    "out->dac_raw[f] = (uint16_t)cfg->par->drive[f].dac_zero_raw;", /* 0 A of one not in use */
};

/* 1 if dac_raw is assigned to in this line. */
static int writes(const char *line)
{
    const char *at = strstr(line, "dac_raw[");
    while (at != NULL) {
        const char *to = at + strlen("dac_raw[");
        for (int depth = 1; depth > 0 && *to != '\0'; to++) {
            depth += (*to == '[') - (*to == ']');
        }
        to += strspn(to, " ");
        to += strspn(to, "+-|&^*<>");
        if (to[0] == '=' && to[1] != '=') { return 1; }
        at = strstr(to, "dac_raw[");
    }
    return 0;
}

static int is_moved(const char *line)
{
    for (size_t k = 0; k < sizeof moved / sizeof moved[0]; k++) {
        if (strstr(line, moved[k])) { return 1; }
    }
    return 0;
}

static int in_file(const char *path)
{
    int n = 0;
    (void)read_into(source, sizeof source, path);
    for (const char *line = strtok(source, "\n"); line != NULL; line = strtok(NULL, "\n")) {
        if (!writes(line)) { continue; }
        CHECK(strcmp(path, "lib/src/act/gate.c") == 0 || is_moved(line), "%s: %s", path, line);
        n++;
    }
    return n;
}

static int in_folder(const char *path)
{
    DIR *d = opendir(path);
    struct dirent *e;
    int n = 0;
    CHECK(d != NULL, "%s: not there", path);
    while ((e = readdir(d)) != NULL) {
        char at[300];
        const char *end = strrchr(e->d_name, '.');
        if (e->d_name[0] == '.') { continue; }
        snprintf(at, sizeof at, "%s/%s", path, e->d_name);
        if (end != NULL && (strcmp(end, ".c") == 0 || strcmp(end, ".h") == 0)) {
            n += in_file(at);
        } else if (end == NULL && (strcmp(path, "examples") == 0 || strcmp(path, "lib/src") == 0)) {
            n += in_folder(at);
        }
    }
    closedir(d);
    return n;
}

TEST(one_file_makes_codes)
{
    const int lib = in_folder("lib/src"), scenes = in_folder("examples");
    CHECK(
        writes("x.dac_raw[k[1]] = 3;") && writes("dac_raw[0] += 1;") && !writes("dac_raw[0] == 1"),
        "the finder itself");
    CHECK(lib == 3, "%d writes in the library", lib);
    check_note("%d writes of a code in gate.c, %d codes moved in scenes", lib, scenes);
}

TEST_MAIN("sim/safety_doc", tests_that_are_named_are_there, every_name_has_its_row,
    reactions_are_the_librarys, one_file_makes_codes);
