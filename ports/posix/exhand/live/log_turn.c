/* SPDX-License-Identifier: MIT */
/* exhand run --log-size: a log of many files, each a whole log, the newest that is whole under the
 * name given; and what room the disk has. All but the options is the writer's thread's. */
#include "live/log_turn.h"

#include "base/option.h"
#include "base/outfile.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#define PATH_B  4096
#define LOW_B   (UINT64_C(256) << 20)
#define EVERY_B (UINT64_C(16) << 20) /* is looked at the disk */

static struct {
    const char *path;
    int64_t keep;
    uint64_t look_B;
    int told;
} turn;

int log_turn_take_size(void *ctx, const char *text)
{
    static const char unit[] = "kMG";
    uint64_t n = 0, *const to = ctx;
    const char *p = text;
    unsigned shift = 0;
    for (; *p >= '0' && *p <= '9' && n < LOG_TURN_MOST_B; p++) {
        n = 10 * n + (uint64_t)(*p - '0');
    }
    if (p > text && *p != '\0' && strchr(unit, *p)) {
        shift = 10 * (unsigned)(strchr(unit, *p++) - unit + 1);
    }
    if (p == text || *p != '\0' || n > LOG_TURN_MOST_B >> shift || n << shift < LOG_TURN_LEAST_B) {
        cli_complain("--log-size: %s: give BYTES, 64k to 1024G: k, M or G behind them is 1024, "
                     "1024^2 or 1024^3 of them",
            text);
        return 2;
    }
    *to = n << shift;
    return 0;
}

/* PATH.k; 0 is the path itself. */
static const char *name(char to[PATH_B], int64_t k)
{
    int n = snprintf(to, PATH_B, "%s", turn.path);
    if (k > 0 && n > 0 && n < PATH_B) {
        (void)snprintf(to + n, (size_t)(PATH_B - n), ".%" PRId64, k);
    }
    return to;
}

/* How many old ones there are, PATH.1 the newest. */
static int64_t old(void)
{
    char path[PATH_B];
    struct stat st;
    int64_t n = 0;
    while (lstat(name(path, n + 1), &st) == 0) { n++; }
    return n;
}

/* Each gets the next number; those that are too many go. errno, or 0. */
int log_turn_shift(void)
{
    char from[PATH_B], to[PATH_B];
    struct stat st;
    int64_t n = old();
    if (lstat(turn.path, &st) != 0 && errno == ENOENT) { return 0; } /* none has the name yet */
    for (; turn.keep >= 0 && n > 0 && n >= turn.keep; n--) {
        if (unlink(name(from, n)) != 0) { return errno; }
    }
    if (turn.keep == 0) { return unlink(name(from, 0)) != 0 ? errno : 0; }
    for (; n >= 0; n--) {
        if (rename(name(from, n), name(to, n + 1)) != 0) { return errno; }
    }
    return 0;
}

int log_turn_open(const char *path, int turns, int64_t keep)
{
    struct stat st;
    int err = 0;
    turn.path = path;
    turn.keep = keep;
    turn.look_B = 0;
    turn.told = 0;
    if (!turns) { return 0; }
    if (strlen(path) + 24 > PATH_B) { err = ENAMETOOLONG; }
    if (err == 0 && stat(path, &st) == 0) {
        if (!S_ISREG(st.st_mode)) {
            cli_complain("--log-size: --log %s is no regular file: leave out --log-size", path);
            return 2;
        }
    }
    if (err) { cli_complain("--log: %s: %s: give a shorter path", path, strerror(err)); }
    return err ? 2 : 0;
}

int log_turn(int fd) { return outfile_turn(fd, log_turn_shift); }

static uint64_t free_B(const char *path)
{
    struct statvfs v;
    return statvfs(path, &v) == 0 ? (uint64_t)v.f_bavail * v.f_frsize : UINT64_MAX;
}

uint64_t (*log_turn_free_B)(const char *path) = free_B;

void log_turn_look(uint64_t all_B)
{
    uint64_t left;
    if (turn.told || all_B < turn.look_B) { return; }
    turn.look_B = all_B + EVERY_B;
    left = log_turn_free_B(turn.path);
    if (left >= LOW_B) { return; }
    turn.told = 1;
    cli_complain("--log: %s: its disk has %" PRIu64 " MiB left: make room, or give --log-size and "
                 "--log-keep",
        turn.path, left >> 20);
}
