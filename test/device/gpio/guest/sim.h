/* SPDX-License-Identifier: MIT */
/* The kernel's simulated GPIO chip, from outside: what hangs on its lines; and somebody else who
 * wants one. Kernel files and system calls alone. */
#ifndef GUEST_SIM_H
#define GUEST_SIM_H

/* 0, or -1 after a line. */
int sim_load(const char *module);
int sim_make(int lines);
const char *sim_chip(void); /* its name */
void sim_unmake(void);      /* whoever holds lines loses them */

void sim_pull(int line, int up); /* a contact closes (1) or opens */
int sim_level(int line);         /* what a meter would show; -1: no such line */
int sim_held(int line);          /* 1: by anybody */

/* Requests a line as somebody else: a file descriptor, or -1 with errno. */
int sim_take(int line, const char *as);

double now_s(void);
void wait_s(double s);

#endif
