/* SPDX-License-Identifier: MIT */
/* exhand run: goes on, ends when asked, and leaves a log that replays. */
#define _XOPEN_SOURCE 700 /* pseudo-terminals */

#include "said.h"
#include "terminal.h"

#include <sys/resource.h>
#include <termios.h>
#include <time.h>

static void replay(const char *dir, const char *log, struct said *s)
{
    said(s, dir, cli_replay, WORDS("replay", log, "--timeline"));
    CHECK(s->status == 0, "%s", s->err);
}

static int times(const char *text, const char *part)
{
    int n = 0;
    for (const char *at = strstr(text, part); at; at = strstr(at + 1, part)) { n++; }
    return n;
}

TEST(each_scene_goes_on_until_its_time_is_over)
{
    static const char *const scene[] = {"drop", "guarded", "bilateral"};
    for (size_t i = 0; i < sizeof scene / sizeof scene[0]; i++) {
        char *dir = said_dir();
        const char *log = said_path(dir, "a.exh");
        struct said s;
        said(&s, dir, cli_run,
            WORDS("run", "--scene", scene[i], "--seconds", "12", "--rate", "1000", "--log", log));
        CHECK(s.status == 0, "%s: %d %s", scene[i], s.status, s.err);
        CHECK(strcmp(s.out, "12000 ticks, 12 s, faults none\n") == 0, "%s", s.out);
        replay(dir, log, &s);
        CHECK_EQ_I64(times(s.out, "command: run"), 1);
        CHECK(times(s.out, "contact begins") >= 3, "%s: %d contacts", scene[i],
            times(s.out, "contact begins"));
        said_clean(dir);
    }
}

/* Less than a tick is one, not for ever. */
TEST(the_shortest_time_ends)
{
    char *dir = said_dir();
    struct said s;
    said(&s, dir, cli_run, WORDS("run", "--seconds", "1e-9"));
    CHECK(s.status == 0 && strncmp(s.out, "1 ticks", 7) == 0, "%d %s", s.status, s.out);
    said_clean(dir);
}

/* The grip is the person's: a fault is cleared, and the box run, by two new ones, and by none
 * unasked. */
TEST(after_a_fault_it_runs_again_by_the_grip_alone)
{
    for (int grip = 0; grip < 2; grip++) {
        char *dir = said_dir();
        const char *log = said_path(dir, "a.exh");
        const char *const word[] = {
            "run", "--seconds", "20", "--let-go", "5", "--log", log, grip ? "--grip" : NULL, NULL};
        struct said s;
        said(&s, dir, cli_run, word);
        CHECK(s.status == 0, "%s", s.err);
        CHECK(strstr(s.out, "deadman") != NULL, "%s", s.out);
        replay(dir, log, &s);
        CHECK_EQ_I64(times(s.out, "run -> release"), 1);
        CHECK_EQ_I64(times(s.out, "command: clear"), grip);
        CHECK_EQ_I64(times(s.out, "arm -> run"), 1 + grip);
        CHECK(grip || times(s.out, "command: run") == 1, "asked by nobody");
        said_clean(dir);
    }
}

/* A mass that falls faster than an encoder may turn: its position is lost for good. */
TEST(what_a_restart_alone_clears_is_said_once)
{
    char *dir = said_dir();
    struct said s;
    said(&s, dir, cli_run, WORDS("run", "--seconds", "20", "--grip", "--set", "speed_max=0.5"));
    CHECK(s.status == 0 && strstr(s.out, "encoder"), "%d: %s%s", s.status, s.out, s.err);
    CHECK(times(s.err, "only a new start of the box clears encoder") == 1, "%s", s.err);
    said(&s, dir, cli_run, WORDS("run", "--seconds", "20", "--grip", "--let-go", "5"));
    CHECK(s.status == 0 && times(s.err, "new start") == 0, "%d: %s", s.status, s.err);
    said_clean(dir);
}

