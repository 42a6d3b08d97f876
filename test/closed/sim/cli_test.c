/* SPDX-License-Identifier: MIT */
/* exhand drop as people use and misuse it: what is refused by name, what is written
 * where, what an interruption leaves. */
#include "said.h"
#include "lab/lab.h"

#include "base/jobs.h"
#include "base/logfile.h"
#include "base/param.h"
#include "box/table2.h"
#include "drop/print.h"

#include "drop/drop.h"

#include <errno.h>
#include <signal.h>
#include <time.h>

/* ---- What is refused ----------------------------------------------------------- */

#define LONG_64  "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef"
#define LONG_512 LONG_64 LONG_64 LONG_64 LONG_64 LONG_64 LONG_64 LONG_64 LONG_64

TEST(bad_usage_is_refused_by_name)
{
    static const struct {
        const char *word[6];
        const char *says;
    } row[] = {
        {{"--rate", "90x"}, "--rate: 90x: not a list"},
        {{"--rate", ""}, "--rate: : not a list"},
        {{"--rate", "90,"}, "--rate: 90,: not a list"},
        {{"--rate", "0.5"}, "--rate: 0.5: not a list"},
        {{"--rate", "90,500,90"}, "--rate: 90,500,90: a rate comes twice"},
        {{"--rate", "500", "--period", "1/90"}, "--period and --rate"},
        {{"--period", "1/90", "--rate", "500"}, "--period and --rate"},
        {{"--period", "1/90x"}, "--period: 1/90x"},
        {{"--period", "1/"}, "--period: 1/"},
        {{"--period", "1"}, "--period: 1 "},
        {{"--period", "-1/-90"}, "--period: -1/-90"},
        {{"--period", "10/200009"}, "--period: 10/200009"},
        {{"--period", "2/1"}, "--period: 2/1"},
        {{"--period", "1/4294967296"}, "--period: 1/4294967296"},
        {{"--period", "4294967297/4294967298"}, "--period: 4294967297"},
        {{"--falls", "2.5"}, "whole number"},
        {{"--seed", "99999999999999999999"}, "--seed: 99999999999999999999"},
        {{"--k", "1e6", "--scale", "100"}, "k: 100000000 "},
        {{"--b", "1000", "--scale", "3"}, "b: 3000 "},
        {{"--set", "k=5"}, "give --k 5"},
        {{"--set", "k=nan"}, "--set: k=nan: the value is no number"},
        {{"--set", "f_max=inf"}, "--set: f_max=inf: the value is no number"},
        {{"--set", "f_max=101"}, "--set: f_max: 101 (allowed 0..100 N)"},
        {{"--set", "slew_up=0"}, "N/s)"},
        {{"--set", "fmax=9"}, "fmax: no such parameter: did you mean f_max?"},
        {{"--device", "mas=1"}, "mas: no such value of the device: did you mean mass?"},
        {{"--rat", "90"}, "--rat: no such option: did you mean --rate?"},
        {{"--rnus=3"}, "--rnus: no such option: did you mean --runs?"},
        {{"--zzz"}, "--zzz: no such option: `"},
        {{"-r", "90"}, "-r: no such option"},
        {{"--k", "0x10"}, "--k: 0x10 (allowed"},
        {{"--k", " 5"}, "--k:  5 (allowed"},
        {{"--k", ""}, "--k: nothing (allowed"},
        {{"--falls"}, "--falls: its value is missing"},
        {{"--load-params", "/etc/passwd"}, "--load-params: /etc/passwd: no image"},
        {{"--set", "kf"}, "--set: kf: give NAME=VALUE"},
        {{"--set", "none=1"}, "none: no such parameter"},
        {{"--set", "q_lim=9"}, "q_lim: 9 (allowed"},
        {{"--device", "mass=9"}, "--device: mass: 9 (allowed"},
        {{"--device", "none=9"}, "--device: none: no such value"},
        {{"--device", "rotor=0.0001", "--device", "substep=1e-4"}, "give --device substep=1e-05"},
        {{"--device", "cable_k=1e6", "--device", "substep=0.001"}, "give --device substep=0.0001"},
        {{"--device", "cable_b=1000", "--device", "rotor=0.0001"}, "substep: none is short enough"},
        {{"--blackbox", "/nowhere/at/all", "--rate", "90"},
            "--blackbox: /nowhere/at/all: No such file"},
        {{"--out", "/dev/null"}, "--out: /dev/null: Not a directory"},
        {{"--out", "/nowhere/at/all"}, "--out: /nowhere/at/all: No such file"},
        {{"--out", LONG_512 LONG_512}, "--out: 0123456789"},
    };
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        const char *const *w = row[i].word;
        static struct said s;
        said(&s, dir, cli_drop, WORDS("drop", w[0], w[1], w[2], w[3], w[4]));
        CHECK(s.status == 2, "row %zu: status %d: %s", i, s.status, s.err);
        CHECK(strstr(s.err, row[i].says) != NULL, "row %zu: %s", i, s.err);
        CHECK(strncmp(s.err, "exhand drop: ", 13) == 0, "row %zu: %s", i, s.err);
        CHECK(strchr(s.err, '\n') == s.err + strlen(s.err) - 1, "row %zu: %s", i, s.err);
        CHECK(s.out[0] == '\0', "row %zu: %s", i, s.out);
    }
    said_clean(dir);
}

