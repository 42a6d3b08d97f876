/* SPDX-License-Identifier: MIT */
/* Lines by libgpiod 1.5 to 1.6 (Debian 12): a bulk for each direction, one ioctl() for all of it.
 */
#include "gpio_lines.h"

#include <gpiod.h>

#include <errno.h>
#include <string.h>

const char gpio_lines_library[] = "libgpiod 1";

static struct {
    struct gpiod_chip *chip;
    struct gpiod_line_bulk in, out;
    unsigned ins, outs; /* requested */
} held;

/* Finds the line that another program uses. The kernel reports only that there is one. */
static int busy(struct gpiod_line_bulk *bulk, struct gpio_problem *p)
{
    for (unsigned i = 0; i < bulk->num_lines; i++) {
        if (gpiod_line_update(bulk->lines[i]) == 0 && gpiod_line_is_used(bulk->lines[i])) {
            gpio_lines_busy(
                p, gpiod_line_offset(bulk->lines[i]), gpiod_line_consumer(bulk->lines[i]));
            return 1;
        }
    }
    return 0;
}

static int find(
    const unsigned *line, unsigned n, struct gpiod_line_bulk *bulk, struct gpio_problem *p)
{
    gpiod_line_bulk_init(bulk);
    for (unsigned i = 0; i < n; i++) {
        struct gpiod_line *l = line[i] < p->lines ? gpiod_chip_get_line(held.chip, line[i]) : NULL;
        if (l == NULL) {
            p->why = line[i] < p->lines ? GPIO_REFUSED : GPIO_NO_LINE;
            p->error = errno;
            p->line = line[i];
            return -1;
        }
        gpiod_line_bulk_add(bulk, l);
    }
    return 0;
}

static int request(struct gpiod_line_bulk *bulk, int direction, int flags, struct gpio_problem *p)
{
    static const int low[GPIO_LINES_MAX];
    const struct gpiod_line_request_config c = {GPIO_CONSUMER, direction, flags};
    if (gpiod_line_request_bulk(bulk, &c, low) == 0) { return 0; }
    p->error = errno;
    if (p->error != EBUSY || !busy(bulk, p)) { p->why = GPIO_REFUSED; }
    return -1;
}

/* Kernels before 5.5 know no bias, and refuse any request that has one. */
static int request_in(struct gpio_problem *p)
{
    struct gpiod_line_bulk *bulk = &held.in;
    if (request(bulk, GPIOD_LINE_REQUEST_DIRECTION_INPUT, GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN,
            p) == 0) {
        return 0;
    }
    return p->error == EINVAL ? request(bulk, GPIOD_LINE_REQUEST_DIRECTION_INPUT, 0, p) : -1;
}

int gpio_chip_open(const char *path)
{
    memset(&held, 0, sizeof held);
    held.chip = gpiod_chip_open(path);
    return held.chip ? 0 : -1;
}

int gpio_chip_request(
    const unsigned *in, unsigned ins, const unsigned *out, unsigned outs, struct gpio_problem *p)
{
    p->lines = gpiod_chip_num_lines(held.chip);
    if (find(in, ins, &held.in, p) < 0 || find(out, outs, &held.out, p) < 0) { return -1; }
    if (ins && request_in(p) < 0) { return -1; }
    held.ins = ins;
    if (outs && request(&held.out, GPIOD_LINE_REQUEST_DIRECTION_OUTPUT, 0, p) < 0) { return -1; }
    held.outs = outs;
    return 0;
}

void gpio_lines_close(void)
{
    if (held.ins) { gpiod_line_release_bulk(&held.in); }
    if (held.outs) { gpiod_line_release_bulk(&held.out); }
    if (held.chip) { gpiod_chip_close(held.chip); }
    memset(&held, 0, sizeof held);
}

int gpio_lines_get(int *level) { return held.ins ? gpiod_line_get_value_bulk(&held.in, level) : 0; }

int gpio_lines_put(const int *level)
{
    return held.outs ? gpiod_line_set_value_bulk(&held.out, level) : 0;
}
