/* SPDX-License-Identifier: MIT */
/* Every test that needs no machine, as one program: `tests` runs all groups, `tests FOLDER...`
 * those of these folders, as unit and prop. Says which begins; the last line is "N groups passed, N
 * failed". */
#include "check.h"

#if __STDC_HOSTED__
#include <stdio.h>
#endif

#define GROUP(name) int suite_##name(void);
#include "groups.inc"
#undef GROUP

static const struct {
    const char *name; /* folder_module */
    int (*main)(void);
} group[] = {
#define GROUP(name) {#name, suite_##name},
#include "groups.inc"
};

static int of_folder(const char *name, const char *folder)
{
    while (*folder != '\0' && *name == *folder) {
        name++;
        folder++;
    }
    return *folder == '\0' && *name == '_';
}

#if __STDC_HOSTED__
int main(int argc, char **argv)
{
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ); /* a test that dies has its name before it */
#else
int main(void)
{
    const int argc = 1;
    const char *const argv[] = {"tests"};
#endif
    unsigned passed = 0;
    unsigned failed = 0;
    for (size_t i = 0; i < sizeof group / sizeof group[0]; i++) {
        int wanted = argc == 1;
        for (int a = 1; a < argc; a++) { wanted |= of_folder(group[i].name, argv[a]); }
        if (!wanted) { continue; }
        check_line("group: %s", group[i].name);
        if (group[i].main() == 0) {
            passed++;
        } else {
            failed++;
        }
    }
    check_line("%u groups passed, %u failed", passed, failed);
    return failed != 0 || passed == 0;
}
