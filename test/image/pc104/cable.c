/* SPDX-License-Identifier: MIT */
/* The other end of an emulator's cable: answers ARP and sends bad frames, a good one now and then.
 *
 *   cable SOCKET FRAMES [SEED]
 *
 * SOCKET: a Unix stream that the emulator connects to (qemu: -netdev stream), each frame behind its
 * length, u32, the highest byte first. What is not taken is waited for, so that none is lost on the
 * way. Prints what it sent, and how many of these a card lets through; 0 if all were taken, 1 if
 * the other end left before. */
#include "frames.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#define GOOD_EVERY 64
#define START_MS   20000
#define STUCK_MS   60000
#define BUFFER_B   65536u
#define PASSES_B   1522u /* QEMU's: a tag and a CRC more than it needs be */

static struct frames peer = {0, {{0}, 0x0A000002u, 0x0A000001u, 4747, 256}, {2, 0, 0, 0, 0, 9}};
static unsigned long answered, heard, sent, good, through;
static uint8_t out[BUFFER_B], in[BUFFER_B];
static size_t out_n, in_n;

static int listen_at(const char *path)
{
    struct sockaddr_un a;
    const int fd = socket(AF_UNIX, SOCK_STREAM, 0);
    memset(&a, 0, sizeof a);
    a.sun_family = AF_UNIX;
    if (strlen(path) >= sizeof a.sun_path) {
        fprintf(stderr, "cable: %s: a shorter path, please\n", path);
        return -1;
    }
    strcpy(a.sun_path, path);
    (void)unlink(path);
    if (fd < 0 || bind(fd, (const struct sockaddr *)&a, sizeof a) != 0 || listen(fd, 1) != 0) {
        perror("cable");
        return -1;
    }
    return fd;
}

static int meet(const char *path)
{
    const int door = listen_at(path);
    struct pollfd p = {door, POLLIN, 0};
    int fd = -1;
    if (door < 0) { return -1; }
    if (poll(&p, 1, START_MS) > 0) { fd = accept(door, NULL, NULL); }
    if (fd < 0) { fprintf(stderr, "cable: %s: nobody came\n", path); }
    (void)close(door);
    (void)unlink(path);
    return fd >= 0 && fcntl(fd, F_SETFL, O_NONBLOCK) == 0 ? fd : -1;
}

static void put(const uint8_t *frame, size_t n)
{
    for (unsigned i = 0; i < 4; i++) { out[out_n++] = (uint8_t)(n >> (24 - 8 * i)); }
    memcpy(&out[out_n], frame, n);
    out_n += n;
}

/* Learns their MAC from whatever they send, and answers ARP. */
static void take(const uint8_t *f, size_t n)
{
    uint8_t answer[FRAMES_MAX_B];
    if (n < 42) { return; }
    heard++;
    memcpy(peer.to.mac, f + 6, 6);
    if (f[12] == 8 && f[13] == 6 && f[21] == 1) {
        put(answer, frames_arp(&peer, answer, 2));
        answered++;
    }
}

static void take_all(void)
{
    size_t at = 0;
    while (in_n - at >= 4) {
        const size_t n = (size_t)in[at + 2] << 8 | in[at + 3];
        if (in_n - at < 4 + n || out_n + FRAMES_MAX_B + 4 > BUFFER_B) { break; }
        take(&in[at + 4], n);
        at += 4 + n;
    }
    in_n -= at;
    memmove(in, &in[at], in_n);
}

static int passes(const uint8_t *f, size_t n)
{
    static const uint8_t all[6] = {255, 255, 255, 255, 255, 255};
    return n <= PASSES_B && (memcmp(f, peer.to.mac, 6) == 0 || memcmp(f, all, 6) == 0);
}

static void fill(unsigned long frames)
{
    uint8_t f[FRAMES_MAX_B];
    while (answered > 0 && sent < frames && out_n + 3 * (FRAMES_MAX_B + 4) <= BUFFER_B) {
        size_t n;
        if (sent % GOOD_EVERY == 0) {
            put(f, frames_datagram(&peer, f, &sent, sizeof sent));
            good++;
        }
        do {
            n = frames_bad(&peer, f);
        } while (n < 14); /* no cable brings less */
        put(f, n);
        sent++;
        through += (unsigned long)passes(f, n);
    }
}

/* 0: the other end has left. */
static int move(int fd, int ms)
{
    struct pollfd p = {fd, (short)(POLLIN | (out_n ? POLLOUT : 0)), 0};
    ssize_t n;
    if (poll(&p, 1, ms) <= 0) { return ms < STUCK_MS; }
    if (p.revents & POLLIN) {
        n = read(fd, &in[in_n], sizeof in - in_n);
        if (n <= 0) { return n < 0 && errno == EAGAIN; }
        in_n += (size_t)n;
        take_all();
    }
    if (p.revents & POLLOUT) {
        n = send(fd, out, out_n, MSG_NOSIGNAL);
        if (n < 0) { return errno == EAGAIN; }
        out_n -= (size_t)n;
        memmove(out, &out[n], out_n);
    }
    return !(p.revents & (POLLERR | POLLHUP));
}

int main(int argc, char **argv)
{
    const unsigned long frames = argc > 2 ? strtoul(argv[2], NULL, 10) : 0;
    int fd, there = 1, all;
    if (frames == 0) {
        fprintf(stderr, "usage: cable SOCKET FRAMES [SEED]\n");
        return 2;
    }
    peer.state = argc > 3 ? strtoull(argv[3], NULL, 10) : 1;
    fd = meet(argv[1]);
    if (fd < 0) { return 3; }
    while (there && (sent < frames || out_n > 0)) {
        fill(frames);
        there = move(fd, STUCK_MS);
    }
    all = there; /* the rest of the emulator's life: it is answered, and sees the cable */
    while (there) { there = move(fd, 1000); }
    printf("sent %lu bad, %lu good, %lu ARP; %lu to be seen; heard %lu\n", sent, good, answered,
        through + good + answered, heard);
    return all ? 0 : 1;
}
