/* SPDX-License-Identifier: MIT */
/* Signals that end a program: its exit status, and that it leaves no half of a file behind. */
#ifndef CLI_ENDS_H
#define CLI_ENDS_H

/* First in main(). From now on SIGINT and SIGTERM end the program at once with status 128 + their
 * number, and SIGHUP, SIGQUIT and SIGPIPE as ever, but first the files that are not whole go
 * (outpart.h). Ignored signals stay ignored. A full disk is an error of write(), no signal. The
 * handlers are of one use: who has plans for a signal that ends a program replaces them, and
 * raises it anew behind its own last act (gpio.c). */
void ends_begin(void);

/* A handler of a command took this one, and the command will end by itself. */
void ends_note(int sig);

/* Last in main(): what a command's status becomes. 128 + the signal's number if one was noted. From
 * now on signals end the program at once, as after ends_begin(). */
int ends_status(int status);

#endif
