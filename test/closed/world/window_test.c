/* SPDX-License-Identifier: MIT */
/* The window and its keys, on a separate screen (Xvfb), pressed as a user does (xdotool). The
 * program leaves a draw list, which has the picture. */
#include "check.h"

#include "world/draw.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *dir;
static struct v3 palm, tip[FINGERS]; /* as the last run left them */

/* The exit status of the program; 77: there can be no window here. */
static int run(const char *keys)
{
    char line[300];
    int status = 77;
    FILE *f;
    snprintf(line, sizeof line, "test/closed/world/window.sh %s %s %s", WORLD_PROGRAM, dir, keys);
    f = popen(line, "r");
    CHECK(f != NULL, "no shell");
    if (fgets(line, sizeof line, f)) { status = atoi(line); }
    (void)pclose(f);
    return status;
}

/* Whether a text like this was on the screen; where things were. */
static int showed(const char *what)
{
    char path[300], line[300];
    int found = 0, palms = 0;
    FILE *f;
    snprintf(path, sizeof path, "%s/list", dir);
    f = fopen(path, "r");
    CHECK(f != NULL, "%s", path);
    while (fgets(line, sizeof line, f)) {
        int kind, thing, which;
        struct v3 at;
        found |= strncmp(line, "text", 4) == 0 && strstr(line, what) != NULL;
        if (sscanf(line, "item %d %d %d %lf %lf %lf", &kind, &thing, &which, &at.x, &at.y, &at.z) !=
            6) {
            continue;
        }
        if (thing != DRAW_HAND) { continue; }
        if (which < 0 && palms++ == 0) { palm = at; }
        if (which >= 0) { tip[which] = at; } /* the last link's comes last */
    }
    (void)fclose(f);
    return found;
}

TEST(keys_bend_carry_pause_help_and_leave)
{
    char made[] = "/tmp/exhand-window-XXXXXX", line[100];
    struct v3 palm_before, tip_before[FINGERS];
    int status;
    dir = mkdtemp(made);
    CHECK(dir != NULL, "no directory in /tmp");
    status = run("");
    if (status == 77 || status == 3) {
        check_note(
            "not tried: %s", status == 3 ? "built without pictures" : "install xvfb and xdotool");
    } else {
        CHECK_EQ_I64(status, 0);
        CHECK(showed("Collision with simple bodies") && showed(" frames/s, ") && showed("no link"),
            "what is always there");
        CHECK(!showed("paused") && !showed("turn the view"), "what no key asked for");
        palm_before = palm;
        memcpy(tip_before, tip, sizeof tip);
        CHECK_EQ_I64(run("3 3 3 w w w h space"), 0);
        CHECK(showed("paused") && showed("turn the view"), "space, h");
        CHECK(fabs(palm.y - palm_before.y - 0.012) < 2e-6 && fabs(palm.x - palm_before.x) < 2e-6,
            "w: %g m to y", palm.y - palm_before.y);
        for (int f = 0; f < FINGERS; f++) {
            const struct v3 way = v3_sub(v3_sub(tip[f], tip_before[f]), v3_sub(palm, palm_before));
            CHECK((v3_len(way) > 0.01) == (f == 2),
                "3 bends the middle alone, not finger %d by %g m", f, v3_len(way));
        }
    }
    snprintf(line, sizeof line, "rm -r %s", dir);
    CHECK_EQ_I64(system(line), 0);
}

TEST_MAIN("world: the window", keys_bend_carry_pause_help_and_leave);
