/* SPDX-License-Identifier: MIT */
/* Third-party recordings: --columns gives the places of sensors, time and label. */
#include "glove_said.h"

#include "base/cli.h"

#include <dirent.h>

static struct said s;
static const char *dir;
static char *csv;

#define RATE "--rate", "200"
#define REST "0.3,0.4,0.5,0.6,0.7,0.8,0.9,1,1.1,1.2,1.3,1.4,1.5,-0.1,-0.2,-0.3,-0.4,-0.5,-0.6,-0.7"

static void begin(void)
{
    dir = said_dir();
    csv = strdup(said_path(dir, "in.csv"));
}

static void end(void)
{
    free(csv);
    said_clean(dir);
}

/* The output of the two plain rows, to compare with other ways of reading them. */
static const char *plain(void)
{
    static char text[SAID_B];
    write_text(csv, ROW_A "\n" ROW_B "\n");
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, RATE));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    return strcpy(text, s.out);
}

static void says(const char *text, const char *columns)
{
    write_text(csv, text);
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, RATE, "--columns", columns));
}

/* The same 22 values behind and before other columns, by number and by name. */
TEST(sensors_are_where_the_columns_say)
{
#define NAMES "a-b,c d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,v,w,\"x\""
    static const struct {
        const char *head, *before, *behind, *columns;
    } row[] = {
        {"", "7720, ", "", "2-23"},
        {"", "7720,7.84,", ",0.5,-9e9,word", "3-24"},
        {"", "A,", "", "2-23"},
        {"t," NAMES ",y", ",", ",two words", "2-23"},
        {"t," NAMES ",y", "1,", ",2", "a-b,c d,e-w,x"},
        {NAMES, "", "", "1-22"},
        {NAMES, "", "", "a-b,c d,e-w,x"},
        {NAMES, "", "", "a-b-e,4,5,6-x"},
        {NAMES, "", "", "1,2-21,x"},
    };
    const char *want;
    begin();
    want = plain();
    for (size_t i = 0; i < LEN(row); i++) {
        char text[2000];
        snprintf(text, sizeof text, "%s\n%s" ROW_A "%s\n\r\n%s" ROW_B "%s\n", row[i].head,
            row[i].before, row[i].behind, row[i].before, row[i].behind);
        says(text, row[i].columns);
        CHECK(s.status == 0, "%zu: %d: %s", i, s.status, s.err);
        CHECK(strcmp(s.out, want) == 0, "%zu: %s", i, s.out);
    }
    end();
}

/* Blanks, semicolons and tabs; the order of the list is the order of the sensors. */
TEST(columns_go_with_every_separator_and_order)
{
    char text[2000] = "";
    const char *want;
    begin();
    want = plain();
    for (const char *sep = " ;\t"; *sep != '\0'; sep++) {
        snprintf(text, sizeof text, "9,%s,8\n9,%s,8\n", ROW_A, ROW_B);
        for (char *c = text; *c != '\0'; c++) { *c = *c == ',' ? *sep : *c; }
        says(text, "2-23");
        CHECK(s.status == 0 && strcmp(s.out, want) == 0, "'%c': %d: %s", *sep, s.status, s.err);
    }
    says("-0.7," ROW_A "\n-0.7," ROW_B "\n", "2-22,1");
    CHECK(s.status == 0 && strcmp(s.out, want) == 0, "%d: %s", s.status, s.err);
    says(ROW_A "\n" ROW_B "\n", "2,1,3-22");
    CHECK(s.status == 0 && strcmp(s.out, want) != 0, "%d: %s", s.status, s.err);
    CHECK(
        number_after(s.out, "\n0", 0) > 0.19 && number_after(s.out, "\n0", 1) < 0.11, "%s", s.out);
    end();
}

