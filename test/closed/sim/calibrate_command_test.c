/* SPDX-License-Identifier: MIT */
/* exhand calibrate as people meet it: exit status, words, files, interruption. */
#include "said.h"

#include <signal.h>
#include <time.h>

/* `exhand calibrate` with these words, blanks between; @ is the directory. */
static int command(const char *dir, const char *words)
{
    char text[600], *argv[20];
    int argc = 1;
    size_t n = 0;
    argv[0] = text;
    for (const char *w = words; *w != '\0' && n + 100 < sizeof text; w++) {
        n += (size_t)snprintf(
            text + n, sizeof text - n, *w == '@' ? "%s" : "%.1s", *w == '@' ? dir : w);
    }
    text[n] = '\0';
    for (char *word = strtok(text, " "); word != NULL && argc < 20; word = strtok(NULL, " ")) {
        argv[argc++] = word;
    }
    argv[0] = text;
    return cli_calibrate(argc, argv);
}

TEST(exit_status_says_what_happened)
{
    static const struct {
        int status;
        const char *words;
    } row[] = {
        {0, "--help"},
        {0, "--params"},
        {0, "--out @ --day 20000 --valid 30 --id 9 --finger 2"},
        {0, "--check @/calibration.bin --day 20030 --id 9 --finger 2"},
        {1, "--check @/calibration.bin --day 20031 --id 9 --finger 2"}, /* stale */
        {1, "--check @/calibration.bin --day 19999 --id 9 --finger 2"},
        {1, "--check @/calibration.bin --day 20000 --id 8 --finger 2"},
        {1, "--check @/calibration.bin --day 20000 --id 9"},
        {1, "--check @/calibration.bin --day 20000 --id 9 --finger 2 --device dac_scale=1000"},
        {1, "--check @/calibration.csv --day 20000"}, /* no image */
        {3, "--check @/none"},
        {2, "--check @"}, /* a directory */
        {2, "--out @/calibration.bin"},
        {1, "--wrong stuck"},
        {1, "--wrong motor_reversed"},
        {1, "--mass 0.1,0.2,0.22,0.5 --hung 0.1,0.22,0.2,0.5"}, /* does not rise */
        {1, "--mass 0.1,0.2,0.3 --hung 0.1,0.24,0.3"},          /* far from the line */
        {0, "--mass 0.1,0.2,0.3 --hung 0.1,0.24,0.3 --residual 1"},
        {1, "--set wait_time=1300 --out @/nobody"},
        {2, "--mass 0.2,0.1"},
        {2, "--mass 0.2,"},
        {2, "--mass 9"},
        {2, "--mass 0.5"}, /* one point is on any line */
        {0, "--mass 0.1,0.5"},
        {2, "--mass 0.01,0.5"}, /* i.e. at most 49 mA, but slack_cur is 50 */
        {0, "--mass 0.02,0.5 --residual 1"},
        {2, "--set i_max=0.2"},                                         /* pol_max */
        {2, "--set i_max=0.09 --set pol_max=0.05"},                     /* home_cur */
        {2, "--set i_max=0.04 --set pol_max=0.03 --set home_cur=0.03"}, /* slack_cur */
        {2, "--set go=1"},                                              /* the person's word */
        {2, "--set mass=0.3"},
        {2, "--valid 367"},
        {2, "--hung 0.1"},
        {2, "--wrong nothing"},
        {2, "--rate 0"},
        {2, "--rate 30 --set dwell=10"}, /* less than two ticks a dwell */
        {2, "--set nothing=1"},
        {2, "--set i_max=4"},
        {2, "--set home_min=0.4"},                   /* beyond home_max */
        {2, "--set f0_speed=0.25 --set dwell=1000"}, /* beyond the travel limit */
        {2, "--device kf=0"},
        {2, "--device kf"},
        {2, "--out @/calibration.bin/x"},
        {2, "--nothing"},
        {2, "word"},
    };
    char dir[] = "/tmp/exhand_calibrate_XXXXXX", path[64];
    static const char *const made[] = {
        "calibration.bin", "calibration.csv", "table.csv", "pictures.gp"};
    CHECK(mkdtemp(dir) != NULL, "no temporary directory");
    for (size_t i = 0; i < LEN(row); i++) {
        const int status = command(dir, row[i].words);
        CHECK(status == row[i].status, "%s: exit status %d", row[i].words, status);
    }
    for (size_t i = 0; i < LEN(made); i++) {
        snprintf(path, sizeof path, "%s/%s", dir, made[i]);
        CHECK(remove(path) == 0, "%s was not written", made[i]);
    }
    snprintf(path, sizeof path, "%s/nobody", dir);
    CHECK(rmdir(path) == 0, "something was written though nobody came");
    CHECK_EQ_I64(rmdir(dir), 0);
}

