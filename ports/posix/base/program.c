/* SPDX-License-Identifier: MIT */
#include "base/program.h"

#include "base/assign.h"
#include "base/ends.h"
#include "base/near.h"
#include "base/option.h"

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
    fputs("  help       print this list; `help COMMAND` lists the options of a command\n"
          "  --version  versions of library, record, board, parameter image, calibration\n"
          "If an option is given twice, the last one counts, unless its help says otherwise.\n"
          "Exit status: 0 ok, 1 a check failed, 2 bad usage, 3 something is missing,\n"
          "130 interrupted.\n",
        to);
}

static int no_such(const struct program *p, const char *name)
{
    struct near n = near_to(name, strlen(name));
    char mean[NEAR_B];
    if (cli_listed(p->moved, name, strlen(name))) {
        cli_complain("%s: a study: `exhand-lab %s` has it (make lab)", name, name);
        return 2;
    }
    for (size_t t = 0; t < PROGRAM_TABLES && p->table[t]; t++) {
        for (size_t i = 0; i < p->table[t]->n; i++) { near_try(&n, p->table[t]->at[i].name); }
    }
    near_try(&n, "--version");
    near_try(&n, "--help");
    cli_complain("%.60s: no such command%s: `%s help` lists them", name[0] ? name : "\"\"",
        near_text(mean, &n, ""), p->name);
    return 2;
}

static int is_any(const char *word, const char *one, const char *other)
{
    return strcmp(word, one) == 0 || strcmp(word, other) == 0;
}

/* help, or help COMMAND. */
static int ask_help(const struct program *p, int argc, char **argv)
{
    static char ask[] = "--help";
    const struct program_command *c;
    if (argc < 3) {
        help(p, stdout);
        return 0;
    }
    c = find(p, argv[2]);
    if (c == NULL) { return no_such(p, argv[2]); }
    if (argc == 3) { return c->run(2, (char *[]){argv[2], ask, NULL}); }
    return c->run(3, (char *[]){argv[2], argv[3], ask, NULL});
}

int program_main(const struct program *p, int argc, char **argv)
{
    const char *name = argc > 1 ? argv[1] : "";
    const struct program_command *c = find(p, name);
    ends_begin();
    cli_program = p->name;
    cli_hint = assign_hint;
    if (c) { return ends_status(cli_finish(c->run(argc - 1, argv + 1))); }
    if (strcmp(name, "--version") == 0) {
        cli_version();
        return cli_finish(0);
    }
    if (strcmp(name, "help") == 0 || is_any(name, "--help", "-h")) {
        return cli_finish(ask_help(p, argc, argv));
    }
    if (argc > 1) { return no_such(p, name); }
    help(p, stderr);
    return 2;
}