/* A word before the first row makes no header of it: no row is lost, nor shifted. */
TEST(no_row_is_lost_or_shifted)
{
    const char *want;
    begin();
    want = plain();
    says("A," ROW_A "\nB," ROW_B "\n", "2-23");
    CHECK(s.status == 0 && strcmp(s.out, want) == 0, "%d: %s%s", s.status, s.err, s.out);
    says("2014-09-12," ROW_A ",x\n2014-09-12," ROW_B ",x\n", "2-23");
    CHECK(s.status == 0 && strcmp(s.out, want) == 0, "%d: %s%s", s.status, s.err, s.out);
    says("1,2," ROW_A "\n1,2," ROW_B "\n1,2,3," ROW_B "\n", "3-24");
    CHECK(s.status == 2 && strstr(s.err, "line 3: 25 columns (24 in the first line)") != NULL,
        "%d: %s", s.status, s.err);
    write_text(csv, ",.2"
                    "," REST "\n,.2," REST "\n"); /* nothing where the first number is */
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, RATE));
    CHECK(s.status == 0 && strstr(s.err, "2 of 44 values are no number") != NULL, "%d: %s",
        s.status, s.err);
    CHECK(strstr(s.out, "\n0.005,") != NULL, "%s", s.out);
    end();
}

/* A text that is no number is a fault of its channel, not of one that depends on it. Three of four
 * frames make it one. */
TEST(no_number_is_no_fault_of_a_neighbour)
{
    static struct exh_glove_cal cal;
    uint8_t image[EXH_GLOVE_CAL_IMAGE_B];
    char *to;
    FILE *f;
    begin();
    to = strdup(said_path(dir, "user.glove"));
    cal = exh_glove_cal_default;
    cal.sensor[10].of[0] = 4;
    cal.sensor[10].cross_q30[0] = -(1 << 28);
    CHECK_EQ_I64(exh_glove_cal_save(&cal, image, sizeof image, NULL), EXH_GLOVE_CAL_IMAGE_B);
    f = fopen(to, "wb");
    CHECK(f != NULL && fwrite(image, 1, sizeof image, f) == sizeof image, "%s", to);
    CHECK_EQ_I64(fclose(f), 0);
#define BEFORE ".1,.2,.3,.4,"
#define BEHIND ",.6,.7,.8,.9,1,.3,1.2,1.3,1.4,.4,.6,.7,.8,.3,.2,.1,-.1\n"
    write_text(csv,
        BEFORE ".5" BEHIND BEFORE BEHIND BEFORE "inf" BEHIND BEFORE "nan" BEHIND BEFORE BEHIND);
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, RATE, "--calibration", to));
    CHECK(s.status == 0 && strstr(s.err, "4 of 110 values are no number") != NULL, "%s", s.err);
    CHECK(number_after(s.out, "\n0.01,", 22) == 0, "%s", s.out);
    CHECK(number_after(s.out, "\n0.015,", 22) == 1 << 4, "%s", s.out);
    CHECK(number_after(s.out, "\n0.02,", 22) == 1 << 4, "%s", s.out);
    for (int i = 0; i < SENSORS; i++) { /* nor of its angle: none moves */
        CHECK(number_after(s.out, "\n0.02,", i) == number_after(s.out, "\n0,", i), "column %d", i);
    }
    free(to);
    end();
}

/* The time of a column is in the output, from 0, and gives the rate. */
TEST(time_is_taken_from_its_column)
{
    static const struct {
        const char *columns, *at[3];
    } row[] = {
        {"4-25,time=3", {"0,0,7.5,", "0,0,7.505,", "0,0,7.51,"}},
        {"4-25,time_ms=1", {"65180,0,0,", "65185,0,0,", "65190,0,0,"}},
        {"4-25,time_us=2", {"0,-5000,0,", "0,0,0,", "0,5e3,0,"}},
        {"4-25,clock=1-3", {"23,59,59.995,", "0,0,0,", "0,0,0.005,"}},
    };
    char text[2000], want[SAID_B];
    begin();
    write_text(csv, ROW_A "\n" ROW_B "\n" ROW_A "\n");
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, RATE));
    strcpy(want, s.out);
    for (size_t i = 0; i < LEN(row); i++) {
        snprintf(text, sizeof text, "%s" ROW_A "\n%s" ROW_B "\n%s" ROW_A "\n", row[i].at[0],
            row[i].at[1], row[i].at[2]);
        write_text(csv, text);
        said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--columns", row[i].columns));
        CHECK(s.status == 0 && s.err[0] == '\0', "%zu: %d: %s", i, s.status, s.err);
        CHECK(strcmp(s.out, want) == 0, "%zu: %s", i, s.out);
    }
    end();
}

