/* SPDX-License-Identifier: MIT */
/* What gloves recorded, as string for fingers: files of both kinds, and real hands through the
 * simulated exoskeleton. */
#include "check.h"
#include "file_of.h"
#include "said.h"

#include "box/hand_record.h"

#include <math.h>

static struct sim_exo_par exo_par;

/* A row of the timed kind: knuckle, first and last joint of the index, the rest 0. */
static void timed(
    char *to, size_t cap, double minute, double second, double knuckle, double first, double last)
{
    const size_t n = strlen(to);
    snprintf(to + n, cap - n, "2014 09 15 23 %.0f %.5f 1 0 0 0 0 %.6f %.6f %.6f 0.3", minute,
        second, knuckle, first, last);
    for (int k = 8; k < 23; k++) { strcat(to, " 0"); }
    strcat(to, "\n");
}

TEST(rows_with_a_clock_go_onto_an_even_grid)
{
    static char text[100000];
    struct hand_record h;
    double arm[3];
    const char *name;
    text[0] = '\0';
    exo_par = sim_exo_default();
    memcpy(arm, exo_par.finger[1].arm_m, sizeof arm);
    for (int n = 0; n < 100;
         n++) { /* the knuckle bends, counted down, at 1 rad/s, by a bad clock */
        const double t = n * 0.0155 + (n % 3) * 0.004;
        timed(text, sizeof text, t + 59.2 < 60 ? 58 : 59, t + 59.2 < 60 ? t + 59.2 : t - 0.8, -t,
            -0.5, -0.25);
    }
    name = file_of(text);
    CHECK_EQ_I64(hand_record_read(&h, name, NULL, 5, &exo_par), 0);
    (void)remove(name);
    CHECK(
        h.row_hz == 60 && h.rows == (long)(1.5345 * 60) + 1, "%ld rows at %g Hz", h.rows, h.row_hz);
    for (long n = 0; n < h.rows; n++) {
        const double want = arm[0] * ((double)n / 60) + arm[1] * 0.5 + arm[2] * 0.25;
        CHECK(fabs(h.string_m[1][n] - want) < 1e-6, "row %ld: %.9f, want %.9f", n, h.string_m[1][n],
            want);
        CHECK(h.string_m[0][n] == 0 && h.string_m[2][n] == 0 && h.string_m[4][n] == 0, "others");
    }
    hand_record_free(&h);
}

TEST(every_finger_gets_its_own_angles)
{
    /* 23 angles 0.01, 0.02, ...: which of them bend which finger */
    static const double want[5][3] = {
        {2, 3, 3}, {5, 6, 7}, {9, 10, 11}, {13, 14, 15}, {17, 18, 19}};
    char text[2000];
    struct hand_record h;
    const char *name;
    exo_par = sim_exo_default();
    text[0] = '\0';
    for (int row = 0; row < 2; row++) {
        snprintf(text + strlen(text), 100, "2014 9 15 0 0 %d 0", row);
        for (int k = 1; k <= 23; k++) { snprintf(text + strlen(text), 20, " %.2f", k * 0.01); }
        strcat(text, "\n");
    }
    name = file_of(text);
    CHECK_EQ_I64(hand_record_read(&h, name, NULL, 5, &exo_par), 0);
    (void)remove(name);
    CHECK_EQ_I64(h.rows, 61);
    for (unsigned i = 0; i < 5; i++) {
        const double *arm = exo_par.finger[i].arm_m;
        const double m = 0.01 * (arm[0] * want[i][0] + arm[1] * want[i][1] + arm[2] * want[i][2]);
        CHECK(fabs(h.string_m[i][30] - m) < 1e-9, "finger %u: %.6f, want %.6f", i,
            h.string_m[i][30], m);
    }
    hand_record_free(&h);
}

TEST(rows_without_a_clock_have_the_rate_they_are_given)
{
    struct hand_record h;
    const char *name = file_of("0,0,0,0,.5,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\r0,0,0,0,1.5,0,0,0,0,"
                               "0,0,0,0,0,0,0,0,0,0,0,0,0\r");
    exo_par = sim_exo_default();
    CHECK_EQ_I64(hand_record_read(&h, name, NULL, 12.5, &exo_par), 0);
    (void)remove(name);
    CHECK(h.rows == 2 && h.row_hz == 12.5, "%ld rows", h.rows);
    CHECK(fabs(h.string_m[1][0] - 0.01) < 1e-12 && fabs(h.string_m[1][1] - 0.03) < 1e-12, "string");
    hand_record_use(&h, &exo_par);
    CHECK(exo_par.record[1].string_m == h.string_m[1] && exo_par.record[4].rows == 2, "use");
    hand_record_free(&h);
}

