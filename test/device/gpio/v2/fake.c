/* SPDX-License-Identifier: MIT */
/* libgpiod 2 over the chip of the tests. Objects are counted: those not freed are in fake_objects.
 */
#include "chip.h"
#include "gpiod.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct gpiod_chip {
    int any;
};
struct gpiod_chip_info {
    size_t lines;
};
struct gpiod_line_info {
    unsigned offset;
};
struct gpiod_line_settings {
    int output, bias, low;
};
struct gpiod_line_config {
    unsigned line[GPIO_LINES_MAX], n;
    struct gpiod_line_settings settings;
};
struct gpiod_request_config {
    const char *consumer;
};
struct gpiod_line_request {
    unsigned line[GPIO_LINES_MAX], n;
};

extern int fake_objects;
int fake_objects;
static struct gpiod_chip the_chip;

static void *make(size_t size)
{
    void *p = calloc(1, size);
    fake_objects += p != NULL;
    return p;
}

static void unmake(void *p)
{
    fake_objects -= p != NULL;
    free(p);
}

struct gpiod_chip *gpiod_chip_open(const char *path)
{
    return chip_open(path) == 0 ? &the_chip : NULL;
}

void gpiod_chip_close(struct gpiod_chip *c)
{
    if (c == &the_chip) { chip_close(); }
}

struct gpiod_chip_info *gpiod_chip_get_info(struct gpiod_chip *c)
{
    struct gpiod_chip_info *info = make(sizeof *info);
    if (info && c == &the_chip) { info->lines = CHIP_LINES; }
    return info;
}

size_t gpiod_chip_info_get_num_lines(struct gpiod_chip_info *info) { return info->lines; }

void gpiod_chip_info_free(struct gpiod_chip_info *info) { unmake(info); }

struct gpiod_line_info *gpiod_chip_get_line_info(struct gpiod_chip *c, unsigned int offset)
{
    struct gpiod_line_info *info;
    if (c != &the_chip || offset >= CHIP_LINES) {
        errno = EINVAL;
        return NULL;
    }
    info = make(sizeof *info);
    if (info) { info->offset = offset; }
    return info;
}

bool gpiod_line_info_is_used(struct gpiod_line_info *info)
{
    return chip.line[info->offset].holder || chip.line[info->offset].held;
}

const char *gpiod_line_info_get_consumer(struct gpiod_line_info *info)
{
    return chip.line[info->offset].holder;
}

void gpiod_line_info_free(struct gpiod_line_info *info) { unmake(info); }

struct gpiod_line_settings *gpiod_line_settings_new(void)
{
    return make(sizeof(struct gpiod_line_settings));
}

void gpiod_line_settings_free(struct gpiod_line_settings *s) { unmake(s); }

int gpiod_line_settings_set_direction(struct gpiod_line_settings *s, enum gpiod_line_direction d)
{
    s->output = d == GPIOD_LINE_DIRECTION_OUTPUT;
    return 0;
}

int gpiod_line_settings_set_bias(struct gpiod_line_settings *s, enum gpiod_line_bias bias)
{
    s->bias = bias == GPIOD_LINE_BIAS_PULL_DOWN;
    return 0;
}

int gpiod_line_settings_set_output_value(struct gpiod_line_settings *s, enum gpiod_line_value value)
{
    s->low = value == GPIOD_LINE_VALUE_INACTIVE;
    return 0;
}

struct gpiod_line_config *gpiod_line_config_new(void)
{
    return make(sizeof(struct gpiod_line_config));
}

void gpiod_line_config_free(struct gpiod_line_config *c) { unmake(c); }

int gpiod_line_config_add_line_settings(struct gpiod_line_config *c, const unsigned int *offsets,
    size_t n, struct gpiod_line_settings *s)
{
    memcpy(c->line, offsets, n * sizeof *offsets);
    c->n = (unsigned)n;
    c->settings = *s;
    return 0;
}

struct gpiod_request_config *gpiod_request_config_new(void)
{
    return make(sizeof(struct gpiod_request_config));
}

void gpiod_request_config_free(struct gpiod_request_config *c) { unmake(c); }

void gpiod_request_config_set_consumer(struct gpiod_request_config *c, const char *consumer)
{
    c->consumer = consumer;
}

struct gpiod_line_request *gpiod_chip_request_lines(
    struct gpiod_chip *c, struct gpiod_request_config *name, struct gpiod_line_config *lines)
{
    const struct gpiod_line_settings *s = &lines->settings;
    struct gpiod_line_request *r;
    if (c != &the_chip ||
        chip_request(lines->line, lines->n, s->output, s->bias, s->low, name->consumer) < 0) {
        return NULL;
    }
    r = make(sizeof *r);
    if (r) {
        memcpy(r->line, lines->line, sizeof r->line);
        r->n = lines->n;
    }
    return r;
}

void gpiod_line_request_release(struct gpiod_line_request *r)
{
    chip_release(r->line, r->n);
    unmake(r);
}

int gpiod_line_request_get_values(struct gpiod_line_request *r, enum gpiod_line_value *values)
{
    int level[GPIO_LINES_MAX];
    if (chip_get(r->line, r->n, level) < 0) { return -1; }
    for (unsigned i = 0; i < r->n; i++) {
        values[i] = level[i] ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    }
    return 0;
}

int gpiod_line_request_set_values(struct gpiod_line_request *r, const enum gpiod_line_value *values)
{
    int level[GPIO_LINES_MAX];
    for (unsigned i = 0; i < r->n; i++) { level[i] = values[i] == GPIOD_LINE_VALUE_ACTIVE; }
    return chip_put(r->line, r->n, level);
}