/* Steps that are not even are said, and times stay as they are. */
TEST(uneven_time_is_said)
{
    begin();
    write_text(csv, "1," ROW_A "\n1.01," ROW_B "\n1.02," ROW_B "\n1.07," ROW_B "\n");
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--columns", "time=1,2-23"));
    CHECK(s.status == 0 && strstr(s.out, "\n0.07,") != NULL, "%d: %s", s.status, s.out);
    CHECK(strstr(s.err, "in.csv: 1 of 3 steps of time are longer than 1.5 of the mean") != NULL,
        "%s", s.err);
    CHECK(strstr(s.err, "42.8571 Hz") != NULL, "%s", s.err);
    end();
}

/* A label is at the end of its row, also if it is a number. */
TEST(labels_stand_in_the_answer)
{
    char text[2000], want[SAID_B], *line;
    begin();
    strcpy(want, plain());
    says(ROW_A ",A\n" ROW_B ",two words\n", "1-22,label=23");
    CHECK(s.status == 0 && strstr(s.out, ",label\n") != NULL, "%d: %s", s.status, s.err);
    CHECK(strstr(s.out, ",0,A\n") != NULL && strstr(s.out, ",0,two words\n") != NULL, "%s", s.out);
    says("7," ROW_A ",1\n-7," ROW_B ",2\n", "2-23,label=1");
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    text[0] = '\0';
    for (int n = 0; n < 3; n++) { /* all else is as without */
        line = strtok(n == 0 ? want : NULL, "\n");
        sprintf(text + strlen(text), "%s%s\n", line, n == 0 ? ",label" : n == 1 ? ",7" : ",-7");
    }
    CHECK(strcmp(s.out, text) == 0, "%s", s.out);
    end();
}

TEST(bad_columns_are_refused_by_name)
{
    static const struct {
        const char *text, *columns, *why;
    } row[] = {
        {ROW_A "\n", "1-21", "21 sensors: give 22"},
        {ROW_A "\n", "1-23", "too many columns"},
        {ROW_A "\n", "22-1", "22-1: a range rises"},
        {ROW_A "\n", "1-21,21", "21: a column in use already"},
        {ROW_A "\n", "1-22,time=5", "time=5: a column in use already"},
        {ROW_A "\n", "1-22,", "no such column"},
        {ROW_A "\n", "0-21", "0-21: no such column"},
        {ROW_A "\n", "1-300", "no such column"},
        {ROW_A "\n", "thumb,2-22", "thumb: no such column"},
        {ROW_A "\n", "1-22,clock=23-24", "its three columns"},
        {ROW_A "\n", "2-23", "line 1: 22 columns (23 wanted)"},
        {"1," ROW_A "\n1," ROW_A ",3\n", "2-23", "line 2: 24 columns (23 in the first line)"},
        {"1," ROW_A "\n1,x" ROW_A "\n", "2-23", "line 2, column 2: \"x0.1\" is no number"},
        {"1," ROW_A "\nx," ROW_A "\n", "2-23,time=1", "line 2, column 1: \"x\" is no number"},
        {"1," ROW_A "\n1," ROW_A "\n", "2-23,time=1", "line 2: its clock stands or jumps"},
        {"2," ROW_A "\n1," ROW_A "\n", "2-23,time=1", "line 2: its clock stands or jumps"},
        {"1," ROW_A "\n20," ROW_A "\n", "2-23,time=1", "line 2: its clock stands or jumps"},
        {ROW_A ",12345678901234567890123456789012\n", "1-22,label=23", "column 23: a label of"},
        {"1,x" ROW_A "\n", "2-23", "line 1, column 2: \"x0.1\" is no number"},
    };
    begin();
    for (size_t i = 0; i < LEN(row); i++) {
        says(row[i].text, row[i].columns);
        CHECK(s.status == 2 && s.out[0] == '\0', "%zu: %d: %s", i, s.status, s.out);
        CHECK(strstr(s.err, row[i].why) != NULL, "%zu: %s", i, s.err);
    }
    write_text(csv, "1," ROW_A "\n5," ROW_B "\n");
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--columns", "2-23,time=1"));
    CHECK(s.status == 2 && strstr(s.err, "0.25 rows a second") != NULL, "%s", s.err);
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--columns", "2-23"));
    CHECK(s.status == 2 && strstr(s.err, "--rate HZ says") != NULL, "%s", s.err);
    said(&s, dir, cli_glove, WORDS("glove", "--record", csv, "--columns", "2-23"));
    CHECK(s.status == 2 && strstr(s.err, "--columns, --scale: of the rows") != NULL, "%s", s.err);
    end();
}