/* The options of a study, in addition to the others. */
TEST(bad_usage_of_a_study)
{
    static const struct {
        const char *word[4];
        const char *says;
    } row[] = {
        {{"--k", "1e6", "--gates"}, "k: 1500000 "},
        {{"--sweep", "--let-go", "1"}, "leave out --k, --b, --scale, --gates, --pace, --let-go"},
        {{"--k", "1e6", "--scale", "100"}, "k: 100000000 "},
    };
    const char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        const char *const *w = row[i].word;
        static struct said s;
        said(&s, dir, lab_drop, WORDS("drop", w[0], w[1], w[2], w[3]));
        CHECK(s.status == 2, "row %zu: status %d: %s", i, s.status, s.err);
        CHECK(strstr(s.err, row[i].says) != NULL, "row %zu: %s", i, s.err);
        CHECK(strchr(s.err, '\n') == s.err + strlen(s.err) - 1, "row %zu: %s", i, s.err);
        CHECK(s.out[0] == '\0', "row %zu: %s", i, s.out);
    }
    said_clean(dir);
}

/* The table's step is shortened to the one that a longer one's refusal names. */
TEST(a_stiff_device_is_integrated_in_shorter_steps)
{
    static const char *const given[] = {"observe=0.6", "substep=0.0002", "substep=0.0001"};
    const char *dir = said_dir();
    static struct said s[3];
    for (int i = 0; i < 3; i++) {
        said(&s[i], dir, cli_drop,
            WORDS("drop", "--rate", "200", "--falls", "1", "--device", "observe=0.6", "--device",
                "cable_k=6e5", "--device", given[i]));
        CHECK(s[i].status == 0, "%s: %d %s", given[i], s[i].status, s[i].err);
    }
    CHECK(strcmp(s[0].out, s[1].out) == 0, "by itself %s, as named %s", s[0].out, s[1].out);
    CHECK(strcmp(s[0].out, s[2].out) != 0, "the step changes nothing: %s", s[0].out);
    said_clean(dir);
}

/* A cause in the ramp is no refusal of a step before it, and no log that is damaged. */
TEST(what_ends_the_ramp_is_named)
{
    const char *dir = said_dir();
    static struct said s;
    said(&s, dir, cli_drop, WORDS("drop", "--rate", "500", "--falls", "1", "--let-go", "0.2"));
    CHECK(s.status == 1, "status %d: %s", s.status, s.err);
    CHECK(strstr(s.err, "arming: refused at ramp, causes deadman: this came before") != NULL, "%s",
        s.err);
    CHECK(strchr(s.err, '\n') == s.err + strlen(s.err) - 1, "%s", s.err);
    CHECK(s.out[0] == '\0', "%s", s.out);
    said_clean(dir);
}

