/* SPDX-License-Identifier: MIT */
/* The files that a command leaves. Each is complete at its name, or is not there (outpart.h).
 * Options are named without their dashes; NULL: no option names this file. */
#ifndef CLI_OUTFILE_H
#define CLI_OUTFILE_H

#include <stddef.h>
#include <stdio.h>

/* Before the work begins: each can be written, and no two are one file. Paths may be NULL. 0, or 2
 * after a line on stderr that names option and path. */
struct outfile_option {
    const char *option, *path;
};
int outfile_try(const struct outfile_option *o, size_t n);

/* A file on its way; NULL after a line on stderr. It may be read, too, if it is no device. */
FILE *outfile_open(const char *option, const char *path);
/* DIR/NAME of --out. */
FILE *outfile_in(const char *dir, const char *name);

/* It is whole: 0, or 1 after a line on stderr: nothing of it is left, and what was at the name is
 * there still. */
int outfile_close(FILE *f);

/* The same, and it goes on: more is appended at its name, and other writers are kept away. */
int outfile_goes_on(FILE *f);

/* Completes the file; the stream continues in the next file of that name. Before the file gets its
 * name, make_way() moves an existing one. The box runs on, so no caller waits for the disk. errno,
 * or 0. */
int outfile_turn(int fd, int (*make_way)(void));

/* It is not, and will not be. NULL is none. */
void outfile_abandon(FILE *f);

/* Closes it if it is whole, else abandons it. */
int outfile_end(FILE *f, int whole);

/* Why an open file could not be begun, in a line on stderr. */
void outfile_refused(const char *option, const char *path, int error);

/* Makes the directory of --out if need be; name is the longest of what will be in it. 0, or 2 after
 * a line on stderr. */
int outfile_dir(const char *dir, const char *name);

/* DIR/NAME of --out by a function that writes it. 0, or 1 after a line on stderr. */
int outfile_write(
    const char *dir, const char *name, void (*write)(FILE *f, const void *ctx), const void *ctx);

/* Writes the start of a command's pictures.gp: how to run it, and a message if it is run otherwise.
 * `plots` is then the path of ports/posix/plot. */
void outfile_pictures(FILE *f, const char *command);

/* An image of at most cap bytes that an option names: its length, or -status after a line on
 * stderr that says what file was expected. */
long outfile_read(
    const char *option, const char *path, const char *expected, void *to, size_t cap_B);

#endif