TEST(an_interrupt_leaves_a_complete_log)
{
    char *dir = said_dir();
    const char *log = said_path(dir, "a.exh");
    const struct timespec while_it_runs = {0, 400000000};
    struct said s;
    const pid_t pid =
        said_start(dir, cli_run, WORDS("run", "--pace", "--rate", "1000", "--log", log));
    nanosleep(&while_it_runs, NULL);
    CHECK(said_size(said_path(dir, "a.exh.part")) > 0, "it has not begun");
    CHECK(said_size(log) < 0, "a log that is not whole has its name");
    kill(pid, SIGINT);
    said_end(&s, dir, pid);
    CHECK(s.status == 130, "%d %s", s.status, s.err);
    replay(dir, log, &s);
    CHECK(strstr(s.out, "end of the log, 0 records lost") != NULL, "%s", s.out);
    said_clean(dir);
}

static int ended(pid_t pid)
{
    siginfo_t is = {0};
    return waitid(P_PID, (id_t)pid, &is, WEXITED | WNOHANG | WNOWAIT) == 0 && is.si_pid == pid;
}

/* Waits for its end for so many seconds; else ends it and returns -1. */
static int ends_within(pid_t pid, double limit_s)
{
    const struct timespec a_while = {0, 10000000};
    for (double s = 0; s < limit_s; s += 0.01) {
        if (ended(pid)) { return 0; }
        (void)nanosleep(&a_while, NULL);
    }
    kill(pid, SIGKILL);
    return -1;
}

/* The first number before such words; -1: there is none. */
static long number_before(const char *text, const char *words)
{
    const char *at = strstr(text, words);
    if (at == NULL || at == text) { return -1; }
    while (at > text && at[-1] == ' ') { at--; }
    while (at > text && at[-1] >= '0' && at[-1] <= '9') { at--; }
    return strtol(at, NULL, 10);
}

/* Runs for a time, is stopped for a time, runs to its end. */
static void stopped_for(pid_t pid, struct timespec runs, struct timespec stands)
{
    nanosleep(&runs, NULL);
    kill(pid, SIGSTOP);
    nanosleep(&stands, NULL);
    kill(pid, SIGCONT);
    CHECK(ends_within(pid, 60) == 0, "it does not end");
}

/* A stopped program misses the ticks of that time: they are counted, the box lets go, none is made
 * up for. 1: it was in RUN when it was stopped, and stood still while nothing else kept it from its
 * ticks. */
static int stopped_in_run(void)
{
    char *dir = said_dir();
    const char *log = said_path(dir, "a.exh");
    const struct timespec runs = {1, 500000000}, stands = {1, 0}, a_while = {0, 10000000};
    long ticks, missed;
    struct said s;
    int in_run;
    const pid_t pid = said_start(dir, cli_run,
        WORDS("run", "--pace", "--rate", "100", "--seconds", "4", "--slack", "0.3", "--log", log));
    for (int i = 0; i < 1000 && said_size(said_path(dir, "a.exh.part")) <= 0; i++) {
        nanosleep(&a_while, NULL);
    }
    stopped_for(pid, runs, stands);
    said_end(&s, dir, pid);
    CHECK(s.status == 0 && strstr(s.out, " s, faults overrun"), "%d %s%s", s.status, s.out, s.err);
    ticks = number_before(s.out, "ticks");
    missed = number_before(s.out, "missed");
    CHECK(missed >= 60 && ticks + missed <= 400 && ticks + missed > 300, "%s", s.out);
    replay(dir, log, &s);
    CHECK(strstr(s.out, "missed") != NULL, "%s", s.out);
    in_run = strstr(s.out, "run -> release") != NULL;
    said_clean(dir);
    return in_run;
}

/* Real time: a machine that is busy with something else makes it overrun before it runs. */
TEST(what_goes_by_while_it_is_stopped_is_missed)
{
    int tries = 0, in_run = 0;
    while (!in_run && tries++ < 6) { in_run = stopped_in_run(); }
    CHECK(in_run, "it never ran before it was stopped");
    if (tries > 1) { check_note("a busy machine: in RUN at try %d", tries); }
}

