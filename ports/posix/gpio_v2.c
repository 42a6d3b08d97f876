/* SPDX-License-Identifier: MIT */
/* Lines by libgpiod 2 (Debian 13): a request for each direction, one ioctl() for all of it. */
#include "gpio_lines.h"

#include <gpiod.h>

#include <errno.h>
#include <string.h>

const char gpio_lines_library[] = "libgpiod 2";

static struct {
    struct gpiod_chip *chip;
    struct gpiod_line_request *in, *out; /* NULL: none */
    unsigned ins, outs;
} held;

/* Finds the line that another program uses. The kernel reports only that there is one. */
static int busy(const unsigned *line, unsigned n, struct gpio_problem *p)
{
    for (unsigned i = 0; i < n && p->why != GPIO_BUSY; i++) {
        struct gpiod_line_info *info = gpiod_chip_get_line_info(held.chip, line[i]);
        if (info && gpiod_line_info_is_used(info)) {
            gpio_lines_busy(p, line[i], gpiod_line_info_get_consumer(info));
        }
        if (info) { gpiod_line_info_free(info); }
    }
    return p->why == GPIO_BUSY;
}

static int count(struct gpio_problem *p)
{
    struct gpiod_chip_info *info = gpiod_chip_get_info(held.chip);
    if (info == NULL) { return -1; }
    p->lines = (unsigned)gpiod_chip_info_get_num_lines(info);
    gpiod_chip_info_free(info);
    return 0;
}

static int exist(const unsigned *line, unsigned n, struct gpio_problem *p)
{
    for (unsigned i = 0; i < n; i++) {
        if (line[i] >= p->lines) {
            p->why = GPIO_NO_LINE;
            p->line = line[i];
            return 0;
        }
    }
    return 1;
}

/* The three libgpiod objects of a request for lines, or NULL. */
struct asked {
    struct gpiod_line_settings *settings;
    struct gpiod_line_config *lines;
    struct gpiod_request_config *name;
};

static int ask(struct asked *a, const unsigned *line, unsigned n, int output)
{
    a->settings = gpiod_line_settings_new();
    a->lines = gpiod_line_config_new();
    a->name = gpiod_request_config_new();
    if (!a->settings || !a->lines || !a->name) { return -1; }
    gpiod_request_config_set_consumer(a->name, GPIO_CONSUMER);
    if (output) {
        if (gpiod_line_settings_set_direction(a->settings, GPIOD_LINE_DIRECTION_OUTPUT) < 0 ||
            gpiod_line_settings_set_output_value(a->settings, GPIOD_LINE_VALUE_INACTIVE) < 0) {
            return -1;
        }
    } else if (gpiod_line_settings_set_direction(a->settings, GPIOD_LINE_DIRECTION_INPUT) < 0 ||
               gpiod_line_settings_set_bias(a->settings, GPIOD_LINE_BIAS_PULL_DOWN) < 0) {
        return -1;
    }
    return gpiod_line_config_add_line_settings(a->lines, line, n, a->settings);
}

static struct gpiod_line_request *request(
    const unsigned *line, unsigned n, int output, struct gpio_problem *p)
{
    struct gpiod_line_request *r = NULL;
    struct asked a = {NULL, NULL, NULL};
    errno = 0;
    if (ask(&a, line, n, output) == 0) { r = gpiod_chip_request_lines(held.chip, a.name, a.lines); }
    p->error = errno;
    if (a.settings) { gpiod_line_settings_free(a.settings); }
    if (a.lines) { gpiod_line_config_free(a.lines); }
    if (a.name) { gpiod_request_config_free(a.name); }
    if (r == NULL && (p->error != EBUSY || !busy(line, n, p))) { p->why = GPIO_REFUSED; }
    return r;
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
    if (count(p) < 0) {
        p->why = GPIO_NO_CHIP;
        p->error = errno;
        return -1;
    }
    if (!exist(in, ins, p) || !exist(out, outs, p)) { return -1; }
    if (ins && (held.in = request(in, ins, 0, p)) == NULL) { return -1; }
    if (outs && (held.out = request(out, outs, 1, p)) == NULL) { return -1; }
    held.ins = ins;
    held.outs = outs;
    return 0;
}

void gpio_lines_close(void)
{
    if (held.in) { gpiod_line_request_release(held.in); }
    if (held.out) { gpiod_line_request_release(held.out); }
    if (held.chip) { gpiod_chip_close(held.chip); }
    memset(&held, 0, sizeof held);
}

int gpio_lines_get(int *level)
{
    enum gpiod_line_value value[GPIO_LINES_MAX];
    if (!held.in) { return 0; }
    if (gpiod_line_request_get_values(held.in, value) < 0) { return -1; }
    for (unsigned i = 0; i < held.ins; i++) { level[i] = value[i] == GPIOD_LINE_VALUE_ACTIVE; }
    return 0;
}

int gpio_lines_put(const int *level)
{
    enum gpiod_line_value value[GPIO_LINES_MAX];
    if (!held.out) { return 0; }
    for (unsigned i = 0; i < held.outs; i++) {
        value[i] = level[i] ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    }
    return gpiod_line_request_set_values(held.out, value);
}
