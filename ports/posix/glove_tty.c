/* SPDX-License-Identifier: MIT */
#include "glove_tty.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#define COMMANDS 5
#define STATUS   3 /* behind the command that asks for it */
#define ANSWER_S 0.25
#define QUIET_S  1.0
#define READ_B   256
#define READS    16 /* a call, at most: a flood holds no tick up */

/* Control-C, or these two letters: sources have one or the other. */
#define STOP "\003^c"

static void set_raw(struct termios *t)
{
    memset(t, 0, sizeof *t);
    t->c_cflag = CS8 | CREAD | CLOCAL;
    t->c_cc[VMIN] = 1; /* so that nothing there is not the end */
    (void)cfsetispeed(t, B115200);
    (void)cfsetospeed(t, B115200);
}

static int try_open(struct glove_tty *t)
{
    struct termios raw;
    const int fd = open(t->path, O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (fd < 0) { return -1; }
    set_raw(&raw);
    if (tcsetattr(fd, TCSANOW, &raw) < 0) {
        const int err = errno;
        close(fd);
        errno = err == EINVAL ? ENOTTY : err;
        return -1;
    }
    (void)ioctl(fd, TIOCEXCL); /* two that read it would each have parts of frames */
    (void)tcflush(fd, TCIOFLUSH);
    t->fd = fd;
    t->step = 0;
    t->in.told = 0;
    return 0;
}

int glove_tty_open(struct glove_tty *t, const char *path, double rate_Hz)
{
    memset(t, 0, sizeof *t);
    t->path = path;
    t->rate_Hz = 115200.0 / (double)(long)(115200.0 / rate_Hz + 0.5);
    t->said_s = -ANSWER_S;
    t->fd = -1;
    return try_open(t);
}

/* A command that cannot be sent now is repeated later. */
static void say(struct glove_tty *t, const char *text)
{
    const ssize_t n = write(t->fd, text, strlen(text));
    (void)n;
}

static void tell(struct glove_tty *t, double now_s)
{
    char period[32];
    const char *const command[COMMANDS] = {STOP, "f 0\r", "u 1\r", period, "S"};
    const uint32_t answers = t->in.replies + t->in.errors;
    if (t->step == COMMANDS) { return; }
    if (answers == t->answers && now_s - t->said_s < ANSWER_S) { return; }
    if (t->step == STATUS && answers != t->answers) { t->in.told = t->in.answer == 'u'; }
    (void)snprintf(period, sizeof period, "t %ld 1\r", (long)(115200.0 / t->rate_Hz + 0.5));
    say(t, command[t->step++]);
    t->answers = answers;
    t->said_s = t->frame_s = now_s;
    t->told += t->step == COMMANDS;
}

/* 1: it is there. */
static int there(struct glove_tty *t, double now_s)
{
    if (t->fd >= 0) { return 1; }
    if (now_s - t->tried_s < QUIET_S) { return 0; }
    t->tried_s = now_s;
    return try_open(t) == 0;
}

static void lose(struct glove_tty *t, double now_s)
{
    close(t->fd);
    t->fd = -1;
    t->gone++;
    t->tried_s = now_s;
}

static int take(struct glove_tty *t, const uint8_t *byte, ssize_t n)
{
    int came = 0;
    t->bytes += (uint32_t)n;
    for (ssize_t i = 0; i < n; i++) { came |= cyberglove_take(&t->in, byte[i]); }
    return came;
}

int glove_tty_poll(struct glove_tty *t, double now_s)
{
    uint8_t byte[READ_B];
    int came = 0;
    if (!there(t, now_s)) { return 0; }
    for (int k = 0; k < READS; k++) {
        const ssize_t n = read(t->fd, byte, sizeof byte);
        if (n > 0) {
            came |= take(t, byte, n);
        } else if (n < 0 && (errno == EAGAIN || errno == EINTR)) {
            break;
        } else {
            lose(t, now_s);
            return came;
        }
    }
    if (came) { t->frame_s = now_s; }
    if (t->step == COMMANDS && now_s - t->frame_s >= QUIET_S) { t->step = 0; }
    tell(t, now_s);
    return came;
}

void glove_tty_close(struct glove_tty *t)
{
    if (t->fd < 0) { return; }
    say(t, STOP);
    (void)ioctl(t->fd, TIOCNXCL);
    close(t->fd);
    t->fd = -1;
}