/* The ends of a range as a message prints them can be given back. */
TEST(printed_ranges_are_the_true_ones)
{
    struct exh_params *p = exh_scene_drop.params;
    exh_scene_drop.defaults();
    for (uint32_t i = 0; i < exh_signal_count(p->table); i++) {
        const struct exh_signal *row = exh_signal_at(p->table, i, NULL);
        const int32_t end[] = {row->min, row->max};
        for (int e = 0; e < 2; e++) {
            char text[32];
            snprintf(text, sizeof text, "%.12g", cli_signal_value(row, end[e]));
            CHECK(cli_param_set(p, row->name, strtod(text, NULL)) == 0, "%s: %s", row->name, text);
            CHECK_EQ_I64(p->staged[i], end[e]);
        }
    }
    exh_scene_drop.defaults();
}

/* ---- The table ------------------------------------------------------------------ */

TEST(gains_are_the_nearest_rows)
{
    static const struct {
        double rate_Hz;
        double row_Hz;
        int at; /* it is the paper's rate */
    } row[] = {{1193182 / 597.0, 2000, 1}, {2000, 2000, 1}, {1998, 2000, 1}, {1997, 1000, 0},
        {2002, 2000, 1}, {2003, 2000, 0}, {90, 90, 1}, {89.92, 90, 1}, {3, 90, 0}, {95, 90, 0},
        {99.9, 100, 1}, {99.8, 90, 0}, {20000, 2000, 0}};
    for (size_t i = 0; i < LEN(row); i++) {
        const struct table2_row *at = table2_at(row[i].rate_Hz);
        CHECK(table2_gains(row[i].rate_Hz)->rate_Hz == row[i].row_Hz, "%.3f Hz: %g", row[i].rate_Hz,
            table2_gains(row[i].rate_Hz)->rate_Hz);
        CHECK((at != NULL) == row[i].at && (at == NULL || at->rate_Hz == row[i].row_Hz), "%.3f Hz",
            row[i].rate_Hz);
    }
}

/* table2.csv's line of a row. */
static void csv_line(char *to, size_t size, const struct table2_runs *r)
{
    FILE *f = fmemopen(to, size, "w");
    CHECK(f != NULL, "no memory stream");
    table2_csv_line(f, r);
    fclose(f);
}

TEST(the_paper_stands_beside_its_own_gains_alone)
{
    struct table2_runs r = {.runs = 1,
        .rate_Hz = 1193182 / 597.0,
        .falls = 10,
        .resting = -1,
        .swing = -1,
        .b_Npm = 25002,
        .a_Npm = 9000,
        .r2 = 0.5,
        .k_Npm = 20000,
        .b_Nspm = 60};
    char text[256];
    csv_line(text, sizeof text, &r);
    CHECK(strstr(text, ",50004,0.5,\n") != NULL, "%s", text);
    r.k_Npm = 19999;
    csv_line(text, sizeof text, &r);
    CHECK(strstr(text, ",,0,,,,\n") != NULL, "%s", text);
    r.k_Npm = 20000;
    r.rate_Hz = 1990;
    csv_line(text, sizeof text, &r);
    CHECK(strstr(text, ",,0,,,,\n") != NULL, "%s", text);
}

static void check_no_zero_stiffness(const char *text)
{
    static const char *const bad[] = {"nan", "NaN", "inf", " 0..", "0.00", " 0 N/m", "'0'"};
    for (size_t i = 0; i < LEN(bad); i++) {
        CHECK(strstr(text, bad[i]) == NULL, "%s in %s", bad[i], text);
    }
}

