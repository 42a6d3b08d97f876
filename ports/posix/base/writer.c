/* SPDX-License-Identifier: MIT */
#include "base/writer.h"

#include "base/thread.h"

#include <errno.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define PIECE_B     65536u /* at most in one write, so that room is free soon */
#define LOOK_NS     100000000L
#define LOOKS_PER_S 10

/* What can be written in one piece from the ring's head on, up to a cut; the lock is held. */
static size_t piece(const struct writer *w)
{
    const uint64_t whole = w->cuts ? w->cut_B - w->written_B : w->held;
    const size_t straight = w->cap_B - w->head;
    const size_t n = whole < straight ? (size_t)whole : straight;
    return n < PIECE_B ? n : PIECE_B;
}

/* The lock is held, but for the hook. */
static void cut(struct writer *w)
{
    int error;
    pthread_mutex_unlock(&w->lock);
    error = w->hooks.cut(w->fd);
    pthread_mutex_lock(&w->lock);
    w->error = error;
    w->cuts = 0;
}

/* errno of it, without the lock. */
static int open_path(struct writer *w)
{
    const int err = w->path ? outpart_open(&w->part, w->path) : 0;
    if (w->path) { w->fd = w->part.fd; }
    return err;
}

static int close_path(struct writer *w, int error)
{
    if (w->path == NULL) { return error; }
    if (error == 0) { error = outpart_commit(&w->part); }
    outpart_abandon(&w->part);
    return error;
}

static void *write_on(void *ctx)
{
    struct writer *w = ctx;
    int error = open_path(w);
    pthread_mutex_lock(&w->lock);
    w->error = error;
    while (w->error == 0 && (w->held || w->cuts || !w->ends)) {
        const size_t n = piece(w);
        ssize_t done;
        if (n == 0 && w->cuts) {
            cut(w);
            continue;
        }
        if (n == 0) {
            pthread_cond_wait(&w->moved, &w->lock);
            continue;
        }
        pthread_mutex_unlock(&w->lock);
        do {
            done = write(w->fd, w->ring + w->head, n);
        } while (done < 0 && errno == EINTR);
        error = done < 0 ? errno : 0;
        if (w->hooks.wrote && done > 0) { w->hooks.wrote(w->written_B + (uint64_t)done); }
        pthread_mutex_lock(&w->lock);
        w->error = error;
        if (done > 0) {
            w->written_B += (uint64_t)done;
            w->head = (w->head + (size_t)done) % w->cap_B;
            w->held -= (size_t)done;
        }
        pthread_cond_broadcast(&w->moved);
    }
    pthread_mutex_unlock(&w->lock);
    error = close_path(w, error);
    pthread_mutex_lock(&w->lock);
    w->error = error;
    w->over = 1;
    pthread_cond_broadcast(&w->moved);
    pthread_mutex_unlock(&w->lock);
    return NULL;
}

static int start(struct writer *w, int fd, const char *path, void *ring, size_t cap_B)
{
    pthread_t thread;
    int err;
    memset(w, 0, sizeof *w);
    w->fd = fd;
    w->path = path;
    w->ring = ring;
    w->cap_B = cap_B;
    pthread_mutex_init(&w->lock, NULL);
    pthread_cond_init(&w->moved, NULL);
    err = thread_start(&thread, write_on, w); /* a pipe without a reader is an error and no end */
    if (err == 0) { (void)pthread_detach(thread); }
    return err;
}

int writer_start(struct writer *w, int fd, void *ring, size_t cap_B)
{
    return start(w, fd, NULL, ring, cap_B);
}

int writer_start_file(struct writer *w, const char *path, void *ring, size_t cap_B)
{
    return start(w, -1, path, ring, cap_B);
}

/* A tenth of a second, or until something moves; the lock is held. */
static void look(struct writer *w)
{
    struct timespec until;
    (void)clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += LOOK_NS;
    if (until.tv_nsec >= 1000000000L) {
        until.tv_nsec -= 1000000000L;
        until.tv_sec++;
    }
    (void)pthread_cond_timedwait(&w->moved, &w->lock, &until);
}

/* Until there is room, or the thread has ended, or nothing moved for so long; the lock is held. */
static void wait_for(struct writer *w, size_t room_B, double patience_s)
{
    unsigned looks = 0;
    size_t held = w->held;
    while (!w->over && room_B > w->cap_B - w->held && looks < LOOKS_PER_S * patience_s) {
        look(w);
        looks = w->held == held ? looks + 1 : 0;
        held = w->held;
    }
}

int writer_put(struct writer *w, const void *bytes, size_t n, double patience_s)
{
    size_t at, straight;
    int error, takes;
    pthread_mutex_lock(&w->lock);
    wait_for(w, n, patience_s);
    error = w->error;
    takes = error == 0 && n <= w->cap_B - w->held;
    at = (w->head + w->held) % w->cap_B;
    pthread_mutex_unlock(&w->lock);
    if (!takes) { return error ? -1 : 0; }
    straight = w->cap_B - at < n ? w->cap_B - at : n; /* no other thread uses the free part */
    memcpy(w->ring + at, bytes, straight);
    memcpy(w->ring, (const uint8_t *)bytes + straight, n - straight);
    pthread_mutex_lock(&w->lock);
    w->held += n;
    w->put_B += n;
    pthread_cond_broadcast(&w->moved);
    pthread_mutex_unlock(&w->lock);
    return 1;
}

void writer_hook(struct writer *w, const struct writer_hooks *hooks)
{
    pthread_mutex_lock(&w->lock);
    w->hooks = *hooks;
    pthread_mutex_unlock(&w->lock);
}

int writer_takes(struct writer *w, size_t n)
{
    int takes;
    pthread_mutex_lock(&w->lock);
    takes = w->error == 0 && !w->cuts && n <= w->cap_B - w->held;
    pthread_mutex_unlock(&w->lock);
    return takes;
}

void writer_cut(struct writer *w)
{
    pthread_mutex_lock(&w->lock);
    w->cut_B = w->put_B;
    w->cuts = 1;
    pthread_cond_broadcast(&w->moved);
    pthread_mutex_unlock(&w->lock);
}

size_t writer_held(struct writer *w)
{
    size_t held;
    pthread_mutex_lock(&w->lock);
    held = w->held;
    pthread_mutex_unlock(&w->lock);
    return held;
}

int writer_end(struct writer *w, double patience_s)
{
    int err;
    pthread_mutex_lock(&w->lock);
    w->ends = 1;
    pthread_cond_broadcast(&w->moved);
    wait_for(w, SIZE_MAX, patience_s); /* so much room there never is */
    err = w->over ? w->error : -1;
    pthread_mutex_unlock(&w->lock);
    return err;
}