/* An unread pipe is soon full. The box goes on by its clock, and reports the loss. */
TEST(a_log_that_nobody_takes_stalls_nobody)
{
    char *dir = said_dir();
    const char *log = said_path(dir, "pipe");
    struct said s;
    int fd;
    pid_t pid;
    CHECK_EQ_I64(mkfifo(log, 0600), 0);
    fd = open(log, O_RDONLY | O_NONBLOCK);
    CHECK(fd >= 0, "no pipe");
    pid = said_start(dir, cli_run,
        WORDS("run", "--scene", "bilateral", "--fingers", "all", "--pace", "--slack", "0.1",
            "--rate", "500", "--seconds", "2", "--log", log));
    CHECK(ends_within(pid, 60) == 0, "it stands still");
    said_end(&s, dir, pid);
    CHECK(s.status == 1 && strstr(s.err, "pipe: takes nothing for 2 s"), "%d %s", s.status, s.err);
    CHECK(strstr(s.out, " s, faults "), "%s", s.out);
    close(fd);
    said_clean(dir);
}

static struct terminal tty;

static int run_on_terminal(int argc, char **argv)
{
    return dup2(tty.slave, STDERR_FILENO) < 0 ? 99 : cli_run(argc, argv);
}

/* One line, drawn over and over. */
TEST(the_line_of_status)
{
    static char text[65536];
    char *dir = said_dir();
    struct said s;
    pid_t pid;
    if (terminal_open(&tty) < 0) { return; }
    pid = said_start(dir, run_on_terminal,
        WORDS("run", "--pace", "--slack", "60", "--rate", "100", "--seconds", "2"));
    text[0] = '\0';
    for (int i = 0; i < 3000 && !ended(pid); i++) {
        const struct timespec a_while = {0, 10000000};
        terminal_read(&tty, text, sizeof text);
        nanosleep(&a_while, NULL);
    }
    terminal_read(&tty, text, sizeof text);
    said_end(&s, dir, pid);
    CHECK(s.status == 0, "%d %s", s.status, text);
    CHECK(times(text, "\r") >= 4 && times(text, "\n") == 1, "%s", text);
    CHECK(strstr(text, " s  run") && strstr(text, "faults none\033[K"), "%s", text);
    terminal_close(&tty);
    said_clean(dir);
}

/* Ctrl-S holds the terminal, and not the box: all its ticks are in the log. */
TEST(a_terminal_that_was_halted_stalls_nobody)
{
    char *dir = said_dir();
    const char *log = said_path(dir, "a.exh");
    struct said s;
    pid_t pid;
    if (terminal_open(&tty) < 0) { return; }
    CHECK_EQ_I64(tcflow(tty.slave, TCOOFF), 0);
    pid = said_start(dir, run_on_terminal,
        WORDS("run", "--pace", "--rate", "50", "--seconds", "2", "--let-go", "1.5", "--blackbox",
            said_path(dir, "box.exh"), "--log", log));
    CHECK(ends_within(pid, 30) == 0, "it stands still");
    said_end(&s, dir, pid);
    CHECK(s.status == 0 && number_before(s.out, "ticks") >= 50, "%d %s", s.status, s.out);
    replay(dir, log, &s);
    CHECK(strstr(s.out, "end of the log, 0 records lost") != NULL, "%s", s.out);
    terminal_close(&tty);
    said_clean(dir);
}

/* Paced, dumps go piece by piece, one after the other: what the person did, what a stop did. */
TEST(dumps_of_a_paced_box)
{
    char *dir = said_dir();
    const char *first = said_path(dir, "box.exh"), *second = said_path(dir, "box.exh.2"),
               *err = said_path(dir, "said.err");
    const struct timespec a_while = {0, 10000000}, until_it_runs = {3, 0}, stands = {1, 500000000};
    struct said s;
    const pid_t pid = said_start(dir, cli_run,
        WORDS("run", "--pace", "--slack", "0.5", "--rate", "100", "--seconds", "10", "--let-go",
            "1.5", "--grip", "--blackbox", first));
    for (int i = 0; i < 3000 && said_size(err) <= 0; i++) { nanosleep(&a_while, NULL); }
    stopped_for(pid, until_it_runs, stands);
    said_end(&s, dir, pid);
    CHECK(
        s.status == 0 && times(s.err, "black box: fault ") >= 2, "%d %s%s", s.status, s.out, s.err);
    CHECK(said_size(first) > 2 * 4096, "%ld bytes: one piece", said_size(first));
    replay(dir, first, &s);
    CHECK(strstr(s.out, "end of the log, 0 records lost"), "%s", s.out);
    replay(dir, second, &s);
    CHECK(strstr(s.out, "end of the log, 0 records lost"), "%s", s.out);
    said_clean(dir);
}

