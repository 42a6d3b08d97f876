/* SPDX-License-Identifier: MIT */
/* exhand calibrate --glove finds the simulated glove's parameters again, names what is wrong, and
 * reads and writes files. */
#include "said.h"

#include "glove/poses.h"
#include "sim/glove.h"

#include "exhand/error.h"
#include "exhand/glove.h"

#include <math.h>

#define RAD (3.14159265358979323846 / 180)

/* --- against the truth --- */

static struct exh_glove_cal made_by(const char *dir, const char *miss_deg, const char *couple)
{
    static struct said s;
    static uint8_t image[EXH_GLOVE_CAL_IMAGE_B];
    struct exh_glove_cal cal;
    struct exh_glove_error bad;
    FILE *f;
    said(&s, dir, cli_calibrate_glove,
        WORDS("calibrate", "--glove", "--out", dir, "--miss", miss_deg, "--device", couple,
            "--user", "5", "--id", "6", "--day", "20000", "--valid", "30"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    f = fopen(said_path(dir, "glove.bin"), "rb");
    CHECK(f != NULL && fread(image, 1, sizeof image, f) == sizeof image && getc(f) == EOF,
        "glove.bin");
    fclose(f);
    CHECK_EQ_I64(exh_glove_cal_load(&cal, image, sizeof image, &bad), 0);
    CHECK_EQ_I64(exh_glove_cal_check(&cal, 5, 6, 20030, &bad), 0);
    return cal;
}

/* Any posture between the sensors' end points: the worst error of the 22 angles that the
 * library makes of the codes, rad. No noise: what is left is the calibration's. */
static double worst_of(const struct exh_glove_cal *cal, double couple, uint64_t seed)
{
    const struct exh_glove_par par = {0, 65536, 16, 0, -32700, 32700, 1, 1, 8 * 65536};
    struct sim_glove_par p = sim_glove_default();
    static struct sim_glove g;
    struct exh_glove_cfg cfg;
    struct exh_glove s;
    struct exh_glove_in in = {{0}, 0};
    struct sim_random r = {seed};
    double rad[EXH_GLOVE_SENSORS], worst = 0;
    int32_t angle[EXH_GLOVE_SENSORS];
    p.noise_V = 0;
    p.couple = couple;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const struct sim_glove_sensor *n = &sim_glove_sensor[i];
        rad[i] = (n->lo_deg + sim_random_unit(&r) * (n->hi_deg - n->lo_deg)) * RAD;
    }
    sim_glove_start(&g, &p, 1, rad);
    memset(&s, 0, sizeof s);
    CHECK_EQ_I64(exh_glove_setup(&cfg, &par, cal, (struct exh_period){1, 1000}), 0);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        in.raw[i] = sim_glove_code(&p, sim_glove_volt(&g, i, 0));
    }
    CHECK_EQ_I64(exh_glove_step(&s, &cfg, &in, angle), 0);
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const double off = fabs(angle[i] * (360 * RAD / 4294967296.0) - rad[i]);
        if (off > worst) { worst = off; }
    }
    return worst;
}

static double worst_of_many(const struct exh_glove_cal *cal, double couple)
{
    double worst = 0;
    for (uint64_t k = 0; k < 200; k++) {
        const double w = worst_of(cal, couple, k + 1);
        if (w > worst) { worst = w; }
    }
    return worst;
}

/* Codes per degree of the simulated sensor, sign and all. */
static double true_gain(unsigned i)
{
    const struct sim_glove_sensor *n = &sim_glove_sensor[i];
    return (n->hi_deg - n->lo_deg) / ((n->hi - n->lo) * 18.0 / 20 * 65536);
}

static double worst_gain(const struct exh_glove_cal *cal)
{
    double worst = 0;
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        const double off =
            fabs(cal->sensor[i].gain_turnpraw_q38 * 360.0 / 274877906944.0 / true_gain(i) - 1);
        if (off > worst) { worst = off; }
    }
    return worst;
}

