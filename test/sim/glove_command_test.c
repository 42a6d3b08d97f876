/* exhand glove as people use and misuse it: Table I within bounds on both sides, recordings
 * of every shape, bad ones refused by name, and logs that replay bit for bit. */
#include "said.h"

#include "cli/logfile.h"

#include "glove/glove.h"
#include "log.h"
#include "sim/operator.h"

#include "exhand/record.h"

#include <signal.h>
#include <time.h>

#define LEN(a)  (sizeof(a) / sizeof((a)[0]))
#define SENSORS EXH_GLOVE_SENSORS

static struct said s;

static double size_of(double v)
{
    return v < 0 ? -v : v;
}

/* Column i of the last line of a CSV file. */
static double last_value(const char *path, int column)
{
    static char text[4096];
    FILE *f = fopen(path, "r");
    char *at;
    double v = -1e9;
    size_t n;
    CHECK(f != NULL && fseek(f, -4000, SEEK_END) == 0, "%s", path);
    n = fread(text, 1, sizeof text - 1, f);
    fclose(f);
    text[n] = '\0';
    if (n > 0) { text[n - 1] = '\0'; }
    at = strrchr(text, '\n');
    CHECK(at != NULL, "%s: one line", path);
    for (int i = 0; at && i <= column; i++) { v = strtod(at + 1, &at); }
    return v;
}

static void write_text(const char *path, const char *text)
{
    FILE *f = fopen(path, "wb");
    CHECK(f != NULL && fputs(text, f) >= 0, "%s", path);
    CHECK_EQ_I64(fclose(f), 0);
}

/* The number after the first `word` of a text, or at its n-th column behind it. */
static double number_after(const char *text, const char *word, int column)
{
    const char *at = strstr(text, word);
    char *end;
    double v = -1e9;
    CHECK(at != NULL, "no \"%s\" in %s", word, text);
    at = at ? at + strlen(word) : "";
    for (int n = 0; n <= column; n++) {
        while (*at == ' ' || *at == ',') { at++; }
        v = strtod(at, &end);
        at = end;
    }
    return v;
}

/* ---- Table I ------------------------------------------------------------------------ */

TEST(the_selftest_gives_the_papers_rows)
{
    static const char *const seed[] = {"1", "2", "3", "77"};
    static const char *const rate[] = {"2000", "90", "20000"};
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(seed) * LEN(rate); i++) {
        double pp;
        said(&s, dir, cli_glove,
             WORDS("glove", "--selftest", "--seed", seed[i % LEN(seed)], "--rate",
                   rate[i / LEN(seed)], "--seconds", i / LEN(seed) == 2 ? "2" : "30"));
        CHECK(s.status == 0, "status %d: %s%s", s.status, s.err, s.out);
        pp = number_after(s.out, "joint angle     ", 0);
        CHECK(pp >= 5.79 && pp <= 6.42, "%g mV", pp); /* a code either side of 6.1 */
        pp = number_after(s.out, "motor position  ", 0);
        CHECK(pp > 66.31 && pp < 66.33, "%g um", pp);
        pp = number_after(s.out, "motor current   ", 0);
        CHECK(pp > 35 && pp < 47.8, "%g mA", pp); /* its bound, and a code */
        CHECK(strstr(s.out, "20 V                         11   6.1 mV            11\n") != NULL, "%s", s.out);
        CHECK(strstr(s.out, " 9   1 encoder step     9\n") != NULL, "%s", s.out);
        CHECK(strstr(s.out, " 7   47.2 mA            7\n") != NULL, "%s", s.out);
        CHECK(strstr(s.out, "changes of its 22 angles 0\n") != NULL, "%s", s.out);
    }
    said_clean(dir);
}

/* Of white noise at 2 kHz a second-order low-pass at fc lets through a share of
 * sqrt(1.11 fc / 1000), and it is sqrt(2) / (2 pi fc) late. */
TEST(a_low_pass_gives_bits_for_delay)
{
    static const struct {
        const char *fc;
        double rms, delay_ms;
        int bits_lo, bits_hi;
    } row[] = {{"\n       300", 0.577, 0.7503, 12, 12}, {"\n       100", 0.333, 2.2508, 12, 13},
               {"\n        30", 0.182, 7.5026, 13, 14},  {"\n        10", 0.105, 22.508, 14, 15},
               {"\n         3", 0.0577, 75.026, 15, 16}};
    const char *dir = said_dir();
    said(&s, dir, cli_glove, WORDS("glove", "--selftest", "--seconds", "30"));
    for (size_t i = 0; i < LEN(row); i++) {
        const double pp = number_after(s.out, row[i].fc, 0);
        const double delay = number_after(strstr(s.out, row[i].fc), "mV", 1);
        const int bits = (int)number_after(strstr(s.out, row[i].fc), "mV", 0);
        /* 3 deviations of white noise become 4 of normal noise, correlated: fewer chances */
        CHECK(pp > 5.2 * row[i].rms && pp < 9.5 * row[i].rms, "%s: %g mV", row[i].fc, pp);
        CHECK(bits >= row[i].bits_lo && bits <= row[i].bits_hi, "%s: %d bits", row[i].fc, bits);
        CHECK(delay > row[i].delay_ms - 0.08 && delay < row[i].delay_ms + 0.02, "%s: %g ms", row[i].fc,
              delay);
    }
    CHECK(strstr(s.out, "\n      none") != NULL, "%s", s.out);
    CHECK(number_after(strstr(s.out, "\n      none"), "ms", 0) > 1000, "a quantizer alone flips");
    CHECK(number_after(strstr(s.out, "\n      none"), "ms", 1) == 0, "with hysteresis it does not");
    said_clean(dir);
}

