/* SPDX-License-Identifier: MIT */
/* Lines on stderr block no thread. On a halted terminal they wait. They come whole and in order,
 * for any number of drawn lines of status. */
#define _XOPEN_SOURCE 700 /* pseudo-terminals */

#include "terminal.h"

#include "base/option.h"
#include "base/messages.h"

#include <errno.h>
#include <stdio.h>
#include <termios.h>
#include <time.h>

static struct terminal tty;
static int stderr_was;
static char text[1 << 17];

static int begin(int paced)
{
    if (terminal_open(&tty) < 0) { return -1; }
    fflush(stderr);
    stderr_was = dup(2);
    dup2(tty.slave, 2);
    text[0] = '\0';
    words_begin(paced);
    return 0;
}

static void end(void)
{
    words_end();
    dup2(stderr_was, 2);
    close(stderr_was);
    terminal_close(&tty);
}

static double now_s(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Until these words have come. */
static int comes(const char *words)
{
    const double until = now_s() + 30;
    while (now_s() < until) {
        const struct timespec a_while = {0, 1000000};
        terminal_read(&tty, text, sizeof text);
        if (strstr(text, words)) { return 1; }
        (void)nanosleep(&a_while, NULL);
    }
    return 0;
}

TEST(a_halted_terminal_holds_nobody_up)
{
    char line[64];
    const char *at = text;
    double before_s;
    if (begin(1) < 0) { return; }
    CHECK_EQ_I64(tcflow(tty.slave, TCOOFF), 0);
    before_s = now_s();
    for (int i = 0; i < 1000; i++) { words_show("a line of status, drawn over and over again"); }
    for (int i = 0; i < 100; i++) {
        snprintf(line, sizeof line, "said %03d", i);
        words_say(line);
        words_show("a line of status");
    }
    cli_complain("complained %d", 7);
    CHECK(now_s() - before_s < 5, "it waited");
    CHECK_EQ_I64(words_lost(), 0);
    CHECK_EQ_I64(tcflow(tty.slave, TCOON), 0);
    CHECK(comes("exhand: complained 7\r\n"), "%s", text);
    for (int i = 0; i < 100; i++) {
        snprintf(line, sizeof line, "said %03d\r\n", i);
        at = strstr(at, line);
        CHECK(at != NULL, "line %d is not there, or not in its order", i);
    }
    end();
}

/* More than there is room for: the first come, the others are counted. */
TEST(what_was_lost_is_counted)
{
    char line[WORDS_LINE_B / 2];
    unsigned said = 0;
    if (begin(1) < 0) { return; }
    CHECK_EQ_I64(tcflow(tty.slave, TCOOFF), 0);
    memset(line, 'x', sizeof line);
    line[sizeof line - 1] = '\0';
    for (; said < 1000; said++) { words_say(line); }
    CHECK(words_lost() > 800 && words_lost() < 1000, "%lu lost", (unsigned long)words_lost());
    CHECK_EQ_I64(tcflow(tty.slave, TCOON), 0);
    said -= words_lost();
    for (unsigned n = 0; n < said;) {
        n = 0;
        CHECK(comes("x\r\n"), "nothing");
        for (const char *at = text; (at = strstr(at, "x\r\n")) != NULL; at++) { n++; }
        CHECK(n <= said, "%u lines of %u", n, said);
    }
    end();
}

/* The line of status gives way to what is said, and has an end behind it. */
TEST(lines_among_status)
{
    if (begin(1) < 0) { return; }
    words_show("status 1");
    words_say("said");
    words_show("status 2");
    words_end();
    CHECK(comes("\rstatus 1\033[K\r\033[Ksaid\r\n\rstatus 2\033[K\r\n"), "%s", text);
    words_say("at once");
    words_show("nowhere");
    CHECK(comes("at once\r\n"), "%s", text);
    CHECK(strstr(text, "nowhere") == NULL, "%s", text);
    end();
}

TEST_MAIN("words", a_halted_terminal_holds_nobody_up, what_was_lost_is_counted, lines_among_status);