/* In a separate process, with these words. */
#define SAYS(dir, wanted, text, ...) \
    do { \
        static struct said s; \
        said(&s, dir, cli_calibrate, WORDS("calibrate", __VA_ARGS__)); \
        CHECK(s.status == (wanted) && strstr(s.err, text), "status %d: %s, wanted %s", s.status, \
            s.err, text); \
        CHECK(strstr(s.out, "for the drop experiment") == NULL, "%s", s.out); \
    } while (0)

TEST(what_is_refused_is_named)
{
    char *dir = said_dir();
    const char *image = said_path(dir, "calibration.bin");
    static struct said made;
    SAYS(dir, 2, "--mass: 0.5: one mass", "--mass", "0.5");
    SAYS(dir, 2, "--mass: two of them are the same", "--mass", "0.1,0.1000000001");
    SAYS(dir, 2, "--mass: 0.01 (slack_cur", "--mass", "0.01,0.5");
    SAYS(dir, 2, "(allowed up to i_max: ", "--set", "i_max=0.2");
    SAYS(dir, 2, "give --device substep=1e-05", "--device", "rotor=0.0001", "--device",
        "substep=1e-4");
    SAYS(dir, 2, "--set: go:", "--set", "go=1");
    SAYS(dir, 1, "mass 0.1 kg: did not move", "--wrong", "fixed_mass");
    SAYS(dir, 1, "mass 0.1 kg: a limit of the drive acts (peak: i_peak)", "--set", "i_cont=0.15",
        "--set", "i_peak=0.2");
    SAYS(dir, 1, "nobody prepared the step after 1.30 s", "--set", "wait_time=1300");
    SAYS(dir, 3, "No such file or directory: give the calibration.bin", "--check",
        "/nowhere/at/all");
    SAYS(dir, 2, "Is a directory: give the calibration.bin", "--check", dir);
    said(
        &made, dir, cli_calibrate, WORDS("calibrate", "--day", "20000", "--id", "9", "--out", dir));
    CHECK(made.status == 0, "%s", made.err);
    SAYS(dir, 1, "made for device 9, this is 8:", "--check", image, "--day", "20000", "--id", "8");
    SAYS(dir, 1, "made for finger 0, this is 3:", "--check", image, "--day", "20000", "--id", "9",
        "--finger", "3");
    SAYS(dir, 1,
        "from the future: made on day 20000, today is day 19999: set the clock right, or give "
        "--day",
        "--check", image, "--day", "19999", "--id", "9");
    SAYS(dir, 1, "stale: made on day 20000, good for 90 days", "--check", image, "--day", "20091",
        "--id", "9");
    SAYS(dir, 1, "scale or zero", "--check", image, "--day", "20000", "--id", "9", "--device",
        "dac_zero=32767");
    SAYS(dir, 2, "Not a directory", "--out", image); /* before anything runs */
    said_clean(dir);
}

/* A mistyped mass at each place of the list, too light and too heavy. It is named, by its step or
 * by its residual, and nothing is written. */
TEST(a_mistyped_mass_is_named)
{
    static const struct {
        const char *mass, *says;
        int status;
    } row[] = {
        {"0.02,0.2,0.3,0.5,0.7", "mass 0.02 kg: did not move", 1},
        {"0.085,0.2,0.3,0.5,0.7", "mass 0.085 kg: ", 1},
        {"0.12,0.2,0.3,0.5,0.7", "mass 0.12 kg: residual: 0.1", 1},
        {"0.1,0.17,0.3,0.5,0.7", "mass 0.17 kg: ", 1},
        {"0.1,0.29,0.3,0.5,0.7", "mass 0.29 kg: residual: 0.8", 1},
        {"0.1,0.2,0.23,0.5,0.7", "mass 0.23 kg: ", 1},
        {"0.1,0.2,0.49,0.5,0.7", "mass 0.49 kg: residual: 1.8", 1},
        {"0.1,0.2,0.3,0.05,0.7", "--mass: 0.1,0.2,0.3,0.05,0.7 (", 2},
        {"0.1,0.2,0.3,0.4,0.7", "mass 0.4 kg: ", 1},
        {"0.1,0.2,0.3,0.69,0.7", "mass 0.69 kg: residual: 1.8", 1},
        {"0.1,0.2,0.3,0.5,0.6", "mass 0.6 kg: residual: 0.9", 1},
        {"0.1,0.2,0.3,0.5,2", "mass 2 kg: residual: 12", 1},
        {"0.2,0.4,0.6,1,1.4", "are --mass in kg?", 1}, /* all of them, by one factor */
        {"0.12,0.24,0.3,0.5,0.7", "no one mass is the cause", 1},
    };
    char *dir = said_dir();
    for (size_t i = 0; i < LEN(row); i++) {
        SAYS(dir, row[i].status, row[i].says, "--mass", row[i].mass, "--hung",
            "0.1,0.2,0.3,0.5,0.7", "--rate", "500", "--out", dir);
        CHECK(said_size(said_path(dir, "calibration.bin")) < 0, "%s: written", row[i].mass);
    }
    said_clean(dir);
}

