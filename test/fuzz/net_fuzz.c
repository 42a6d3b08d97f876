/* SPDX-License-Identifier: MIT */
/* The receiving end of the image gets any frames from a network card.
 *
 * An input is a sequence of frames. Before each are three bytes: repairs, and its length (u16).
 * Repairs by bit: 0 our address, 1 IPv4's type, version and addresses, 2 UDP and its ports, 3 sums,
 * 4 ARP's head. Bit 5: a second passes first. Bit 6: we ask where the peer is. Bit 7: a broadcast.
 *
 * Rules: No read or write is outside. Each frame raises exactly one count. A dropped frame changes
 * nothing else. A frame that is handed over is from the peer, to us, and its data are in the frame.
 * Only an answer to a request sets the peer's address. We would accept the frames that we send.
 *
 *   net_fuzz SECONDS [SEED]     damaged frames for that time
 *   net_fuzz FILE...            these inputs
 * LLVMFuzzerTestOneInput() is libFuzzer's; with it, -DFUZZ_NO_MAIN. */
#include "frames.h"
#include "must.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define TO_US     1u
#define RIGHT_IP  2u
#define RIGHT_UDP 4u
#define RIGHT_SUM 8u
#define RIGHT_ARP 16u
#define A_SECOND  32u
#define WE_ASK    64u
#define TO_ALL    128u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const struct net_cfg cfg = {{2, 1, 1, 1, 1, 1}, 0x0A000002u, 0x0A000001u, 4747, 256};

static void put(uint8_t *f, size_t n, size_t at, uint32_t v, size_t bytes)
{
    if (at + bytes > n) { return; }
    for (size_t i = bytes; i-- > 0; v >>= 8) { f[at + i] = (uint8_t)v; }
}

static void put_right(uint8_t *f, size_t n, unsigned right)
{
    if (right & TO_US && n >= 6) { memcpy(f, cfg.mac, 6); }
    if (right & TO_ALL && n >= 6) { memset(f, 255, 6); }
    if (right & RIGHT_ARP) {
        put(f, n, 12, 0x08060001u, 4);
        put(f, n, 16, 0x08000604u, 4);
        put(f, n, 20, 1u + (f[0] & 1u), 2);
        put(f, n, 28, cfg.peer_ip, 4);
        put(f, n, 38, cfg.ip, 4);
        if (n >= 28) { memcpy(f + 22, f + 6, 6); }
    }
    if (right & RIGHT_IP) {
        put(f, n, 12, 0x080045u, 3);
        if (n > 14) { put(f, n, 16, (uint32_t)n - 14, 2); }
        put(f, n, 20, 0, 2);
        put(f, n, 23, 17, 1);
        put(f, n, 26, cfg.peer_ip, 4);
        put(f, n, 30, cfg.ip, 4);
    }
    if (right & RIGHT_UDP) {
        put(f, n, 34, 4747u << 16 | 4747u, 4);
        if (n > 34) { put(f, n, 38, (uint32_t)n - 34, 2); }
    }
    if (right & RIGHT_SUM) { frames_sums(f, n); }
}

static uint64_t counted(const struct net_counts *c)
{
    uint64_t n = (uint64_t)c->datagrams + c->arp_asked + c->arp_heard;
    for (unsigned i = 0; i < NET_DROPS; i++) { n += c->drop[i]; }
    return n;
}

/* What we send, a receiver like us takes as it was. */
static void send_back(struct net *n, const uint8_t *payload, size_t len_B)
{
    struct net_cfg theirs = {.ip = cfg.peer_ip, .peer_ip = cfg.ip, .port = 4747, .longest_B = 256};
    struct net other;
    uint8_t *const frame = malloc(NET_FRAME_B);
    const uint8_t *at;
    size_t got, size;
    MUST(frame != NULL);
    memcpy(theirs.mac, n->peer_mac, 6);
    net_open(&other, &theirs);
    size = net_datagram(n, frame, 4747, payload, len_B);
    MUST((size > 0) == n->known);
    if (size > 0) {
        MUST(net_take(&other, frame, size, 0, &at, &got) == NET_DATAGRAM);
        MUST(got == len_B && memcmp(at, payload, len_B) == 0);
    }
    free(frame);
}

static void datagram(struct net *n, const uint8_t *f, size_t len_B, const uint8_t *at, size_t got)
{
    MUST(at == f + 42 && got >= 1 && got <= cfg.longest_B && 42 + got <= len_B);
    MUST(memcmp(f, cfg.mac, 6) == 0);
    MUST(f[12] == 8 && f[13] == 0 && f[14] == 0x45 && f[23] == 17);
    MUST((f[20] & 0xBF) == 0 && f[21] == 0);
    MUST(memcmp(f + 26, "\x0A\0\0\1\x0A\0\0\2", 8) == 0);
    send_back(n, at, got);
}

