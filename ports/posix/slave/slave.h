/* SPDX-License-Identifier: MIT */
/* exhand run --modbus: the registers of the running box (exhand/modbus.h) for clients, over TCP or
 * a serial line. A separate thread answers them. A mailbox connects it with the loop:
 *
 *   loop, after a tick:   copies all registers, from one tick
 *   clients:              read the copy, stage and command in it
 *   loop, before a tick:  executes commands
 *
 * The loop never waits for the mailbox. If it is in use, the copy stays that of the last tick, and
 * commands wait for the next. So a client can delay a response, but no tick. */
#ifndef POSIX_SLAVE_H
#define POSIX_SLAVE_H

#include "exhand/run/scene.h"

#include "exhand/regs.h"

struct mail_cfg {
    const char *save; /* SAVE writes the parameters there; NULL: refused */
    int write;        /* parameters may be changed; else clients only read */
    int remote;       /* RUN, CLEAR and OFF may be commanded */
};

/* mail.c. start, before and after: hooks of the loop, called earlier than those that log. A tick
 * never waits. 0 of mail_before() and mail_show(): the server has the registers, try next tick. */
void mail_open(const struct mail_cfg *cfg);
int mail_start(const struct exh_scene *sc, struct exh_scene_board board); /* 0 or -EXH_E… */
int mail_before(struct exh_scene_in *in);
void mail_after(const struct exh_scene_in *in); /* a step of the trace, and show */
int mail_show(const struct exh_scene_in *in);

/* Locks the registers for one request, until they are given back. */
struct exh_regs *mail_take(void);
void mail_give(void);

/* Between requests: writes the image that SAVE requested. */
void mail_save(void);

/* After the last tick and the last response: executes commands that were confirmed but found no
 * tick. */
void mail_end(void);

/* libmodbus.c, or none.c without that package. where: "tcp:HOST:PORT",
 * "rtu:DEVICE:BAUD". 0, or 2 or 3 after a line on stderr. */
int live_modbus_open(const char *where);
/* Answers from now on: behind mail_start(). 0, or 3 after a line on stderr. */
int live_modbus_serve(void);
void live_modbus_close(void);

#endif
