/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE
#include "sim.h"

#include <linux/gpio.h>

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#define CONFIG "/sys/kernel/config/gpio-sim/box"

static char lines_at[300]; /* the folder of its lines in /sys */
static char chip[64];      /* gpiochip0, and another number after each removal */

double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void wait_s(double s)
{
    const struct timespec t = {(time_t)s, (long)((s - (double)(time_t)s) * 1e9)};
    nanosleep(&t, NULL);
}

int sim_load(const char *module)
{
    const int fd = open(module, O_RDONLY | O_CLOEXEC);
    const long err = syscall(SYS_finit_module, fd, "", 0);
    if (err) { printf("# %s: %s\n", module, strerror(errno)); }
    close(fd);
    return (int)err;
}

const char *sim_chip(void) { return chip; }

static int open_chip(void)
{
    char path[80];
    snprintf(path, sizeof path, "/dev/%s", chip);
    return open(path, O_RDONLY | O_CLOEXEC);
}

static int put(const char *path, const char *text)
{
    const int fd = open(path, O_WRONLY | O_CLOEXEC);
    const ssize_t n = fd < 0 ? -1 : write(fd, text, strlen(text));
    if (fd >= 0) { close(fd); }
    return n == (ssize_t)strlen(text) ? 0 : -1;
}

static int get(const char *path, char *to, size_t size)
{
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    const ssize_t n = fd < 0 ? -1 : read(fd, to, size - 1);
    if (fd >= 0) { close(fd); }
    if (n < 0) { return -1; }
    to[n] = '\0';
    to[strcspn(to, "\n")] = '\0';
    return 0;
}

int sim_make(int lines)
{
    char text[64], dev[64];
    snprintf(text, sizeof text, "%d", lines);
    if (mkdir(CONFIG, 0755) || mkdir(CONFIG "/bank0", 0755) ||
        put(CONFIG "/bank0/num_lines", text) || put(CONFIG "/live", "1") ||
        get(CONFIG "/dev_name", dev, sizeof dev) ||
        get(CONFIG "/bank0/chip_name", chip, sizeof chip)) {
        printf("# no chip: %s\n", strerror(errno));
        return -1;
    }
    snprintf(lines_at, sizeof lines_at, "/sys/devices/platform/%s/%s", dev, chip);
    return 0;
}

void sim_unmake(void)
{
    (void)put(CONFIG "/live", "0");
    (void)rmdir(CONFIG "/bank0");
    (void)rmdir(CONFIG);
}

void sim_pull(int line, int up)
{
    char path[400];
    snprintf(path, sizeof path, "%s/sim_gpio%d/pull", lines_at, line);
    if (put(path, up ? "pull-up" : "pull-down")) { printf("# %s: %s\n", path, strerror(errno)); }
}

int sim_level(int line)
{
    char path[400], text[16];
    snprintf(path, sizeof path, "%s/sim_gpio%d/value", lines_at, line);
    return get(path, text, sizeof text) ? -1 : atoi(text);
}

int sim_held(int line)
{
    struct gpioline_info info;
    const int fd = open_chip();
    int err;
    memset(&info, 0, sizeof info);
    info.line_offset = (unsigned)line;
    err = ioctl(fd, GPIO_GET_LINEINFO_IOCTL, &info);
    close(fd);
    return err == 0 && (info.flags & GPIOLINE_FLAG_KERNEL);
}

int sim_take(int line, const char *as)
{
    struct gpiohandle_request r;
    const int fd = open_chip();
    int err, error;
    memset(&r, 0, sizeof r);
    r.lineoffsets[0] = (unsigned)line;
    r.lines = 1;
    r.flags = GPIOHANDLE_REQUEST_INPUT;
    snprintf(r.consumer_label, sizeof r.consumer_label, "%s", as);
    err = ioctl(fd, GPIO_GET_LINEHANDLE_IOCTL, &r);
    error = errno;
    close(fd);
    errno = error;
    return err < 0 ? -1 : r.fd;
}
