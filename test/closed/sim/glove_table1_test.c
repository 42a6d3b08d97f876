/* SPDX-License-Identifier: MIT */
/* exhand-lab glove --selftest and --skew: Table I within bounds on both sides, and failing when it
 * should; the scan's skew in proportion. */
#include "glove_said.h"
#include "lab/lab.h"

static struct said s;

/* ---- Table I ------------------------------------------------------------------------ */

TEST(the_selftest_gives_the_papers_rows)
{
    static const char *const seed[] = {"1", "2", "3", "77"};
    static const char *const rate[] = {"2000", "90", "20000"};
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(seed) * LEN(rate); i++) {
        double pp;
        said(&s, dir, lab_glove,
            WORDS("glove", "--selftest", "--seed", seed[i % LEN(seed)], "--rate",
                rate[i / LEN(seed)], "--seconds", i / LEN(seed) == 2 ? "2" : "30"));
        CHECK(s.status == 0, "status %d: %s%s", s.status, s.err, s.out);
        pp = number_after(s.out, "joint angle     ", 0);
        CHECK(pp >= 5.79 && pp <= 6.42, "%g mV", pp); /* a code either side of 6.1 */
        pp = number_after(s.out, "motor position  ", 0);
        CHECK(pp > 66.31 && pp < 66.33, "%g um", pp);
        pp = number_after(s.out, "motor current   ", 0);
        CHECK(pp > 35 && pp < 47.8, "%g mA", pp); /* its bound, and a code */
        CHECK(strstr(s.out, "20 V                         11   6.1 mV            11\n") != NULL,
            "%s", s.out);
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
        {"\n        30", 0.182, 7.5026, 13, 14}, {"\n        10", 0.105, 22.508, 14, 15},
        {"\n         3", 0.0577, 75.026, 15, 16}};
    const char *dir = said_dir();
    said(&s, dir, lab_glove, WORDS("glove", "--selftest", "--seconds", "30"));
    for (size_t i = 0; i < LEN(row); i++) {
        const double pp = number_after(s.out, row[i].fc, 0);
        const double delay = number_after(strstr(s.out, row[i].fc), "mV", 1);
        const int bits = (int)number_after(strstr(s.out, row[i].fc), "mV", 0);
        /* 3 deviations of white noise become 4 of normal noise, correlated: fewer chances */
        CHECK(pp > 5.2 * row[i].rms && pp < 9.5 * row[i].rms, "%s: %g mV", row[i].fc, pp);
        CHECK(bits >= row[i].bits_lo && bits <= row[i].bits_hi, "%s: %d bits", row[i].fc, bits);
        CHECK(delay > row[i].delay_ms - 0.08 && delay < row[i].delay_ms + 0.02, "%s: %g ms",
            row[i].fc, delay);
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
        said(&s, dir, lab_glove, WORDS("glove", "--selftest", "--device", row[i].device));
        CHECK(s.status == 1, "%s: status %d", row[i].device, s.status);
        at = strstr(s.out, "falls short");
        CHECK(at != NULL && strstr(at + 1, "falls short") == NULL, "%s", s.out);
        while (at && *at != '\n') { at--; }
        CHECK(at && strncmp(at + 3, row[i].row, strlen(row[i].row)) == 0, "%s", s.out);
    }
    said(&s, dir, lab_glove, WORDS("glove", "--selftest", "--set", "glove_hyst=0"));
    CHECK(s.status == 1 && strstr(s.out, "changes of its 22 angles 0\n") == NULL, "%s", s.out);
    said(&s, dir, lab_glove, WORDS("glove", "--selftest", "--travel", "0.033"));
    CHECK(s.status == 1 && strstr(s.out, "497)") &&
              strstr(s.out, " 8   1 encoder step     9   falls"),
        "%s", s.out);
    said(&s, dir, lab_glove, WORDS("glove", "--selftest", "--device", "decode=4"));
    CHECK(s.status == 0 && strstr(s.out, " 11   1 encoder step     9\n"), "%s", s.out);
    said_clean(dir);
}

/* The quietest sensor is a dead one: Table I alone would call its bits stable. */
TEST(a_dead_glove_fails)
{
    const char *dir = said_dir();
    said(&s, dir, lab_glove, WORDS("glove", "--selftest", "--device", "excite=0.1"));
    CHECK(s.status == 1, "%d: %s", s.status, s.out);
    CHECK(strstr(s.out, "Not believed: ThumbRotate ThumbMPJ ") && strstr(s.out, " WristYaw\n"),
        "%s", s.out);
    said_clean(dir);
}

