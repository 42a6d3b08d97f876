/* SPDX-License-Identifier: MIT */
/* The kernel's simulated GPIO chip, from outside: the contacts on its lines, and another program
 * that requests a line. Uses kernel files and system calls alone. */
#ifndef GUEST_SIM_H
#define GUEST_SIM_H

/* 0, or -1 after a line. */
int sim_load(const char *module);
int sim_make(int lines);
const char *sim_chip(void); /* its name */
void sim_unmake(void);      /* programs that hold lines lose them */

void sim_pull(int line, int up); /* a contact closes (1) or opens */
int sim_level(int line);         /* what a meter would show; -1: no such line */
int sim_held(int line);          /* 1: by anybody */

/* Requests a line as another program: a file descriptor, or -1 with errno. */
int sim_take(int line, const char *as);

double now_s(void);
void wait_s(double s);

#endif
