/* SPDX-License-Identifier: MIT */
#include "base/outpart.h"

#include "base/fifo.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#define SUFFIX    ".part"
#define LINKS_MAX 40
#define TRIES     8

/* --- what is on its way, for who ends the program --- */

static struct {
    volatile sig_atomic_t on; /* set behind the others, cleared before them */
    int taken;                /* by a thread: the lock's */
    pid_t owner;              /* what a parent has open is not its child's to remove */
    char part[OUTPART_B];
} list[OUTPART_MAX];

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

void outpart_remove_all(void)
{
    const int before = errno;
    const pid_t me = getpid();
    for (int i = 0; i < OUTPART_MAX; i++) {
        if (list[i].on && list[i].owner == me) { (void)unlink(list[i].part); }
    }
    errno = before;
}

/* Between creating a file and its entry, and between renaming it and removing the entry, no signal
 * may end this thread. */
static void no_signals(sigset_t *was)
{
    sigset_t all;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, was);
}

static void signals(const sigset_t *was) { (void)pthread_sigmask(SIG_SETMASK, was, NULL); }

/* < 0: none free. A slot of the parent that this child does not have is free. */
static int take_slot(void)
{
    static int at_exit;
    const pid_t me = getpid();
    int slot = -1;
    (void)pthread_mutex_lock(&lock);
    if (!at_exit) { at_exit = atexit(outpart_remove_all) == 0; }
    for (int i = 0; i < OUTPART_MAX && slot < 0; i++) {
        if (!list[i].taken || list[i].owner != me) { slot = i; }
    }
    if (slot >= 0) {
        list[slot].on = 0;
        list[slot].taken = 1;
        list[slot].owner = me;
    }
    (void)pthread_mutex_unlock(&lock);
    return slot;
}

static void give_slot(int slot)
{
    (void)pthread_mutex_lock(&lock);
    list[slot].on = 0;
    list[slot].taken = 0;
    (void)pthread_mutex_unlock(&lock);
}

/* --- names --- */