/* A motor's constant does not change by half: an image is not replaced by a very different one. */
TEST(the_last_image_is_asked)
{
    char *dir = said_dir();
    const char *image = said_path(dir, "calibration.bin");
    static struct said made;
    said(&made, dir, cli_calibrate,
        WORDS("calibrate", "--day", "20000", "--rate", "500", "--device", "kf=7", "--out", dir));
    CHECK(made.status == 0, "%s", made.err);
    SAYS(dir, 1, "half to 3/2 of 6.8", "--rate", "500", "--out", dir);
    SAYS(dir, 1, "(allowed 1.669..5.008, half to 3/2 of kf 3.339): calibrate again", "--check",
        image, "--day", "20000");
    said(&made, dir, cli_calibrate,
        WORDS("calibrate", "--check", image, "--day", "20000", "--device", "kf=7"));
    CHECK(made.status == 0, "%s", made.err);
    said(&made, dir, cli_calibrate, /* another finger's: not asked */
        WORDS("calibrate", "--rate", "500", "--finger", "1", "--out", dir));
    CHECK(made.status == 0, "%s", made.err);
    said_clean(dir);
}

#define LONG_64  "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef"
#define LONG_512 LONG_64 LONG_64 LONG_64 LONG_64 LONG_64 LONG_64 LONG_64 LONG_64

TEST(what_cannot_be_written_is_said)
{
    static const char *const name[] = {
        "calibration.bin", "calibration.csv", "table.csv", "pictures.gp"};
    for (size_t i = 0; i < 2 * LEN(name); i++) {
        char *dir = said_dir();
        const char *path = said_path(dir, name[i / 2]);
        char text[300];
        if (i % 2 == 0) { CHECK_EQ_I64(mkdir(path, 0777), 0); }
        if (i % 2 == 1) { CHECK_EQ_I64(symlink("/dev/full", path), 0); }
        snprintf(text, sizeof text, "--out: %s: %s:", path,
            i % 2 ? "can't be written: No space left on device" : "Is a directory");
        SAYS(dir, 1, text, "--out", dir);
        said_clean(dir);
    }
    {
        char *dir = said_dir();
        SAYS(dir, 2, "File name too long", "--out", LONG_512);
        said_clean(dir);
    }
}

static int line_by_line(int argc, char **argv)
{
    setvbuf(stdout, NULL, _IOLBF, 0);
    return cli_calibrate(argc, argv);
}

/* A signal while it waits, within a step, within a mass. */
TEST(an_interruption_saves_nothing)
{
    static const char *const after[] = {
        "  zero", "  polarity", "  home", "  f0", "  mass 0.1", "  mass 0.3"};
    for (size_t i = 0; i < LEN(after); i++) {
        const struct timespec nap = {0, 1000000};
        char *dir = said_dir();
        static struct said s;
        const pid_t pid =
            said_start(dir, line_by_line, WORDS("calibrate", "--rate", "20000", "--out", dir));
        s.out[0] = '\0';
        for (int n = 0; n < 20000 && strstr(s.out, after[i]) == NULL; n++) {
            nanosleep(&nap, NULL);
            said_read(s.out, said_path(dir, "said.out"));
        }
        CHECK_EQ_I64(kill(pid, i % 2 ? SIGINT : SIGTERM), 0);
        said_end(&s, dir, pid);
        CHECK(s.status == 130, "after%s: status %d: %s", after[i], s.status, s.err);
        CHECK(strstr(s.err, "interrupted") && strstr(s.err, ": nothing was saved\n"), "%s", s.err);
        CHECK(strstr(s.out, "force over current") == NULL, "%s", s.out);
        CHECK(said_size(said_path(dir, "calibration.bin")) < 0, "after%s: written", after[i]);
        said_clean(dir);
    }
}

TEST_MAIN("sim/calibrate_command", exit_status_says_what_happened, what_is_refused_is_named,
    a_mistyped_mass_is_named, the_last_image_is_asked, what_cannot_be_written_is_said,
    an_interruption_saves_nothing);