/* A person who hits every angle: 200 frames of 6.1 mV of noise leave next to nothing. */
TEST(a_good_hand_is_found_back)
{
    char *dir = said_dir();
    const struct exh_glove_cal cal = made_by(dir, "0", "couple=0.3");
    const double gain = worst_gain(&cal), rad = worst_of_many(&cal, 0.3);
    check_note(
        "poses hit exactly: gains within %.3f %%, angles within %.2f mrad", gain * 100, rad * 1e3);
    CHECK(gain > 1e-6 && gain < 2e-3, "%.3g", gain);
    CHECK(rad > 1e-5 && rad < 2e-3, "%.3g", rad);
    CHECK(fabs(cal.sensor[10].cross_q30[0] / 1073741824.0 + 0.15) < 2e-3 &&
              fabs(cal.sensor[10].cross_q30[1] / 1073741824.0 + 0.15) < 2e-3 &&
              fabs(cal.sensor[3].cross_q30[0] / 1073741824.0 + 0.3) < 2e-3,
        "%.4f %.4f", cal.sensor[10].cross_q30[0] / 1073741824.0,
        cal.sensor[10].cross_q30[1] / 1073741824.0);
    said_clean(dir);
}

/* A person who misses each by up to a degree: the angles come out about so well, too. */
TEST(a_real_hand_is_found_back)
{
    char *dir = said_dir();
    const struct exh_glove_cal cal = made_by(dir, "1", "couple=0.08");
    const double gain = worst_gain(&cal), rad = worst_of_many(&cal, 0.08);
    const double fallback = worst_of_many(&exh_glove_cal_default, 0.08);
    check_note("poses missed by up to 1 deg: gains within %.2f %%, angles within %.1f mrad; the "
               "default calibration: "
               "%.1f mrad",
        gain * 100, rad * 1e3, fallback * 1e3);
    CHECK(gain > 2e-3 && gain < 0.08, "%.3g", gain);
    CHECK(rad > 5e-3 && rad < 0.08, "%.3g", rad);
    CHECK(fallback > 0.05 && fallback < 0.2, "%.3g",
        fallback); /* no cross terms, but this hand's lines */
    said_clean(dir);
}

/* --- words --- */

TEST(exit_status_says_what_happened)
{
    static const struct {
        int status;
        const char *word[8], *says; /* @ in a word: the directory */
    } row[] = {
        {0, {"--help"}, NULL},
        {0, {"--list"}, NULL},
        {0, {"--params"}, NULL},
        {0, {"--out", "@", "--day", "20000", "--user", "5"}, NULL},
        {0, {"--check", "@/glove.bin", "--day", "20090", "--user", "5"}, NULL},
        {1, {"--check", "@/glove.bin", "--day", "20091", "--user", "5"}, "stale"},
        {1, {"--check", "@/glove.bin", "--day", "19999", "--user", "5"}, "from the future"},
        {1, {"--check", "@/glove.bin", "--day", "20000", "--user", "6"},
            "made for user 5, this is 6"},
        {1, {"--check", "@/glove.bin", "--day", "20000", "--user", "5", "--id", "2"},
            "made for glove 1, this is 2"},
        {1, {"--check", "@/glove.csv"}, "image"},
        {3, {"--check", "@/none"}, "No such file"},
        {2, {"--check", "@"}, "can't be read"},
        {0, {"--poses", "@/poses.csv"}, NULL},
        {1, {"--poses", "/dev/null"}, "0 poses"},
        {3, {"--poses", "@/none"}, "No such file"},
        {2, {"--poses", "@"}, "can't be read"},
        {2, {"--poses", "@/glove.csv"}, "line 1: sensor: no such pose"},
        {0, {"--sensors", "18"}, NULL},
        {2, {"--sensors", "20"}, "18 or 22"},
        {1, {"--wrong", "IndexMPJ=open"}, "IndexMPJ: at the end of the card"},
        {1, {"--wrong", "WristYaw=short"}, "WristYaw: at the end of the card"},
        {1, {"--wrong", "PalmArch=stuck"}, "PalmArch: movement between poses"},
        {1, {"--device", "noise=0.1"}, "RingDIJ: noise in a pose"},
        {0, {"--device", "noise=0.1", "--noise", "400"}, NULL},
        {1, {"--miss", "10"}, "deg in pose"},
        {0, {"--miss", "10", "--residual", "30"}, NULL},
        {1, {"--device", "gain=0.1", "--device", "offset=0"}, "under 256 codes"},
        {2, {"--out", "@/glove.bin"}, "give a directory"},
        {2, {"--wrong", "IndexMPJ"}, "SENSOR=open"},
        {2, {"--wrong", "IndexMPJ=bad"}, "SENSOR=open"},
        {2, {"--device", "nothing=1"}, "no such value"},
        {2, {"--device", "noise=2"}, "allowed 0..1"},
        {2, {"--device", "noise"}, "NAME=VALUE"},
        {2, {"--mass", "0.1"}, "no such option"}, /* the motors' */
        {2, {"word"}, "one word too many"},
    };
    static struct said s;
    char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        const char *word[12] = {"calibrate", "--glove"};
        char with[8][300];
        size_t n = 0;
        for (; n < 8 && row[i].word[n] != NULL; n++) {
            const char *w = row[i].word[n];
            snprintf(
                with[n], sizeof with[n], "%s%s", w[0] == '@' ? dir : "", w[0] == '@' ? w + 1 : w);
            word[2 + n] = with[n];
        }
        said(&s, dir, cli_calibrate_glove, word);
        CHECK(s.status == row[i].status, "row %zu: %d: %s", i, s.status, s.err);
        CHECK(row[i].says == NULL || strstr(s.err, row[i].says) != NULL, "row %zu: %s", i, s.err);
        CHECK((s.status != 0) == (s.err[0] != '\0'), "row %zu: %s", i, s.err);
    }
    said_clean(dir);
}

