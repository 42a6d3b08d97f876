/* SPDX-License-Identifier: MIT */
/* Without libgpiod: a request for lines gives an error message. */
#include "gpio_lines.h"

#include <errno.h>

const char gpio_lines_library[] = "";

int gpio_chip_open(const char *path)
{
    (void)path;
    errno = ENOSYS;
    return -1;
}

int gpio_chip_request(
    const unsigned *in, unsigned ins, const unsigned *out, unsigned outs, struct gpio_problem *p)
{
    (void)in, (void)ins, (void)out, (void)outs, (void)p;
    return -1;
}

void gpio_lines_close(void) {}

int gpio_lines_get(int *level)
{
    (void)level;
    errno = ENOSYS;
    return -1;
}

int gpio_lines_put(const int *level)
{
    (void)level;
    errno = ENOSYS;
    return -1;
}