static void one(struct net *n, const uint8_t *f, size_t len_B, uint32_t now_us)
{
    const struct net before = *n;
    struct net rest;
    const uint8_t *at;
    size_t got;
    const enum net_take what = net_take(n, f, len_B, now_us, &at, &got);
    MUST(n->counts.frames == before.counts.frames + 1);
    MUST(counted(&n->counts) == counted(&before.counts) + 1);
    MUST((what == NET_DATAGRAM) == (at != NULL));
    if (what == NET_DATAGRAM) { datagram(n, f, len_B, at, got); }
    if (what == NET_ANSWER) {
        uint8_t to[NET_ARP_B];
        MUST(net_answer(n, to) == NET_ARP_B && memcmp(to, f + 6, 6) == 0);
    }
    if (n->counts.arp_heard != before.counts.arp_heard) { MUST(before.waiting && !n->waiting); }
    if (n->counts.arp_heard == before.counts.arp_heard) {
        MUST(n->known == before.known && memcmp(n->peer_mac, before.peer_mac, 6) == 0);
    }
    rest = *n;
    rest.counts = before.counts;
    if (what == NET_NOTHING && n->counts.arp_heard == before.counts.arp_heard) {
        MUST(memcmp(&rest, &before, sizeof rest) == 0);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct net n;
    uint32_t now_us = 0;
    net_open(&n, &cfg);
    while (size >= 3) {
        const unsigned right = data[0];
        size_t len_B = (size_t)data[1] | (size_t)data[2] << 8;
        uint8_t *f, to[NET_FRAME_B];
        data += 3;
        size -= 3;
        len_B = len_B < size ? len_B : size;
        f = malloc(len_B ? len_B : 1); /* exactly its size: a read beyond it is seen */
        MUST(f != NULL);
        memcpy(f, data, len_B);
        data += len_B;
        size -= len_B;
        put_right(f, len_B, right);
        if (right & A_SECOND) { now_us += 1000000; }
        if (right & WE_ASK) { (void)net_ask(&n, to, now_us); }
        one(&n, f, len_B, now_us);
        free(f);
    }
    return 0;
}

#ifndef FUZZ_NO_MAIN
#define INPUT_MAX 8192u

static const uint8_t peer_mac[NET_MAC_B] = {2, 2, 2, 2, 2, 2};
static uint8_t input[INPUT_MAX];
static size_t input_n;
static uint64_t made_of;

static void failed(int sig)
{
    FILE *f = fopen("net-fuzz-failed", "wb");
    if (f != NULL) {
        fwrite(input, 1, input_n, f);
        fclose(f);
    }
    fprintf(stderr, "input of seed %llu: in net-fuzz-failed\n", (unsigned long long)made_of);
    signal(sig, SIG_DFL);
    raise(sig);
}

/* Some frames, most of them bent already, then bytes of the whole. */
static void make(uint64_t seed)
{
    struct frames f = {seed, cfg, {0}};
    memcpy(f.mac, peer_mac, sizeof f.mac);
    made_of = seed;
    input_n = 0;
    for (uint64_t k = frames_u64(&f) % 4 + 1; k > 0 && input_n + 3 + FRAMES_MAX_B <= INPUT_MAX;
         k--) {
        const uint64_t kind = frames_u64(&f);
        uint8_t *const at = &input[input_n];
        const size_t n = kind % 8 == 0   ? frames_arp(&f, at + 3, 1 + (kind >> 8 & 1))
                         : kind % 8 == 1 ? frames_datagram(&f, at + 3, &kind, sizeof kind)
                                         : frames_bad(&f, at + 3);
        at[0] = (uint8_t)(kind >> 16 & (kind % 8 == 0 ? A_SECOND | WE_ASK : kind >> 24));
        at[1] = (uint8_t)n;
        at[2] = (uint8_t)(n >> 8);
        input_n += 3 + n;
    }
    for (uint64_t k = frames_u64(&f) % 4; k > 0; k--) {
        input[frames_u64(&f) % input_n] ^= (uint8_t)(1u << frames_u64(&f) % 8);
    }
}

static int fuzz(long seconds, uint64_t seed)
{
    const time_t end = time(NULL) + seconds;
    uint64_t n = 0;
    for (; n % 256 || time(NULL) < end; n++) {
        make(seed + n);
        (void)LLVMFuzzerTestOneInput(input, input_n);
    }
    printf("net: %llu inputs from seed %llu: nothing found\n", (unsigned long long)n,
        (unsigned long long)seed);
    return 0;
}

int main(int argc, char **argv)
{
    signal(SIGABRT, failed);
    if (argc >= 2 && atol(argv[1]) > 0) {
        return fuzz(atol(argv[1]), argc > 2 ? strtoull(argv[2], NULL, 10) : 1);
    }
    for (int i = 1; i < argc; i++) {
        FILE *f = fopen(argv[i], "rb");
        if (f == NULL) {
            perror(argv[i]);
            return 3;
        }
        input_n = fread(input, 1, sizeof input, f);
        fclose(f);
        (void)LLVMFuzzerTestOneInput(input, input_n);
    }
    return argc < 2 ? 2 : 0;
}
#endif