/* --play does at 200 Hz of recorded time what it does at 200 Hz of plain rows; codes have none. */
TEST(a_played_recording_has_columns_too)
{
    static char log[2][65536];
    size_t n[2] = {0, 0};
    char *to;
    begin();
    to = strdup(said_path(dir, "log.exh"));
    for (int timed = 0; timed < 2; timed++) {
        FILE *f;
        write_text(csv, timed ? "5," ROW_A "\n5.005," ROW_B "\n" : ROW_A "\n" ROW_B "\n");
        said(&s, dir, cli_glove,
            WORDS("glove", "--record", to, "--play", csv, RATE, timed ? "--columns" : NULL,
                "2-23,time=1"));
        CHECK(s.status == 0, "%d: %s", s.status, s.err);
        f = fopen(to, "rb");
        CHECK(f != NULL, "%s", to);
        n[timed] = fread(log[timed], 1, sizeof log[timed], f);
        CHECK_EQ_I64(fclose(f), 0);
    }
    CHECK(n[0] == n[1] && n[0] > 1000 && memcmp(log[0], log[1], n[0]) == 0, "%zu, %zu", n[0], n[1]);
    write_text(csv, "1,10," ROW_A "\n"); /* ten is no angle */
    said(&s, dir, cli_glove,
        WORDS(
            "glove", "--record", to, "--play", csv, "--unit", "codes", "--columns", "3-24,time=1"));
    CHECK(s.status == 2 && strstr(s.err, "codes are whole") != NULL, "%s", s.err);
    write_text(csv, "1,1,2,3,4,5,6,7,8,9,1,2,3,4,5,6,7,8,9,1,2,3,4\n");
    said(&s, dir, cli_glove,
        WORDS("glove", "--record", to, "--play", csv, "--columns", "2-23,time=1"));
    CHECK(s.status == 2 && strstr(s.err, "a row a scan") != NULL, "%s", s.err);
    write_text(csv,
        ",1,2,3,4,5,6,7,8,9,1,2,3,4,5,6,7,8,9,1,2,3\n\n,1,2,3,4,5,6,7,8,9,1,2,3,4,5,6,7,8,"
        "9,1,2,3\n");
    said(&s, dir, cli_glove, WORDS("glove", "--record", to, "--play", csv));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    for (int k = 0; k < 2; k++) { /* each is said, and once */
        const char *word = k ? "1 empty lines" : "2 of 44 values", *at = strstr(s.err, word);
        CHECK(at != NULL && strstr(at + 1, word) == NULL, "%s", s.err);
    }
    free(to);
    end();
}

/* --- the recordings themselves, by the lines of docs/EXPERIMENTS.md --- */

