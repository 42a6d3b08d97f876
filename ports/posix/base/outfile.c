/* SPDX-License-Identifier: MIT */
#include "base/outfile.h"

#include "base/fifo.h"
#include "base/option.h"
#include "base/outpart.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* --- those that are on their way --- */

static struct entry {
    FILE *f; /* NULL: free */
    struct outpart part;
    const char *option;
    char path[OUTPART_B]; /* as it was given */
} open_now[OUTPART_MAX];

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

/* NULL: finds a free entry. The caller stores its stream there. */
static struct entry *find(FILE *f)
{
    struct entry *e = NULL;
    for (int i = 0; i < OUTPART_MAX && e == NULL; i++) {
        if (open_now[i].f == f) { e = &open_now[i]; }
    }
    return e;
}

static const char *advice(int error)
{
    switch (error) {
    case EBUSY: return "another writer has it now: wait for its end, or give another file";
    case ENAMETOOLONG: return "give a shorter path";
    default: return "give a file that can be written";
    }
}

void outfile_refused(const char *option, const char *path, int error)
{
    cli_complain("%s%s%s%s: %s: %s", option ? "--" : "", option ? option : "", option ? ": " : "",
        path, strerror(error), advice(error));
}

static void failed(const struct entry *e, int error)
{
    cli_complain("%s%s%s%s: can't be written: %s: make room or give another%s%s",
        e->option ? "--" : "", e->option ? e->option : "", e->option ? ": " : "", e->path,
        strerror(error ? error : EIO), e->option ? " --" : " file", e->option ? e->option : "");
}

int outfile_try(const struct outfile_option *o, size_t n)
{
    struct outpart p;
    struct stat st;
    for (size_t i = 0; i < n; i++) {
        const char *const path = o[i].path;
        int err = 0;
        if (path == NULL) { continue; }
        for (size_t k = 0; k < i; k++) {
            if (o[k].path && outpart_same(o[k].path, path)) {
                cli_complain("--%s: %s: is the file of --%s, too: give each its own", o[i].option,
                    path, o[k].option);
                return 2;
            }
        }
        if (stat(path, &st) == 0 && !S_ISREG(st.st_mode) && !S_ISDIR(st.st_mode)) {
            if (access(path, W_OK) != 0) { err = errno; } /* to open it may take for ever */
        } else {
            err = outpart_open(&p, path);
            if (err == 0) { outpart_abandon(&p); }
        }
        if (err) {
            outfile_refused(o[i].option, path, err);
            return 2;
        }
    }
    return 0;
}

FILE *outfile_open(const char *option, const char *path)
{
    struct entry *e;
    FILE *f = NULL;
    int err = strlen(path) < OUTPART_B ? 0 : ENAMETOOLONG;
    (void)pthread_mutex_lock(&lock);
    e = find(NULL);
    if (err == 0) { err = e ? outpart_open(&e->part, path) : EMFILE; }
    if (err == 0) {
        f = e->f = fdopen(e->part.fd, e->part.slot < 0 ? "w" : "w+");
        e->option = option;
        strcpy(e->path, path);
        if (f == NULL) {
            err = errno;
            outpart_abandon(&e->part);
        }
    }
    (void)pthread_mutex_unlock(&lock);
    if (err) { outfile_refused(option, path, err); }
    return f;
}

/* Removes the entry and returns it. */
static struct entry taken(FILE *f)
{
    struct entry e = {.part = {.fd = -1, .slot = -1}, .path = "?"}, *at;
    (void)pthread_mutex_lock(&lock);
    at = find(f);
    if (at) {
        e = *at;
        at->f = NULL;
    }
    (void)pthread_mutex_unlock(&lock);
    return e;
}

/* Of a stream that an earlier write failed on, errno may be a stranger's by now. */
static int error_of(FILE *f)
{
    static const int known[] = {ENOSPC, EFBIG, EDQUOT, EPIPE};
    const int before = errno;
    int why = EIO;
    if (fflush(f) != 0) { return errno; }
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (before == known[i]) { why = before; }
    }
    return ferror(f) ? why : 0;
}

int outfile_goes_on(FILE *f)
{
    struct entry *e;
    int err = error_of(f);
    (void)pthread_mutex_lock(&lock);
    e = find(f);
    if (e && err) {
        outpart_abandon(&(struct outpart){.fd = -1, .slot = e->part.slot});
        e->part.slot = -1;
    } else if (e) {
        err = outpart_commit(&e->part);
    }
    (void)pthread_mutex_unlock(&lock);
    if (e && err) { failed(e, err); }
    return err != 0;
}

