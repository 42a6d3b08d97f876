/* SPDX-License-Identifier: MIT */
/* What is the same by every version of libgpiod. */
#include "gpio_lines.h"

#include <errno.h>
#include <string.h>

int gpio_lines_open(const char *path, const unsigned *in, unsigned ins, const unsigned *out,
    unsigned outs, struct gpio_problem *p)
{
    memset(p, 0, sizeof *p);
    if (gpio_lines_library[0] == '\0') {
        p->why = GPIO_NO_LIBRARY;
        return -1;
    }
    if (gpio_chip_open(path) < 0) {
        p->why = GPIO_NO_CHIP;
        p->error = errno;
        return -1;
    }
    if (gpio_chip_request(in, ins, out, outs, p) < 0) {
        gpio_lines_close();
        return -1;
    }
    p->why = GPIO_FINE;
    return 0;
}
