/* SPDX-License-Identifier: MIT */
/* Glove tty: a stock glove (cyberglove.h) on a serial line, 115200 baud, 8 bits, no parity.
 * Commands stop it, switch its filter off and its status on, and start the stream at a rate. Each
 * command waits for the answer to the previous one, or 250 ms. After a second without a frame all
 * commands are sent again. A second after the device is lost it is opened again, for a glove that
 * was switched off or unplugged. While it is open, no other program may open it.
 * - The calls never wait. Times come from the caller, in s, and rise. */
#ifndef GLOVE_TTY_H
#define GLOVE_TTY_H

#include "cyberglove.h"

/* Time from the first to the last bit of a frame. Sampling takes place earlier; the delay is
 * undocumented. */
#define GLOVE_TTY_FRAME_S (CYBERGLOVE_FRAME_B * 10 / 115200.0)

#define GLOVE_TTY_RATE_MIN_HZ 2
#define GLOVE_TTY_RATE_MAX_HZ 200

struct glove_tty {
    const char *path; /* the caller's */
    double rate_Hz;   /* 115200 / a whole number */
    int fd;           /* -1: the device is gone */
    struct cyberglove in;
    uint32_t bytes;                  /* that came */
    uint32_t told;                   /* number of start commands */
    uint32_t gone;                   /* how often the device went away */
    unsigned step;                   /* of the commands */
    uint32_t answers;                /* before the last of them */
    double said_s, frame_s, tried_s; /* a command; a frame, or all commands; to open */
};

/* Opens it, at 0 s; rate_Hz is made one that the glove can have. 0, or -1 with errno; ENOTTY: no
 * serial line. */
int glove_tty_open(struct glove_tty *t, const char *path, double rate_Hz);

/* Reads the received bytes. Returns 1 if a new complete frame is in t->in, else 0. */
int glove_tty_poll(struct glove_tty *t, double now_s);

/* Stops the stream. */
void glove_tty_close(struct glove_tty *t);

#endif