/* One bad sensor does not hide another, and nothing is written. */
TEST(all_that_is_wrong_is_told_at_once)
{
    static struct said s;
    char *dir = said_dir();
    said(&s, dir, cli_calibrate_glove,
        WORDS("calibrate", "--glove", "--out", dir, "--wrong", "IndexMPJ=open", "--wrong",
            "ThumbIJ=stuck"));
    CHECK_EQ_I64(s.status, 1);
    CHECK(strstr(s.err, "IndexMPJ: at") && strstr(s.err, "ThumbIJ: movement") &&
              strstr(s.err, "MiddleIndexAb: cross"),
        "%s", s.err);
    CHECK(strstr(s.err, "RingMPJ") == NULL, "%s", s.err);
    CHECK(said_size(said_path(dir, "glove.bin")) < 0, "written");
    said_clean(dir);
}

/* --- recorded poses --- */

static void write_text(const char *path, const char *text)
{
    FILE *f = fopen(path, "wb");
    CHECK(f != NULL && fputs(text, f) >= 0 && fclose(f) == 0, "%s", path);
}

/* Several lines of a pose are averaged, whatever ends them. */
TEST(lines_of_a_pose_are_averaged)
{
    static const char *const end[] = {"\n", "\r", "\r\n"};
    static struct glove_taken t;
    char *dir = said_dir(), text[2000];
    const char *path = said_path(dir, "in.csv");
    for (size_t e = 0; e < LEN(end); e++) {
        struct exh_glove_pose pose[GLOVE_POSES];
        uint8_t which[GLOVE_POSES];
        int n = snprintf(text, sizeof text, "# taken by hand%spose,codes%s", end[e], end[e]);
        for (int k = 0; k < 3; k++) {
            n += snprintf(text + n, sizeof text - (size_t)n, "%s", k == 1 ? "hook" : "spread");
            for (int i = 0; i < EXH_GLOVE_SENSORS; i++) {
                n += snprintf(text + n, sizeof text - (size_t)n, ",%d", 100 * k - i);
            }
            n += snprintf(text + n, sizeof text - (size_t)n, "%s", end[e]);
        }
        write_text(path, text);
        CHECK_EQ_I64(glove_poses_read(&t, path), 0);
        CHECK_EQ_I64(glove_poses_fit(pose, which, &t), 2);
        CHECK(which[0] == 1 && which[1] == 3, "%d %d", which[0], which[1]);
        for (int i = 0; i < EXH_GLOVE_SENSORS; i++) {
            CHECK_EQ_I64(pose[0].mean_raw_q16[i], (100 - i) * 65536);
            CHECK_EQ_I64(pose[0].noise_raw[i], 200);
            CHECK_EQ_I64(pose[1].mean_raw_q16[i], (100 - i) * 65536);
            CHECK_EQ_I64(pose[1].noise_raw[i], 0);
        }
    }
    said_clean(dir);
}

/* A glove without last joints: each follows the middle joint beside it. */
TEST(a_glove_of_18_sensors_lacks_the_last_joints)
{
    static const char *const line[] = {"\nIndexDIJ         +0.6667 of IndexPIJ (not measured)\n",
        "\nMiddleDIJ        +0.6667 of MiddlePIJ (not measured)\n",
        "\nRingDIJ          +0.6667 of RingPIJ (not measured)\n",
        "\nPinkieDIJ        +0.6667 of PinkiePIJ (not measured)\n"};
    static struct said s;
    char *dir = said_dir();
    said(&s, dir, cli_calibrate_glove, WORDS("calibrate", "--glove", "--sensors", "18"));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    for (size_t i = 0; i < LEN(line); i++) {
        CHECK(strstr(s.out, line[i]) != NULL, "no %s: %s", line[i], s.out);
    }
    said_clean(dir);
}

