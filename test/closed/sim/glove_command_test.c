/* SPDX-License-Identifier: MIT */
/* exhand glove as people use and misuse it: recordings of every shape, bad ones refused by name,
 * options that make no sense. */
#include "glove_said.h"
#include "lab/lab.h"

#include <math.h>
#include <signal.h>
#include <time.h>

static struct said s;

/* ---- Recordings ----------------------------------------------------------------------- */

#define SPACED \
    "0.1 0.2\t0.3  0.4 0.5 0.6 0.7 0.8 0.9 1.0 1.1 1.2 1.3 1.4 1.5 -0.1 -0.2 -0.3 -0.4 -0.5 -0.6 " \
    "-0.7"

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
        said(&s, dir, lab_glove, WORDS("glove", "--csv", csv, "--rate", "200"));
        CHECK(s.status == 0, "%zu: status %d: %s", i, s.status, s.err);
        CHECK(
            (strstr(s.err, "1 empty lines between rows") != NULL) == (i == 4), "%zu: %s", i, s.err);
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
        {ROW_A "\n"
               "0.1,0.2\n",
            "in.csv: line 2: 2 columns (22 wanted)"},
        {ROW_A "\r\n\r\n" ROW_A "\r\n1,2,3\r\n", "in.csv: line 4: 3 columns (22 wanted)"},
        {ROW_A "\r" ROW_A "\r1,2,x,4\r", "in.csv: line 3, column 3: \"x\" is no number"},
        {ROW_A "\n"
               "S01,S02\n",
            "in.csv: line 2, column 1: \"S01\" is no number"},
        {ROW_A "\n00000000000000000000000000000000000000000000000000000000000000001,2\n",
            "line 2, column 1: "},
        {"nan," ROW_A "\n", "in.csv: line 1: more than 22 columns"},
        {"1,nan,3\n", "in.csv: line 1: 3 columns (22 wanted)"},
        {"1,,3\n", "in.csv: line 1: 3 columns (22 wanted)"},
        {ROW_A "\n\x1b[2J\x07\x80,2\n", "line 2, column 1: \"\\x1b[2J\\x07\\x80\" is no number"},
        {ROW_A ",1\n", "in.csv: line 1: more than 22 columns and a label"},
        {ROW_A ",A,B\n", "in.csv: line 1: more than 22 columns and a label"},
        {"t_s,x\n0," ROW_A "\n0.1,0.1,0.2\n", "in.csv: line 3: 3 columns (23 wanted)"},
        {CODES_22 "\n40000"
                  "," CODES_22 "\n",
            "line 2: more than 22"},
        {"t\n40000,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22\n",
            "codes are whole numbers"},
        {"t\n4.5,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22\n", "within half a turn"},
    };
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        const char *csv = said_path(dir, "in.csv");
        write_text(csv, row[i].text);
        said(&s, dir, lab_glove, WORDS("glove", "--csv", csv, "--rate", "200"));
        CHECK(s.status == 2, "%zu: status %d: %s", i, s.status, s.err);
        CHECK(strstr(s.err, row[i].says) != NULL, "%zu: %s", i, s.err);
        CHECK(s.out[0] == '\0', "%zu: %s", i, s.out);
    }
    said(&s, dir, lab_glove, WORDS("glove", "--csv", "/dev/zero", "--rate", "200"));
    CHECK(s.status == 2 && strstr(s.err, "/dev/zero: line 1: it does not end"), "%d: %s", s.status,
        s.err);
    said(&s, dir, lab_glove, WORDS("glove", "--csv", "/nowhere", "--rate", "200"));
    CHECK(s.status == 3 && strstr(s.err, "/nowhere: No such file"), "%s", s.err);
    said_clean(dir);
}

