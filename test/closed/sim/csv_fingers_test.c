/* SPDX-License-Identifier: MIT */
/* exhand csv of a log of several fingers: whose columns there are, and what they are called. */
#include "said.h"

#include "base/columns.h"
#include "bilateral/bilateral.h"

#define NINE "t_s,q_m,qd_m_per_s,f_des_n,i_des_a,c,f_mon_n,d_m,q_lim_m"

static char *whole_file(const char *path)
{
    const long len_B = said_size(path);
    FILE *f = fopen(path, "r");
    char *text = calloc(1, (size_t)len_B + 1);
    CHECK(f != NULL && text != NULL, "%s", path);
    CHECK_EQ_I64((int64_t)fread(text, 1, (size_t)len_B, f), len_B);
    fclose(f);
    return text;
}

/* Two fingers touch, the thumb is not in use: DIR/bilateral_natural.exh, and a CSV of each. */
static const char *log_of_two_fingers(char *dir)
{
    static struct said s;
    said(&s, dir, cli_bilateral,
        WORDS("bilateral", "--speed", "natural", "--approaches", "1", "--fingers", "index,ring",
            "--out", dir));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    return said_path(dir, "bilateral_natural.exh");
}

/* The table of the experiment itself is the same finger's, digit by digit; where it has no plane
 * and no contact, too. */
TEST(csv_of_a_finger_is_the_experiments_own)
{
    static const char *const finger[] = {"index", "ring"};
    char *dir = said_dir(), log[512];
    static struct said s;
    strcpy(log, log_of_two_fingers(dir));
    for (size_t i = 0; i < LEN(finger); i++) {
        char name[64], *own, *made;
        snprintf(name, sizeof name, "bilateral_natural_%s.csv", finger[i]);
        said(&s, dir, cli_csv,
            WORDS("csv", log, "--finger", finger[i], "--out", said_path(dir, "f.csv")));
        CHECK(s.status == 0, "%d: %s", s.status, s.err);
        own = whole_file(said_path(dir, name));
        made = whole_file(said_path(dir, "f.csv"));
        CHECK(strncmp(made, NINE "\n", sizeof NINE) == 0, "%.99s", made);
        CHECK(strcmp(own, made) == 0 && strstr(made, ",,\n"), "%s: %.999s", finger[i], made);
        free(own);
        free(made);
    }
    said_clean(dir);
}

/* Names of columns in the first line; none is there twice. */
static long different_names(char *text)
{
    char *name[COLUMNS_MAX];
    long n = 0;
    text[strcspn(text, "\n")] = '\0';
    for (char *at = strtok(text, ","); at; at = strtok(NULL, ",")) {
        for (long k = 0; k < n; k++) { CHECK(strcmp(name[k], at) != 0, "%s is there twice", at); }
        CHECK(n < COLUMNS_MAX, "more columns than there is room for");
        name[n++] = at;
    }
    return n;
}

TEST(no_two_columns_have_one_name)
{
    const struct {
        const char *option, *more, *has, *has_not;
        uint32_t columns;
    } row[] = {
        {NULL, NULL, ",q_m_index,", "thumb", 1 + 2 * 8}, /* those in use */
        {"--all", NULL, ",q_lim_m_little,", ",q_m,",
            1 + exh_signal_count(exh_scene_bilateral.signals) + EXH_GLOVE_SENSORS},
        {"--finger", "ring", ",q_m,", "_ring", 9},
    };
    char *dir = said_dir(), log[512];
    static struct said s;
    strcpy(log, log_of_two_fingers(dir));
    for (size_t i = 0; i < LEN(row); i++) {
        const char *to = said_path(dir, "f.csv");
        char *text;
        said(&s, dir, cli_csv, WORDS("csv", "--out", to, log, row[i].option, row[i].more));
        CHECK(s.status == 0, "row %zu: %d: %s", i, s.status, s.err);
        text = whole_file(to);
        text[strcspn(text, "\n")] = '\0';
        CHECK(strstr(text, row[i].has) && !strstr(text, row[i].has_not), "row %zu: %s", i, text);
        CHECK_EQ_I64(different_names(text), row[i].columns);
        free(text);
    }
    said_clean(dir);
}

TEST(a_finger_that_there_is_not_is_refused)
{
    static const struct {
        const char *log, *finger, *says;
    } row[] = {
        {"bilateral_natural.exh", "thumb", "thumb is not in use: give one of index+ring"},
        {"bilateral_natural.exh", "nose", "nose: give thumb, index"},
        {"drop_500Hz.exh", "index", "the scene drop has no fingers to choose from"},
    };
    char *dir = said_dir();
    static struct said s;
    said(&s, dir, cli_drop, WORDS("drop", "--rate", "500", "--falls", "1", "--out", dir));
    CHECK(s.status == 0, "%s", s.err);
    (void)log_of_two_fingers(dir);
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, cli_csv, WORDS("csv", said_path(dir, row[i].log), "--finger", row[i].finger));
        CHECK(s.status == 2 && strstr(s.err, row[i].says) && s.out[0] == '\0', "row %zu: %d: %s", i,
            s.status, s.err);
    }
    said_clean(dir);
}

TEST_MAIN("csv_fingers", csv_of_a_finger_is_the_experiments_own, no_two_columns_have_one_name,
    a_finger_that_there_is_not_is_refused);