/* Without stiffness there is no force, so no pair in the band and no line. */
TEST(no_line_is_no_number)
{
    char *dir = said_dir();
    static struct said s;
    static char text[SAID_B];
    said(&s, dir, cli_drop,
        WORDS("drop", "--rate", "90,2000", "--k", "0", "--b", "0", "--falls", "2", "--runs", "2",
            "--out", dir));
    CHECK(s.status == 1 && strstr(s.err, "not seen to their end"), "%d: %s", s.status, s.err);
    check_no_zero_stiffness(s.out);
    CHECK(strstr(s.out, "  2000      0      0          -               -               -") != NULL,
        "%s", s.out);
    CHECK(strstr(s.out, "2000 Hz: blank: the box stopped: encoder+speed.") != NULL, "%s", s.out);
    said_read(text, said_path(dir, "table2.csv"));
    CHECK(strstr(text, "\n2000,0,0,2,4,,,,,,,,,,,,,the box stopped: encoder+speed\n") != NULL, "%s",
        text);
    said_read(text, said_path(dir, "runs.csv"));
    CHECK(strstr(text, "\n2000,0,0,1,0.") && strstr(text, "\n2000,0,0,2,0."), "%s", text);
    said_read(text, said_path(dir, "pictures.gp"));
    check_no_zero_stiffness(text);
    CHECK(strstr(text, "b_stiffness=''") && strstr(text, "stiffnesses='- -'"), "%s", text);
    said_clean(dir);
}

TEST(medians_are_of_runs_with_a_line)
{
    static struct table2_result r[5];
    struct table2_runs s;
    for (int i = 0; i < 5; i++) {
        r[i] = (struct table2_result){.done = i < 4,
            .falls = 10,
            .b_Npm = i < 3 ? 100 + i : 0,
            .a_Npm = i < 3 ? 50 + i : 0,
            .phase = 0.1 * i,
            .line = i < 3 ? FALL_OK : FALL_TOO_FEW};
    }
    s = table2_runs(r, NULL, 5);
    CHECK(s.runs == 4 && s.lines == 3 && s.line == FALL_TOO_FEW && s.places, "%d %d", s.runs,
        s.lines);
    CHECK(s.b_Npm == 101 && s.a_Npm == 51, "%g %g", s.b_Npm, s.a_Npm);
    CHECK(s.low_Npm == 0, "three runs have no interval: %g", s.low_Npm);
    CHECK(s.rest == 1 && s.swing < 0, "%g %g", s.rest, s.swing);
    r[1].b_Npm = r[2].b_Npm = 0;
    s = table2_runs(r, r, 5);
    CHECK(s.b_Npm == 0 && s.swing == 0, "of one in four: %g, %g", s.b_Npm, s.swing);
}

/* After a fault, or a fall whose end was not observed, there is a reason and never a number. */
TEST(a_row_that_was_not_seen_is_blank)
{
    for (int how = 0; how < 2; how++) {
        static struct table2_result r[20];
        struct table2_runs s;
        char text[256];
        for (int i = 0; i < 20; i++) {
            r[i] = (struct table2_result){.done = 1, .falls = 10, .b_Npm = 1000, .a_Npm = 900};
        }
        r[13].faults = how == 0;
        r[13].incomplete = how == 1;
        s = table2_runs(r, NULL, 20);
        csv_line(text, sizeof text, &s);
        CHECK(s.b_Npm == 0 && s.rest < 0, "%d: %g %g", how, s.b_Npm, s.rest);
        CHECK(strstr(text, ",20,200,,,,,,,,,,,,") &&
                  strstr(text, how ? "1 of 200 falls were not seen" : "the box stopped: estop"),
            "%s", text);
    }
}

/* The distribution-free interval of a median, by printed tables of the sign test. */
TEST(the_interval_of_a_median_is_the_binomial_one)
{
    static const int row[][2] = {{1, 0}, {5, 0}, {6, 1}, {8, 1}, {9, 2}, {10, 2}, {15, 4}, {20, 6},
        {25, 8}, {50, 18}, {100, 40}, {1000, 469}};
    for (size_t i = 0; i < LEN(row); i++) {
        CHECK_EQ_I64(table2_median_rank(row[i][0]), row[i][1]);
    }
}

