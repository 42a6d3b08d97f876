/* SPDX-License-Identifier: MIT */
/* What lines mean: contacts that are believed, outputs that go low when in doubt. */
#include "gpio.h"

#include "gpio_lines.h"

#include "exhand/error.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE_B       512
#define PUTS         3   /* tries to set the outputs low */
#define GPIO_SIGNALS 128 /* more than there are */

static struct {
    struct gpio_spec spec;
    unsigned ins, outs;
    struct exh_period T;
    uint32_t differ_max; /* ticks that contacts of a channel may disagree */
    struct {
        uint32_t differ;         /* ticks they have, saturating */
        uint32_t longest, times; /* of them, saturating */
        int stuck;               /* for longer: one may not open any more */
    } channel[GPIO_CHANNELS];
    int enable, beat; /* levels */
    uint8_t alive;    /* of the last frame */
    int failed;       /* and said */
} gpio;

/* Handlers of signals read and write these. */
static volatile sig_atomic_t is_open, dropped;

const char *const gpio_channel_name[GPIO_CHANNELS] = {"estop", "deadman"};
static const char *const output_name[GPIO_OUTPUTS] = {"enable", "alive"};
static const uint32_t channel_bit[GPIO_CHANNELS] = {EXH_DIN_ESTOP, EXH_DIN_DEADMAN};

/* --- words --- */

static const char *name_of(unsigned line)
{
    for (unsigned i = 0; i < GPIO_CHANNELS; i++) {
        for (unsigned c = 0; c < gpio.spec.contacts[i]; c++) {
            if (gpio.spec.contact[i][c] == line) { return gpio_channel_name[i]; }
        }
    }
    for (unsigned i = 0; i < GPIO_OUTPUTS; i++) {
        if (gpio.spec.wired[i] && gpio.spec.output[i] == line) { return output_name[i]; }
    }
    return "?";
}

/* "gpiochip0 gpiochip1", as many as fit */
static void list_chips(char *to, size_t size)
{
    DIR *d = opendir("/dev");
    struct dirent *e;
    size_t n = 0;
    to[0] = '\0';
    while (d && (e = readdir(d)) != NULL) {
        const size_t len = strlen(e->d_name);
        if (strncmp(e->d_name, "gpiochip", 8) != 0 || n + len + 2 > size) { continue; }
        n += (size_t)snprintf(to + n, size - n, "%s%s", n ? " " : "", e->d_name);
    }
    if (d) { closedir(d); }
}

static void say_no_chip(char *said, int error)
{
    const char *path = gpio.spec.path;
    char chips[64];
    if (error == ENOENT) {
        list_chips(chips, sizeof chips);
        snprintf(said, GPIO_SAID_B,
            "%s: there is no such chip (%s%s): take one that gpiodetect lists", path,
            chips[0] ? "there are: " : "there is none", chips);
    } else if (error == EACCES || error == EPERM) {
        snprintf(said, GPIO_SAID_B,
            "%s: not allowed (%s): join the group that `ls -l %s` shows, or add a udev rule", path,
            strerror(error), path);
    } else {
        snprintf(said, GPIO_SAID_B, "%s: not a GPIO chip (%s): take one that gpiodetect lists",
            path, strerror(error));
    }
}

static void say_problem(char *said, const struct gpio_problem *p)
{
    const char *path = gpio.spec.path;
    const char *name = name_of(p->line);
    switch (p->why) {
    case GPIO_NO_LIBRARY:
        snprintf(said, GPIO_SAID_B,
            "this program was built without libgpiod: install libgpiod-dev and build it again");
        break;
    case GPIO_NO_CHIP: say_no_chip(said, p->error); break;
    case GPIO_NO_LINE:
        snprintf(said, GPIO_SAID_B, "%s=%u: %s has lines 0..%u: choose one of them", name, p->line,
            path, p->lines - 1);
        break;
    case GPIO_BUSY:
        snprintf(said, GPIO_SAID_B,
            "%s=%u: line %u of %s is held by \"%s\": end that program, or take another line", name,
            p->line, p->line, path, p->who);
        break;
    case GPIO_FINE:
    case GPIO_REFUSED:
    default:
        snprintf(said, GPIO_SAID_B,
            "%s: the kernel does not give these lines (%s): see `gpioinfo` and the kernel's log",
            path, strerror(p->error));
        break;
    }
}

