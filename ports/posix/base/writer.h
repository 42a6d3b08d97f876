/* SPDX-License-Identifier: MIT */
/* A file written by a separate thread, so that the caller does not wait for a disk, a pipe or a
 * terminal. */
#ifndef CLI_WRITER_H
#define CLI_WRITER_H

#include "base/outpart.h"

#include <pthread.h>
#include <stddef.h>
#include <stdint.h>

/* Called by the writer's thread, without its lock. */
struct writer_hooks {
    int (*cut)(int fd);            /* what was put before writer_cut() is written: errno, or 0 */
    void (*wrote)(uint64_t all_B); /* so much since it began */
};

struct writer {
    int fd;
    const char *path; /* the thread opens and closes it; NULL: fd is the caller's */
    struct outpart part;
    uint8_t *ring; /* cap_B of it, the caller's, as is the writer: for ever */
    size_t cap_B;
    size_t head, held;                /* where the thread reads, and how much of it is its */
    uint64_t put_B, written_B, cut_B; /* in all; where the cut is */
    int cuts;                         /* number of cuts requested */
    struct writer_hooks hooks;
    int error;      /* errno of what ended it: nothing is taken any more */
    int ends, over; /* asked to, has */
    pthread_mutex_t lock;
    pthread_cond_t moved;
};

/* 0, or the errno of a thread that could not be made. */
int writer_start(struct writer *w, int fd, void *ring, size_t cap_B);
/* The same, to a file of this name. The file is complete when writer_end() has returned 0;
 * otherwise it is not there (outpart.h). The thread opens it, too, because that may take long.
 * writer_end() reports a failure. */
int writer_start_file(struct writer *w, const char *path, void *ring, size_t cap_B);

/* For one calling thread. Returns 1: all bytes will be written in order, unless the file fails. 0:
 * no byte, because there was no room for patience_s. -1: the file failed. */
int writer_put(struct writer *w, const void *bytes, size_t n, double patience_s);

/* To be given before anything is put. */
void writer_hook(struct writer *w, const struct writer_hooks *hooks);
/* Room for so much, and no cut under way. */
int writer_takes(struct writer *w, size_t n);
/* Behind all that was put: the hook. One at a time. */
void writer_cut(struct writer *w);

/* Bytes that were put and are not written yet. */
size_t writer_held(struct writer *w);

/* Until all is written, the file fails, or nothing moves for so long. 0; errno of the file; or
 * -1: it does not move, and the thread keeps what it has; no patience: not yet. */
int writer_end(struct writer *w, double patience_s);

#endif