/* A command of the document with one file: every row of it comes out, at its time. */
static void open_by(const char *command, const char *file)
{
    static char words[600], line[4096], last[4096];
    const char *word[30];
    int n = 0, columns = 0;
    long rows = 0, lines = 0;
    FILE *f;
    snprintf(words, sizeof words, "%s", command);
    for (char *at = strtok(words, " "); at != NULL && n < 29; at = strtok(NULL, " ")) {
        word[n++] = strcmp(at, "FILE") == 0 ? file : at;
    }
    word[n] = NULL;
    said(&s, dir, cli_glove, word + 1);
    CHECK(s.status == 0, "%s %s: %d: %s", command, file, s.status, s.err);
    f = fopen(file, "rb");
    CHECK(f != NULL, "%s", file);
    for (int c = getc(f), before = '\n'; c != EOF; before = c, c = getc(f)) {
        rows += before == '\n' || before == '\r'; /* none of them ends in both */
    }
    CHECK_EQ_I64(fclose(f), 0);
    f = fopen(said_path(dir, "said.out"), "r");
    CHECK(f != NULL, "no answer");
    for (; fgets(line, sizeof line, f) != NULL; lines++) { strcpy(last, line); }
    CHECK_EQ_I64(fclose(f), 0);
    for (const char *c = last; *c != '\0'; c++) { columns += *c == ','; }
    CHECK(columns == 23 + (strstr(command, "label=") != NULL), "%s: %d columns", file, columns);
    CHECK(lines == rows + (strstr(command, "S01") == NULL), "%s: %ld of %ld", file, lines, rows);
    check_note("%s: %ld rows, to %.9g s", strrchr(file, '/') + 1, lines - 1, strtod(last, NULL));
}

/* All recordings of a folder: those that are there. */
static int open_folder(const char *folder, const char *command)
{
    const char *data = getenv("EXH_DATA") ? getenv("EXH_DATA") : "$EXH_DATA";
    char path[512];
    struct dirent *e;
    int files = 0;
    DIR *d;
    snprintf(path, sizeof path, "%s/%s", data, folder);
    d = opendir(path);
    if (d == NULL) {
        check_note("%s: not there: nothing of it is tested; EXH_DATA names the place", path);
        return 0;
    }
    while ((e = readdir(d)) != NULL) {
        const char *end = strrchr(e->d_name, '.');
        char file[800];
        if (end == NULL || (strcmp(end, ".txt") != 0 && strcmp(end, ".csv") != 0)) { continue; }
        snprintf(file, sizeof file, "%s/%s", path, e->d_name);
        open_by(command, file);
        files++;
    }
    closedir(d);
    return files;
}

TEST(documented_commands_open_the_recordings)
{
    static char line[4096], folder[100], command[600];
    FILE *f = fopen("docs/EXPERIMENTS.md", "r");
    int rows = 0, files = 0;
    begin();
    CHECK(f != NULL, "docs/EXPERIMENTS.md");
    while (fgets(line, sizeof line, f) != NULL) {
        const char *at = strstr(line, "| `exhand glove --csv FILE");
        if (at == NULL || sscanf(line, "| `%99[^`]`", folder) != 1 ||
            sscanf(at, "| `%599[^`]`", command) != 1) {
            continue;
        }
        files += open_folder(folder, command);
        rows++;
    }
    CHECK_EQ_I64(fclose(f), 0);
    CHECK_EQ_I64(rows, 3);
    CHECK(files == 0 || files == 6, "%d files", files);
    end();
}

TEST_MAIN("sim/glove_columns", sensors_are_where_the_columns_say,
    columns_go_with_every_separator_and_order, no_row_is_lost_or_shifted,
    no_number_is_no_fault_of_a_neighbour, time_is_taken_from_its_column, uneven_time_is_said,
    labels_stand_in_the_answer, bad_columns_are_refused_by_name, a_played_recording_has_columns_too,
    documented_commands_open_the_recordings);
