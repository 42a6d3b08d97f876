/* SPDX-License-Identifier: MIT */
/* Signals that end a program: its exit status, and that it leaves no half of a file behind. */
#ifndef CLI_ENDS_H
#define CLI_ENDS_H

/* Call it first in main(). From then on SIGINT and SIGTERM end the program immediately with status
 * 128 + their number. SIGHUP, SIGQUIT and SIGPIPE act as usual. Incomplete files are removed first
 * (outpart.h). Ignored signals stay ignored. A full disk is an error of write(), no signal. Each
 * handler acts once: a module with other plans for a terminating signal replaces it, and raises the
 * signal again after its own work (gpio.c). */
void ends_begin(void);

/* For a command's own handler of this signal; the command then ends normally. */
void ends_note(int sig);

/* Last in main(): what a command's status becomes. 128 + the signal's number if one was noted. From
 * now on signals end the program immediately, as after ends_begin(). */
int ends_status(int status);

#endif
