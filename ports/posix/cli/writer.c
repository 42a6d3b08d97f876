#include "writer.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define PIECE_B     65536u /* at most at once, so that room comes back soon           */
#define LOOK_NS     100000000L
#define LOOKS_PER_S 10

/* What can be written in one piece from the ring's head on; the lock is held. */
static size_t piece(const struct writer *w)
{
    const size_t straight = w->cap_B - w->head, n = w->held < straight ? w->held : straight;
    return n < PIECE_B ? n : PIECE_B;
}

static void *write_on(void *ctx)
{
    struct writer *w = ctx;
    pthread_mutex_lock(&w->lock);
    while (w->error == 0 && (w->held || !w->ends)) {
        const size_t n = piece(w);
        ssize_t done;
        int error;
        if (n == 0) {
            pthread_cond_wait(&w->moved, &w->lock);
            continue;
        }
        pthread_mutex_unlock(&w->lock);
        do {
            done = write(w->fd, w->ring + w->head, n);
        } while (done < 0 && errno == EINTR);
        error = done < 0 ? errno : 0;
        pthread_mutex_lock(&w->lock);
        w->error = error;
        if (done > 0) {
            w->head = (w->head + (size_t)done) % w->cap_B;
            w->held -= (size_t)done;
        }
        pthread_cond_broadcast(&w->moved);
    }
    w->over = 1;
    pthread_cond_broadcast(&w->moved);
    pthread_mutex_unlock(&w->lock);
    return NULL;
}

int writer_start(struct writer *w, int fd, void *ring, size_t cap_B)
{
    sigset_t all, was;
    pthread_t thread;
    int err;
    memset(w, 0, sizeof *w);
    w->fd = fd;
    w->ring = ring;
    w->cap_B = cap_B;
    pthread_mutex_init(&w->lock, NULL);
    pthread_cond_init(&w->moved, NULL);
    sigfillset(&all); /* signals are the loop's; a pipe without a reader is an error and no end */
    pthread_sigmask(SIG_SETMASK, &all, &was);
    err = pthread_create(&thread, NULL, write_on, w);
    pthread_sigmask(SIG_SETMASK, &was, NULL);
    if (err == 0) { (void)pthread_detach(thread); }
    return err;
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
    straight = w->cap_B - at < n ? w->cap_B - at : n; /* nobody else touches what is not held */
    memcpy(w->ring + at, bytes, straight);
    memcpy(w->ring, (const uint8_t *)bytes + straight, n - straight);
    pthread_mutex_lock(&w->lock);
    w->held += n;
    pthread_cond_broadcast(&w->moved);
    pthread_mutex_unlock(&w->lock);
    return 1;
}

int writer_end(struct writer *w, double patience_s)
{
    int err;
    pthread_mutex_lock(&w->lock);
    w->ends = 1;
    pthread_cond_broadcast(&w->moved);
    wait_for(w, SIZE_MAX, patience_s); /* so much room there never is */
    err = w->error ? w->error : w->over ? 0 : -1;
    pthread_mutex_unlock(&w->lock);
    return err;
}