/* Where the wall lies between two counts, by what a run says of itself. */
TEST(the_wall_is_drawn_or_fixed)
{
    struct run_cfg c = {.rate_Hz = 90, .k_Npm = 1500, .b_Nspm = 0};
    const double step_m = sim_device_default().step_m, height_m = sim_device_default().height_m;
    double sum = 0;
    int part[4] = {0};
    c.board = posix_config_default();
    c.board.device.observe_s = 0.6;
    for (int i = 0; i < 400; i++) {
        struct run r;
        c.wall = i < 390 ? RUN_WALL_DRAWN : i < 399 ? RUN_WALL_AT_PHASE : RUN_WALL_AT_HEIGHT;
        c.phase = 0.1 * (i - 390);
        c.board.seed = (uint64_t)i;
        CHECK_EQ_I64(run_drop(&c, &r), 0);
        if (i < 390) {
            sum += r.phase;
            part[(int)(4 * r.phase)]++;
        } else if (i > 390 && i < 399) {
            CHECK(r.phase > c.phase - 1e-4 && r.phase < c.phase + 1e-4, "%g, told %g", r.phase,
                c.phase);
        }
        CHECK(r.q_lim_m > height_m - 0.51 * step_m && r.q_lim_m < height_m + 0.51 * step_m, "%.9g",
            r.q_lim_m);
        CHECK(i < 399 || (r.q_lim_m > height_m - 2e-9 && r.q_lim_m < height_m + 2e-9), "%.9g",
            r.q_lim_m);
        run_free(&r);
    }
    for (int i = 0; i < 4; i++) {
        CHECK(part[i] > 65 && part[i] < 130, "%d in part %d", part[i], i);
    }
    CHECK(sum / 390 > 0.44 && sum / 390 < 0.56, "mean place %g", sum / 390);
}

/* --device observe=... is how long the fall is seen; the judge must ask for no more. */
TEST(the_judge_observes_as_long_as_the_device)
{
    static const double observe_s[] = {0.6, 1, 7};
    for (size_t i = 0; i < LEN(observe_s); i++) {
        struct run_cfg c = {.rate_Hz = 500, .k_Npm = 6000, .b_Nspm = 20};
        struct table2_result r;
        c.board = posix_config_default();
        c.board.falls = 3;
        c.board.device.observe_s = observe_s[i];
        r = table2_measure(&c, NULL, TABLE2_SAME);
        CHECK(r.done && r.falls == 3 && r.incomplete == 0, "%g s: %d of %d incomplete",
            observe_s[i], r.incomplete, r.falls);
    }
}

/* ---- The directory ---------------------------------------------------------------- */

/* Run without the path that it needs, it says so instead of what gnuplot misses. */
TEST(a_script_of_pictures_asks_for_its_path)
{
    static struct said s;
    char *dir = said_dir();
    char command[400];
    if (system("command -v gnuplot >/dev/null 2>&1") != 0) {
        check_note("no gnuplot here: pictures.gp is not run");
        return;
    }
    said(&s, dir, cli_drop, WORDS("drop", "--rate", "90", "--falls", "2", "--out", dir));
    snprintf(command, sizeof command, "cd %s && gnuplot pictures.gp 2>&1 | grep -qx '%s'", dir,
        "give the path of ports/posix/plot: gnuplot -c pictures.gp PLOTS");
    CHECK(system(command) == 0, "%s", command);
    snprintf(command, sizeof command,
        "p=$PWD/ports/posix/plot; cd %s && gnuplot -c pictures.gp $p && test -s fall.png", dir);
    CHECK(system(command) == 0, "%s", command);
    said_clean(dir);
}