/* --- open, close, and events between them --- */

/* 0, or -1: they may be high still. An expander on a bus may fail once: that is no reason to leave
 * a motor on. */
static int put_low(void)
{
    static const int low[GPIO_LINES_MAX];
    int err = is_open ? -1 : 0;
    for (int i = 0; err != 0 && i < PUTS; i++) { err = gpio_lines_put(low); }
    return err;
}

void gpio_safe(void)
{
    (void)put_low();
    gpio.enable = gpio.beat = 0;
}

static struct sigaction before_us[GPIO_SIGNALS];

/* Low before anything else, and low they stay: a program that was stopped and goes on later must
 * not go on where it was. Then the signal does what it would have done. */
static void on_signal(int sig)
{
    const int before = errno;
    dropped = 1;
    (void)put_low();
    (void)sigaction(sig, &before_us[sig], NULL);
    raise(sig); /* blocked until the handler returns */
    errno = before;
}

/* One of a single use ends the program, too: it comes behind ours. */
static int is_last(const struct sigaction *a)
{
    return a->sa_handler == SIG_DFL ||
           ((a->sa_flags & (int)SA_RESETHAND) && a->sa_handler != on_signal);
}

/* All signals that end or stop a program, unless another handler is installed. SIGKILL and SIGSTOP
 * cannot be handled. */
static void guard_signals(void)
{
    struct sigaction a, was;
    memset(&a, 0, sizeof a);
    a.sa_handler = on_signal;
    a.sa_flags = (int)SA_RESETHAND;
    sigfillset(&a.sa_mask);
    for (int sig = 1; sig <= SIGRTMAX && sig < GPIO_SIGNALS; sig++) {
        if (sig == SIGCHLD || sig == SIGURG || sig == SIGCONT || sig == SIGWINCH) { continue; }
        if (sigaction(sig, NULL, &was) == 0 && is_last(&was)) {
            before_us[sig] = was;
            (void)sigaction(sig, &a, NULL);
        }
    }
}

int gpio_open(const struct gpio_spec *s, char said[GPIO_SAID_B])
{
    static int at_exit;
    unsigned in[GPIO_LINES_MAX], out[GPIO_LINES_MAX];
    struct gpio_problem p;
    gpio_close();
    memset(&gpio, 0, sizeof gpio);
    gpio.spec = *s;
    for (unsigned i = 0; i < GPIO_CHANNELS; i++) {
        for (unsigned c = 0; c < s->contacts[i]; c++) { in[gpio.ins++] = s->contact[i][c]; }
    }
    for (unsigned i = 0; i < GPIO_OUTPUTS; i++) {
        if (s->wired[i]) { out[gpio.outs++] = s->output[i]; }
    }
    if (gpio_lines_open(s->path, in, gpio.ins, out, gpio.outs, &p) < 0) {
        say_problem(said, &p);
        return -1;
    }
    dropped = 0;
    is_open = 1;
    guard_signals();
    if (!at_exit) { at_exit = atexit(gpio_close) == 0; }
    return 0;
}

void gpio_close(void)
{
    if (!is_open) { return; }
    gpio_safe();
    is_open = 0;
    gpio_lines_close();
}

int gpio_has(enum gpio_channel channel) { return is_open && gpio.spec.contacts[channel] != 0; }

/* --- a tick --- */

void gpio_start(struct exh_period T)
{
    if (!is_open) { return; }
    gpio_safe();
    memset(gpio.channel, 0, sizeof gpio.channel);
    gpio.T = T;
    gpio.differ_max = (uint32_t)(GPIO_DIFFER_S * T.den / T.num + 0.5);
    if (gpio.differ_max < 2) { gpio.differ_max = 2; }
    gpio.alive = 0;
    gpio.failed = 0;
}

static void (*take_line)(const char *line);

void gpio_say(void (*say)(const char *line)) { take_line = say; }

static void tell(const char *line)
{
    if (take_line) {
        take_line(line);
    } else {
        fprintf(stderr, "%s\n", line);
    }
}