/* Behind the last row a way leads to the first, as smooth as all else, and time goes on. */
TEST(a_recording_again_has_no_seam)
{
    const struct sim_path_load load = {0, 0, 0, 0, 300, 5};
    const struct sim_path_par par = sim_path_default();
    struct hand_record h;
    struct sim_path p;
    const char *name = file_of("0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n"
                               "0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n"
                               "0,0,0,0,2,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n");
    double last, once_m[60];
    exo_par = sim_exo_default();
    CHECK_EQ_I64(hand_record_read(&h, name, NULL, 10, &exo_par), 0);
    (void)remove(name);
    CHECK_EQ_I64(hand_record_again(&h), 0);
    hand_record_use(&h, &exo_par);
    CHECK(h.rows == 13 && exo_par.record[1].again, "%ld rows", h.rows);
    sim_path_start(&p, &par, &load, &exo_par.record[1], 1);
    last = sim_path_at(&p, 0);
    for (int n = 1; n < 60000; n++) { /* 1.3 s a round */
        const double t = n * 1e-3;
        double now;
        sim_path_advance(&p, t);
        now = sim_path_at(&p, t);
        CHECK(fabs(now - last) < 0.3e-3, "%.3f s: %.6f m, then %.6f m", t, last, now);
        last = now;
        if (n >= 1300 && n < 2600 && n % 50 == 0) { once_m[(n - 1300) / 50] = now; }
        if (n >= 53300 && n < 54600 && n % 50 == 0) {
            CHECK(fabs(now - once_m[(n - 53300) / 50]) < 1e-9, "round 41 is not round 1");
        }
    }
    CHECK(once_m[6] > 0.02, "%.4f m, rows to 0.04 m", once_m[6]);
    hand_record_free(&h);
}

/* Time and angles in a different order of columns, also on the even grid. */
TEST(columns_say_where_time_and_angles_are)
{
    char text[1000] = "";
    struct hand_record h;
    const char *name;
    exo_par = sim_exo_default();
    for (int n = 0; n < 3; n++) { /* only the index's knuckle bends, 1 rad/s, past an even clock */
        const double t = n == 1 ? 0.04 : n * 0.05;
        snprintf(text + strlen(text), 200,
            "x;0;0;0;0;%.3f;0;0;0;0;0;0;0;0;0;0;0;0;0;0;0;0;0;%.0f\n", t, 7e6 + 1e3 * t);
    }
    name = file_of(text);
    CHECK_EQ_I64(hand_record_read(&h, name, "2-23,time_ms=24", 5, &exo_par), 0);
    (void)remove(name);
    CHECK(h.rows == 7 && h.row_hz == 60, "%ld rows at %g Hz", h.rows, h.row_hz);
    for (long n = 0; n < h.rows; n++) {
        const double want = exo_par.finger[1].arm_m[0] * ((double)n / 60);
        CHECK(fabs(h.string_m[1][n] - want) < 1e-12, "row %ld: %.9f, want %.9f", n,
            h.string_m[1][n], want);
    }
    hand_record_free(&h);
}

static const char *bad_path;

static int command(int argc, char **argv)
{
    struct hand_record h;
    (void)argc;
    (void)argv;
    return hand_record_read(&h, bad_path, NULL, 10, &exo_par);
}

