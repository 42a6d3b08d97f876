/* SPDX-License-Identifier: MIT */
/* A pseudo-terminal, for a command that looks whether it has one. */
#ifndef TEST_SIM_TERMINAL_H
#define TEST_SIM_TERMINAL_H

#include "check.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct terminal {
    int master, slave;
};

/* 0, or -1 and a note: the machine has none. */
static inline int terminal_open(struct terminal *t)
{
    t->slave = -1;
    setenv("TERM", "xterm", 1); /* whatever the tests are run on, it can be drawn on */
    t->master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (t->master >= 0 && grantpt(t->master) == 0 && unlockpt(t->master) == 0) {
        t->slave = open(ptsname(t->master), O_RDWR | O_NOCTTY);
    }
    if (t->slave >= 0) { return 0; }
    check_note("no pseudo-terminal here (%s): not tried on one", strerror(errno));
    if (t->master >= 0) { close(t->master); }
    return -1;
}

static inline void terminal_close(struct terminal *t)
{
    close(t->slave);
    close(t->master);
}

/* Appends new output of the terminal to text. Output beyond its size is dropped. */
static inline void terminal_read(const struct terminal *t, char *text, size_t size)
{
    size_t at = strlen(text);
    char more[512];
    ssize_t n;
    while ((n = read(t->master, more, sizeof more)) > 0) {
        const size_t take = (size_t)n < size - 1 - at ? (size_t)n : size - 1 - at;
        memcpy(text + at, more, take);
        at += take;
        text[at] = '\0';
    }
}

#endif