TEST(too_much_noise_falls_short)
{
    static const struct {
        const char *device, *row;
    } row[] = {{"noise=0.0125", "joint angle"}, {"mon_noise=0.12", "motor current"}};
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        const char *at;
        said(&s, dir, cli_glove, WORDS("glove", "--selftest", "--device", row[i].device));
        CHECK(s.status == 1, "%s: status %d", row[i].device, s.status);
        at = strstr(s.out, "falls short");
        CHECK(at != NULL && strstr(at + 1, "falls short") == NULL, "%s", s.out);
        while (at && *at != '\n') { at--; }
        CHECK(at && strncmp(at + 3, row[i].row, strlen(row[i].row)) == 0, "%s", s.out);
    }
    said(&s, dir, cli_glove, WORDS("glove", "--selftest", "--set", "glove_hyst=0"));
    CHECK(s.status == 1 && strstr(s.out, "changes of its 22 angles 0\n") == NULL, "%s", s.out);
    said(&s, dir, cli_glove, WORDS("glove", "--selftest", "--travel", "0.033"));
    CHECK(s.status == 1 && strstr(s.out, "497)") && strstr(s.out, " 8   1 encoder step     9   falls"), "%s", s.out);
    said(&s, dir, cli_glove, WORDS("glove", "--selftest", "--device", "decode=4"));
    CHECK(s.status == 0 && strstr(s.out, " 11   1 encoder step     9\n"), "%s", s.out);
    said_clean(dir);
}

/* The quietest sensor is a dead one: Table I alone would call its bits stable. */
TEST(a_dead_glove_fails)
{
    const char *dir = said_dir();
    said(&s, dir, cli_glove, WORDS("glove", "--selftest", "--device", "excite=0.1"));
    CHECK(s.status == 1, "%d: %s", s.status, s.out);
    CHECK(strstr(s.out, "Not believed: ThumbRotate ThumbMPJ ") && strstr(s.out, " WristYaw\n"), "%s", s.out);
    said_clean(dir);
}

