/* SPDX-License-Identifier: MIT */
/* exhand-lab certificate: it goes on behind what is in its file, and says what does not hold. */
#include "lab/lab.h"
#include "said.h"

#include "lab/certificate/one.h"

#include <stdio.h>

static struct said s;

/* A device as a line of the file: of its eleven values so many are outside of their intervals. */
static void put(FILE *f, int device, int outside, int unstable, int covered, double device_s)
{
    fprintf(f, "7,2000,4,%d,0,1,1,24,0,%d,12,1,1,0.5,%g,0.3,12,%d,11,%d,10,%d", device, unstable,
        device_s, covered, covered, covered);
    for (int p = 0; p < ONE_VALUES; p++) { fprintf(f, ",%d,1,0.9,1.1", p < outside ? 2 : 1); }
    fprintf(f, "\n");
}

/* 20 devices, of whose 240 values twelve are outside. */
static void certify(const char *dir, int more_outside, int unstable, int covered, double device_s)
{
    char path[300];
    FILE *f;
    snprintf(path, sizeof path, "%s/devices.csv", dir);
    f = fopen(path, "w");
    CHECK(f != NULL, "%s", path);
    put(f, 0, 2 + more_outside, unstable, covered, device_s);
    for (int i = 1; i < 20; i++) { put(f, i, i % 2, 0, covered, 40); }
    fclose(f);
    said(&s, dir, cli_certificate,
        WORDS("certificate", "--devices", "20", "--seed", "7", "--grid", "4", "--results", path));
}

TEST(what_holds_is_said)
{
    char *dir = said_dir();
    certify(dir, 0, 0, 8, 40);
    CHECK(s.status == 0, "%d\n%s%s", s.status, s.out, s.err);
    CHECK(strstr(s.out, "| 95.0 % |"), "%s", s.out);
    CHECK(strstr(s.out, "| 73, 73; 67, 67 % |"), "%s", s.out);
    CHECK(strstr(s.out, "| 0 of 480 |") && strstr(s.out, "| 20 of 240 |"), "%s", s.out);
    said_clean(dir);
}

TEST(what_does_not_hold_fails)
{
    static const struct {
        int outside, unstable, covered;
        double device_s;
        const char *says;
    } row[] = {{9, 0, 8, 40, "| 93 .. 97 % | NOT |"}, {0, 1, 8, 40, "| 1 of 480 | 0 | NOT |"},
        {0, 0, 7, 40, "| 70 % | >= 80 % | NOT |"}, {0, 0, 4, 40, "| 40 % | >= 50 % | NOT |"},
        {0, 0, 8, 121, "| 121 s | <= 120 s | NOT |"}};
    char *dir = said_dir();
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        certify(dir, row[i].outside, row[i].unstable, row[i].covered, row[i].device_s);
        CHECK(s.status == 1 && strstr(s.out, row[i].says), "row %zu: %d\n%s%s", i, s.status, s.out,
            s.err);
    }
    said_clean(dir);
}

/* One device, at few rounds: worked out once, then read. */
TEST(it_goes_on)
{
    char *dir = said_dir(), path[300];
    static struct said first;
    snprintf(path, sizeof path, "%s/devices.csv", dir);
    for (int again = 0; again < 2; again++) {
        said(&s, dir, cli_certificate,
            WORDS("certificate", "--devices", "1", "--seed", "2", "--repeats", "4", "--grid", "3",
                "--results", path));
        CHECK((s.status == 0 || s.status == 1) && strstr(s.out, "of 1 random devices"), "%d\n%s%s",
            s.status, s.out, s.err);
        CHECK(strstr(s.out, "| 1; 1, 1 |") && strstr(s.out, "| 0 of "), "%s", s.out);
        if (again) { CHECK(strcmp(first.out, s.out) == 0, "%s%s", first.out, s.out); }
        first = s;
    }
    said_clean(dir);
}

TEST_MAIN("certificate", what_holds_is_said, what_does_not_hold_fails, it_goes_on);