/* The name, and its lock, are the next one's. */
static int go_on(struct entry *e)
{
    struct outpart next;
    int err;
    (void)flock(e->part.fd, LOCK_UN);
    err = outpart_open(&next, e->path);
    if (err == 0 && dup2(next.fd, e->part.fd) < 0) { err = errno; }
    if (err) {
        outpart_abandon(&next);
        return err;
    }
    (void)close(next.fd);
    (void)fcntl(e->part.fd, F_SETFD, FD_CLOEXEC);
    next.fd = e->part.fd;
    e->part = next;
    return 0;
}

int outfile_turn(int fd, int (*make_way)(void))
{
    struct entry *e = NULL;
    int err = EBADF;
    (void)pthread_mutex_lock(&lock);
    for (int i = 0; i < OUTPART_MAX && e == NULL; i++) {
        if (open_now[i].f && open_now[i].part.fd == fd) { e = &open_now[i]; }
    }
    if (e) { err = make_way(); }
    if (err == 0) { err = outpart_name(&e->part); }
    if (err == 0) { err = go_on(e); }
    (void)pthread_mutex_unlock(&lock);
    return err;
}

int outfile_close(FILE *f)
{
    const int bad = outfile_goes_on(f);
    const struct entry e = taken(f);
    if (fclose(f) == 0 || bad) { return bad; }
    failed(&e, errno);
    return 1;
}

void outfile_abandon(FILE *f)
{
    struct entry e;
    if (f == NULL) { return; }
    e = taken(f);
    e.part.fd = -1; /* the stream's to close */
    outpart_abandon(&e.part);
    (void)fclose(f);
}

int outfile_end(FILE *f, int whole)
{
    if (whole) { return outfile_close(f); }
    outfile_abandon(f);
    return 0;
}

/* --- in a directory --- */

static int path_of(char to[OUTPART_B], const char *dir, const char *name)
{
    const int n = snprintf(to, OUTPART_B, "%s/%s", dir, name);
    if (n >= 0 && n < OUTPART_B) { return 0; }
    cli_complain("--out: %s: too long a path: give a shorter one", dir);
    return 1;
}

int outfile_dir(const char *dir, const char *name)
{
    char path[OUTPART_B];
    struct stat st;
    if (path_of(path, dir, name)) { return 2; }
    if (mkdir(dir, 0777) != 0 && errno != EEXIST) {
        cli_complain("--out: %s: %s: give a directory that can be made", dir, strerror(errno));
        return 2;
    }
    if (stat(dir, &st) != 0 || !S_ISDIR(st.st_mode)) {
        cli_complain("--out: %s: %s: give a directory", dir, strerror(ENOTDIR));
        return 2;
    }
    return 0;
}

FILE *outfile_in(const char *dir, const char *name)
{
    char path[OUTPART_B];
    return path_of(path, dir, name) ? NULL : outfile_open("out", path);
}

int outfile_write(
    const char *dir, const char *name, void (*write)(FILE *f, const void *ctx), const void *ctx)
{
    FILE *f = outfile_in(dir, name);
    if (f == NULL) { return 1; }
    errno = 0;
    write(f, ctx);
    return outfile_close(f);
}

void outfile_pictures(FILE *f, const char *command)
{
    fprintf(f,
        "# Made by exhand %s. In this directory: gnuplot -c pictures.gp PLOTS, where\n"
        "# PLOTS is the path of ports/posix/plot.\n"
        "if (!exists('ARG1') || strlen(ARG1) == 0) {\n"
        "    print 'give the path of ports/posix/plot: gnuplot -c pictures.gp PLOTS'\n"
        "    exit status 2\n"
        "}\n"
        "plots=ARG1\n",
        command);
}

long outfile_read(
    const char *option, const char *path, const char *expected, void *to, size_t cap_B)
{
    FILE *f = fifo_read(path);
    long len;
    if (f == NULL) {
        cli_complain("--%s: %s: %s: give the %s", option, path, strerror(errno), expected);
        return -3;
    }
    len = (long)fread(to, 1, cap_B, f);
    if (ferror(f)) { /* a directory, as a rule */
        cli_complain(
            "--%s: %s: can't be read: %s: give the %s", option, path, strerror(errno), expected);
        len = -2;
    }
    fclose(f);
    return len;
}
