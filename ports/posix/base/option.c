/* SPDX-License-Identifier: MIT */
#include "base/option.h"

#include "base/lines.h"
#include "base/near.h"

#include "exhand/board.h"
#include "exhand/exhand.h"

#include <ctype.h>
#include <poll.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *cli_program = "exhand";
static const char *command = ""; /* for cli_complain() */

#define LINE_B 8192
#define SHOWN  60 /* characters of a value that is refused */
const char *(*cli_hint)(const char *name, size_t len);
void (*cli_complain_by)(const char *line);

/* Texts that were given, files as a rule, and the options that they came by. */
#define GIVEN 40
static struct {
    const char *option, *text;
} given[GIVEN];
static int givens;

static void give(const char *option, const char *text)
{
    for (int i = 0; i < givens; i++) { /* the last counts */
        if (strcmp(given[i].option, option) == 0) {
            given[i].text = text;
            return;
        }
    }
    if (givens == GIVEN) { return; }
    given[givens].option = option;
    given[givens++].text = text;
}

/* The option whose text, or a file below it, this line begins with; NULL: none. */
static const char *came_by(const char *line)
{
    for (int i = 0; i < givens; i++) {
        const size_t n = strlen(given[i].text);
        if (strncmp(line, given[i].text, n) == 0 && (line[n] == ':' || (n > 0 && line[n] == '/'))) {
            return given[i].option;
        }
    }
    return NULL;
}

/* Between the program and its command. */
static const char *blank(const char *name) { return cli_program[0] && name[0] ? " " : ""; }

void cli_complain(const char *format, ...)
{
    char body[LINE_B - 128], line[LINE_B], plain[LINE_B];
    const char *by;
    va_list args;
    va_start(args, format);
    vsnprintf(body, sizeof body, format, args);
    va_end(args);
    by = came_by(body);
    (void)snprintf(line, sizeof line, "%s%s%s: %s%s%s%s", cli_program, blank(command), command,
        by ? "--" : "", by ? by : "", by ? ": " : "", body);
    lines_plain(plain, sizeof plain, line); /* it may quote a file, of any bytes */
    if (cli_complain_by) {
        cli_complain_by(plain);
    } else {
        fprintf(stderr, "%s\n", plain);
    }
}

void cli_version(void)
{
    printf("exhand %d.%d.%d, record %d, board %d, parameters %d, calibration %d, of the glove "
           "%d, wire %d\n",
        EXH_VERSION_MAJOR, EXH_VERSION_MINOR, EXH_VERSION_PATCH, EXH_RECORD_VERSION,
        EXH_BOARD_VERSION, EXH_PARAMS_VERSION, EXH_CALIB_VERSION, EXH_GLOVE_CAL_VERSION,
        EXH_WIRE_VERSION);
}

/* What became of standard output. */
static const char *why_not(void)
{
    struct pollfd f = {STDOUT_FILENO, POLLOUT, 0};
    (void)poll(&f, 1, 0);
    if (f.revents & POLLNVAL) { return "it is closed: open it, or give it to /dev/null"; }
    return f.revents & POLLERR ? "whoever read it has gone" : "is its disk full?";
}

int cli_finish(int status)
{
    if (fflush(stdout) == 0 && !ferror(stdout)) { return status; }
    cli_complain("standard output can't be written: %s", why_not());
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
    printf("  %-24s %s\n", "--help", "print this help");
}

/* What: so many characters of it. */
static int bad(const struct cli_command *c, const char *what, size_t len, const char *why)
{
    cli_complain("%.*s: %s: `%s%s%s --help` lists the options", (int)(len < SHOWN ? len : SHOWN),
        what, why, cli_program, blank(c->name), c->name);
    return 2;
}

/* A name after the dashes that no option has. */
static int unknown(
    const struct cli_command *c, const struct cli_more *more, const char *word, size_t len)
{
    const size_t dashes = word[1] == '-' ? 2 : 1;
    struct near n = near_to(word + dashes, len - dashes);
    char why[200], mean[NEAR_B];
    const char *device = NULL;
    for (int i = 0; i < c->options + more->options; i++) {
        const char *name = row(c, more, i)->name;
        near_try(&n, name);
        if (strcmp(name, "device") == 0 && cli_hint) { device = cli_hint(n.word, n.len); }
    }
    (void)snprintf(why, sizeof why, "no such option%s", near_text(mean, &n, "--"));
    if (device) {
        (void)snprintf(why, sizeof why, "no such option: give --device %s=VALUE", device);
    }
    return bad(c, word, len, why);
}

/* The operand that is missing, as the usage calls it. */
static int missing(const struct cli_command *c, int n)
{
    const char *at = c->args;
    for (; n > 0; n--) {
        at += strcspn(at, " ");
        at += strspn(at, " ");
    }
    return bad(c, at, strcspn(at, " "), "this word is missing");
}

int cli_number(const char *text, int whole, double *v)
{
    const char *digits = text + (text[0] == '-' || text[0] == '+');
    char *end;
    if (!isdigit((unsigned char)digits[digits[0] == '.']) || digits[strcspn(digits, "xX")]) {
        return 0;
    }
    *v = whole ? (double)strtoll(text, &end, 10) : strtod(text, &end);
    return *end == '\0';
}

static int take_number(const struct cli_option *o, const char *text)
{
    const int whole = o->kind == CLI_INT;
    double v;
    if (!cli_number(text, whole, &v) || !(v >= o->min && v <= o->max)) {
        cli_complain("--%s: %.*s (allowed %.15g..%.15g): give a %snumber in that range", o->name,
            SHOWN, text[0] ? text : "nothing", o->min, o->max, whole ? "whole " : "");
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
    case CLI_TEXT:
        give(o->name, text);
        *(const char **)o->to = text;
        return 0;
    case CLI_CALL: give(o->name, text); return call->take(call->ctx, text);
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
    if (o == NULL) { return unknown(c, more, word, len); }
    if (o->kind == CLI_FLAG) {
        return equals ? bad(c, word, strlen(word), "takes no value") : take(o, NULL);
    }
    if (equals) { return take(o, equals + 1); }
    if (*i + 1 >= argc) { return bad(c, word, len, "its value is missing"); }
    *i += 1;
    return take(o, argv[*i]);
}

int cli_parse_more(const struct cli_command *c, const struct cli_more *more, int argc, char **argv,
    const char **operand)
{
    int n = 0;
    command = c->name;
    givens = 0;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            help(c, more);
            return 1;
        }
        if (strcmp(argv[i], "--version") == 0) {
            cli_version();
            return 1;
        }
        if (strncmp(argv[i], "--", 2) == 0) {
            const int err = take_word(c, more, argc, argv, &i);
            if (err) { return err; }
        } else if (argv[i][0] == '-' && isalpha((unsigned char)argv[i][1])) {
            return unknown(c, more, argv[i], strlen(argv[i]));
        } else if (n < c->operands) {
            operand[n++] = argv[i];
        } else {
            return bad(c, argv[i][0] ? argv[i] : "\"\"", SHOWN, "one word too many");
        }
    }
    return n < c->operands ? missing(c, n) : 0;
}

int cli_parse(const struct cli_command *c, int argc, char **argv, const char **operand)
{
    static const struct cli_more none = {NULL, 0, NULL};
    return cli_parse_more(c, &none, argc, argv, operand);
}
