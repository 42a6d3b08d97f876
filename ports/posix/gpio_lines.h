/* SPDX-License-Identifier: MIT */
/* Lines of one GPIO chip through a version of libgpiod: gpio_v1.c, gpio_v2.c, or gpio_none.c
 * without it. One of them is linked with gpio_lines.c. gpio.c defines the meaning of lines. Levels,
 * never edges. */
#ifndef GPIO_LINES_H
#define GPIO_LINES_H

#include <stdio.h>

#define GPIO_LINES_MAX 4 /* of either direction */
#define GPIO_CONSUMER  "exhand"

enum gpio_why {
    GPIO_FINE,
    GPIO_NO_LIBRARY,
    GPIO_NO_CHIP, /* not there, not ours to open, or none: error */
    GPIO_NO_LINE, /* line >= lines */
    GPIO_BUSY,    /* another program uses the line */
    GPIO_REFUSED  /* the kernel does not give the lines: error */
};

struct gpio_problem {
    enum gpio_why why;
    int error; /* errno */
    unsigned line, lines;
    char who[32];
};

extern const char gpio_lines_library[]; /* "libgpiod 1"; "" without */

/* Requests in[0..ins-1] as inputs, pulled down where the chip can, and out[0..outs-1] as outputs,
 * low from the first. Each count 0..GPIO_LINES_MAX. 0, or -1 and nothing is held: *p says why. */
int gpio_lines_open(const char *path, const unsigned *in, unsigned ins, const unsigned *out,
    unsigned outs, struct gpio_problem *p);
void gpio_lines_close(void);

/* What each version has of it. The chip alone: 0, or -1 with errno. Then its lines: 0, or -1 with
 * *p said, and what is held by then is left to gpio_lines_close(). */
int gpio_chip_open(const char *path);
int gpio_chip_request(
    const unsigned *in, unsigned ins, const unsigned *out, unsigned outs, struct gpio_problem *p);
/* Another program uses this line; who: NULL, or its name. */
static inline void gpio_lines_busy(struct gpio_problem *p, unsigned line, const char *who)
{
    p->why = GPIO_BUSY;
    p->line = line;
    snprintf(p->who, sizeof p->who, "%s", who ? who : "");
}

/* Reads all inputs together: level[i] is 0 or 1. Returns 0, or -1 with errno. */
int gpio_lines_get(int *level);

/* Writes all outputs together. Returns 0, or -1 with errno. It allocates nothing and takes no lock,
 * because signal handlers call it. */
int gpio_lines_put(const int *level);

#endif