/* The bytes of a path before its last name, the slash among them. */
static size_t folder_B(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* Where a path leads once its last links are followed, there or not: 0 or an errno. */
static int follow(char to[OUTPART_B], const char *path)
{
    char link[OUTPART_B];
    if (strlen(path) + sizeof SUFFIX > OUTPART_B) { return ENAMETOOLONG; }
    strcpy(to, path);
    for (int i = 0; i < LINKS_MAX; i++) {
        const ssize_t n = readlink(to, link, sizeof link - 1);
        const size_t keep = n > 0 && link[0] != '/' ? folder_B(to) : 0;
        if (n < 0) { return errno == EINVAL || errno == ENOENT ? 0 : errno; }
        link[n] = '\0';
        if (keep + (size_t)n + sizeof SUFFIX > OUTPART_B) { return ENAMETOOLONG; }
        strcpy(to + keep, link);
    }
    return ELOOP;
}

static int same(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

static int folder_stat(const char *path, struct stat *st)
{
    char dir[OUTPART_B];
    const size_t n = folder_B(path);
    memcpy(dir, n ? path : "./", n ? n : 2);
    dir[n ? n : 2] = '\0';
    return stat(dir, st);
}

int outpart_same(const char *a, const char *b)
{
    char to[2][OUTPART_B];
    struct stat sa, sb;
    const int there = stat(a, &sa) == 0;
    if (there != (stat(b, &sb) == 0)) { return 0; }
    if (there) { return same(&sa, &sb) && (S_ISREG(sa.st_mode) || S_ISFIFO(sa.st_mode)); }
    return follow(to[0], a) == 0 && follow(to[1], b) == 0 &&
           strcmp(to[0] + folder_B(to[0]), to[1] + folder_B(to[1])) == 0 &&
           folder_stat(to[0], &sa) == 0 && folder_stat(to[1], &sb) == 0 && same(&sa, &sb);
}

/* --- beside --- */

/* A file system without locks gives none. */
static int lock_file(int fd, int how)
{
    int err;
    do {
        err = flock(fd, how | LOCK_NB) != 0 ? errno : 0;
    } while (err == EINTR);
    return err == EWOULDBLOCK ? EBUSY : 0;
}

static int is_named(int fd, const char *name)
{
    struct stat here, there;
    return fstat(fd, &here) == 0 && lstat(name, &there) == 0 && same(&here, &there);
}

/* Removes a stale file; one of a living writer is locked and stays. 0 or an errno. */
static int clear_away(const char *part)
{
    struct stat st;
    int err = 0;
    const int fd = open(part, O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) { return errno == ENOENT ? 0 : errno; }
    if (fstat(fd, &st) != 0 || !S_ISREG(st.st_mode)) { err = EEXIST; }
    if (err == 0) { err = lock_file(fd, LOCK_EX); }
    if (err == 0 && is_named(fd, part) && unlink(part) != 0) { err = errno; }
    (void)close(fd);
    return err;
}

/* Not one of the standard streams', should they be closed. */
static int open_high(const char *path, int how)
{
    const int fd = fifo_open(path, how | O_CLOEXEC);
    const int high = fd >= 0 && fd <= STDERR_FILENO ? fcntl(fd, F_DUPFD_CLOEXEC, 3) : fd;
    const int why = errno;
    if (fd != high) { (void)close(fd); }
    errno = why;
    return high;
}

/* A new file, locked: its descriptor, or -errno. Another may take ours for one that was left, in
 * the moment before it is locked: then that one writes. */
static int create(const char *part)
{
    for (int i = 0; i < TRIES; i++) {
        const int fd = open_high(part, O_RDWR | O_CREAT | O_EXCL);
        int err = fd < 0 ? errno : lock_file(fd, LOCK_EX);
        if (err == 0 && is_named(fd, part)) { return fd; }
        if (fd >= 0) { (void)close(fd); }
        if (err == EEXIST) { err = clear_away(part); }
        if (err) { return -err; }
    }
    return -EBUSY;
}

/* The file that is there: 0, or an errno; EBUSY: it is whole, and its writer goes on. */
static int may_write(const char *path)
{
    const int fd = open_high(path, O_WRONLY | O_NONBLOCK);
    const int err = fd < 0 ? errno : lock_file(fd, LOCK_SH);
    if (fd >= 0) { (void)close(fd); }
    return err;
}

static int open_beside(struct outpart *p, const struct stat *old)
{
    sigset_t was;
    int err = 0;
    p->slot = take_slot();
    if (p->slot < 0) { return EMFILE; }
    (void)snprintf(
        list[p->slot].part, OUTPART_B, "%.*s" SUFFIX, (int)(OUTPART_B - sizeof SUFFIX), p->path);
    no_signals(&was);
    p->fd = create(list[p->slot].part);
    if (p->fd >= 0) { list[p->slot].on = 1; }
    signals(&was);
    if (p->fd < 0) {
        err = -p->fd;
        give_slot(p->slot);
        p->slot = -1;
    } else if (old) { /* the owner first: that may take bits of the mode away */
        if (fchown(p->fd, old->st_uid, old->st_gid) != 0) { errno = 0; }
        if (fchmod(p->fd, old->st_mode & 07777) != 0) { err = errno; }
    }
    return err;
}

/* --- in place --- */

/* Standard output or error by another name: what else is written there must not be lost. */
static int standard(const struct stat *st)
{
    struct stat own;
    for (int fd = STDOUT_FILENO; fd <= STDERR_FILENO; fd++) {
        if (fstat(fd, &own) == 0 && same(st, &own)) { return fd; }
    }
    return -1;
}

static int open_in_place(struct outpart *p, const char *path, int as)
{
    if (as >= 0) { (void)fflush(as == STDOUT_FILENO ? stdout : stderr); }
    p->fd = as >= 0 ? fcntl(as, F_DUPFD_CLOEXEC, 3) : open_high(path, O_WRONLY | O_NOCTTY);
    return p->fd < 0 ? errno : 0;
}

/* --- the whole --- */

int outpart_open(struct outpart *p, const char *path)
{
    struct stat st;
    const int there = stat(path, &st) == 0, why = errno;
    int err, as;
    p->fd = p->slot = -1;
    if (path[0] == '\0' || (!there && why != ENOENT)) { return path[0] ? why : ENOENT; }
    if (there && S_ISDIR(st.st_mode)) { return EISDIR; }
    as = there ? standard(&st) : -1;
    if (there && (!S_ISREG(st.st_mode) || as >= 0)) {
        return open_in_place(p, path, S_ISREG(st.st_mode) ? as : -1);
    }
    err = follow(p->path, path);
    if (err == 0 && there) { err = may_write(path); }
    if (err == 0) { err = open_beside(p, there ? &st : NULL); }
    if (err) { outpart_abandon(p); }
    return err;
}

/* The name is on disk when its folder is. Not everywhere can one be synchronised. */
static void sync_folder(const char *path)
{
    char dir[OUTPART_B];
    const size_t n = folder_B(path);
    int fd;
    memcpy(dir, n ? path : "./", n ? n : 2);
    dir[n ? n : 2] = '\0';
    fd = open(dir, O_RDONLY | O_CLOEXEC);
    if (fd < 0) { return; }
    (void)fsync(fd);
    (void)close(fd);
}

/* err: what went wrong before: then nothing of it is left. */
static int take_name(struct outpart *p, int err)
{
    sigset_t was;
    no_signals(&was);
    if (!err && rename(list[p->slot].part, p->path) != 0) { err = errno; }
    if (err) { (void)unlink(list[p->slot].part); }
    give_slot(p->slot);
    p->slot = -1;
    signals(&was);
    return err;
}

int outpart_name(struct outpart *p) { return p->slot < 0 ? 0 : take_name(p, 0); }

int outpart_commit(struct outpart *p)
{
    int err;
    if (p->slot < 0) { return 0; }
    err = take_name(p, fsync(p->fd) != 0 ? errno : 0);
    if (!err) { sync_folder(p->path); }
    return err;
}

void outpart_abandon(struct outpart *p)
{
    sigset_t was;
    if (p->slot >= 0) {
        no_signals(&was);
        (void)unlink(list[p->slot].part);
        give_slot(p->slot);
        signals(&was);
    }
    if (p->fd >= 0) { (void)close(p->fd); }
    p->fd = p->slot = -1;
}