/* Ticks are not frames: a scene may ask less often, and a scan may be longer than a tick. */
TEST(frames_have_a_rate_of_their_own)
{
    static const struct {
        const char *rate, *set, *device, *says;
    } row[] = {{"2000", "every=1", "interval=0.000004", "\n20000 frames of 22 channels at 2000 Hz, 10 s"},
               {"2000", "every=5", "interval=0.000004", "\n4000 frames of 22 channels at 400 Hz, 10 s"},
               {"2000", "every=1", "interval=0.00006", "\n6667 frames of 22 channels at 666.667 Hz, 10 s"},
               {"20000", "every=1", "interval=0.000004", "\n100000 frames of 22 channels at 10000 Hz, 10 s"}};
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, cli_glove,
             WORDS("glove", "--selftest", "--rate", row[i].rate, "--set", row[i].set, "--device", row[i].device));
        CHECK(s.status == 0 && strstr(s.out, row[i].says), "row %zu: %d: %s", i, s.status, s.out);
        CHECK(number_after(strstr(s.out, "\n        30"), "mV", 1) < 7.52, "row %zu: %s", i, s.out);
    }
    said(&s, dir, cli_glove, WORDS("glove", "--record", "/dev/null", "--set", "every=5", "--set", "glove_fc=199"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    said(&s, dir, cli_glove, WORDS("glove", "--record", "/dev/null", "--set", "every=5", "--set", "glove_fc=201"));
    CHECK(s.status == 2 && strstr(s.err, "at or above half the rate"), "of 400 Hz: %d: %s", s.status, s.err);
    said_clean(dir);
}

TEST(the_selftest_takes_recordings)
{
    char *dir = said_dir();
    char text[4000] = "";
    const char *csv = said_path(dir, "codes.csv");
    const char *log = said_path(dir, "rest.exh");
    for (int n = 0; n < 20; n++) { /* 31 codes of noise in column 5, 3 in the others */
        for (int i = 0; i < SENSORS; i++) {
            char cell[16];
            snprintf(cell, sizeof cell, "%d%c", 1000 * i + n % 4 + (i == 5 ? n % 2 * 29 : 0), i < 21 ? ',' : '\n');
            strcat(text, cell);
        }
    }
    write_text(csv, text);
    said(&s, dir, cli_glove, WORDS("glove", "--selftest", "--csv", csv, "--rate", "100"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    CHECK(strstr(s.out, "(32 codes)") && strstr(s.out, "IndexPIJ") && strstr(s.out, " 11   6.1 mV"), "%s", s.out);
    CHECK(strstr(s.out, "motor") == strstr(s.out, "motor at rest"), "no motor in it: %s", s.out);
    said(&s, dir, cli_glove,
         WORDS("glove", "--selftest", "--csv", csv, "--rate", "100", "--to", "0.01", "--span", "5"));
    CHECK(s.status == 0 && strstr(s.out, "(1 codes)") && strstr(s.out, " 14   6.1 mV"), "%s", s.out);
    said(&s, dir, cli_glove,
         WORDS("glove", "--selftest", "--csv", csv, "--rate", "100", "--from", "0.2"));
    CHECK(s.status == 2 && strstr(s.err, "it ends at 0.2 s"), "%d: %s", s.status, s.err);
    said(&s, dir, cli_glove, WORDS("glove", "--record", log, "--seconds", "5"));
    CHECK_EQ_I64(s.status, 0);
    said(&s, dir, cli_glove, WORDS("glove", "--selftest", "--log", log));
    CHECK(s.status == 0 && strstr(s.out, "10000 frames"), "%d: %s%s", s.status, s.err, s.out);
    said_clean(dir);
}

/* ---- Recordings ----------------------------------------------------------------------- */

#define ROW_A "0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1.0,1.1,1.2,1.3,1.4,1.5,-0.1,-0.2,-0.3,-0.4,-0.5,-0.6,-0.7"
#define ROW_B "0.2,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1.0,1.1,1.2,1.3,1.4,1.5,-0.1,-0.2,-0.3,-0.4,-0.5,-0.6,-0.7"
#define SPACED "0.1 0.2\t0.3  0.4 0.5 0.6 0.7 0.8 0.9 1.0 1.1 1.2 1.3 1.4 1.5 -0.1 -0.2 -0.3 -0.4 -0.5 -0.6 -0.7"

/* The same two rows in every dress give the same lines. */
TEST(every_line_end_and_header_reads_alike)
{
    static const char *const dress[] = {
        ROW_A "\n" ROW_B "\n",
        ROW_A "\r" ROW_B "\r",
        ROW_A "\r\n" ROW_B "\r\n",
        ROW_A "\n" ROW_B,
        "\n\n" ROW_A "\n\n" ROW_B "\n\n",
        "S01,S02,OUTPUT\r" ROW_A ",A\r" ROW_B ",B\r",
        "\xEF\xBB\xBF" ROW_A "\n" ROW_B "\n",
        "any words here\n" ROW_A ",label\n" ROW_B ", label \n",
        SPACED "\n" ROW_B "\n",
        "  " SPACED " A \r\n" ROW_B "\r\n",
        "t_s,thumb_rotate_rad\n0," ROW_A ",5,6,7\n0.1," ROW_B ",5,6,7\n",
    };
    static char first[SAID_B];
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(dress); i++) {
        const char *csv = said_path(dir, "in.csv");
        write_text(csv, dress[i]);
        said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--rate", "200"));
        CHECK(s.status == 0 && s.err[0] == '\0', "%zu: status %d: %s", i, s.status, s.err);
        if (i == 0) { strcpy(first, s.out); }
        CHECK(strcmp(first, s.out) == 0, "%zu: %s", i, s.out);
    }
    CHECK(strncmp(first, "t_s,thumb_rotate_rad,thumb_mpj_rad,", 35) == 0, "%s", first);
    CHECK(strstr(first, "\n0,0.0997") || strstr(first, "\n0,0.1"), "%s", first);
    CHECK(strstr(first, "\n0.005,") != NULL, "%s", first);
    said_clean(dir);
}

#define CODES_22 "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22"

TEST(bad_recordings_are_refused_by_line)
{
    static const struct {
        const char *text, *says;
    } row[] = {
        {"", "in.csv: holds no row"},
        {"S01,S02\n", "in.csv: holds no row"},
        {"S01\nS02\n", "in.csv: line 2, column 1: \"S02\" is no number"},
        {ROW_A "\n" "0.1,0.2\n", "in.csv: line 2: 2 columns (22 wanted)"},
        {ROW_A "\r\n\r\n" ROW_A "\r\n1,2,3\r\n", "in.csv: line 4: 3 columns (22 wanted)"},
        {ROW_A "\r" ROW_A "\r1,2,x,4\r", "in.csv: line 3, column 3: \"x\" is no number"},
        {ROW_A "\n" "S01,S02\n", "in.csv: line 2, column 1: \"S01\" is no number"},
        {"nan," ROW_A "\n" ROW_A "\n", "in.csv: line 1, column 1: \"nan\" is no number"},
        {"," ROW_A "\n" ROW_A "\n", "in.csv: line 1, column 1: \"\" is no number"},
        {ROW_A "\n00000000000000000000000000000000000000000000000000000000000000001,2\n", "line 2, column 1: "},
        {"1,nan,3\n", "in.csv: line 1, column 2: \"nan\" is no number"},
        {"1,inf,3\n", "in.csv: line 1, column 2: \"inf\""},
        {"1,,3\n", "in.csv: line 1, column 2: \"\" is no number"},
        {ROW_A ",1\n", "in.csv: line 1: more than 22 columns and a label"},
        {ROW_A ",A,B\n", "in.csv: line 1: more than 22 columns and a label"},
        {"t_s,x\n0," ROW_A "\n0.1,0.1,0.2\n", "in.csv: line 3: 3 columns (23 wanted)"},
        {CODES_22 "\n40000" "," CODES_22 "\n", "line 2: more than 22"},
        {"t\n40000,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22\n", "codes are whole numbers"},
        {"t\n4.5,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22\n", "within half a turn"},
    };
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        const char *csv = said_path(dir, "in.csv");
        write_text(csv, row[i].text);
        said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--rate", "200"));
        CHECK(s.status == 2, "%zu: status %d: %s", i, s.status, s.err);
        CHECK(strstr(s.err, row[i].says) != NULL, "%zu: %s", i, s.err);
        CHECK(s.out[0] == '\0', "%zu: %s", i, s.out);
    }
    said(&s, dir, cli_glove, WORDS("glove", "--csv", "/nowhere", "--rate", "200"));
    CHECK(s.status == 3 && strstr(s.err, "/nowhere: No such file"), "%s", s.err);
    said_clean(dir);
}

/* Codes are whole and some beyond pi; --unit says otherwise. Degrees in, degrees out. */
TEST(units_are_guessed_or_told)
{
    const char *dir = said_dir();
    const char *csv = said_path(dir, "in.csv");
    write_text(csv, "10,20,30,40,50,60,70,80,90,100,110,120,130,140,150,-10,-20,-30,-40,-50,-60,-70\n");
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--rate", "200", "--unit", "deg", "--deg", "--set",
                                   "glove_bits=24", "--set", "glove_hyst=0", "--set", "glove_order=0"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    for (int i = 0; i < SENSORS; i++) { /* a code is 0.0055 degrees */
        const double want = i < 15 ? 10 * (i + 1) : -10 * (i - 14);
        const double got = number_after(s.out, "\n0", i);
        CHECK(got > want - 0.003 && got < want + 0.003, "column %d: %g, want %g", i, got, want);
    }
    write_text(csv, ".25,.01,.02,.03,.04,.05,.06,.07,.08,.09,.1,.11,.12,.13,.14,-.1,-.2,-.3,-.4,-.45,0,0\n");
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--rate", "200", "--unit", "turn", "--deg", "--set",
                                   "glove_bits=24", "--set", "glove_hyst=0", "--set", "glove_order=0"));
    CHECK(number_after(s.out, "\n0", 0) > 89.99 && number_after(s.out, "\n0", 0) < 90.01, "%s", s.out);
    CHECK(number_after(s.out, "\n0", 19) > -162.01 && number_after(s.out, "\n0", 19) < -161.99, "%s", s.out);
    write_text(csv, "10,20,30,40,50,60,70,80,90,100,110,120,130,140,150,-10,-20,-30,-40,-50,-60,-70\n");
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--rate", "200", "--unit", "radians"));
    CHECK(s.status == 2 && strstr(s.err, "--unit: codes, rad, deg or turn"), "%s", s.err);
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--rate", "200", "--deg"));
    CHECK(s.status == 0, "as codes: %d: %s", s.status, s.err); /* through nobody's calibration */
    CHECK(number_after(s.out, "\n0", 4) > 28 && number_after(s.out, "\n0", 4) < 29.5, "%s", s.out);
    said_clean(dir);
}

