/* SPDX-License-Identifier: MIT */
/* A GPIO chip that is none: what the two fakes of libgpiod (v1/, v2/) share, and what a test does
 * to it. */
#ifndef TEST_GPIO_CHIP_H
#define TEST_GPIO_CHIP_H

#include "gpio_lines.h"

#define CHIP_PATH  "/dev/gpiochip0"
#define CHIP_LINES 12

struct chip_line {
    int level;                     /* an input's, or what it was last set to */
    const char *holder;            /* another program's name, or NULL */
    int held, output, pulled_down; /* by us, and how */
    const char *consumer;
};

extern struct chip {
    int open_error;    /* errno of opening it; ENOENT also for any other path */
    int request_error; /* of any request */
    int no_bias;       /* a kernel before 5.5: EINVAL for a request with bias */
    int get_error, put_error;
    int puts_fail; /* so many more, by EIO */
    int opened;    /* and not closed yet */
    long gets, puts;
    int flips;     /* this line reads 1 at the first and 0 at the second of two reads, */
    int first_low; /* or the other way round; -1: none */
    int put_fd;    /* what outputs are set to goes there, a byte each; -1: nowhere */
    struct chip_line line[CHIP_LINES];
} chip;

/* All lines free and low. */
void chip_reset(void);

/* What the fakes do: 0, or -1 with errno. */
int chip_open(const char *path);
int chip_request(
    const unsigned *line, unsigned n, int output, int bias, int low, const char *consumer);
void chip_release(const unsigned *line, unsigned n);
void chip_close(void);
int chip_get(const unsigned *line, unsigned n, int *level);
int chip_put(const unsigned *line, unsigned n, const int *level);

#endif