TEST(any_directory_name_will_do)
{
    char *base = said_dir();
    char dir[256];
    static struct said s;
    static char text[SAID_B];
    snprintf(dir, sizeof dir, "%s/it's \"a b\"'; system('touch x'); '\n`y`", base);
    for (int again = 0; again < 2; again++) {
        said(&s, base, cli_drop, WORDS("drop", "--rate", "90", "--falls", "2", "--out", dir));
        CHECK(s.status == 0, "%d: %s", s.status, s.err);
        said_read(text, said_path(dir, "pictures.gp"));
        CHECK(strstr(text, "system") == NULL && strstr(text, base) == NULL, "%s", text);
        CHECK(said_size(said_path(dir, "fall.png")) < 0, "an earlier run's picture is left");
        fclose(fopen(said_path(dir, "fall.png"), "w"));
    }
    said_clean(base);
}

TEST(what_cannot_be_written_is_named)
{
    static const char *const name[] = {
        "drop_90Hz.exh", "drop_90Hz.csv", "drop_90Hz_fall.csv", "drop_90Hz_line.csv", "said.out"};
    for (size_t i = 0; i < LEN(name); i++) {
        char *dir = said_dir();
        static struct said s;
        CHECK_EQ_I64(symlink("/dev/full", said_path(dir, name[i])), 0);
        said(&s, dir, cli_drop, WORDS("drop", "--rate", "90", "--falls", "2", "--out", dir));
        CHECK(s.status == 1, "%s: status %d", name[i], s.status);
        CHECK(strstr(s.err, i == 4   ? "standard output"
                            : i == 3 ? "_line.csv"
                                     : name[i]) != NULL,
            "%s: %s", name[i], s.err);
        said_clean(dir);
    }
}

/* ---- Interruption ------------------------------------------------------------------- */

static void nap_ms(long ms)
{
    const struct timespec t = {ms / 1000, ms % 1000 * 1000000};
    nanosleep(&t, NULL);
}

/* Starts it, signals its first process once the log of `name` grows; what it said. */
static void interrupt(
    struct said *s, char *dir, int sig, const char *name, const char *rates, const char *jobs)
{
    const pid_t pid = said_start(dir, cli_drop,
        WORDS("drop", "--rate", rates, "--falls", "1000", "--jobs", jobs, "--out", dir));
    char part[64];
    snprintf(part, sizeof part, "%s.part", name);
    for (int i = 0; i < 2000 && said_size(said_path(dir, part)) <= 0; i++) { nap_ms(5); }
    CHECK(said_size(said_path(dir, part)) > 0, "%s does not grow", part);
    CHECK_EQ_I64(kill(pid, sig), 0);
    said_end(s, dir, pid);
    CHECK(kill(-pid, 0) != 0 && errno == ESRCH, "it left processes behind");
}

TEST(an_interruption_ends_all_runs)
{
    static const char *const jobs[] = {"1", "2", "3"};
    for (int i = 0; i < 6; i++) {
        char *dir = said_dir();
        static struct said s;
        struct logfile l;
        struct exh_record r;
        interrupt(&s, dir, i < 3 ? SIGINT : SIGTERM, "drop_20000Hz.exh", "20000,19999,19998,19997",
            jobs[i % 3]);
        CHECK(s.status == 130, "jobs %s: status %d: %s", jobs[i % 3], s.status, s.err);
        CHECK(s.out[0] == '\0', "a row of nothing: %s", s.out);
        CHECK(strstr(s.err, "interrupted: 0 of 80 runs") != NULL, "%s", s.err);
        CHECK(said_size(said_path(dir, "drop_19997Hz.exh")) < 0, "jobs %s: a new job began",
            jobs[i % 3]);
        CHECK_EQ_I64(logfile_open(&l, said_path(dir, "drop_20000Hz.exh")), 0);
        while (logfile_next(&l, &r)) {}
        CHECK_EQ_I64(logfile_complain(&l), 0); /* complete up to where it was stopped */
        logfile_close(&l);
        said_clean(dir);
    }
}

