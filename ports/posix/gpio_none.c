/* Without libgpiod: whoever asks for lines is told. */
#include "gpio_lines.h"

#include <errno.h>
#include <string.h>

const char gpio_lines_library[] = "";

int gpio_lines_open(const char *path, const unsigned *in, unsigned ins, const unsigned *out,
                    unsigned outs, struct gpio_problem *p)
{
    (void)path, (void)in, (void)ins, (void)out, (void)outs;
    memset(p, 0, sizeof *p);
    p->why = GPIO_NO_LIBRARY;
    return -1;
}

void gpio_lines_close(void)
{
}

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
