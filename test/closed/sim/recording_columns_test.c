/* SPDX-License-Identifier: MIT */
/* exhand glove --csv: recordings of other programs. Their sensors are among other columns, the
 * numbers are no codes, and some are no numbers. */
#include "said.h"
#include "lab/lab.h"

#include <math.h>
#include <stdlib.h>

#define SENSORS 22
#define V7      ".11,.12,.13,.14,.15,.16,.17"
#define V15     ".18,.19,.2,.21,.22,.23,.24,.25,.26,.27,.28,.29,.3,.31,.32"
#define V       V7 "," V15
#define NAMES   "a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,v"

static struct said s;
static char plain[SAID_B];

static const char *glove(const char *dir, const char *text, const char *option, const char *value)
{
    const char *csv = said_path(dir, "in.csv");
    FILE *f = fopen(csv, "wb");
    (void)fputs(text, f);
    (void)fclose(f);
    said(&s, dir, lab_glove, WORDS("glove", "--csv", csv, "--rate", "200", option, value));
    return s.out;
}

TEST(columns_stand_anywhere)
{
    static const struct {
        const char *text, *columns;
    } row[] = {
        {"7720, 7.849," V ",-9,abc,3.25\n", "3-24"},
        {"1 2 " V7 " x " V15 " 1 2\n", "3-9,11-25"},
        {"stamp," NAMES ",label\n2014-09-12," V ",5\n", NAMES},
        {"stamp," NAMES ",label\n2014-09-12," V ",5\n", "a,b,c,5-23"},
        {"label," V "\n9," V, "2-23"},
    };
    char *dir = said_dir();
    strcpy(plain, glove(dir, V "\n", "--unit", "rad"));
    CHECK(s.status == 0 && strchr(plain, '\n'), "%s", s.err);
    for (size_t i = 0; i < LEN(row); i++) {
        char text[600];
        strcpy(text, row[i].text);
        for (char *p = text; i == 1 && *p; p++) {
            if (*p == ',') { *p = ' '; }
        }
        glove(dir, text, "--columns", row[i].columns);
        CHECK(s.status == 0 && strncmp(s.out, plain, strlen(plain)) == 0, "%zu: %d %s\n%s%s", i,
            s.status, s.err, s.out, plain);
    }
    said_clean(dir);
}

TEST(columns_that_cannot_be_are_refused)
{
    static const struct {
        const char *text, *option, *value, *says;
    } row[] = {
        {V "\n", "--columns", "1-21", "in.csv: columns: 1-21: 21 sensors: give 22"},
        {V "\n", "--columns", "1-23", "columns: 1-23: too many columns for that"},
        {V "\n", "--columns", "0-21", "columns: 0-21: no such column"},
        {V "\n", "--columns", "22-1", "columns: 22-1: a range rises"},
        {V "\n", "--columns", "1-22,", "columns: : no such column"},
        {V "\n", "--columns", "2-23", "line 1: 22 columns (23 wanted)"},
        {V "\n", "--columns", "1-21,wrist", "columns: wrist: no such column"},
        {NAMES "\n" V "\n", "--columns", "1-21,wrist", "columns: wrist: no such column"},
        {"1,x" V "\n", "--columns", "2-23", "column 2: \"x.11\" is no number"},
        {V "\n", "--scale", "0", "--scale: 0: give A or A,B"},
        {V "\n", "--scale", "2,3,4", "--scale: 2,3,4: give"},
        {V "\n", "--scale", "2e5", "codes are whole numbers -32768..32767"},
    };
    char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        glove(dir, row[i].text, row[i].option, row[i].value);
        CHECK(s.status == 2 && strstr(s.err, row[i].says) && s.out[0] == '\0', "%zu: %d %s", i,
            s.status, s.err);
    }
    said_clean(dir);
}

/* Codes of 8 bits and fractions of them become the corresponding codes of 16 bits. */
TEST(a_scale_makes_codes)
{
    char *dir = said_dir();
    char eight[400] = "", sixteen[400] = "";
    for (int i = 0; i < SENSORS; i++) {
        const double v = 90.5 + 3 * i;
        (void)snprintf(eight + strlen(eight), 20, "%s%g", i ? "," : "", v);
        (void)snprintf(sixteen + strlen(sixteen), 20, "%s%g", i ? "," : "", 256 * v - 32768);
    }
    strcat(eight, "\n");
    strcat(sixteen, "\n");
    strcpy(plain, glove(dir, sixteen, "--unit", "codes"));
    CHECK(s.status == 0 && strstr(plain, "\n0,"), "%s", s.err);
    glove(dir, eight, "--scale", "256,-32768");
    CHECK(s.status == 0 && strcmp(s.out, plain) == 0, "%d %s\n%s%s", s.status, s.err, s.out, plain);
    said_clean(dir);
}

/* Cell n of row n of the output. */
static double cell(const char *out, int line, int column)
{
    const char *p = out;
    for (int i = 0; i < line && p; i++) { p = strchr(p, '\n'), p = p ? p + 1 : NULL; }
    for (int i = 0; i < column && p; i++) { p = strchr(p, ','), p = p ? p + 1 : NULL; }
    return p ? atof(p) : (double)NAN;
}

/* One is nothing but that channel's: it holds. Three in a row are its fault. All others go on. */
TEST(what_is_no_number_is_its_channels_fault)
{
    static const char *const none[] = {"nan", "inf", "", "-NaN"};
    char *dir = said_dir();
    for (size_t k = 0; k < LEN(none); k++) {
        char text[4000] = "";
        for (int n = 0; n < 12; n++) {
            const int gone = n == 3 || (n >= 6 && n <= 8);
            (void)snprintf(text + strlen(text), 300, "%s,.12,%s\n", gone ? none[k] : ".11",
                strchr(strchr(V, ',') + 1, ',') + 1);
        }
        glove(dir, text, "--unit", "rad");
        CHECK(s.status == 0 && strstr(s.err, "4 of 264 values are no number"), "%s: %d %s", none[k],
            s.status, s.err);
        for (int n = 1; n <= 12; n++) {
            const long fault = (long)cell(s.out, n, 1 + SENSORS);
            CHECK(fabs(cell(s.out, n, 1) - 0.11) < 0.01, "row %d: %g", n, cell(s.out, n, 1));
            CHECK(fabs(cell(s.out, n, 2) - 0.12) < 0.01, "row %d: %g", n, cell(s.out, n, 2));
            CHECK((n - 1 < 8 || n - 1 > 10) == (fault == 0), "row %d: faults %ld", n, fault);
            CHECK(fault == 0 || fault == 1, "row %d: faults %ld", n, fault);
        }
    }
    said_clean(dir);
}

TEST_MAIN("sim/recording_columns", columns_stand_anywhere, columns_that_cannot_be_are_refused,
    a_scale_makes_codes, what_is_no_number_is_its_channels_fault);
