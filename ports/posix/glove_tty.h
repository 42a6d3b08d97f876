/* SPDX-License-Identifier: MIT */
/* Glove tty: a stock glove (cyberglove.h) on a serial line of this machine, 115200 baud, 8 bits, no
 * parity. It is told to stop, filter nothing, send its status, and stream at a rate; each command
 * waits for the answer to the one before, or a quarter of a second. After a second without a frame
 * it is told all of it again, and after a second without the device that is opened again: a glove
 * that was switched off or unplugged comes back by itself.
 *
 * While it is open no other program may open it. Never waits. Times are the caller's, s, and rise.
 */
#ifndef GLOVE_TTY_H
#define GLOVE_TTY_H

#include "cyberglove.h"

/* From a frame's first bit to its last. Sampled it was before that; how long, nobody says. */
#define GLOVE_TTY_FRAME_S (CYBERGLOVE_FRAME_B * 10 / 115200.0)

#define GLOVE_TTY_RATE_MIN_HZ 2
#define GLOVE_TTY_RATE_MAX_HZ 200

struct glove_tty {
    const char *path; /* the caller's */
    double rate_Hz;   /* 115200 / a whole number */
    int fd;           /* -1: the device is gone */
    struct cyberglove in;
    uint32_t bytes;                  /* that came */
    uint32_t told;                   /* how often it was told to stream */
    uint32_t gone;                   /* how often the device went away */
    unsigned step;                   /* of the commands */
    uint32_t answers;                /* before the last of them */
    double said_s, frame_s, tried_s; /* a command; a frame, or all commands; to open */
};

/* Opens it, at 0 s; rate_Hz is made one that the glove can have. 0, or -1 with errno; ENOTTY: no
 * serial line. */
int glove_tty_open(struct glove_tty *t, const char *path, double rate_Hz);

/* What has come until now: 1, a new whole frame is in t->in; 0. */
int glove_tty_poll(struct glove_tty *t, double now_s);

/* Tells it to stop. */
void glove_tty_close(struct glove_tty *t);

#endif
