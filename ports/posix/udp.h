/* SPDX-License-Identifier: MIT */
/* UDP over IPv4, one peer, never waiting. */
#ifndef UDP_H
#define UDP_H

#include <netinet/in.h>
#include <stddef.h>
#include <stdint.h>

struct udp {
    int fd;     /* < 0: closed */
    int learns; /* udp_learn() sets the peer */
    int known;  /* there is a peer */
    struct sockaddr_in peer;
    struct sockaddr_in from; /* who sent the newest packet */
    uint64_t strangers;      /* packets from others, dropped */
    uint64_t bad_length;     /* longer than the buffer, or empty: dropped */
    uint64_t unsent;         /* not taken by the system, or there was no peer yet */
};

/* Addresses are numeric "host:port", such as "127.0.0.1:4747"; port 0: any. peer NULL: set by
 * udp_learn(), so that both sides may restart in any order. 0, or -1 with errno. */
int udp_open(struct udp *u, const char *local, const char *peer);
void udp_close(struct udp *u);

/* The port it listens at. */
unsigned udp_port(const struct udp *u);

/* A whole packet: its length, or 0: not now. A peer that is not there is no error. */
int udp_send(struct udp *u, const void *buf, size_t len_B);

/* The next packet, or 0: none, or too much that is none for one call. One longer than cap_B is
 * dropped and counted, as are empty ones. */
int udp_recv(struct udp *u, void *buf, size_t cap_B);

/* 1: the packet just received came from this peer. */
int udp_from(const struct udp *u, const struct sockaddr_in *peer);

/* Makes the sender of the last packet the peer, unless one was given. Call it only for a checked
 * packet: otherwise anybody could redirect the answers. */
void udp_learn(struct udp *u);

#endif
