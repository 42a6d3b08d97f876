/* SPDX-License-Identifier: MIT */
/* Line: what the board's link functions lead to: two impaired ways (sim/link.h), and at their end
 * a peer in this process or a UDP socket. */
#ifndef LINE_H
#define LINE_H

#include "sim/link.h"

#include "exhand/keyed.h"

#include <stdint.h>

struct posix_line {
    int on;
    struct sim_link_par way[SIM_LINK_WAYS];       /* SIM_LINK_OUT, SIM_LINK_IN */
    const struct sim_trace *trace[SIM_LINK_WAYS]; /* the caller's, or NULL */
    /* A peer in this process. It is called at its frames in virtual time, frame_first_s + n
     * frame_s; with frame_s 0, at each packet. It takes packets from the outgoing link and gives
     * packets to the incoming one, at t_s. NULL: none. */
    void (*frame)(void *ctx, struct sim_link *link, double t_s);
    void *ctx;
    double frame_s, frame_first_s;
    /* Or a socket: "127.0.0.1:4747" and the peer's address; NULL: any sender. Real time, for runs
     * with the wall clock. */
    const char *udp_local, *udp_peer;
    /* Of the socket; NULL: none. key_start: where numbers begin (key_start()); they go on from run
     * to run. */
    const struct exh_mac_key *key;
    uint64_t key_start;
};

struct posix_line posix_line_default(void);

/* 0, or -1: no socket. */
int line_start(const struct posix_line *cfg, uint64_t seed);
void line_stop(void);

/* Everything up to and at now_s. */
void line_advance(double now_s);

int line_send(double now_s, const void *buf, size_t len_B);
int line_recv(double now_s, void *buf, size_t cap_B);

/* Packets that came to the socket and went no further. */
struct posix_line_drops {
    uint64_t strangers;  /* from elsewhere than its peer */
    uint64_t bad_length; /* the peer's, empty or longer than any */
};
struct posix_line_drops posix_line_drops(void);

/* Counts of the packets that a socket with a key received; NULL: there is no key. */
const struct exh_keyed *posix_line_keyed(void);

/* The ways, for their counts and for changes on the way. */
struct sim_link *posix_link(void);

#endif
