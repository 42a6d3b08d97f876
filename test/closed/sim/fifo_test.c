/* SPDX-License-Identifier: MIT */
/* A command that waits for the other end of a FIFO prints so, and Ctrl-C ends it. An unread
 * standard output is named. */
#include "said.h"

#include "base/ends.h"

#include <time.h>

static struct said s;

static void nap(void)
{
    const struct timespec ms50 = {0, 50000000};
    nanosleep(&ms50, NULL);
}

/* As main() has it. */
static int (*command)(int, char **);
static int whole(int argc, char **argv)
{
    ends_begin();
    return ends_status(cli_finish(command(argc, argv)));
}

TEST(who_waits_for_a_fifo_says_so)
{
    static const struct {
        int (*run)(int, char **);
        const char *word[8];
        const char *says;
    } row[] = {
        {cli_glove, {"glove", "--rate", "90", "--csv"}, "--csv: "},
        {cli_glove, {"glove", "--record", "/dev/null", "--play"}, "--play: "},
        {cli_quad, {"quad", "--csv"}, "--csv: "},
        {cli_calibrate, {"calibrate", "--check"}, "--check: "},
        {cli_drop, {"drop", "--rate", "90", "--falls", "1", "--runs", "1", "--save-params"},
            "--save-params: "},
        {cli_listen, {"listen", "--at", "127.0.0.1:0", "--out"}, "--out: "},
        {cli_run, {"run", "--seconds", "0.1", "--log"}, "--log: "},
    };
    const char *dir = said_dir(), *fifo = said_path(dir, "fifo"), *err = said_path(dir, "said.err");
    CHECK(mkfifo(fifo, 0600) == 0, "no FIFO");
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        const char *word[10] = {NULL};
        pid_t pid;
        int n = 0;
        for (; n < 8 && row[i].word[n]; n++) { word[n] = row[i].word[n]; }
        word[n] = fifo;
        command = row[i].run;
        (void)unlink(err);
        pid = said_start(dir, whole, word);
        for (n = 0; n < 1200 && said_size(err) <= 0; n++) { nap(); }
        kill(pid, SIGINT);
        said_end(&s, dir, pid);
        CHECK(s.status == 130, "%s %s: status %d: %s", word[0], row[i].says, s.status, s.err);
        CHECK(strstr(s.err, row[i].says) && strstr(s.err, "this FIFO; Ctrl-C ends it\n"), "%s: %s",
            word[0], s.err);
    }
    said_clean(dir);
}

/* What the other end gives, and takes, goes through whole, however late it comes. */
TEST(a_fifo_that_has_its_other_end_is_a_file)
{
    const char *dir = said_dir(), *fifo = said_path(dir, "fifo");
    const char *in = said_path(dir, "in.csv");
    char line[300];
    FILE *f = fopen(in, "w");
    CHECK(f && fputs("0,0,0\n1,0,1\n2,1,1\n3,1,0\n", f) >= 0 && fclose(f) == 0, "%s", in);
    CHECK(mkfifo(fifo, 0600) == 0, "no FIFO");
    said(&s, dir, cli_quad, WORDS("quad", "--csv", in));
    CHECK(s.status == 0 && strstr(s.out, "net=3"), "%d: %s%s", s.status, s.out, s.err);
    strcpy(line, strstr(s.out, "net="));
    for (int late = 0; late < 2; late++) {
        char copy[700];
        snprintf(
            copy, sizeof copy, "(sleep %s; exec cat '%s' >'%s') &", late ? "1.5" : "0", in, fifo);
        CHECK_EQ_I64(system(copy), 0);
        said(&s, dir, cli_quad, WORDS("quad", "--csv", fifo));
        CHECK(s.status == 0 && strstr(s.out, line), "%d: %s%s", s.status, s.out, s.err);
    }
    said_clean(dir);
}

/* A FIFO is no log, because it can't be read twice. This is reported immediately. */
TEST(a_fifo_is_no_log)
{
    const char *dir = said_dir(), *fifo = said_path(dir, "fifo");
    CHECK(mkfifo(fifo, 0600) == 0, "no FIFO");
    said(&s, dir, cli_csv, WORDS("csv", fifo));
    CHECK(s.status == 2 && strstr(s.err, "not a log"), "%d: %s", s.status, s.err);
    said(&s, dir, cli_replay, WORDS("replay", fifo));
    CHECK(s.status == 2 && strstr(s.err, "not a log"), "%d: %s", s.status, s.err);
    said_clean(dir);
}

static int closed(int argc, char **argv)
{
    (void)close(STDOUT_FILENO);
    return cli_regs(argc, argv);
}

static int unread(int argc, char **argv)
{
    int fd[2];
    signal(SIGPIPE, SIG_IGN); /* as who starts us may have it */
    if (pipe(fd) != 0 || dup2(fd[1], STDOUT_FILENO) < 0) { return 99; }
    (void)close(fd[0]);
    (void)close(fd[1]);
    return cli_regs(argc, argv);
}

static int full(int argc, char **argv)
{
    const int fd = open("/dev/full", O_WRONLY);
    return dup2(fd, STDOUT_FILENO) < 0 ? 99 : cli_regs(argc, argv);
}

TEST(what_became_of_standard_output_is_named)
{
    static const struct {
        int (*run)(int, char **);
        const char *says;
    } row[] = {
        {closed, "can't be written: it is closed"},
        {unread, "can't be written: whoever read it has gone"},
        {full, "can't be written: is its disk full?"},
    };
    const char *dir = said_dir();
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        said(&s, dir, row[i].run, WORDS("regs"));
        CHECK(s.status == 1 && strstr(s.err, row[i].says), "%zu: %d: %s", i, s.status, s.err);
    }
    said_clean(dir);
}

TEST_MAIN("fifo", who_waits_for_a_fifo_says_so, a_fifo_that_has_its_other_end_is_a_file,
    a_fifo_is_no_log, what_became_of_standard_output_is_named);
