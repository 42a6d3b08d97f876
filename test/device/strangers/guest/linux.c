/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE 1 /* syscall, usleep: also with -std=c99 */
#include "linux.h"

#include "pin.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#define MINORS 4

static int fd[MINORS] = {-1, -1, -1, -1};

void fail(const char *what, int error)
{
    printf("FAILED: %s: %s\n", what, strerror(-error));
    fflush(stdout);
    usleep(300000);
    outl(1, EXIT_PORT);
    for (;;) { pause(); }
}

int load(const char *path, const char *options)
{
    const int f = open(path, O_RDONLY | O_CLOEXEC);
    int result;
    if (f < 0) { return -errno; }
    result = syscall(SYS_finit_module, f, options, 0) ? -errno : 0;
    close(f);
    return result;
}

int unload(const char *name) { return syscall(SYS_delete_module, name, O_NONBLOCK) ? -errno : 0; }

static int device(unsigned minor)
{
    char path[32];
    if (fd[minor] < 0) {
        snprintf(path, sizeof path, "/dev/comedi%u", minor);
        fd[minor] = open(path, O_RDWR | O_CLOEXEC);
    }
    return fd[minor] < 0 ? -errno : fd[minor];
}

int attach(unsigned minor, const char *board, int base, int irq)
{
    struct comedi_devconfig c;
    const int f = device(minor);
    memset(&c, 0, sizeof c);
    snprintf(c.board_name, sizeof c.board_name, "%s", board);
    c.options[0] = base;
    c.options[1] = irq;
    if (f < 0) { return f; }
    return ioctl(f, COMEDI_DEVCONFIG, &c) < 0 ? -errno : 0;
}

/* Its device is closed too: an open one would hold the driver's module. */
int detach(unsigned minor)
{
    const int f = device(minor);
    const int result = f < 0 ? f : ioctl(f, COMEDI_DEVCONFIG, NULL) < 0 ? -errno : 0;
    if (f >= 0) { close(f); }
    fd[minor] = -1;
    return result;
}

int insn(unsigned minor, unsigned subdev, unsigned chan, unsigned range, unsigned kind, unsigned n,
    unsigned *data)
{
    struct comedi_insn i;
    const int f = device(minor);
    int result;
    memset(&i, 0, sizeof i);
    i.insn = kind;
    i.n = n;
    i.data = data;
    i.subdev = subdev;
    i.chanspec = CR_PACK(chan, range, AREF_GROUND);
    if (f < 0) { return f; }
    result = ioctl(f, COMEDI_INSN, &i);
    return result < 0 ? -errno : result;
}

int command(unsigned minor, struct comedi_cmd *c, uint16_t *sample, unsigned want)
{
    const int f = device(minor);
    struct pollfd p = {f, POLLIN, 0};
    size_t got_B = 0, want_B = want * sizeof *sample;
    if (f < 0) { return f; }
    if (ioctl(f, COMEDI_CMD, c) < 0) { return -errno; }
    while (got_B < want_B && poll(&p, 1, 5000) == 1) {
        const ssize_t n = read(f, (char *)sample + got_B, want_B - got_B);
        if (n <= 0) { break; }
        got_B += (size_t)n;
    }
    (void)ioctl(f, COMEDI_CANCEL, c->subdev);
    return (int)(got_B / sizeof *sample);
}

uint32_t get(unsigned minor, unsigned subdev, unsigned chan, unsigned range)
{
    unsigned v = 0;
    const int result = insn(minor, subdev, chan, range, INSN_READ, 1, &v);
    if (result != 1) { fail("a read", result); }
    return v;
}

void put(unsigned minor, unsigned subdev, unsigned chan, uint32_t value)
{
    unsigned v = value;
    const int result = insn(minor, subdev, chan, 0, INSN_WRITE, 1, &v);
    if (result != 1) { fail("a write", result); }
}

uint32_t lines(unsigned minor, unsigned subdev, uint32_t mask, uint32_t bits)
{
    unsigned v[2];
    int result;
    v[0] = mask;
    v[1] = bits;
    result = insn(minor, subdev, 0, 0, INSN_BITS, 2, v);
    if (result != 2) { fail("digital lines", result); }
    return v[1];
}

void config(
    unsigned minor, unsigned subdev, unsigned chan, unsigned n, unsigned a, unsigned b, unsigned c)
{
    unsigned v[3];
    int result;
    v[0] = a;
    v[1] = b;
    v[2] = c;
    result = insn(minor, subdev, chan, 0, INSN_CONFIG, n, v);
    if (result < 0) { fail("a configuration", result); }
}