/* No program opens the pipe. The box goes on by its clock, and at the end gives up the dump. */
TEST(a_dump_that_nobody_takes_stalls_nobody)
{
    char *dir = said_dir();
    const char *dump = said_path(dir, "pipe"), *log = said_path(dir, "a.exh");
    struct said s;
    pid_t pid;
    CHECK_EQ_I64(mkfifo(dump, 0600), 0);
    pid = said_start(dir, cli_run,
        WORDS("run", "--pace", "--slack", "0.5", "--rate", "100", "--seconds", "3", "--let-go",
            "1.5", "--blackbox", dump, "--log", log));
    CHECK(ends_within(pid, 60) == 0, "it stands still");
    said_end(&s, dir, pid);
    CHECK(s.status == 1 && strstr(s.err, "pipe: takes nothing for 2 s"), "%d %s", s.status, s.err);
    CHECK(strstr(s.err, "black box: fault") == NULL, "%s", s.err);
    replay(dir, log, &s);
    CHECK(strstr(s.out, "run -> release") && strstr(s.out, "end of the log, 0 records lost"), "%s",
        s.out);
    said_clean(dir);
}

/* In virtual time it waits for the slowest. */
TEST(a_slow_log_is_complete_in_virtual_time)
{
    char *dir = said_dir();
    const char *log = said_path(dir, "pipe"), *copy = said_path(dir, "copy.exh");
    const struct timespec a_while = {0, 300000000};
    char cat[700];
    struct said s;
    pid_t pid;
    int fd;
    CHECK_EQ_I64(mkfifo(log, 0600), 0);
    fd = open(log, O_RDONLY | O_NONBLOCK);
    CHECK(fd >= 0, "no pipe");
    pid = said_start(dir, cli_run,
        WORDS("run", "--scene", "bilateral", "--fingers", "all", "--rate", "1000", "--seconds",
            "20", "--log", log));
    nanosleep(&a_while, NULL);
    snprintf(cat, sizeof cat, "cat '%s' > '%s'", log, copy);
    {
        const pid_t reader = fork();
        int status;
        if (reader == 0) { _exit(system(cat) != 0); }
        close(fd);
        CHECK(ends_within(pid, 300) == 0, "it stands still");
        said_end(&s, dir, pid);
        CHECK(waitpid(reader, &status, 0) == reader && status == 0, "no copy");
    }
    CHECK(s.status == 0, "%d %s", s.status, s.err);
    CHECK(said_size(copy) > 5 << 20, "%ld bytes: the ring was never full", said_size(copy));
    said(&s, dir, cli_replay, WORDS("replay", copy));
    CHECK(s.status == 0 && strstr(s.out, ": 20000 ticks from tick 0 "), "%s%s", s.out, s.err);
    said_clean(dir);
}

/* The person catches the mass: else it is metres deep at the next grip. */
TEST(it_runs_again_wherever_the_fault_found_the_mass)
{
    static const char *const at[] = {"0.9", "1.05", "2", "4", "7"}, *const rate[] = {
                                                                        "50", "100", "500"};
    for (size_t i = 0; i < 15; i++) {
        char *dir = said_dir();
        const char *log = said_path(dir, "a.exh");
        struct said s;
        said(&s, dir, cli_run,
            WORDS("run", "--rate", rate[i / 5], "--seconds", "14", "--let-go", at[i % 5], "--grip",
                "--log", log));
        CHECK(
            s.status == 0 && strstr(s.out, "faults deadman\n"), "%d %s%s", s.status, s.out, s.err);
        replay(dir, log, &s);
        CHECK(times(s.out, "arm -> run") == 2, "%s Hz, let go at %s s: %d", rate[i / 5], at[i % 5],
            times(s.out, "arm -> run"));
        CHECK(times(s.out, "arming is refused") == 0, "%s Hz, let go at %s s: refused", rate[i / 5],
            at[i % 5]);
        said_clean(dir);
    }
}