/* Codes are whole and some beyond pi; --unit says otherwise. Degrees in, degrees out. */
TEST(units_are_guessed_or_told)
{
    const char *dir = said_dir();
    const char *csv = said_path(dir, "in.csv");
    write_text(
        csv, "10,20,30,40,50,60,70,80,90,100,110,120,130,140,150,-10,-20,-30,-40,-50,-60,-70\n");
    said(&s, dir, lab_glove,
        WORDS("glove", "--csv", csv, "--rate", "200", "--unit", "deg", "--deg", "--set",
            "glove_bits=24", "--set", "glove_hyst=0", "--set", "glove_order=0"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    for (int i = 0; i < SENSORS; i++) { /* a code is 0.0055 degrees */
        const double want = i < 15 ? 10 * (i + 1) : -10 * (i - 14);
        const double got = number_after(s.out, "\n0", i);
        CHECK(got > want - 0.003 && got < want + 0.003, "column %d: %g, want %g", i, got, want);
    }
    write_text(csv,
        ".25,.01,.02,.03,.04,.05,.06,.07,.08,.09,.1,.11,.12,.13,.14,-.1,-.2,-.3,-.4,-.45,0,0\n");
    said(&s, dir, lab_glove,
        WORDS("glove", "--csv", csv, "--rate", "200", "--unit", "turn", "--deg", "--set",
            "glove_bits=24", "--set", "glove_hyst=0", "--set", "glove_order=0"));
    CHECK(number_after(s.out, "\n0", 0) > 89.99 && number_after(s.out, "\n0", 0) < 90.01, "%s",
        s.out);
    CHECK(number_after(s.out, "\n0", 19) > -162.01 && number_after(s.out, "\n0", 19) < -161.99,
        "%s", s.out);
    write_text(
        csv, "10,20,30,40,50,60,70,80,90,100,110,120,130,140,150,-10,-20,-30,-40,-50,-60,-70\n");
    said(&s, dir, lab_glove, WORDS("glove", "--csv", csv, "--rate", "200", "--unit", "radians"));
    CHECK(s.status == 2 && strstr(s.err, "--unit: radians: give codes, rad, deg or turn"), "%s",
        s.err);
    said(&s, dir, lab_glove, WORDS("glove", "--csv", csv, "--rate", "200", "--deg"));
    CHECK(s.status == 0, "as codes: %d: %s", s.status, s.err); /* through no user's calibration */
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
    CHECK(
        f != NULL && fwrite(image, 1, sizeof image, f) == sizeof image && fclose(f) == 0, "image");
    write_text(csv, ".1,.2,.3,.4,.5,.6,.7,.8,.9,1,.3,1.2,1.3,1.4,.4,.6,.7,.8,.3,.2,.1,-.1\n");
    said(&s, dir, lab_glove,
        WORDS("glove", "--csv", csv, "--rate", "200", "--calibration", cal_path, "--set",
            "glove_bits=24", "--set", "glove_hyst=0", "--set", "glove_order=0"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    for (int i = 0; i < SENSORS; i++) {
        static const double want[] = {.1, .2, .3, .4, .5, .6, .7, .8, .9, 1, .3, 1.2, 1.3, 1.4, .4,
            .6, .7, .8, .3, .2, .1, -.1};
        const double code_rad = abs(cal.sensor[i].gain_turnpraw_q38) / 274877906944.0 * 6.2832;
        const double off = fabs(number_after(s.out, "\n0", i) - want[i]);
        CHECK(off <= 0.51 * code_rad + (i == 10 ? 1e-4 : 0), "column %d: %.6f rad off", i, off);
    }
    image[30] ^= 1;
    f = fopen(cal_path, "wb");
    CHECK(
        f != NULL && fwrite(image, 1, sizeof image, f) == sizeof image && fclose(f) == 0, "image");
    said(&s, dir, lab_glove,
        WORDS("glove", "--csv", csv, "--rate", "200", "--calibration", cal_path));
    CHECK(s.status == 2 && strstr(s.err, "user.glove: checksum wrong"), "%s", s.err);
    said_clean(dir);
}

/* The output is also an input, and comes out the same: a fixed point of the quantizer. */
TEST(its_own_output_is_an_input)
{
    static char first[SAID_B], text[SAID_B];
    char *dir = said_dir();
    const char *csv = said_path(dir, "in.csv"), *back = said_path(dir, "back.csv");
    int n = 0;
    for (int k = 0; k < 40; k++) {
        for (int i = 0; i < SENSORS; i++) {
            n += snprintf(text + n, sizeof text - (size_t)n, "%.5f%c",
                ((k * 37 + i * 91) % 300) * 0.01 - 1.5, i < 21 ? ',' : '\r');
        }
    }
    write_text(csv, text);
    said(&s, dir, lab_glove,
        WORDS("glove", "--csv", csv, "--rate", "60", "--set", "glove_order=0", "--tips"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    strcpy(first, s.out);
    write_text(back, first);
    said(&s, dir, lab_glove,
        WORDS("glove", "--csv", back, "--rate", "60", "--set", "glove_order=0", "--tips"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    CHECK(strcmp(first, s.out) == 0, "not the same");
    said_clean(dir);
}

/* A real recording: lines end in CR, with a letter behind it. Every stable angle is within the
 * quantizer's (Q + H)/2, 26 codes of 2^-16 turn, and half a code, of the recorded one. */
TEST(a_real_recording_comes_through)
{
    const char *data = getenv("EXH_DATA") ? getenv("EXH_DATA") : "$EXH_DATA";
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
    said(&s, dir, lab_glove,
        WORDS("glove", "--csv", in_path, "--rate", "10", "--set", "glove_order=0"));
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

/* 30 Hz of low-pass do not fit 60 Hz: it goes down and says so. As an option, 30 Hz is refused. */
TEST(the_low_pass_fits_the_rate)
{
    const char *dir = said_dir();
    const char *csv = said_path(dir, "in.csv");
    write_text(csv, ROW_A "\n" ROW_B "\n");
    said(&s, dir, lab_glove, WORDS("glove", "--csv", csv, "--rate", "60"));
    CHECK(s.status == 0 && strstr(s.err, "at 60 Hz the low-pass is at 15 Hz"), "%d: %s", s.status,
        s.err);
    said(&s, dir, lab_glove, WORDS("glove", "--csv", csv, "--rate", "60", "--set", "glove_fc=30"));
    CHECK(s.status == 2 && strstr(s.err, "cut-off"), "%d: %s", s.status, s.err);
    said(&s, dir, lab_glove, WORDS("glove", "--csv", csv, "--rate", "60", "--set", "glove_fc=29"));
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
        {{"--selftest", "--device", "noise=9"}, "noise: 9 (allowed 0..1 V)"},
        {{"--selftest", "--device", "mass=9"}, "mass: 9 (allowed"},
        {{"--selftest", "--device", "none=9"}, "none: no such value"},
        {{"--selftest", "--device", "rotor=0.0001", "--device", "substep=1e-4"},
            "give --device substep=1e-05"},
        {{"--record", "/nowhere/x"}, "/nowhere/x: No such file"},
        {{"--record", "x", "--pose", "none"}, "--pose: none: no such pose"},
        {{"--record", "x", "--does", "none"}, "--does: none"},
        {{"--selftest", "--set", "present=1"}, "give --calibration"},
        {{"--selftest", "--does", "wave"}, "go with --record"},
        {{"--skew", "--pose", "fist"}, "go with --record, --pose with --serial"},
        {{"--serial", "x", "--pose", "flat", "--calibration", "x"},
            "codes as they come: leave --record"},
        {{"--serial", "x", "--pose", "flat", "--set", "glove_fc=20"},
            "codes as they come: leave --record"},
        {{"--serial", "x", "--pose", "flat", "--deg"}, "codes as they come: leave --record"},
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
        said(&s, dir, lab_glove, WORDS("glove", w[0], w[1], w[2], w[3], w[4], w[5]));
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
        said(&s, dir, lab_glove, WORDS("glove", "--selftest", option[i], "/nowhere"));
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
    pid = said_start(dir, lab_glove, WORDS("glove", "--csv", pipe, "--rate", "100"));
    nanosleep(&while_it_waits, NULL);
    CHECK_EQ_I64(kill(pid, SIGINT), 0);
    said_end(&s, dir, pid);
    CHECK(s.status == -1 && s.err[0] == '\0', "%d: %s", s.status, s.err);
    said_clean(dir);
}

TEST(help_and_parameters_are_listed)
{
    const char *dir = said_dir();
    said(&s, dir, lab_glove, WORDS("glove", "--help"));
    CHECK(s.status == 0 && strstr(s.out, "--selftest") && strstr(s.out, "--tips"), "%s", s.out);
    said(&s, dir, lab_glove, WORDS("glove", "--params"));
    CHECK(s.status == 0 && strstr(s.out, "glove_fc") && strstr(s.out, "settle"), "%s", s.out);
    CHECK(strstr(s.out, "every") && strstr(s.out, "cal_zero") == NULL, "22 of each: %s", s.out);
    said_clean(dir);
}

TEST_MAIN("glove_command", every_line_end_and_header_reads_alike,
    bad_recordings_are_refused_by_line, units_are_guessed_or_told,
    angles_pass_a_calibration_and_back, its_own_output_is_an_input, a_real_recording_comes_through,
    the_low_pass_fits_the_rate, bad_usage_is_refused_by_name, what_is_not_there_is_said_by_status,
    an_interrupt_is_no_success, help_and_parameters_are_listed);