/* Angles go backwards through a user's calibration, cross terms and all, and come back to a
 * code's worth of angle, and what its cross terms add. */
TEST(angles_pass_a_calibration_and_back)
{
    char *dir = said_dir();
    const char *csv = said_path(dir, "in.csv"), *cal_path = said_path(dir, "user.glove");
    struct exh_glove_cal cal = exh_glove_cal_default;
    uint8_t image[EXH_GLOVE_CAL_IMAGE_B];
    FILE *f;
    cal.sensor[10].of[0] = 4;
    cal.sensor[10].of[1] = 7;
    cal.sensor[10].cross_q30[0] = -(1 << 28);
    cal.sensor[10].cross_q30[1] = 1 << 27;
    CHECK_EQ_I64(exh_glove_cal_save(&cal, image, sizeof image, NULL), EXH_GLOVE_CAL_IMAGE_B);
    f = fopen(cal_path, "wb");
    CHECK(f != NULL && fwrite(image, 1, sizeof image, f) == sizeof image && fclose(f) == 0, "image");
    write_text(csv, ".1,.2,.3,.4,.5,.6,.7,.8,.9,1,.3,1.2,1.3,1.4,.4,.6,.7,.8,.3,.2,.1,-.1\n");
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--rate", "200", "--calibration", cal_path, "--set",
                                   "glove_bits=24", "--set", "glove_hyst=0", "--set", "glove_order=0"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    for (int i = 0; i < SENSORS; i++) {
        static const double want[] = {.1, .2, .3, .4, .5,  .6, .7, .8, .9, 1,  .3,
                                      1.2, 1.3, 1.4, .4, .6, .7, .8, .3, .2, .1, -.1};
        const double code_rad = size_of(cal.sensor[i].gain_turnpraw_q38) / 274877906944.0 * 6.2832;
        const double off = size_of(number_after(s.out, "\n0", i) - want[i]);
        CHECK(off <= 0.51 * code_rad + (i == 10 ? 1e-4 : 0), "column %d: %.6f rad off", i, off);
    }
    image[30] ^= 1;
    f = fopen(cal_path, "wb");
    CHECK(f != NULL && fwrite(image, 1, sizeof image, f) == sizeof image && fclose(f) == 0, "image");
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--rate", "200", "--calibration", cal_path));
    CHECK(s.status == 2 && strstr(s.err, "user.glove: ") && strstr(s.err, "damaged"), "%s", s.err);
    said_clean(dir);
}