TEST(what_it_cannot_do_is_named)
{
    static const struct {
        const char *word[8], *said;
        int status;
    } row[] = {{{"run", "--scene", "minimal"}, "give drop, guarded or bilateral", 2},
        {{"run", "--set", "nobody=1"}, "nobody: no such parameter", 2},
        {{"run", "--set", "k=1e9"}, "allowed 0..", 2},
        {{"run", "--seconds", "1e9"}, "or leave it out", 2},
        {{"run", "--load-params", "/nowhere/at.all"}, "image that a run saved", 3},
        {{"run", "--load-params", "/dev/null"}, "/dev/null: ", 2},
        {{"run", "--seconds", "1", "--log", "/nowhere/at.all"}, "give a file that can be written",
            2},
        {{"run", "--log", "/nowhere/at.all"}, "give --seconds, or --pace", 2},
        {{"run", "--slack", "0.1"}, "only with --pace", 2},
        {{"run", "--fingers", "thumb"}, "--fingers: thumb: goes with --scene bilateral", 2},
        {{"run", "--speed", "slow"}, "--speed: slow: goes with --scene bilateral", 2},
        {{"run", "--fingers", "index,thumb,index"}, "one comes twice", 2},
        {{"run", "--seconds", "1", "--log", "a.exh", "--blackbox", "a.exh"},
            "--blackbox: a.exh: is the file of --log", 2},
        {{"run", "--pace", "--slack", "60.1"}, "--slack", 2},
        {{"run", "--pace", "--slack", "0.1", "--gpio", "gpiochip9:estop=4,deadman=5"},
            "not with --gpio", 2},
        {{"run", "--seconds", "1", "--log", "/dev/full"}, "/dev/full: can't be written: No space",
            1}};
    char *dir = said_dir();
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        struct said s;
        said(&s, dir, cli_run, row[i].word);
        CHECK(s.status == row[i].status, "%s %s: %d", row[i].word[1], row[i].word[2], s.status);
        CHECK(strstr(s.err, row[i].said) != NULL, "%s", s.err);
    }
    said_clean(dir);
}

/* On a disk that is full the log ends behind its last whole record, and the loss is in it. */
TEST(a_full_disk_ends_a_log)
{
    const struct rlimit few = {200000, RLIM_INFINITY};
    struct rlimit was;
    char *dir = said_dir();
    const char *log = said_path(dir, "a.exh");
    struct said s;
    CHECK_EQ_I64(getrlimit(RLIMIT_FSIZE, &was), 0);
    signal(SIGXFSZ, SIG_IGN);
    CHECK_EQ_I64(setrlimit(RLIMIT_FSIZE, &few), 0);
    said(&s, dir, cli_run, WORDS("run", "--seconds", "4", "--log", log));
    CHECK_EQ_I64(setrlimit(RLIMIT_FSIZE, &was), 0);
    CHECK(s.status == 1 && strstr(s.err, "can't be written: File too large"), "%d %s", s.status,
        s.err);
    CHECK(said_size(log) > 190000 && said_size(said_path(dir, "a.exh.part")) < 0, "%ld B",
        said_size(log));
    said(&s, dir, cli_csv, WORDS("csv", log, "--out", "/dev/null"));
    CHECK(s.status == 0 && s.err[0] == '\0', "%d %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", "--timeline", log));
    CHECK(s.status == 0 && strstr(s.out, " records lost") && !strstr(s.out, " 0 records lost"),
        "%d %s", s.status, s.out);
    said_clean(dir);
}

TEST_MAIN("live", each_scene_goes_on_until_its_time_is_over, the_shortest_time_ends,
    after_a_fault_it_runs_again_by_the_grip_alone, what_a_restart_alone_clears_is_said_once,
    an_interrupt_leaves_a_complete_log, what_goes_by_while_it_is_stopped_is_missed,
    a_log_that_nobody_takes_stalls_nobody, dumps_of_a_paced_box,
    a_dump_that_nobody_takes_stalls_nobody, the_line_of_status,
    a_terminal_that_was_halted_stalls_nobody, a_slow_log_is_complete_in_virtual_time,
    it_runs_again_wherever_the_fault_found_the_mass, what_it_cannot_do_is_named,
    a_full_disk_ends_a_log);