TEST(bad_lines_are_told_by_number)
{
    static const char *const nine = "1,1,1,1,1,1,1,1,1,";
    static const struct {
        const char *tail, *says;
    } row[] = {{"1,1,1", "too few"}, {"1,1,1,1,1", "too many"}, {"1,1,1,x", "no code"},
        {"1,1,1,32768", "no code"}, {"1,1,1,1e", "no code"}, {"1,1,1,nan", "no code"}};
    static struct said s;
    char *dir = said_dir(), text[300];
    const char *path = said_path(dir, "in.csv");
    for (size_t i = 0; i < LEN(row); i++) {
        snprintf(
            text, sizeof text, "%sflat,%s%s%s\n", i % 2 ? "\n" : "\r\n", nine, nine, row[i].tail);
        write_text(path, text);
        said(&s, dir, cli_calibrate_glove, WORDS("calibrate", "--glove", "--poses", path));
        CHECK(s.status == 2 && strstr(s.err, "line 2") && strstr(s.err, row[i].says),
            "row %zu: %d: %s", i, s.status, s.err);
    }
    write_text(path, "flat\n");
    said(&s, dir, cli_calibrate_glove, WORDS("calibrate", "--glove", "--poses", path));
    CHECK(s.status == 2 && strstr(s.err, "too few"), "%d: %s", s.status, s.err);
    said_clean(dir);
}

/* The recorded means give what the live ones gave. */
TEST(recorded_poses_give_the_same)
{
    static struct said s;
    static uint8_t image[2][EXH_GLOVE_CAL_IMAGE_B];
    struct exh_glove_cal cal[2];
    char *dir = said_dir(), again[100];
    struct exh_glove_error bad;
    snprintf(again, sizeof again, "%s/again", dir);
    said(&s, dir, cli_calibrate_glove,
        WORDS("calibrate", "--glove", "--out", dir, "--day", "20000"));
    CHECK_EQ_I64(s.status, 0);
    said(&s, dir, cli_calibrate_glove,
        WORDS("calibrate", "--glove", "--out", again, "--day", "20000", "--poses",
            said_path(dir, "poses.csv")));
    CHECK(s.status == 0, "%s", s.err);
    for (int k = 0; k < 2; k++) {
        FILE *f = fopen(said_path(k ? again : dir, "glove.bin"), "rb");
        CHECK(f != NULL && fread(image[k], 1, sizeof image[k], f) == sizeof image[k], "glove.bin");
        fclose(f);
        CHECK_EQ_I64(exh_glove_cal_load(&cal[k], image[k], sizeof image[k], &bad), 0);
    }
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) { /* four decimals of a code */
        CHECK(fabs((double)(cal[0].sensor[i].zero_raw_q15 - cal[1].sensor[i].zero_raw_q15)) < 32,
            "%u", i);
        CHECK(fabs((double)cal[0].sensor[i].gain_turnpraw_q38 / cal[1].sensor[i].gain_turnpraw_q38 -
                   1) < 1e-6,
            "%u", i);
    }
    said_clean(dir);
}

/* Poses by number behind a time, codes of 8 bits and fractions: the same image, byte for byte. */
static void other_columns(const char *from, const char *to, const char *rest)
{
    FILE *in = fopen(from, "r"), *out = fopen(to, "w");
    char line[2000];
    CHECK(in != NULL && out != NULL && fgets(line, sizeof line, in), "%s, %s", from, to);
    fputs("t\tpose", out);
    for (int i = 0; i < EXH_GLOVE_SENSORS; i++) { fprintf(out, "\ts %d", i); }
    for (int n = 0; fgets(line, sizeof line, in); n++) {
        char *at = strchr(line, ',');
        *at++ = '\0';
        fprintf(out, "\n%d\t", 5 * n);
        fprintf(out, n % 2 ? "%s" : "%.0s%d", line, glove_pose_find(line) + 1);
        for (int i = 0; i < EXH_GLOVE_SENSORS; i++, at++) {
            fprintf(out, "\t%.12f", (strtod(at, &at) + 32768) / 256);
        }
    }
    fprintf(out, "\n%s", rest);
    CHECK(fclose(in) == 0 && fclose(out) == 0, "%s", to);
}