TEST(what_was_finished_is_kept)
{
    static const char *const jobs[] = {"1", "2"};
    for (int i = 0; i < 2; i++) {
        char *dir = said_dir();
        static struct said s;
        static char text[SAID_B];
        const pid_t pid = said_start(dir, lab_drop,
            WORDS("drop", "--rate", "90,20000", "--falls", "200", "--runs", "1000", "--jobs",
                jobs[i], "--out", dir));
        for (int n = 0; n < 2000 && said_size(said_path(dir, "drop_90Hz.csv")) <= 0; n++) {
            nap_ms(5);
        }
        nap_ms(300);
        CHECK_EQ_I64(kill(pid, SIGINT), 0);
        said_end(&s, dir, pid);
        CHECK(s.status == 130, "jobs %s: status %d: %s", jobs[i], s.status, s.err);
        CHECK(strstr(s.err, " of 2000 runs were finished") != NULL, "%s", s.err);
        CHECK(strstr(s.out, "\n    90   1500 ") && !strstr(s.out, "\n     0 ") &&
                  !strstr(s.out, "\n 20000 "),
            "%s", s.out);
        said_read(text, said_path(dir, "table2.csv"));
        CHECK(strstr(text, "\n90,1500,0,") && !strstr(text, "\n0,") && !strstr(text, "\n20000,"),
            "%s", text);
        said_clean(dir);
    }
}

/* Job 3 dies, or is killed; what the others gave is there, and the loss is said. */
static void work(const void *ctx, int i, void *result)
{
    const int how = *(const int *)ctx;
    memcpy(result, &i, sizeof i);
    if (i == 3 && how == 0) { _exit(3); }
    if (i == 3 && how == 1) { raise(SIGKILL); }
}

TEST(a_job_that_dies_is_an_error)
{
    for (int how = 0; how < 3; how++) {
        int result[8];
        const struct jobs j = {8, 3, sizeof result[0], result, work, &how, NULL, NULL};
        memset(result, 0xFF, sizeof result);
        CHECK_EQ_I64(jobs_run(&j), how < 2);
        for (int i = 0; i < 8; i++) {
            CHECK(
                result[i] == (i == 3 && how < 2 ? -1 : i), "%d: job %d gave %d", how, i, result[i]);
        }
    }
}

/* The loop's own words, of a job that a signal ended. */
static int dies(int argc, char **argv)
{
    const int how = 1;
    int result[8];
    const struct jobs j = {8, 3, sizeof result[0], result, work, &how, "runs", NULL};
    (void)argc;
    (void)argv;
    return jobs_run(&j);
}

TEST(what_a_job_died_of_is_named)
{
    const char *dir = said_dir();
    static struct said s;
    said(&s, dir, dies, WORDS("drop"));
    CHECK(s.status == 1 && strstr(s.err, "1 of 8 runs died: the first by signal 9, Killed: "),
        "%d: %s", s.status, s.err);
    said_clean(dir);
}

TEST_MAIN("cli", bad_usage_of_a_study, bad_usage_is_refused_by_name,
    a_stiff_device_is_integrated_in_shorter_steps, what_ends_the_ramp_is_named,
    printed_ranges_are_the_true_ones, gains_are_the_nearest_rows,
    the_paper_stands_beside_its_own_gains_alone, no_line_is_no_number,
    medians_are_of_runs_with_a_line, a_row_that_was_not_seen_is_blank,
    the_interval_of_a_median_is_the_binomial_one, the_wall_is_drawn_or_fixed,
    the_judge_observes_as_long_as_the_device, a_script_of_pictures_asks_for_its_path,
    any_directory_name_will_do, what_cannot_be_written_is_named, an_interruption_ends_all_runs,
    what_was_finished_is_kept, a_job_that_dies_is_an_error, what_a_job_died_of_is_named);
