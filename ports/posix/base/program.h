/* SPDX-License-Identifier: MIT */
/* A program of several commands. */
#ifndef BASE_PROGRAM_H
#define BASE_PROGRAM_H

#include <stddef.h>

struct program_command {
    const char *name, *what;
    int (*run)(int argc, char **argv);
};

struct program_commands {
    const struct program_command *at;
    size_t n;
};

#define PROGRAM_TABLES 2

struct program {
    const char *name;
    const struct program_commands *table[PROGRAM_TABLES]; /* the first that has a name runs it */
    const char *moved; /* names of commands that the lab's program has, blanks between; or NULL */
};

/* The exit status: 0 ok, 1 a check failed, 2 bad usage, 3 something is missing, 130 interrupted,
 * 143 ended by SIGTERM. */
int program_main(const struct program *p, int argc, char **argv);

#endif