/* Ticks are not frames: a scene may ask less often, and a scan may be longer than a tick. */
TEST(frames_have_a_rate_of_their_own)
{
    static const struct {
        const char *rate, *set, *device, *says;
    } row[] = {
        {"2000", "every=1", "interval=0.000004", "\n20000 frames of 22 channels at 2000 Hz, 10 s"},
        {"2000", "every=5", "interval=0.000004", "\n4000 frames of 22 channels at 400 Hz, 10 s"},
        {"2000", "every=1", "interval=0.00006", "\n6667 frames of 22 channels at 666.667 Hz, 10 s"},
        {"20000", "every=1", "interval=0.000004",
            "\n100000 frames of 22 channels at 10000 Hz, 10 s"}};
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        said(&s, dir, lab_glove,
            WORDS("glove", "--selftest", "--rate", row[i].rate, "--set", row[i].set, "--device",
                row[i].device));
        CHECK(s.status == 0 && strstr(s.out, row[i].says), "row %zu: %d: %s", i, s.status, s.out);
        CHECK(number_after(strstr(s.out, "\n        30"), "mV", 1) < 7.52, "row %zu: %s", i, s.out);
    }
    said(&s, dir, lab_glove,
        WORDS("glove", "--record", "/dev/null", "--set", "every=5", "--set", "glove_fc=199"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    said(&s, dir, lab_glove,
        WORDS("glove", "--record", "/dev/null", "--set", "every=5", "--set", "glove_fc=201"));
    CHECK(s.status == 2 && strstr(s.err, "at or above half the rate"), "of 400 Hz: %d: %s",
        s.status, s.err);
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
            snprintf(cell, sizeof cell, "%d%c", 1000 * i + n % 4 + (i == 5 ? n % 2 * 29 : 0),
                i < 21 ? ',' : '\n');
            strcat(text, cell);
        }
    }
    write_text(csv, text);
    said(&s, dir, lab_glove, WORDS("glove", "--selftest", "--csv", csv, "--rate", "100"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    CHECK(strstr(s.out, "(32 codes)") && strstr(s.out, "IndexPIJ") && strstr(s.out, " 11   6.1 mV"),
        "%s", s.out);
    CHECK(strstr(s.out, "motor") == strstr(s.out, "motor at rest"), "no motor in it: %s", s.out);
    said(&s, dir, lab_glove,
        WORDS("glove", "--selftest", "--csv", csv, "--rate", "100", "--to", "0.01", "--span", "5"));
    CHECK(
        s.status == 0 && strstr(s.out, "(1 codes)") && strstr(s.out, " 14   6.1 mV"), "%s", s.out);
    said(&s, dir, lab_glove,
        WORDS("glove", "--selftest", "--csv", csv, "--rate", "100", "--from", "0.2"));
    CHECK(s.status == 2 && strstr(s.err, "it ends at 0.2 s"), "%d: %s", s.status, s.err);
    said(&s, dir, lab_glove, WORDS("glove", "--record", log, "--seconds", "5"));
    CHECK_EQ_I64(s.status, 0);
    said(&s, dir, lab_glove, WORDS("glove", "--selftest", "--log", log));
    CHECK(s.status == 0 && strstr(s.out, "10000 frames"), "%d: %s%s", s.status, s.err, s.out);
    said_clean(dir);
}

/* ---- Skew ------------------------------------------------------------------------------- */

/* Errors are in proportion to the interval and to the speed. The delay part is the way of a
 * fingertip in a scan. Its speed is below the sum of the joints' speeds times their lever arms. */
TEST(skew_grows_with_interval_and_speed)
{
    const char *dir = said_dir();
    double um[2][5][4];
    const char *at;
    said(&s, dir, lab_glove, WORDS("glove", "--skew"));
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
        CHECK(um[0][4][c] > 4.95 * um[0][0][c] && um[0][4][c] < 5.05 * um[0][0][c],
            "interval, column %d", c);
        CHECK(um[1][0][c] > 2.47 * um[0][0][c] && um[1][0][c] < 2.53 * um[0][0][c],
            "speed, column %d", c);
    }
    /* Once found to be so: also which channel comes first matters. */
    CHECK(um[0][0][0] > 36.0 && um[0][0][0] < 36.6 && um[0][0][2] > 12.3 && um[0][0][2] < 12.6,
        "%g %g um", um[0][0][0], um[0][0][2]);
    /* 338 deg/s at three joints, 25 mm at each lever: below 5.9 * 0.105 * (1 + 0.48 + 0.24) m/s */
    CHECK(um[0][0][0] > 20 && um[0][0][0] < 88e-6 * 1.1e6, "%g um", um[0][0][0]);
    CHECK(um[0][0][2] < um[0][0][0] / 2 && um[0][0][1] < um[0][0][0], "%g um", um[0][0][2]);
    said_clean(dir);
}

TEST_MAIN("glove_table1", the_selftest_gives_the_papers_rows, a_low_pass_gives_bits_for_delay,
    too_much_noise_falls_short, a_dead_glove_fails, frames_have_a_rate_of_their_own,
    the_selftest_takes_recordings, skew_grows_with_interval_and_speed);