#define TEN_60 "60\t60\t60\t60\t60\t60\t60\t60\t60\t60"
#define ALL_60 TEN_60 "\t60\t"

TEST(poses_in_other_columns_give_the_same)
{
    static struct said s;
    static char image[2][EXH_GLOVE_CAL_IMAGE_B];
    char *dir = said_dir(), *in = strdup(said_path(dir, "in.tsv")), poses[100], once[100];
    snprintf(once, sizeof once, "%s/once", dir);
    snprintf(poses, sizeof poses, "%s/poses.csv", dir);
    said(&s, dir, cli_calibrate_glove, WORDS("calibrate", "--glove", "--out", dir));
    CHECK(s.status == 0, "%s", s.err);
    other_columns(poses, in, "0\t1\tnan\t" ALL_60 TEN_60 "\n");
    for (int k = 0; k < 2; k++) {
        const char *const read = k ? in : poses;
        FILE *f;
        said(&s, dir, cli_calibrate_glove,
            WORDS("calibrate", "--glove", "--out", once, "--day", "20000", "--poses", read,
                k ? "--columns" : NULL, "3-24,label=pose", "--scale", "256,-32768"));
        CHECK(s.status == 0, "%d: %s", s.status, s.err);
        f = fopen(said_path(once, "glove.bin"), "rb");
        CHECK(f != NULL && fread(image[k], 1, sizeof image[k], f) == sizeof image[k], "glove.bin");
        fclose(f);
    }
    CHECK(strstr(s.err, "1 rows are left out") != NULL, "%s", s.err);
    CHECK(memcmp(image[0], image[1], sizeof image[0]) == 0, "another calibration");
    free(in);
    said_clean(dir);
}

TEST(poses_in_bad_columns_are_refused)
{
    static const struct {
        const char *row, *columns, *says;
    } row[] = {
        {"1\t", "2-23", "no pose: label=C"},
        {"16\t", "2-23,label=1", "row 1: 16: no such pose"},
        {"0\t", "2-23,label=1", "row 1: 0: no such pose"},
        {"\x1b[1m\t", "2-23,label=1", "row 1: ?[1m: no such pose"},
        {"1\t", "2-23,label=24", "line 1: 23 columns (24 wanted)"},
    };
    static struct said s;
    char *dir = said_dir(), text[300];
    const char *in = said_path(dir, "in.tsv");
    for (size_t i = 0; i < LEN(row); i++) {
        snprintf(text, sizeof text, "%s" ALL_60 TEN_60 "\t60\n", row[i].row);
        write_text(in, text);
        said(&s, dir, cli_calibrate_glove,
            WORDS("calibrate", "--glove", "--poses", in, "--columns", row[i].columns));
        CHECK(s.status == 2 && strstr(s.err, row[i].says), "row %zu: %d: %s", i, s.status, s.err);
    }
    said(&s, dir, cli_calibrate_glove, WORDS("calibrate", "--glove", "--columns", "1-22"));
    CHECK(s.status == 2 && strstr(s.err, "--columns goes with"), "%s", s.err);
    said_clean(dir);
}

/* Every sensor moves in poses that know it, and every abduction is seen with each of its
 * knuckles bent alone. */
TEST(poses_know_enough)
{
    for (unsigned i = 0; i < EXH_GLOVE_SENSORS; i++) {
        int low = 999, high = -999, n = 0;
        for (unsigned p = 0; p < GLOVE_POSES; p++) {
            int deg;
            if (!glove_pose_says(p, i, &deg)) { continue; }
            n++;
            low = deg < low ? deg : low;
            high = deg > high ? deg : high;
        }
        CHECK(n >= 2 && high - low >= 20, "%s: %d poses, %d .. %d", exh_glove_sensor_text(i), n,
            low, high);
    }
}

TEST_MAIN("sim/glove_calibrate", a_good_hand_is_found_back, a_real_hand_is_found_back,
    exit_status_says_what_happened, all_that_is_wrong_is_told_at_once, lines_of_a_pose_are_averaged,
    a_glove_of_18_sensors_lacks_the_last_joints, bad_lines_are_told_by_number,
    recorded_poses_give_the_same, poses_in_other_columns_give_the_same,
    poses_in_bad_columns_are_refused, poses_know_enough);