TEST(bad_files_are_refused_with_the_line)
{
#define ROW "2014 9 15 0 0 %s 1 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n"
    static const struct {
        const char *first, *second, *why;
    } row[] = {{"1", "1", "line 2: its clock stands or jumps"},
        {"2", "1", "line 2: its clock stands or jumps"},
        {"1", "12", "line 2: its clock stands or jumps"},
        {"1", "2 2", "line 2: 31 columns (30 in the first line)"},
        {"1", "x", "line 2, column 6: \"x\" is no number"}};
    static const char *const word[] = {"hand", NULL};
    struct said s;
    char dir[] = "/tmp/hand_record_test.XXXXXX", path[64];
    CHECK(mkdtemp(dir) != NULL, "%s", dir);
    exo_par = sim_exo_default();
    for (size_t i = 0; i <= sizeof row / sizeof row[0]; i++) {
        const int missing = i == sizeof row / sizeof row[0];
        char text[1000];
        pid_t pid;
        snprintf(text, sizeof text, ROW, row[missing ? 0 : i].first);
        snprintf(text + strlen(text), sizeof text - strlen(text), ROW, row[missing ? 0 : i].second);
        bad_path = file_of(text);
        if (missing) { (void)remove(bad_path); }
        pid = said_start(dir, command, word);
        said_end(&s, dir, pid);
        (void)remove(bad_path);
        CHECK(s.status == (missing ? 3 : 2) &&
                  strstr(s.err, missing ? "No such file" : row[i].why) != NULL,
            "row %zu: %d, %s", i, s.status, s.err);
    }
    snprintf(path, sizeof path, "%s/said.out", dir);
    (void)remove(path);
    snprintf(path, sizeof path, "%s/said.err", dir);
    (void)remove(path);
    (void)remove(dir);
}

/* Real hands: the fingers follow what was recorded, and no farther than a hand bends. */
static void follow(const char *file, double row_hz, double run_s)
{
    static struct sim_exo exo;
    const struct sim_device d = sim_device_default();
    const char *dir = getenv("EXH_DATA");
    struct hand_record h;
    char path[512];
    double late_m = 0, most_m = 0, least_m = 1, fastest_mps = 0, was_m[SIM_FINGERS] = {0};
    FILE *f;
    snprintf(path, sizeof path, "%s/%s", dir ? dir : "$EXH_DATA", file);
    f = fopen(path, "rb");
    if (f == NULL) {
        check_note("%s: not here, nothing recorded was tried", path);
        return;
    }
    fclose(f);
    exo_par = sim_exo_default();
    exo_par.fingers = 0x1F;
    CHECK_EQ_I64(hand_record_read(&h, path, NULL, row_hz, &exo_par), 0);
    hand_record_use(&h, &exo_par);
    CHECK_EQ_I64(sim_exo_start(&exo, &exo_par, &d, 3, 0), 0);
    for (int n = 1; n * 0.005 < run_s && !sim_exo_done(&exo); n++) {
        sim_exo_advance(&exo, n * 0.005);
        for (unsigned i = 0; i < SIM_FINGERS; i++) {
            const double x = exo.finger[i].plant.x_m;
            const double off = fabs(x - sim_path_wanted(&exo.finger[i].path, n * 0.005));
            const double v = fabs(x - was_m[i]) / 0.005;
            late_m = off > late_m ? off : late_m;
            most_m = x > most_m ? x : most_m;
            least_m = x < least_m ? x : least_m;
            fastest_mps = n > 1 && v > fastest_mps ? v : fastest_mps;
            was_m[i] = x;
        }
    }
    check_note("%s: %.1f s, %.1f..%.1f mm of string, up to %.2f m/s, at most %.1f mm off", file,
        (double)h.rows / h.row_hz, 1e3 * least_m, 1e3 * most_m, fastest_mps, 1e3 * late_m);
    CHECK(most_m > 0.02 && most_m < 0.13 && least_m >= 0, "%.4f..%.4f m", least_m, most_m);
    CHECK(late_m > 0 && late_m < 0.01, "%.4f m off", late_m);
    CHECK(fastest_mps > 0.02 && fastest_mps < 3, "%.3f m/s", fastest_mps);
    hand_record_free(&h);
}

TEST(fingers_follow_real_hands)
{
    follow("glove-cyberglove-libras-alphabet/alphabet.csv", 10, 40);
    follow("glove-cyberglove-graspdb14/10_ex01-rad-003-grasp-su04.txt", 0, 30);
    follow("glove-cyberglove-graspdb14/04_ex01-rad-045-grasp-su03.txt", 0, 30);
    follow("glove-cyberglove-graspdb14/00_calib-rad-su01.txt", 0, 40);
}

TEST_MAIN("hand_record", rows_with_a_clock_go_onto_an_even_grid, every_finger_gets_its_own_angles,
    rows_without_a_clock_have_the_rate_they_are_given, a_recording_again_has_no_seam,
    columns_say_where_time_and_angles_are, bad_files_are_refused_with_the_line,
    fingers_follow_real_hands);
