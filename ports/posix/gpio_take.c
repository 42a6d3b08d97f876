/* SPDX-License-Identifier: MIT */
/* The text after --gpio. */
#include "gpio.h"

#include <stdio.h>
#include <string.h>

#define EXAMPLE "e.g. gpiochip0:estop=4,deadman=5,enable=6,alive=7"

static const char *const field[GPIO_CHANNELS + GPIO_OUTPUTS] = {
    "estop", "deadman", "enable", "alive"};

static int bad(char *said, const char *what, size_t len, const char *why)
{
    snprintf(said, GPIO_SAID_B, "%.*s: %s: " EXAMPLE, (int)(len < 40 ? len : 40), what, why);
    return -1;
}

static int take_chip(struct gpio_spec *s, const char *text, size_t len, char *said)
{
    const char *dir = memchr(text, '/', len) ? "" : "/dev/";
    if (len == 0) {
        return bad(said, text, strlen(text), "which chip? its name and a colon first");
    }
    if (strlen(dir) + len >= GPIO_PATH_B) {
        return bad(said, text, len, "a chip's name is shorter than that");
    }
    snprintf(s->path, sizeof s->path, "%s%.*s", dir, (int)len, text);
    return 0;
}

/* A whole number in all of the text, or -1. */
static int number(const char *text, size_t len)
{
    int v = 0;
    for (size_t i = 0; i < len; i++) {
        if (text[i] < '0' || text[i] > '9') { return -1; }
        v = 10 * v + (text[i] - '0');
        if (v > GPIO_LINE_TOP) { return -1; }
    }
    return len ? v : -1;
}

/* Which field has this line already: its index, or -1. */
static int user(const struct gpio_spec *s, unsigned line)
{
    for (int i = 0; i < GPIO_CHANNELS; i++) {
        for (unsigned c = 0; c < s->contacts[i]; c++) {
            if (s->contact[i][c] == line) { return i; }
        }
    }
    for (int i = 0; i < GPIO_OUTPUTS; i++) {
        if (s->wired[i] && s->output[i] == line) { return GPIO_CHANNELS + i; }
    }
    return -1;
}

/* A line of a field, "4", into its place. */
static int take_line(struct gpio_spec *s, int i, const char *text, size_t len, const char *whole,
    size_t whole_len, char *said)
{
    const int v = number(text, len);
    char why[96];
    if (v < 0) {
        snprintf(why, sizeof why, "a line is a number 0..%d, as gpioinfo prints it", GPIO_LINE_TOP);
        return bad(said, whole, whole_len, why);
    }
    if (user(s, (unsigned)v) >= 0) {
        snprintf(why, sizeof why, "line %d is %s's already: every line once", v,
            field[user(s, (unsigned)v)]);
        return bad(said, whole, whole_len, why);
    }
    if (i < GPIO_CHANNELS) {
        s->contact[i][s->contacts[i]++] = (unsigned)v;
    } else {
        s->wired[i - GPIO_CHANNELS] = 1;
        s->output[i - GPIO_CHANNELS] = (unsigned)v;
    }
    return 0;
}

/* "4", or of a contact "4+8". */
static int take_lines(struct gpio_spec *s, int i, const char *text, size_t len, const char *whole,
    size_t whole_len, char *said)
{
    const char *plus = memchr(text, '+', len);
    const size_t first = plus ? (size_t)(plus - text) : len;
    if (take_line(s, i, text, first, whole, whole_len, said) < 0) { return -1; }
    if (plus == NULL) { return 0; }
    if (i >= GPIO_CHANNELS) {
        return bad(said, whole, whole_len, "one line: only estop and deadman have two contacts");
    }
    if (memchr(plus + 1, '+', len - first - 1)) {
        return bad(said, whole, whole_len, "one contact or two, as in estop=4+8");
    }
    return take_line(s, i, plus + 1, len - first - 1, whole, whole_len, said);
}

/* "estop=4" */
static int take_field(struct gpio_spec *s, const char *text, size_t len, char *said)
{
    const char *is = memchr(text, '=', len);
    const size_t name = is ? (size_t)(is - text) : len;
    for (int i = 0; i < GPIO_CHANNELS + GPIO_OUTPUTS; i++) {
        if (name != strlen(field[i]) || memcmp(text, field[i], name) != 0) { continue; }
        if (is == NULL) { return bad(said, text, len, "which line? = and its number"); }
        if (i < GPIO_CHANNELS ? s->contacts[i] != 0 : s->wired[i - GPIO_CHANNELS]) {
            return bad(said, text, len, "given twice: two contacts are written as estop=4+8");
        }
        return take_lines(s, i, is + 1, len - name - 1, text, len, said);
    }
    return bad(
        said, text, len, len ? "there are estop, deadman, enable and alive" : "an empty field");
}

int gpio_take(struct gpio_spec *s, const char *text, char said[GPIO_SAID_B])
{
    const char *colon = strchr(text, ':');
    const char *at = colon ? colon + 1 : "";
    memset(s, 0, sizeof *s);
    if (take_chip(s, text, colon ? (size_t)(colon - text) : strlen(text), said) < 0) { return -1; }
    if (*at == '\0') {
        return bad(said, text, strlen(text), "no line: a colon and fields behind it");
    }
    for (;;) {
        const size_t len = strcspn(at, ",");
        if (take_field(s, at, len, said) < 0) { return -1; }
        if (at[len] == '\0') { return 0; }
        at += len + 1;
    }
}