static int fail(const char *what)
{
    const char *why = strerror(errno);
    char line[LINE_B];
    if (!gpio.failed) {
        snprintf(line, sizeof line, "exhand: %s: %s (%s): %s, the run ends", gpio.spec.path, what,
            why,
            put_low() == 0 ? "outputs go low"
                           : "outputs CAN'T BE SET LOW, switch them off by hand");
        tell(line);
    }
    gpio.failed = 1;
    return -EXH_E_IO;
}

static uint32_t one_more(uint32_t n) { return n < UINT32_MAX ? n + 1 : n; }

static void count_differ(unsigned i)
{
    if (gpio.channel[i].differ == 0) { gpio.channel[i].times = one_more(gpio.channel[i].times); }
    gpio.channel[i].differ = one_more(gpio.channel[i].differ);
    if (gpio.channel[i].differ > gpio.channel[i].longest) {
        gpio.channel[i].longest = gpio.channel[i].differ;
    }
}

uint32_t gpio_differed(void)
{
    uint32_t n = 0;
    for (unsigned i = 0; i < GPIO_CHANNELS; i++) { n += gpio.channel[i].times; }
    return n;
}

double gpio_differed_s(enum gpio_channel channel, uint32_t *times)
{
    *times = gpio.channel[channel].times;
    return gpio.T.den ? (double)gpio.channel[channel].longest * gpio.T.num / gpio.T.den : 0;
}

static void say_stuck(unsigned i, const int *level)
{
    const unsigned *at = gpio.spec.contact[i];
    char line[LINE_B];
    snprintf(line, sizeof line,
        "exhand: %s: its contacts disagree for more than %lu ticks (line %u closed, line %u "
        "open): it is taken for open until both have been: look for a welded contact, a broken "
        "or a shorted wire",
        gpio_channel_name[i], (unsigned long)gpio.differ_max, at[level[0] ? 0 : 1],
        at[level[0] ? 1 : 0]);
    tell(line);
}

/* Contacts at such levels, for one tick more: 1 if the channel is closed. */
static int believe(unsigned i, const int *level)
{
    if (gpio.spec.contacts[i] == 1) { return level[0]; }
    if (level[0] == level[1]) {
        gpio.channel[i].differ = 0;
        if (!level[0]) { gpio.channel[i].stuck = 0; }
        return level[0] && !gpio.channel[i].stuck;
    }
    count_differ(i);
    if (gpio.channel[i].differ > gpio.differ_max && !gpio.channel[i].stuck) {
        gpio.channel[i].stuck = 1;
        say_stuck(i, level);
    }
    return 0;
}

int gpio_read(uint32_t *din)
{
    int once[GPIO_LINES_MAX], again[GPIO_LINES_MAX], both[GPIO_LINES_MAX];
    unsigned at = 0;
    if (!is_open || gpio.ins == 0) { return 0; }
    if (gpio_lines_get(once) < 0 || gpio_lines_get(again) < 0) {
        *din &= ~(uint32_t)(EXH_DIN_ESTOP | EXH_DIN_DEADMAN);
        return fail("the contacts can't be read");
    }
    for (unsigned i = 0; i < gpio.ins; i++) { both[i] = once[i] == 1 && again[i] == 1; }
    for (unsigned i = 0; i < GPIO_CHANNELS; i++) {
        const unsigned n = gpio.spec.contacts[i];
        if (n && (!believe(i, both + at) || dropped)) { *din &= ~channel_bit[i]; }
        at += n;
    }
    return 0;
}

int gpio_write(const struct exh_drive_out *out)
{
    int level[GPIO_LINES_MAX];
    unsigned n = 0;
    if (!is_open || gpio.outs == 0) { return 0; }
    gpio.enable = out->enable != 0;
    if (out->alive != gpio.alive) { gpio.beat = !gpio.beat; }
    gpio.alive = out->alive;
    if (gpio.spec.wired[GPIO_ENABLE]) { level[n++] = gpio.enable; }
    if (gpio.spec.wired[GPIO_ALIVE]) { level[n++] = gpio.beat; }
    if (!dropped && gpio_lines_put(level) < 0) { return fail("the outputs can't be set"); }
    if (dropped) { (void)put_low(); } /* a handler may have come in between */
    return 0;
}
