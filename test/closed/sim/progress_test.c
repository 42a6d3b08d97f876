/* SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700 /* pseudo-terminals */
/* How far a long run is, on a terminal and nowhere else. */
#include "said.h"
#include "terminal.h"

#include "base/logfile.h"
#include "base/progress.h"

static struct terminal tty;
static char text[65536];
static int errors; /* where standard error went */

static int begin(void)
{
    text[0] = '\0';
    if (terminal_open(&tty) < 0) { return 0; }
    errors = dup(STDERR_FILENO);
    return errors >= 0 && dup2(tty.slave, STDERR_FILENO) >= 0;
}

/* Reads the output since then. */
static void end(void)
{
    fflush(stderr);
    (void)dup2(errors, STDERR_FILENO);
    (void)close(errors);
    terminal_read(&tty, text, sizeof text);
    terminal_close(&tty);
}

TEST(a_terminal_alone_is_shown_it)
{
    const int nowhere = open("/dev/null", O_WRONLY);
    if (!begin()) { return; }
    progress_show("runs", 1, 3, 0);
    progress_show("falls", 7, 0, 0);
    progress_show(NULL, 2, 3, 0);
    (void)dup2(nowhere, STDERR_FILENO);
    progress_show("never", 1, 3, 0);
    (void)dup2(tty.slave, STDERR_FILENO);
    setenv("TERM", "dumb", 1);
    progress_show("dumb", 1, 3, 0);
    setenv("TERM", "xterm", 1);
    progress_show("runs", 3, 3, 1);
    end();
    (void)close(nowhere);
    CHECK(strcmp(text, "\rruns: 1/3\rfalls: 7\rruns: 3/3\r\n") == 0, "%s", text);
}

/* A log whose end record is cut off, and that grew: all of it is read. */
static const char *long_log(const char *dir)
{
    static struct said s;
    const char *path = said_path(dir, "a.exh");
    said(&s, dir, cli_run, WORDS("run", "--seconds", "0.2", "--log", path));
    CHECK(s.status == 0, "%d: %s", s.status, s.err);
    CHECK(truncate(path, said_size(path) - 10) == 0 && truncate(path, 4 << 20) == 0, "%s", path);
    return path;
}

TEST(a_log_that_takes_long_is_read_in_percents)
{
    const char *dir = said_dir(), *path = long_log(dir);
    struct exh_record r;
    for (int is_long = 0; is_long < 2; is_long++) {
        struct logfile l;
        if (!begin()) { return; }
        CHECK_EQ_I64(logfile_open(&l, path), 0);
        l.shows = 1;
        l.shown_s = is_long ? 0 : l.shown_s + 1000;
        while (logfile_next(&l, &r)) {}
        logfile_close(&l);
        end();
        CHECK(is_long ? strstr(text, "a.exh: ") && strstr(text, ": 100/100\r\n") : !text[0],
            "%d: %s", is_long, text);
    }
    said_clean(dir);
}

TEST_MAIN("progress", a_terminal_alone_is_shown_it, a_log_that_takes_long_is_read_in_percents);
