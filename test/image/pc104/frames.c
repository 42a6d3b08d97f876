/* SPDX-License-Identifier: MIT */
#include "frames.h"

#include <string.h>

/* Written from RFC 768, 791, 826 and 894, without a look at net.c. */

uint64_t frames_u64(struct frames *f)
{
    uint64_t z = f->state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

static size_t below(struct frames *f, size_t n) { return (size_t)(frames_u64(f) % n); }

static void put(uint8_t *at, uint32_t v, int bytes)
{
    while (bytes-- > 0) {
        at[bytes] = (uint8_t)v;
        v >>= 8;
    }
}

/* RFC 1071, the slow way: add with the carry brought round at each step. */
static uint32_t add(uint32_t sum, const uint8_t *at, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        sum += (uint32_t)at[i] << (i % 2 ? 0 : 8);
        if (sum > 0xFFFF) { sum -= 0xFFFF; }
    }
    return sum;
}

static uint32_t added(uint32_t a, uint32_t b) { return a + b > 0xFFFF ? a + b - 0xFFFF : a + b; }

void frames_sums(uint8_t *at, size_t len_B)
{
    const size_t head = len_B > 14 ? (size_t)(at[14] & 15) * 4 : 0;
    size_t udp;
    uint32_t sum;
    if (len_B < 34 || head < 20 || 14 + head > len_B) { return; }
    put(at + 24, 0, 2);
    put(at + 24, 0xFFFF ^ add(0, at + 14, head), 2);
    if (14 + head + 8 > len_B) { return; }
    udp = (size_t)at[14 + head + 4] << 8 | at[14 + head + 5];
    if (udp < 8 || 14 + head + udp > len_B) { return; }
    put(at + 14 + head + 6, 0, 2);
    sum = add(added(17, (uint32_t)udp), at + 26, 8);
    sum = 0xFFFF ^ added(sum, add(0, at + 14 + head, udp));
    put(at + 14 + head + 6, sum ? sum : 0xFFFF, 2);
}

static void ether(const struct frames *f, uint8_t *at, uint32_t type)
{
    memcpy(at, f->to.mac, 6);
    memcpy(at + 6, f->mac, 6);
    put(at + 12, type, 2);
}

size_t frames_datagram(const struct frames *f, uint8_t *at, const void *payload, size_t n)
{
    memset(at, 0, 42);
    ether(f, at, 0x0800);
    at[14] = 0x45;
    put(at + 16, (uint32_t)(28 + n), 2);
    at[22] = 64;
    at[23] = 17;
    put(at + 26, f->to.peer_ip, 4);
    put(at + 30, f->to.ip, 4);
    put(at + 34, f->to.port, 2);
    put(at + 36, f->to.port, 2);
    put(at + 38, (uint32_t)(8 + n), 2);
    memcpy(at + 42, payload, n);
    frames_sums(at, 42 + n);
    return 42 + n;
}

size_t frames_arp(const struct frames *f, uint8_t *at, unsigned op)
{
    memset(at, 0, 60);
    ether(f, at, 0x0806);
    put(at + 14, 1, 2);
    put(at + 16, 0x0800, 2);
    at[18] = 6;
    at[19] = 4;
    put(at + 20, op, 2);
    memcpy(at + 22, f->mac, 6);
    put(at + 28, f->to.peer_ip, 4);
    if (op == 2) { memcpy(at + 32, f->to.mac, 6); }
    put(at + 38, f->to.ip, 4);
    return 60; /* as a cable brings it: filled up */
}

/* Complete with all its checksums, the wire's too (docs/WIRE.md), and from an unknown sender. */
static size_t stranger(struct frames *f, uint8_t *at)
{
    uint8_t packet[256];
    const size_t n = sizeof packet - (below(f, 2) ? 0 : 20 + below(f, 200));
    uint32_t crc = 0xFFFFFFFF;
    for (size_t i = 0; i < n; i++) { packet[i] = (uint8_t)frames_u64(f); }
    packet[0] = 0x58;
    packet[1] = 0x57;
    packet[2] = 1;
    packet[3] = (uint8_t)(1 + below(f, 5));
    packet[4] = (uint8_t)(n - 22);
    packet[5] = 0;
    for (size_t i = 0; i < n - 4; i++) {
        crc ^= packet[i];
        for (int bit = 0; bit < 8; bit++) { crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320 : 0); }
    }
    for (int i = 0; i < 4; i++) { packet[n - 4 + (size_t)i] = (uint8_t)(~crc >> 8 * i); }
    return frames_datagram(f, at, packet, n);
}

static size_t good(struct frames *f, uint8_t *at)
{
    uint8_t payload[NET_PAYLOAD_B];
    const size_t n = below(f, 4) ? below(f, 300) : below(f, NET_PAYLOAD_B + 1);
    if (below(f, 4) == 0) { return frames_arp(f, at, 1 + (unsigned)below(f, 2)); }
    for (size_t i = 0; i < n; i++) { payload[i] = (uint8_t)frames_u64(f); }
    return frames_datagram(f, at, payload, n);
}

/* A field of the headers to something that it should not be. */
static void bend(struct frames *f, uint8_t *at)
{
    static const struct {
        uint8_t at, bytes;
    } field[] = {{12, 2}, {14, 1}, {14, 1}, {16, 2}, {16, 2}, {18, 2}, {20, 2}, {20, 2}, {22, 1},
        {23, 1}, {24, 2}, {26, 4}, {30, 4}, {34, 2}, {36, 2}, {38, 2}, {38, 2}, {40, 2}, {18, 1},
        {19, 1}, {20, 2}, {22, 6}, {28, 4}, {32, 6}, {38, 4}, {6, 6}};
    static const uint32_t odd[] = {0, 1, 2, 5, 7, 8, 19, 20, 27, 28, 0x46, 0x4F, 0x60, 0x1FFF,
        0x2000, 0x7FFF, 0x8000, 0x8100, 0x86DD, 0x0806, 0xFFFF, 0xFFFFFFFF};
    const size_t i = below(f, sizeof field / sizeof field[0]);
    const uint32_t v =
        below(f, 2) ? odd[below(f, sizeof odd / sizeof odd[0])] : (uint32_t)frames_u64(f);
    put(at + field[i].at, v, field[i].bytes);
}

static size_t resized(struct frames *f, uint8_t *at, size_t n)
{
    const size_t to = below(f, 3) ? below(f, n + 1) : below(f, FRAMES_MAX_B + 1);
    for (size_t i = n; i < to; i++) { at[i] = (uint8_t)frames_u64(f); }
    return to;
}

size_t frames_bad(struct frames *f, uint8_t *at)
{
    size_t n = good(f, at);
    switch (below(f, 10)) {
    case 0: /* noise, to us or to all */
        for (size_t i = 12; i < n; i++) { at[i] = (uint8_t)frames_u64(f); }
        break;
    case 1: n = resized(f, at, n); break;
    case 2: at[below(f, n)] ^= (uint8_t)(1u << below(f, 8)); break;
    case 3: /* a datagram to all, an answer to no one */
        for (size_t i = 0; i < 6; i++) { at[i] = 255; }
        break;
    case 4: /* whole, and no packet of the wire's; or one, of a stranger's */
        if (below(f, 2)) { n = stranger(f, at); }
        break;
    case 5: /* another host with our address; as ARP it is taken */
        put(at + 28, f->to.ip, 4);
        break;
    default:
        for (size_t k = 1 + below(f, 3); k > 0; k--) { bend(f, at); }
        if (below(f, 8) == 0) { n = resized(f, at, n); }
        if (below(f, 4)) { frames_sums(at, n); }
    }
    return n;
}
