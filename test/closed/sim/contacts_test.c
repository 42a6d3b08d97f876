/* SPDX-License-Identifier: MIT */
/* A slice of `make contacts`: every scene by every finger at natural speed over a bad link. The
 * command must report a missed contact. */
#include "check.h"

#include "said.h"

#include "lab/lab.h"

static struct said s;

TEST(nothing_is_missed_over_a_bad_link_and_all_is_where_it_is)
{
    char *dir = said_dir();
    const char *row;
    int mesh, tries = 0, felt = 0, missed = 0, around, late, nothing, stood, of, same, froze;
    double median_mm = 0, most_mm = 0, worst_mm = 0;
    said(&s, dir, lab_bilateral,
        WORDS("bilateral", "--contacts", "1", "--speed", "natural", "--jobs", "2", "--link",
            "delay=0.05,jitter=0.03,loss=0.3"));
    mesh =
        strstr(s.err, "libembree-dev") == NULL; /* without it the mesh's scene is named, no more */
    CHECK(mesh ? s.status == 0 : s.status == 1 && strstr(s.err, " 1 runs not done, 0 ended"),
        "%d: %s", s.status, s.err);
    row = strstr(s.out, "| natural |");
    CHECK(row && sscanf(row,
                     "| natural | %d | %d | %d | %d | %d | %d | %d/%d | %d/%d | %lf | %lf | "
                     "%lf",
                     &tries, &felt, &missed, &around, &late, &nothing, &stood, &of, &same, &froze,
                     &median_mm, &most_mm, &worst_mm) == 13,
        "no row: %s", s.out);
    CHECK(tries == (mesh ? 50 : 40) && felt >= tries - 6 && missed == 0 && nothing == 0,
        "%d tries, %d felt, %d missed", tries, felt, missed);
    CHECK(stood == of && of >= 5, "%d of %d stood", stood, of);
    CHECK(median_mm > 0.2 && median_mm < 1.5 && most_mm < 3, "median %g mm, 95 %% within %g",
        median_mm, most_mm);
    check_note("%d contacts over 50 +- 30 ms with 30 %% lost: 0 missed, place %.2f mm off in the "
               "median, %.2f at worst",
        felt, median_mm, worst_mm);
    said_clean(dir);
}

/* The first approach is over before the first plane can be there. */
TEST(what_is_missed_is_told)
{
    char *dir = said_dir();
    said(&s, dir, lab_bilateral,
        WORDS("bilateral", "--contacts", "1", "--speed", "natural", "--jobs", "2", "--link",
            "delay=0.6"));
    CHECK(s.status == 1 && strstr(s.err, " contacts missed, "), "%d: %s", s.status, s.err);
    said_clean(dir);
}

TEST_MAIN("sim/contacts", nothing_is_missed_over_a_bad_link_and_all_is_where_it_is,
    what_is_missed_is_told);