/* What comes out goes in again and comes out the same: a fixed point of the quantizer. */
TEST(its_own_output_is_an_input)
{
    static char first[SAID_B], text[SAID_B];
    char *dir = said_dir();
    const char *csv = said_path(dir, "in.csv"), *back = said_path(dir, "back.csv");
    int n = 0;
    for (int k = 0; k < 40; k++) {
        for (int i = 0; i < SENSORS; i++) {
            n += snprintf(text + n, sizeof text - (size_t)n, "%.5f%c", ((k * 37 + i * 91) % 300) * 0.01 - 1.5,
                          i < 21 ? ',' : '\r');
        }
    }
    write_text(csv, text);
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--rate", "60", "--set", "glove_order=0", "--tips"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    strcpy(first, s.out);
    write_text(back, first);
    said(&s, dir, cli_glove, WORDS("glove", "--csv", back, "--rate", "60", "--set", "glove_order=0", "--tips"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    CHECK(strcmp(first, s.out) == 0, "not the same");
    said_clean(dir);
}

/* A real one, of lines that end in CR with a letter behind them: every stable angle lies within
 * the quantizer's (Q + H)/2, 26 codes of 2^-16 turn, and half a code, of what was recorded. */
TEST(a_real_recording_comes_through)
{
    const char *data = getenv("EXH_DATA") ? getenv("EXH_DATA") : "../shared/data";
    static char in_path[512], in_line[4096], out_line[4096];
    char *dir = said_dir();
    FILE *in, *out;
    double worst = 0;
    long rows = 0;
    snprintf(in_path, sizeof in_path, "%s/glove-cyberglove-libras-alphabet/alphabet.csv", data);
    in = fopen(in_path, "r");
    if (in == NULL) {
        check_note("%s: not there: no real glove is tested; EXH_DATA names the place", in_path);
        said_clean(dir);
        return;
    }
    said(&s, dir, cli_glove, WORDS("glove", "--csv", in_path, "--rate", "10", "--set", "glove_order=0"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    out = fopen(said_path(dir, "said.out"), "r");
    CHECK(out != NULL && fgets(out_line, sizeof out_line, out), "no answer");
    for (int c = getc(in); c != '\r' && c != EOF;) { c = getc(in); } /* its header */
    while (fgets(out_line, sizeof out_line, out)) {
        char *a = in_line, *b = strchr(out_line, ',');
        size_t n = 0;
        for (int c = getc(in); c != '\r' && c != EOF && n < sizeof in_line - 1; c = getc(in)) {
            in_line[n++] = (char)c;
        }
        in_line[n] = '\0';
        for (int i = 0; i < SENSORS; i++) {
            const double off = strtod(a + (i > 0), &a) - strtod(b + 1, &b);
            if (off > worst) { worst = off; }
            if (-off > worst) { worst = -off; }
        }
        CHECK(strcmp(b, ",0\n") == 0, "row %ld: a fault: %s", rows, b);
        rows++;
    }
    fclose(in);
    fclose(out);
    CHECK_EQ_I64(rows, 2100);
    CHECK(worst < 26.51 * 6.2832 / 65536 && worst > 24 * 6.2832 / 65536, "%.6f rad", worst);
    said_clean(dir);
}

/* 30 Hz of low-pass do not fit 60 Hz: it goes down and says so; asked for, it is refused. */
TEST(the_low_pass_fits_the_rate)
{
    const char *dir = said_dir();
    const char *csv = said_path(dir, "in.csv");
    write_text(csv, ROW_A "\n" ROW_B "\n");
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--rate", "60"));
    CHECK(s.status == 0 && strstr(s.err, "at 60 Hz the low-pass is at 15 Hz"), "%d: %s", s.status, s.err);
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--rate", "60", "--set", "glove_fc=30"));
    CHECK(s.status == 2 && strstr(s.err, "cut-off"), "%d: %s", s.status, s.err);
    said(&s, dir, cli_glove, WORDS("glove", "--csv", csv, "--rate", "60", "--set", "glove_fc=29"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    said_clean(dir);
}

TEST(bad_usage_is_refused_by_name)
{
    static const struct {
        const char *word[7];
        const char *says;
    } row[] = {
        {{NULL}, "what to do is missing"},
        {{"--csv", "x"}, "--rate HZ says"},
        {{"--skew", "--selftest"}, "one at a time"},
        {{"--record", "x", "--skew"}, "one at a time"},
        {{"--record", "x", "--selftest"}, "one at a time"},
        {{"--skew", "--log", "x"}, "--log: goes with --selftest"},
        {{"--selftest", "--log", "x", "--rate", "5"}, "--rate: a log knows its own"},
        {{"--selftest", "--tips"}, "--tips and --deg"},
        {{"--skew", "--play", "x"}, "--play: goes with --record"},
        {{"--selftest", "--csv", "x", "--log", "y"}, "--csv and --log"},
        {{"--selftest", "--set", "cal_zero=1"}, "give --calibration"},
        {{"--selftest", "--set", "glove_bits=99"}, "glove_bits: 99 (allowed 1..24)"},
        {{"--selftest", "--set", "none=1"}, "none: no such parameter"},
        {{"--selftest", "--device", "noise=9"}, "noise: 9 (allowed 0..1 v)"},
        {{"--selftest", "--device", "mass=9"}, "mass: 9 (allowed"},
        {{"--selftest", "--device", "none=9"}, "none: no such value"},
        {{"--record", "/nowhere/x"}, "/nowhere/x: No such file"},
        {{"--record", "x", "--pose", "none"}, "--pose: none: no such pose"},
        {{"--record", "x", "--does", "none"}, "--does: none"},
        {{"--selftest", "--set", "present=1"}, "give --calibration"},
        {{"--selftest", "--does", "wave"}, "go with --record"},
        {{"--skew", "--pose", "fist"}, "go with --record"},
        {{"--record", "x", "--play", "y", "--does", "wave"}, "--play: says what"},
        {{"--selftest", "--to", "1"}, "of a recording"},
        {{"--skew", "--rate", "100"}, "--skew: does not depend"},
        {{"--csv", "x", "--rate", "100", "--seconds=1"}, "--seconds: a recording"},
        {{"--selftest", "--seconds", "0.01"}, "20 frames: too few"},
        {{"--selftest", "--rate", "0.5"}, "--rate: 0.5 (allowed 1..20000)"},
        {{"--selftest", "--calibration", "/dev/null"}, "/dev/null: "},
        {{"--selftest", "--log", "/dev/null"}, "/dev/null: not a log"},
    };
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        const char *const *w = row[i].word;
        said(&s, dir, cli_glove, WORDS("glove", w[0], w[1], w[2], w[3], w[4], w[5]));
        CHECK(s.status == 2, "row %zu: status %d: %s", i, s.status, s.err);
        CHECK(strstr(s.err, row[i].says) != NULL, "row %zu: %s", i, s.err);
        CHECK(strncmp(s.err, "exhand glove: ", 14) == 0, "row %zu: %s", i, s.err);
        CHECK(s.out[0] == '\0', "row %zu: %s", i, s.out);
    }
    said_clean(dir);
}

TEST(what_is_not_there_is_said_by_status)
{
    static const char *const option[] = {"--calibration", "--log"};
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(option); i++) {
        said(&s, dir, cli_glove, WORDS("glove", "--selftest", option[i], "/nowhere"));
        CHECK(s.status == 3 && strstr(s.err, "/nowhere: No such file"), "%d: %s", s.status, s.err);
    }
    said(&s, dir, cli_replay, WORDS("replay", "/nowhere"));
    CHECK(s.status == 3 && strstr(s.err, "/nowhere: No such file"), "%d: %s", s.status, s.err);
    said_clean(dir);
}

/* Of a recording there is nothing to save: it ends by the signal, half way or before its input. */
TEST(an_interrupt_is_no_success)
{
    static const struct timespec while_it_waits = {0, 200000000};
    char *dir = said_dir();
    const char *pipe = said_path(dir, "pipe");
    pid_t pid;
    CHECK_EQ_I64(mkfifo(pipe, 0600), 0);
    pid = said_start(dir, cli_glove, WORDS("glove", "--csv", pipe, "--rate", "100"));
    nanosleep(&while_it_waits, NULL);
    CHECK_EQ_I64(kill(pid, SIGINT), 0);
    said_end(&s, dir, pid);
    CHECK(s.status == -1 && s.err[0] == '\0', "%d: %s", s.status, s.err);
    said_clean(dir);
}

TEST(help_and_parameters_are_listed)
{
    const char *dir = said_dir();
    said(&s, dir, cli_glove, WORDS("glove", "--help"));
    CHECK(s.status == 0 && strstr(s.out, "--selftest") && strstr(s.out, "--tips"), "%s", s.out);
    said(&s, dir, cli_glove, WORDS("glove", "--params"));
    CHECK(s.status == 0 && strstr(s.out, "glove_fc") && strstr(s.out, "settle"), "%s", s.out);
    CHECK(strstr(s.out, "every") && strstr(s.out, "cal_zero") == NULL, "22 of each: %s", s.out);
    said_clean(dir);
}

/* ---- Skew ------------------------------------------------------------------------------- */

/* Errors are in proportion to the interval and to the speed; the delay part is what a
 * fingertip goes in a scan: below its speed, joints' speeds times their lever arms. */
TEST(skew_grows_with_interval_and_speed)
{
    const char *dir = said_dir();
    double um[2][5][4];
    const char *at;
    said(&s, dir, cli_glove, WORDS("glove", "--skew"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    at = strstr(s.out, "         0.5");
    if (at == NULL) { at = strstr(s.out, "      0.5 "); }
    CHECK(at != NULL, "%s", s.out);
    for (int m = 0; at && m < 2; m++) {
        for (int k = 0; k < 5; k++) {
            double v[8];
            char *end;
            for (int c = 0; c < 8; c++) {
                v[c] = strtod(at, &end);
                at = end;
            }
            memcpy(um[m][k], v + 4, sizeof um[m][k]);
            CHECK(v[3] == 22 * v[2], "%g us of %g", v[3], v[2]);
        }
    }
    for (int c = 0; c < 4; c++) {
        CHECK(um[0][4][c] > 4.95 * um[0][0][c] && um[0][4][c] < 5.05 * um[0][0][c], "interval, column %d", c);
        CHECK(um[1][0][c] > 2.47 * um[0][0][c] && um[1][0][c] < 2.53 * um[0][0][c], "speed, column %d", c);
    }
    /* Once found to be so: also which channel comes first matters. */
    CHECK(um[0][0][0] > 36.0 && um[0][0][0] < 36.6 && um[0][0][2] > 12.3 && um[0][0][2] < 12.6, "%g %g um",
          um[0][0][0], um[0][0][2]);
    /* 338 deg/s at three joints, 25 mm at each lever: below 5.9 * 0.105 * (1 + 0.48 + 0.24) m/s */
    CHECK(um[0][0][0] > 20 && um[0][0][0] < 88e-6 * 1.1e6, "%g um", um[0][0][0]);
    CHECK(um[0][0][2] < um[0][0][0] / 2 && um[0][0][1] < um[0][0][0], "%g um", um[0][0][2]);
    said_clean(dir);
}

/* ---- Logs ----------------------------------------------------------------------------------- */

static void replay_from(const char *dir, const char *log, const char *from, int status)
{
    said(&s, dir, cli_replay, WORDS("replay", log, "--from", from));
    CHECK(s.status == status, "from %s: %d: %s%s", from, s.status, s.out, s.err);
}

/* Also where the glove runs at a fraction of the loop's rate, and with a scan that does not
 * fit into a tick. */
TEST(a_log_replays_bit_for_bit_from_any_keyframe)
{
    static const struct {
        const char *rate, *every, *does, *device;
    } row[] = {{"2000", "every=1", "poses", "seed=1"},
               {"2000", "every=7", "grasp", "noise=0.02"},
               {"90", "every=1", "wave", "couple=0.2"},
               {"20000", "every=3", "grasp", "interval=0.00002"}};
    char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        const char *log = said_path(dir, "glove.exh");
        const char *device = i ? row[i].device : "noise=0.0061";
        said(&s, dir, cli_glove,
             WORDS("glove", "--record", log, "--rate", row[i].rate, "--set", row[i].every, "--does",
                   row[i].does, "--device", device, "--seconds", i == 2 ? "30" : i == 3 ? "0.3" : "3",
                   i == 2 ? "--set" : "--seed", i == 2 ? "glove_fc=20" : "5"));
        CHECK(s.status == 0, "row %zu: %d: %s", i, s.status, s.err);
        replay_from(dir, log, "0", 0);
        CHECK(strstr(s.out, " identical") != NULL, "%s", s.out);
        replay_from(dir, log, "1", 0);
        replay_from(dir, log, "1024", 0);
        CHECK(strstr(s.out, "from tick 1024") != NULL, "%s", s.out);
        replay_from(dir, log, "2600", 0);
        CHECK(strstr(s.out, "from tick 2048") != NULL, "%s", s.out);
    }
    said_clean(dir);
}

static long size_of_file(const char *path)
{
    struct stat st;
    return stat(path, &st) == 0 ? (long)st.st_size : -1;
}

/* What is refused leaves the log that is there; less than a tick is one, not without end; and
 * what is played is played to its end. */
TEST(a_record_is_as_long_as_it_should_be)
{
    static char text[SAID_B];
    char *dir = said_dir();
    const char *log = said_path(dir, "glove.exh"), *csv = said_path(dir, "in.csv");
    long size;
    said(&s, dir, cli_glove, WORDS("glove", "--record", log, "--rate", "100", "--seconds", "0.001"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 0 && strstr(s.out, ": 1 ticks "), "%s%s", s.out, s.err);
    size = size_of_file(log);
    said(&s, dir, cli_glove, WORDS("glove", "--record", log, "--set", "glove_fc=5000"));
    CHECK(s.status == 2 && strstr(s.err, "cut-off at or above half the rate: see"), "%d: %s", s.status, s.err);
    CHECK_EQ_I64(size_of_file(log), size);
    for (int n = 0; n < 150; n++) { strcat(text, ROW_A "\n"); }
    write_text(csv, text);
    said(&s, dir, cli_glove, WORDS("glove", "--record", log, "--play", csv, "--rate", "70", "--set", "glove_fc=9"));
    CHECK(s.status == 0 && s.err[0] == '\0', "%d: %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 0 && strstr(s.out, ": 150 ticks "), "%s%s", s.out, s.err);
    said(&s, dir, cli_glove, WORDS("glove", "--record", log, "--rate", "20000", "--seconds", "0.1"));
    CHECK(s.status == 0 && strstr(s.err, "1000 frames in 2000 ticks: a scan takes longer"), "%s", s.err);
    said_clean(dir);
}

/* One code of one frame changed, its CRC made good: the replay names the signal, and the tick
 * at which the filter has come out of the hysteresis with it. */
TEST(a_changed_code_is_found)
{
    char *dir = said_dir();
    const char *log = said_path(dir, "glove.exh");
    struct logfile l;
    struct exh_record r;
    FILE *f;
    said(&s, dir, cli_glove, WORDS("glove", "--record", log, "--seconds", "0.3"));
    CHECK_EQ_I64(s.status, 0);
    CHECK_EQ_I64(logfile_open(&l, log), 0);
    while (logfile_next(&l, &r) && !(r.type == EXH_RECORD_FRAME && r.tick == 77)) {}
    {
        uint8_t *record = l.bytes + (r.payload - l.bytes) - 14;
        struct exh_bytes c = exh_bytes_writer(record + 14 + r.len_B, 4);
        uint32_t crc;
        record[14 + 6 + 3 + 2 * 5 + 1] ^= 0x20; /* supply, din; new, age; code 5, high byte */
        crc = exh_crc32(0, record, 14u + r.len_B);
        exh_bytes_u32(&c, &crc);
    }
    f = fopen(log, "wb");
    CHECK(f != NULL && fwrite(l.bytes, 1, l.len, f) == l.len, "write");
    fclose(f);
    logfile_close(&l);
    replay_from(dir, log, "0", 1);
    CHECK(strstr(s.out, "tick 78: index_pij: recorded") != NULL, "%s", s.out);
    said_clean(dir);
}

/* The scene's angles are the operator's, within the quantizer's (Q + H)/2 = 26 codes. */
TEST(angles_are_those_of_the_hand)
{
    char *dir = said_dir();
    const char *log = said_path(dir, "glove.exh"), *csv = said_path(dir, "glove.csv");
    for (int pose = 0; pose < sim_poses; pose++) {
        said(&s, dir, cli_glove, WORDS("glove", "--record", log, "--seconds", "0.05", "--pose",
                                       sim_pose[pose].name, "--device", "couple=0"));
        CHECK(s.status == 0, "%d: %s", s.status, s.err);
        said(&s, dir, cli_csv, WORDS("csv", log, "--all", "--out", csv));
        CHECK(s.status == 0, "%d: %s", s.status, s.err);
        for (int i = 0; i < SENSORS; i++) {
            const struct sim_glove_sensor *n = &sim_glove_sensor[i];
            const double deg_per_code =
                (n->hi_deg - n->lo_deg) / ((n->hi - n->lo) * 18 * 3276.8);
            const double off = last_value(csv, i + 1) * 360 - sim_pose[pose].deg[i];
            const double codes = off / deg_per_code;
            CHECK(codes < 27 && codes > -27, "%s, %s: %.3f deg off, %.1f codes", sim_pose[pose].name, n->name,
                  off, codes);
        }
        CHECK(last_value(csv, SENSORS + 1) == 0, "faults: %s", sim_pose[pose].name);
    }
    said_read(s.out, csv);
    CHECK(strstr(s.out, ",age,raw0,") && strstr(s.out, ",raw21\n"), "the codes are in it");
    said_clean(dir);
}

/* Rows of angles through the analog chain: each is reached where it is held. */
TEST(a_recording_moves_the_simulated_hand)
{
    char *dir = said_dir();
    char text[30000] = "";
    const char *csv = said_path(dir, "in.csv"), *log = said_path(dir, "glove.exh");
    for (int k = 0; k < 100; k++) { /* half a second flat, half with the index bent by 1 rad */
        for (int i = 0; i < SENSORS; i++) {
            strcat(text, i == 5 && k >= 50 ? "1.0" : "0.0");
            strcat(text, i < 21 ? "," : "\r\n");
        }
    }
    write_text(csv, text);
    said(&s, dir, cli_glove, WORDS("glove", "--record", log, "--play", csv, "--rate", "100", "--seconds", "1",
                                   "--set", "glove_fc=20"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    said(&s, dir, cli_csv, WORDS("csv", log, "--out", csv));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    for (int i = 0; i < SENSORS; i++) {
        const double rad = last_value(csv, i + 1) * 6.283185307;
        CHECK(rad > (i == 5) - 0.03 && rad < (i == 5) + 0.03, "column %d: %g", i, rad);
    }
    replay_from(dir, log, "0", 0);
    write_text(csv, text); /* and not before its time */
    said(&s, dir, cli_glove, WORDS("glove", "--record", log, "--play", csv, "--rate", "100", "--seconds",
                                   "0.49", "--set", "glove_fc=20"));
    said(&s, dir, cli_csv, WORDS("csv", log, "--out", csv));
    CHECK(s.status == 0 && last_value(csv, 6) < 0.005, "%g turn", last_value(csv, 6));
    said_clean(dir);
}

TEST_MAIN("glove_command", the_selftest_gives_the_papers_rows, a_low_pass_gives_bits_for_delay,
          too_much_noise_falls_short, a_dead_glove_fails, frames_have_a_rate_of_their_own,
          the_selftest_takes_recordings,
          every_line_end_and_header_reads_alike, bad_recordings_are_refused_by_line,
          units_are_guessed_or_told, angles_pass_a_calibration_and_back, its_own_output_is_an_input, a_real_recording_comes_through, the_low_pass_fits_the_rate,
          bad_usage_is_refused_by_name, what_is_not_there_is_said_by_status, an_interrupt_is_no_success, help_and_parameters_are_listed,
          skew_grows_with_interval_and_speed, a_log_replays_bit_for_bit_from_any_keyframe,
          a_record_is_as_long_as_it_should_be, a_changed_code_is_found, angles_are_those_of_the_hand,
          a_recording_moves_the_simulated_hand);
