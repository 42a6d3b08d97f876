/* SPDX-License-Identifier: MIT */
/* Options: one table per subcommand makes the parser and the --help. */
#ifndef CLI_OPTION_H
#define CLI_OPTION_H

#include <stddef.h>

enum cli_kind { CLI_FLAG, CLI_INT, CLI_REAL, CLI_TEXT, CLI_CALL };

struct cli_option {
    const char *name; /* without the dashes */
    enum cli_kind kind;
    void *to;        /* int, int64_t, double, const char *; CALL: a cli_call */
    double min, max; /* INT and REAL */
    const char *arg; /* "HZ", shown in --help; NULL for a flag */
    const char *help;
};

/* For options that may come more than once or have a syntax of their own; 0, or
 * 2 after a line on stderr. */
struct cli_call {
    int (*take)(void *ctx, const char *text);
    void *ctx;
};

struct cli_command {
    const char *name, *args, *what; /* "drop", "[options]", one line */
    const struct cli_option *option;
    int options;
    int operands; /* how many operands it takes */
};

/* Beside a command's own options. */
struct cli_more {
    const struct cli_option *option; /* a study's, behind the others */
    int options;
    const char *moved; /* names of options that the lab's program has, blanks between; or NULL */
};

/* Parses the options; operands go to operand[]. Returns 0 to go on, 1 after printing help or the
 * version, 2 after an error message on stderr. */
int cli_parse(const struct cli_command *c, int argc, char **argv, const char **operand);
int cli_parse_more(const struct cli_command *c, const struct cli_more *more, int argc, char **argv,
    const char **operand);

/* Decimal digits alone, with a sign, a point and an exponent: nan, inf, 0x10 and blanks are no
 * numbers. 1, and the number; 0: it is none. */
int cli_number(const char *text, int whole, double *v);

/* The versions of the library and its formats, on standard output. */
void cli_version(void);

/* The name of a value of the simulated device if this is one; NULL: unknown. */
extern const char *(*cli_hint)(const char *name, size_t len);

/* Whether a name is in a list with blanks between. */
int cli_listed(const char *names, const char *name, size_t len);

/* Text before a command's name in messages: "exhand"; "" for a program with one command. */
extern const char *cli_program;

/* A whole line on stderr, after that and the command that is parsed or runs. One that begins with
 * the text of an option, "FILE: ", names the option before it. */
#ifdef __GNUC__
__attribute__((format(printf, 1, 2)))
#endif
void cli_complain(const char *format, ...);

/* Who takes that line then, without its end; NULL: it is written. */
extern void (*cli_complain_by)(const char *line);

/* What a command's exit status becomes once stdout is written: 1 after a line on
 * stderr if it was 0 and stdout could not be. */
int cli_finish(int status);

#endif
