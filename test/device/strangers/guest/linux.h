/* SPDX-License-Identifier: MIT */
/* Linux: modules, comedi devices and instructions, by system calls alone. */
#ifndef GUEST_LINUX_H
#define GUEST_LINUX_H

#include <linux/comedi.h>
#include <stdint.h>

enum { GPCT, S526_AI, S526_AO, S526_DIO }; /* subdevices of s526, as its driver orders them */
enum { MM_AI, MM_AO, MM_DIO };             /* of dmm32at */

/* All return 0 or more, or -errno. */
int load(const char *path, const char *options);
int unload(const char *name);

/* irq 0: none; dmm32at then has no commands. */
int attach(unsigned minor, const char *board, int base, int irq);
int detach(unsigned minor);

int insn(unsigned minor, unsigned subdev, unsigned chan, unsigned range, unsigned kind, unsigned n,
    unsigned *data);

/* Runs a command until so many samples came: their number. Waits five seconds for each reading. */
int command(unsigned minor, struct comedi_cmd *c, uint16_t *sample, unsigned want);

/* One value; a failure ends the program: what is read must be readable. */
uint32_t get(unsigned minor, unsigned subdev, unsigned chan, unsigned range);
void put(unsigned minor, unsigned subdev, unsigned chan, uint32_t value);
uint32_t lines(unsigned minor, unsigned subdev, uint32_t mask, uint32_t bits);
void config(
    unsigned minor, unsigned subdev, unsigned chan, unsigned n, unsigned a, unsigned b, unsigned c);

void fail(const char *what, int error);

#endif
