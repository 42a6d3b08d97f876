/* SPDX-License-Identifier: MIT */
#include "base/fifo.h"

#include "base/option.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#define STEP_MS  20
#define QUIET_MS 1000

int fifo_is(const char *path)
{
    struct stat st;
    return stat(path, &st) == 0 && S_ISFIFO(st.st_mode);
}

static void tell(const char *path, const char *does)
{
    cli_complain("%s: waits until another program %s this FIFO; Ctrl-C ends it", path, does);
}

/* A reader that is alone has nothing to read, and no end either. */
static int wait_to_read(const char *path, int how)
{
    struct pollfd f = {open(path, how | O_NONBLOCK), POLLIN, 0};
    int n = f.fd < 0 ? -1 : poll(&f, 1, QUIET_MS);
    if (n == 0) {
        tell(path, "writes to");
        n = poll(&f, 1, -1);
    }
    if (n > 0) { return f.fd; }
    if (f.fd >= 0) {
        (void)close(f.fd);
        errno = EINTR;
    }
    return -1;
}

/* A writer that is alone is refused. */
static int wait_to_write(const char *path, int how)
{
    int fd, waited_ms = 0;
    while ((fd = open(path, how | O_NONBLOCK)) < 0 && errno == ENXIO) {
        if (waited_ms == QUIET_MS) { tell(path, "reads"); }
        waited_ms += STEP_MS;
        if (poll(NULL, 0, STEP_MS) < 0) { return -1; }
    }
    return fd;
}

int fifo_open(const char *path, int how)
{
    int fd;
    if (!fifo_is(path)) { return open(path, how, 0666); }
    fd = (how & O_ACCMODE) == O_RDONLY ? wait_to_read(path, how) : wait_to_write(path, how);
    if (fd >= 0) { (void)fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) & ~O_NONBLOCK); }
    return fd;
}

FILE *fifo_read(const char *path)
{
    const int fd = fifo_open(path, O_RDONLY | O_CLOEXEC);
    return fd < 0 ? NULL : fdopen(fd, "r");
}
