/* SPDX-License-Identifier: MIT */
/* Bytes to a file by a separate thread: a pipe without reads, a slow one, one that ends. */
#include "check.h"

#include "base/writer.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define RING_B 4096u

/* Threads of writers that gave up keep theirs. */
static struct writer writers[8];
static uint8_t rings[8][RING_B];
static unsigned used;
static int end[2];

static struct writer *begin(void)
{
    struct writer *w = &writers[used];
    CHECK_EQ_I64(pipe(end), 0);
    CHECK_EQ_I64(writer_start(w, end[1], rings[used], RING_B), 0);
    used++;
    return w;
}

static double now_s(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static uint32_t rng;

static uint32_t some(uint32_t n)
{
    rng = rng * 1664525u + 1013904223u;
    return (rng >> 8) % n;
}

/* Record k: its length, then bytes that are k's. */
static size_t record(uint8_t *to, uint32_t k)
{
    const size_t n = 3 + some(500);
    to[0] = (uint8_t)(n >> 8);
    to[1] = (uint8_t)n;
    for (size_t i = 2; i < n; i++) { to[i] = (uint8_t)(k * 31 + i); }
    return n;
}

static void take(uint8_t *to, size_t n)
{
    for (size_t at = 0; at < n;) {
        const ssize_t got = read(end[0], to + at, n - at);
        CHECK(got > 0, "the file ends");
        at += (size_t)got;
    }
}

static void check_record(uint32_t k)
{
    uint8_t got[512];
    size_t n;
    take(got, 2);
    n = (size_t)got[0] << 8 | got[1];
    CHECK(n >= 3 && n < sizeof got, "length %lu", (unsigned long)n);
    take(got + 2, n - 2);
    for (size_t i = 2; i < n; i++) { CHECK_EQ_I64(got[i], (uint8_t)(k * 31 + i)); }
}

/* Without a reader, pipe and ring fill. A record without room is refused whole and immediately.
 * Then all accepted records come, in order, and nothing else. */
TEST(a_full_pipe_refuses_and_waits_for_nobody)
{
    static uint32_t taken[4096];
    struct writer *w = begin();
    uint32_t n = 0, lost = 0;
    int read_some = 0;
    double longest_s = 0;
    uint8_t byte[512];
    for (uint32_t k = 0; k < 4096 && lost < 400; k++) {
        const size_t len = record(byte, k);
        const double before_s = now_s();
        int is;
        if (lost == 200 && n > 4 && !read_some) { /* a little room, for some */
            read_some = 1;
            for (int i = 0; i < 4; i++) { check_record(taken[i]); }
            memmove(taken, taken + 4, (n - 4) * sizeof taken[0]);
            n -= 4;
        }
        is = writer_put(w, byte, len, 0);
        if (now_s() - before_s > longest_s) { longest_s = now_s() - before_s; }
        CHECK(is == 0 || is == 1, "%d", is);
        if (is) { taken[n++] = k; }
        lost += is == 0;
    }
    CHECK(lost == 400 && n > 8, "%lu lost, %lu taken", (unsigned long)lost, (unsigned long)n);
    CHECK(
        longest_s < 2, "a put took %d ms", (int)(longest_s * 1000)); /* a machine with other work */
    for (uint32_t i = 0; i < n; i++) { check_record(taken[i]); }
    CHECK_EQ_I64(writer_end(w, 5), 0);
    close(end[1]);
    CHECK_EQ_I64(read(end[0], byte, 1), 0);
    close(end[0]);
}

/* With patience nothing is refused as long as there is a reader. */
TEST(patience_loses_nothing)
{
    struct writer *w = begin();
    uint8_t byte[512];
    const pid_t reader = fork();
    const struct timespec a_while = {0, 300000000};
    if (reader == 0) {
        close(end[1]);
        (void)nanosleep(&a_while, NULL);
        for (uint32_t k = 0; k < 2000; k++) { check_record(k); }
        _exit(read(end[0], byte, 1) == 0 ? 0 : 1);
    }
    for (uint32_t k = 0; k < 2000; k++) {
        const size_t len = record(byte, k);
        CHECK_EQ_I64(writer_put(w, byte, len, 30), 1);
    }
    CHECK_EQ_I64(writer_end(w, 30), 0);
    close(end[1]);
    close(end[0]);
    {
        int status = -1;
        CHECK(waitpid(reader, &status, 0) == reader && status == 0,
            "what was read is not what was put");
    }
}

/* No signal, but an error. Later records are refused with it. */
TEST(a_reader_that_goes)
{
    struct writer *w = begin();
    int is = 1;
    close(end[0]);
    for (int i = 0; i < 6000 && is == 1; i++) {
        const struct timespec a_while = {0, 10000000};
        is = writer_put(w, "x", 1, 0);
        (void)nanosleep(&a_while, NULL);
    }
    CHECK_EQ_I64(is, -1);
    CHECK_EQ_I64(writer_end(w, 5), EPIPE);
    close(end[1]);
}

/* The end still comes, and so does a put that waits. */
TEST(a_file_that_takes_nothing)
{
    static const uint8_t much[RING_B];
    struct writer *w = begin();
    double before_s;
    while (writer_put(w, much, RING_B, 0.3) == 1) {}
    before_s = now_s();
    CHECK_EQ_I64(writer_put(w, much, RING_B, 0.3), 0);
    CHECK_EQ_I64(writer_put(w, much, RING_B + 1, 0), 0);
    CHECK_EQ_I64(writer_end(w, 0.3), -1);
    CHECK(now_s() - before_s >= 0.4, "it has no patience");
}

/* Its thread opens and closes it, so a pipe without a reader blocks no other thread. */
TEST(a_file_by_its_name)
{
    char name[64] = "/tmp/exhand-writer-XXXXXX", got[64] = "";
    struct writer *w = &writers[used];
    int fd = mkstemp(name);
    CHECK(fd >= 0 && write(fd, "something longer", 16) == 16, "no file");
    CHECK_EQ_I64(writer_start_file(w, name, rings[used++], RING_B), 0);
    CHECK_EQ_I64(writer_put(w, "ab", 2, 0), 1);
    CHECK_EQ_I64(writer_put(w, "cd", 2, 0), 1);
    CHECK_EQ_I64(writer_end(w, 30), 0);
    CHECK_EQ_I64((int64_t)writer_held(w), 0);
    CHECK(pread(fd, got, sizeof got, 0) == 16, "what was there is written over: %s", got);
    close(fd);
    fd = open(name, O_RDONLY);
    CHECK(read(fd, got, sizeof got) == 4 && memcmp(got, "abcd", 4) == 0, "%s", got);
    close(fd);
    CHECK_EQ_I64(remove(name), 0);
    CHECK_EQ_I64(mkfifo(name, 0600), 0);
    w = &writers[used];
    CHECK_EQ_I64(writer_start_file(w, name, rings[used++], RING_B), 0);
    CHECK_EQ_I64(writer_put(w, "ab", 2, 0), 1);
    CHECK_EQ_I64((int64_t)writer_held(w), 2);
    CHECK_EQ_I64(writer_end(w, 0), -1);
    fd = open(name, O_RDONLY);
    CHECK_EQ_I64(writer_end(w, 30), 0);
    CHECK_EQ_I64(read(fd, got, sizeof got), 2);
    close(fd);
    CHECK_EQ_I64(remove(name), 0);
    w = &writers[used];
    CHECK_EQ_I64(writer_start_file(w, "/nowhere/at.all", rings[used++], RING_B), 0);
    CHECK_EQ_I64(writer_end(w, 30), ENOENT);
    CHECK_EQ_I64(writer_put(w, "ab", 2, 0), -1);
}

TEST_MAIN("writer", a_full_pipe_refuses_and_waits_for_nobody, patience_loses_nothing,
    a_reader_that_goes, a_file_that_takes_nothing, a_file_by_its_name);
