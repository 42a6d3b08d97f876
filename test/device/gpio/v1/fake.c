/* SPDX-License-Identifier: MIT */
/* libgpiod 1 over the chip of the tests. */
#include "chip.h"
#include "gpiod.h"

#include <stddef.h>

struct gpiod_chip {
    int any;
};
struct gpiod_line {
    unsigned offset;
};

static struct gpiod_chip the_chip;
static struct gpiod_line the_line[CHIP_LINES];

struct gpiod_chip *gpiod_chip_open(const char *path)
{
    return chip_open(path) == 0 ? &the_chip : NULL;
}

void gpiod_chip_close(struct gpiod_chip *c)
{
    if (c == &the_chip) { chip_close(); }
}

unsigned int gpiod_chip_num_lines(struct gpiod_chip *c) { return c == &the_chip ? CHIP_LINES : 0; }

struct gpiod_line *gpiod_chip_get_line(struct gpiod_chip *c, unsigned int offset)
{
    if (c != &the_chip || offset >= CHIP_LINES) { return NULL; }
    the_line[offset].offset = offset;
    return &the_line[offset];
}

int gpiod_line_update(struct gpiod_line *line) { return line->offset < CHIP_LINES ? 0 : -1; }

bool gpiod_line_is_used(struct gpiod_line *line)
{
    return chip.line[line->offset].holder || chip.line[line->offset].held;
}

const char *gpiod_line_consumer(struct gpiod_line *line) { return chip.line[line->offset].holder; }

unsigned int gpiod_line_offset(struct gpiod_line *line) { return line->offset; }

void gpiod_line_bulk_init(struct gpiod_line_bulk *bulk) { bulk->num_lines = 0; }

void gpiod_line_bulk_add(struct gpiod_line_bulk *bulk, struct gpiod_line *line)
{
    bulk->lines[bulk->num_lines++] = line;
}

static unsigned offsets(const struct gpiod_line_bulk *bulk, unsigned line[GPIO_LINES_MAX])
{
    for (unsigned i = 0; i < bulk->num_lines; i++) { line[i] = bulk->lines[i]->offset; }
    return bulk->num_lines;
}

int gpiod_line_request_bulk(struct gpiod_line_bulk *bulk, const struct gpiod_line_request_config *c,
    const int *default_vals)
{
    unsigned line[GPIO_LINES_MAX];
    const unsigned n = offsets(bulk, line);
    return chip_request(line, n, c->request_type == GPIOD_LINE_REQUEST_DIRECTION_OUTPUT,
        c->flags == GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN, default_vals[0] == 0, c->consumer);
}

void gpiod_line_release_bulk(struct gpiod_line_bulk *bulk)
{
    unsigned line[GPIO_LINES_MAX];
    const unsigned n = offsets(bulk, line);
    chip_release(line, n);
}

int gpiod_line_get_value_bulk(struct gpiod_line_bulk *bulk, int *values)
{
    unsigned line[GPIO_LINES_MAX];
    const unsigned n = offsets(bulk, line);
    return chip_get(line, n, values);
}

int gpiod_line_set_value_bulk(struct gpiod_line_bulk *bulk, const int *values)
{
    unsigned line[GPIO_LINES_MAX];
    const unsigned n = offsets(bulk, line);
    return chip_put(line, n, values);
}
