/* SPDX-License-Identifier: MIT */
#include "udp.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define LOOKS 64 /* dropped packets per call at most: a flood must not block */

static int address(struct sockaddr_in *a, const char *text)
{
    char host[INET_ADDRSTRLEN];
    const char *colon = strrchr(text, ':');
    const size_t n = colon ? (size_t)(colon - text) : 0;
    char *end;
    unsigned long port;
    memset(a, 0, sizeof *a);
    a->sin_family = AF_INET;
    errno = EINVAL;
    if (n == 0 || n >= sizeof host || colon[1] < '0' || colon[1] > '9') { return -1; }
    memcpy(host, text, n);
    host[n] = '\0';
    port = strtoul(colon + 1, &end, 10);
    if (*end != '\0' || port > 65535 || inet_pton(AF_INET, host, &a->sin_addr) != 1) {
        errno = EINVAL;
        return -1;
    }
    a->sin_port = htons((uint16_t)port);
    return 0;
}

int udp_open(struct udp *u, const char *local, const char *peer)
{
    struct sockaddr_in here;
    int flags, err;
    memset(u, 0, sizeof *u);
    u->fd = -1;
    u->learns = peer == NULL;
    if (address(&here, local) < 0) { return -1; }
    if (peer != NULL) {
        if (address(&u->peer, peer) < 0) { return -1; }
        u->known = 1;
    }
    u->fd = socket(AF_INET, SOCK_DGRAM, 0);
    if (u->fd < 0) { return -1; }
    flags = fcntl(u->fd, F_GETFL);
    if (flags < 0 || fcntl(u->fd, F_SETFL, flags | O_NONBLOCK) < 0 ||
        fcntl(u->fd, F_SETFD, FD_CLOEXEC) < 0 ||
        bind(u->fd, (const struct sockaddr *)&here, sizeof here) < 0) {
        err = errno;
        udp_close(u);
        errno = err;
        return -1;
    }
    return 0;
}

void udp_close(struct udp *u)
{
    if (u->fd >= 0) { (void)close(u->fd); }
    u->fd = -1;
}

unsigned udp_port(const struct udp *u)
{
    struct sockaddr_in here;
    socklen_t len = sizeof here;
    if (getsockname(u->fd, (struct sockaddr *)&here, &len) < 0) { return 0; }
    return ntohs(here.sin_port);
}

/* The socket is not connected, so a peer that is not there gives no error, only silence. */
int udp_send(struct udp *u, const void *buf, size_t len_B)
{
    ssize_t n = -1;
    if (u->fd >= 0 && u->known) {
        n = sendto(u->fd, buf, len_B, 0, (const struct sockaddr *)&u->peer, sizeof u->peer);
    }
    if (n != (ssize_t)len_B) {
        u->unsent++;
        return 0;
    }
    return (int)n;
}

int udp_from(const struct udp *u, const struct sockaddr_in *peer)
{
    return peer->sin_addr.s_addr == u->from.sin_addr.s_addr && peer->sin_port == u->from.sin_port;
}

int udp_recv(struct udp *u, void *buf, size_t cap_B)
{
    for (int looks = 0; looks < LOOKS && u->fd >= 0 && cap_B > 0; looks++) {
        struct sockaddr_in from;
        struct iovec to = {buf, cap_B};
        struct msghdr m;
        ssize_t n;
        memset(&m, 0, sizeof m);
        m.msg_name = &from;
        m.msg_namelen = sizeof from;
        m.msg_iov = &to;
        m.msg_iovlen = 1;
        n = recvmsg(u->fd, &m, 0);
        if (n < 0 && errno == EINTR) { continue; }
        if (n < 0) { return 0; }
        u->from = from;
        if (!u->learns && !udp_from(u, &u->peer)) {
            u->strangers++;
        } else if (n == 0 || m.msg_flags & MSG_TRUNC) {
            u->bad_length++;
        } else {
            return (int)n;
        }
    }
    return 0;
}

void udp_learn(struct udp *u)
{
    if (!u->learns) { return; }
    u->peer = u->from;
    u->known = 1;
}
