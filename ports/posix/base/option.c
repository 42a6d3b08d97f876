/* SPDX-License-Identifier: MIT */
#include "base/option.h"

#include "base/lines.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *cli_program = "exhand";
static const char *command = ""; /* for cli_complain() */

#define LINE_B 8192
void (*cli_complain_by)(const char *line);

/* Between the program and its command. */
static const char *blank(const char *name) { return cli_program[0] && name[0] ? " " : ""; }

void cli_complain(const char *format, ...)
{
    char line[LINE_B], plain[LINE_B];
    const int n = snprintf(line, 64, "%s%s%s: ", cli_program, blank(command), command);
    va_list args;
    va_start(args, format);
    vsnprintf(line + (n < 64 ? n : 63), sizeof line - 64, format, args);
    va_end(args);
    lines_plain(plain, sizeof plain, line); /* it may quote a file, of any bytes */
    if (cli_complain_by) {
        cli_complain_by(plain);
    } else {
        fprintf(stderr, "%s\n", plain);
    }
}

int cli_finish(int status)
{
    if (fflush(stdout) == 0 && !ferror(stdout)) { return status; }
    cli_complain("standard output can't be written: is its disk full?");
    return status ? status : 1;
}

static const struct cli_option *row(const struct cli_command *c, const struct cli_more *more, int i)
{
    return i < c->options ? &c->option[i] : &more->option[i - c->options];
}

static void help(const struct cli_command *c, const struct cli_more *more)
{
    printf("%s%s%s %s\n%s\n", cli_program, blank(c->name), c->name, c->args, c->what);
    for (int i = 0; i < c->options + more->options; i++) {
        const struct cli_option *o = row(c, more, i);
        char left[40];
        snprintf(left, sizeof left, "--%s%s%s", o->name, o->arg ? " " : "", o->arg ? o->arg : "");
        printf("  %-24s %s\n", left, o->help);
    }
    printf("  %-24s %s\n", "--help", "this");
}

static int bad(const struct cli_command *c, const char *what, const char *why)
{
    cli_complain("%s: %s: `%s%s%s --help` lists the options", what, why, cli_program,
        blank(c->name), c->name);
    return 2;
}

static int take_number(const struct cli_option *o, const char *text)
{
    const int whole = o->kind == CLI_INT;
    char *end;
    const double v = whole ? (double)strtoll(text, &end, 10) : strtod(text, &end);
    if (end == text || *end != '\0' || !(v >= o->min && v <= o->max)) {
        cli_complain("--%s: %s (allowed %.15g..%.15g): give a %snumber in that range", o->name,
            text, o->min, o->max, whole ? "whole " : "");
        return 2;
    }
    if (whole) {
        *(int64_t *)o->to = (int64_t)v; /* every maximum is below 2^53 */
    } else {
        *(double *)o->to = v;
    }
    return 0;
}

static int take(const struct cli_option *o, const char *text)
{
    const struct cli_call *call = o->to;
    switch (o->kind) {
    case CLI_TEXT: *(const char **)o->to = text; return 0;
    case CLI_CALL: return call->take(call->ctx, text);
    case CLI_INT:
    case CLI_REAL: return take_number(o, text);
    case CLI_FLAG: break;
    }
    *(int *)o->to = 1;
    return 0;
}

static const struct cli_option *find(
    const struct cli_command *c, const struct cli_more *more, const char *name, size_t len)
{
    for (int i = 0; i < c->options + more->options; i++) {
        const struct cli_option *o = row(c, more, i);
        if (strlen(o->name) == len && strncmp(o->name, name, len) == 0) { return o; }
    }
    return NULL;
}

int cli_listed(const char *names, const char *name, size_t len)
{
    for (const char *at = names; at != NULL && *at != '\0'; at += strspn(at, " ")) {
        const size_t n = strcspn(at, " ");
        if (n == len && strncmp(at, name, len) == 0) { return 1; }
        at += n;
    }
    return 0;
}

/* One word that starts with --, and its value. *i moves past what was used. */
static int take_word(
    const struct cli_command *c, const struct cli_more *more, int argc, char **argv, int *i)
{
    const char *word = argv[*i];
    const char *equals = strchr(word, '=');
    const size_t len = equals ? (size_t)(equals - word) : strlen(word);
    const struct cli_option *o = find(c, more, word + 2, len - 2);

    if (o == NULL && cli_listed(more->moved, word + 2, len - 2)) {
        cli_complain("%.*s: a study: `exhand-lab %s` has it (make lab)", (int)len, word, c->name);
        return 2;
    }
    if (o == NULL) { return bad(c, word, "no such option"); }
    if (o->kind == CLI_FLAG) { return equals ? bad(c, word, "takes no value") : take(o, NULL); }
    if (equals) { return take(o, equals + 1); }
    if (*i + 1 >= argc) { return bad(c, word, "its value is missing"); }
    *i += 1;
    return take(o, argv[*i]);
}

int cli_parse_more(const struct cli_command *c, const struct cli_more *more, int argc, char **argv,
    const char **operand)
{
    int n = 0;
    command = c->name;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            help(c, more);
            return 1;
        }
        if (strncmp(argv[i], "--", 2) == 0) {
            const int err = take_word(c, more, argc, argv, &i);
            if (err) { return err; }
        } else if (n < c->operands) {
            operand[n++] = argv[i];
        } else {
            return bad(c, argv[i], "one word too many");
        }
    }
    return n < c->operands ? bad(c, c->args, "a word is missing") : 0;
}

int cli_parse(const struct cli_command *c, int argc, char **argv, const char **operand)
{
    static const struct cli_more none = {NULL, 0, NULL};
    return cli_parse_more(c, &none, argc, argv, operand);
}
