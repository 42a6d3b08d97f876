/* SPDX-License-Identifier: MIT */
/* Frames of an attacker or of a broken host, made from a number. For the unit test, the fuzzer and
 * the flood over an emulator's cable. */
#ifndef TEST_PC104_FRAMES_H
#define TEST_PC104_FRAMES_H

#include "pc104/net.h"

#define FRAMES_MAX_B 2048u

struct frames {
    uint64_t state;
    struct net_cfg to;      /* the receiver; `to` may be the broadcast */
    uint8_t mac[NET_MAC_B]; /* the peer's */
};

uint64_t frames_u64(struct frames *f);

/* A whole datagram of the peer's, as it ought to be: its length. n <= NET_PAYLOAD_B. */
size_t frames_datagram(const struct frames *f, uint8_t *at, const void *payload, size_t n);
/* ARP: op 1 asks for to.ip, 2 answers it. */
size_t frames_arp(const struct frames *f, uint8_t *at, unsigned op);
/* Puts the sums right, as far as the frame says that it has any. */
void frames_sums(uint8_t *at, size_t len_B);
/* The next bad one: a good one that was bent, or noise. at[] holds FRAMES_MAX_B. */
size_t frames_bad(struct frames *f, uint8_t *at);

#endif
