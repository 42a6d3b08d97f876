/* SPDX-License-Identifier: MIT */
#include "base/program.h"

#include "base/ends.h"
#include "base/option.h"

#include "exhand/board.h"
#include "exhand/exhand.h"

#include <stdio.h>
#include <string.h>

static const struct program_command *find(const struct program *p, const char *name)
{
    for (size_t t = 0; t < PROGRAM_TABLES && p->table[t]; t++) {
        const struct program_commands *c = p->table[t];
        for (size_t i = 0; i < c->n; i++) {
            if (strcmp(name, c->at[i].name) == 0) { return &c->at[i]; }
        }
    }
    return NULL;
}

static void help(const struct program *p, FILE *to)
{
    fprintf(to, "usage: %s COMMAND [options]\n", p->name);
    for (size_t t = 0; t < PROGRAM_TABLES && p->table[t]; t++) {
        const struct program_commands *c = p->table[t];
        for (size_t i = 0; i < c->n; i++) {
            if (find(p, c->at[i].name) != &c->at[i]) { continue; }
            fprintf(to, "  %-10s %s\n", c->at[i].name, c->at[i].what);
        }
    }
    fprintf(to,
        "  --version  versions of library, record, board, parameter image, calibration\n"
        "`%s COMMAND --help` lists the options of one.\n"
        "Exit status: 0 ok, 1 a check failed, 2 bad usage, 3 something is missing,\n"
        "130 interrupted (SIGINT), 143 ended (SIGTERM).\n",
        p->name);
}

int program_main(const struct program *p, int argc, char **argv)
{
    const char *name = argc > 1 ? argv[1] : "";
    const struct program_command *c = find(p, name);
    ends_begin();
    cli_program = p->name;
    if (c) { return ends_status(cli_finish(c->run(argc - 1, argv + 1))); }
    if (strcmp(name, "--version") == 0) {
        printf("exhand %d.%d.%d, record %d, board %d, parameters %d, calibration %d, of the glove "
               "%d, wire %d\n",
            EXH_VERSION_MAJOR, EXH_VERSION_MINOR, EXH_VERSION_PATCH, EXH_RECORD_VERSION,
            EXH_BOARD_VERSION, EXH_PARAMS_VERSION, EXH_CALIB_VERSION, EXH_GLOVE_CAL_VERSION,
            EXH_WIRE_VERSION);
        return cli_finish(0);
    }
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) {
        help(p, stdout);
        return cli_finish(0);
    }
    if (cli_listed(p->moved, name, strlen(name))) {
        fprintf(
            stderr, "%s: %s: a study: `exhand-lab %s` has it (make lab)\n", p->name, name, name);
        return 2;
    }
    if (name[0] != '\0') { fprintf(stderr, "%s: %s: no such command\n", p->name, name); }
    help(p, stderr);
    return 2;
}
