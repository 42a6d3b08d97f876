/* SPDX-License-Identifier: MIT */
#include "net.h"

#include <string.h>

/* Places in a frame. */
enum { TO = 0, FROM = 6, TYPE = 12, BODY = 14 };
enum { A_HEAD = 14, A_OP = 20, A_MAC = 22, A_IP = 28, A_TO_MAC = 32, A_TO_IP = 38 };
enum { I_VERSION = 14, I_LENGTH = 16, I_ID = 18, I_FRAGMENT = 20, I_TTL = 22, I_PROTOCOL = 23 };
enum { I_SUM = 24, I_FROM = 26, I_TO = 30, U_FROM = 34, U_TO = 36, U_LENGTH = 38, U_SUM = 40 };

#define TYPE_IP       0x0800u
#define TYPE_ARP      0x0806u
#define ARP_ASK       1u
#define ARP_ANSWER    2u
#define IP_B          20u
#define UDP_B         8u
#define UDP           17u
#define DONT_FRAGMENT 0x4000u
#define TTL           64u

#define QUICK_US 100000u
#define SLOW_US  1000000u
#define QUICK    20u /* so many times */

static const uint8_t arp_head[] = {
    0, 1, 8, 0, 6, 4}; /* Ethernet, IPv4, lengths of their addresses */
static const uint8_t all[NET_MAC_B] = {255, 255, 255, 255, 255, 255};

static uint16_t get16(const uint8_t *at) { return (uint16_t)((unsigned)at[0] << 8 | at[1]); }

static uint32_t get32(const uint8_t *at) { return (uint32_t)get16(at) << 16 | get16(at + 2); }

static void put16(uint8_t *at, unsigned v)
{
    at[0] = (uint8_t)(v >> 8);
    at[1] = (uint8_t)v;
}

static void put32(uint8_t *at, uint32_t v)
{
    put16(at, v >> 16);
    put16(at + 2, v & 0xFFFFu);
}

static uint32_t little(const uint8_t *at, size_t bytes)
{
    uint32_t v = 0;
    for (size_t i = 0; i < bytes; i++) { v |= (uint32_t)at[i] << 8 * i; }
    return v;
}

/* Sum of 16-bit words, an odd byte as if a zero followed; at most 64 KiB of them. Four bytes at a
 * time and the lower byte first: such sums don't mind, they come out with their bytes swapped. */
static uint32_t sum_of(const uint8_t *at, size_t len_B)
{
    uint32_t low = 0, high = 0, sum;
    for (; len_B > 3; at += 4, len_B -= 4) {
        const uint32_t word =
            (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
        low += word & 0xFFFFu;
        high += word >> 16;
    }
    sum = little(at, len_B);
    sum = (low & 0xFFFFu) + (low >> 16) + (high & 0xFFFFu) + (high >> 16) + (sum & 0xFFFFu) +
          (sum >> 16);
    sum = (sum & 0xFFFFu) + (sum >> 16);
    sum = (sum & 0xFFFFu) + (sum >> 16);
    return (sum << 8 & 0xFF00u) | sum >> 8;
}

static uint16_t folded(uint32_t sum)
{
    sum = (sum & 0xFFFFu) + (sum >> 16);
    return (uint16_t)((sum & 0xFFFFu) + (sum >> 16));
}

/* Includes addresses, protocol and length, for a frame with complete headers. */
static uint32_t udp_sum(const uint8_t *frame, size_t udp_len_B)
{
    return UDP + (uint32_t)udp_len_B + sum_of(frame + I_FROM, 8 + udp_len_B);
}

void net_open(struct net *n, const struct net_cfg *cfg)
{
    memset(n, 0, sizeof *n);
    n->cfg = *cfg;
}

/* --- in --- */

static enum net_take drop(struct net *n, enum net_drop why)
{
    n->counts.drop[why]++;
    return NET_NOTHING;
}

static int is(const uint8_t *a, const uint8_t *b, size_t len_B) { return memcmp(a, b, len_B) == 0; }

/* An address of one card: neither a group's nor none. */
static int one_card(const uint8_t *mac)
{
    static const uint8_t none[NET_MAC_B];
    return !(mac[0] & 1) && !is(mac, none, NET_MAC_B);
}

static enum net_take take_asked(struct net *n, const uint8_t *f)
{
    if (get32(f + A_TO_IP) != n->cfg.ip) { return drop(n, NET_ARP_OTHERS); }
    memcpy(n->asker_mac, f + A_MAC, NET_MAC_B);
    n->asker_ip = get32(f + A_IP);
    n->counts.arp_asked++;
    return NET_ANSWER;
}

/* Only the answer to a question of ours, and in time: others' are how links are led astray. */
static enum net_take take_answer(struct net *n, const uint8_t *f, uint32_t now_us)
{
    const int due = n->waiting && now_us - n->asked_us <= SLOW_US;
    if (!due || get32(f + A_IP) != n->cfg.peer_ip || get32(f + A_TO_IP) != n->cfg.ip ||
        !is(f + TO, n->cfg.mac, NET_MAC_B) || !is(f + A_TO_MAC, n->cfg.mac, NET_MAC_B)) {
        return drop(n, NET_ARP_UNASKED);
    }
    memcpy(n->peer_mac, f + A_MAC, NET_MAC_B);
    n->known = 1;
    n->waiting = 0;
    n->heard_us = now_us;
    n->counts.arp_heard++;
    return NET_NOTHING;
}

static enum net_take take_arp(struct net *n, const uint8_t *f, size_t len_B, uint32_t now_us)
{
    unsigned op;
    if (len_B < NET_ARP_B) { return drop(n, NET_SHORT); }
    op = get16(f + A_OP);
    if (!is(f + A_HEAD, arp_head, sizeof arp_head) || (op != ARP_ASK && op != ARP_ANSWER) ||
        !one_card(f + A_MAC) || !is(f + A_MAC, f + FROM, NET_MAC_B)) {
        return drop(n, NET_ARP);
    }
    if (get32(f + A_IP) == n->cfg.ip || is(f + A_MAC, n->cfg.mac, NET_MAC_B)) {
        return drop(n, NET_ARP_CONFLICT);
    }
    return op == ARP_ASK ? take_asked(n, f) : take_answer(n, f, now_us);
}

/* The reason to drop an IPv4 packet; NET_DROPS if it is valid, complete and for us. */
static enum net_drop why_not_ip(const struct net *n, const uint8_t *f, size_t len_B)
{
    const size_t length = get16(f + I_LENGTH), head = (size_t)(f[I_VERSION] & 15) * 4;
    if (f[I_VERSION] >> 4 != 4 || head < IP_B || length < head || length > len_B - BODY) {
        return NET_IP;
    }
    if (head != IP_B) { return NET_IP_OPTIONS; }
    if (folded(sum_of(f + BODY, IP_B)) != 0xFFFF) { return NET_IP_SUM; }
    if (get32(f + I_TO) != n->cfg.ip) { return NET_IP_OTHERS; }
    if (get16(f + I_FRAGMENT) & ~DONT_FRAGMENT) { return NET_FRAGMENT; }
    if (f[I_PROTOCOL] != UDP) { return NET_PROTOCOL; }
    return get32(f + I_FROM) == n->cfg.peer_ip ? NET_DROPS : NET_STRANGER;
}

/* The sum comes last: it is what costs, and so no more than longest_B ever does. */
static enum net_drop why_not_udp(const struct net *n, const uint8_t *f)
{
    const size_t ip = get16(f + I_LENGTH) - IP_B;
    const size_t length = ip < UDP_B ? 0 : get16(f + U_LENGTH);
    if (length < UDP_B || length != ip) { return NET_UDP; }
    if (get16(f + U_TO) != n->cfg.port || get16(f + U_FROM) != n->cfg.port) { return NET_PORT; }
    if (length == UDP_B) { return NET_EMPTY; }
    if (length - UDP_B > n->cfg.longest_B) { return NET_TOO_LONG; }
    return get16(f + U_SUM) != 0 && folded(udp_sum(f, length)) != 0xFFFF ? NET_UDP_SUM : NET_DROPS;
}

static enum net_take take_ip(struct net *n, const uint8_t *f, size_t len_B, uint32_t now_us,
    const uint8_t **at, size_t *payload_B)
{
    enum net_drop why;
    if (!is(f + TO, n->cfg.mac, NET_MAC_B)) { return drop(n, NET_OTHERS); }
    if (len_B < BODY + IP_B) { return drop(n, NET_SHORT); }
    why = why_not_ip(n, f, len_B);
    if (why == NET_DROPS) { why = why_not_udp(n, f); }
    if (why != NET_DROPS) { return drop(n, why); }
    n->heard_us = now_us;
    if (n->known && is(f + FROM, n->peer_mac, NET_MAC_B)) { n->waiting = 0; } /* still there */
    n->counts.datagrams++;
    *at = f + NET_HEAD_B;
    *payload_B = (size_t)get16(f + U_LENGTH) - UDP_B;
    return NET_DATAGRAM;
}

enum net_take net_take(struct net *n, const uint8_t *frame, size_t len_B, uint32_t now_us,
    const uint8_t **at, size_t *payload_B)
{
    unsigned type;
    *at = NULL;
    *payload_B = 0;
    n->counts.frames++;
    if (len_B < BODY) { return drop(n, NET_SHORT); }
    if (len_B > NET_FRAME_B) { return drop(n, NET_LONG); }
    if (!is(frame + TO, n->cfg.mac, NET_MAC_B) && !is(frame + TO, all, NET_MAC_B)) {
        return drop(n, NET_OTHERS);
    }
    type = get16(frame + TYPE);
    if (type == TYPE_ARP) { return take_arp(n, frame, len_B, now_us); }
    if (type == TYPE_IP) { return take_ip(n, frame, len_B, now_us, at, payload_B); }
    return drop(n, NET_TYPE);
}

/* --- out --- */

static size_t put_arp(
    const struct net *n, uint8_t *to, unsigned op, const uint8_t *mac, uint32_t ip)
{
    memset(to, 0, NET_ARP_B);
    memcpy(to + TO, op == ARP_ASK ? all : mac, NET_MAC_B);
    memcpy(to + FROM, n->cfg.mac, NET_MAC_B);
    put16(to + TYPE, TYPE_ARP);
    memcpy(to + A_HEAD, arp_head, sizeof arp_head);
    put16(to + A_OP, op);
    memcpy(to + A_MAC, n->cfg.mac, NET_MAC_B);
    put32(to + A_IP, n->cfg.ip);
    if (op == ARP_ANSWER) { memcpy(to + A_TO_MAC, mac, NET_MAC_B); }
    put32(to + A_TO_IP, ip);
    return NET_ARP_B;
}

size_t net_answer(const struct net *n, uint8_t *to)
{
    return put_arp(n, to, ARP_ANSWER, n->asker_mac, n->asker_ip);
}

size_t net_ask(struct net *n, uint8_t *to, uint32_t now_us)
{
    const uint32_t every_us = !n->known && n->asks < QUICK ? QUICK_US : SLOW_US;
    if (now_us - n->asked_us > SLOW_US) { n->waiting = 0; } /* before the clock comes round */
    if (n->begun && now_us - n->asked_us < every_us) { return 0; }
    if (n->known && now_us - n->heard_us < SLOW_US) { return 0; }
    n->begun = n->waiting = 1;
    n->asked_us = now_us;
    n->asks = (uint16_t)(n->asks + (n->asks < QUICK));
    return put_arp(n, to, ARP_ASK, all, n->cfg.peer_ip);
}

size_t net_datagram(struct net *n, uint8_t *to, uint16_t port, const void *payload, size_t len_B)
{
    const size_t udp = UDP_B + len_B;
    uint16_t sum;
    if (!n->known || len_B > NET_PAYLOAD_B) { return 0; }
    memcpy(to + TO, n->peer_mac, NET_MAC_B);
    memcpy(to + FROM, n->cfg.mac, NET_MAC_B);
    put16(to + TYPE, TYPE_IP);
    put16(to + I_VERSION, 0x4500);
    put16(to + I_LENGTH, (unsigned)(IP_B + udp));
    put16(to + I_ID, n->id++);
    put16(to + I_FRAGMENT, DONT_FRAGMENT);
    put16(to + I_TTL, TTL << 8 | UDP);
    put16(to + I_SUM, 0);
    put32(to + I_FROM, n->cfg.ip);
    put32(to + I_TO, n->cfg.peer_ip);
    put16(to + I_SUM, ~(unsigned)folded(sum_of(to + BODY, IP_B)));
    put16(to + U_FROM, n->cfg.port);
    put16(to + U_TO, port);
    put16(to + U_LENGTH, (unsigned)udp);
    put16(to + U_SUM, 0);
    memcpy(to + NET_HEAD_B, payload, len_B);
    sum = folded(udp_sum(to, udp));
    put16(to + U_SUM, sum == 0xFFFF ? 0xFFFFu : ~(unsigned)sum); /* 0 would mean "no checksum" */
    return NET_HEAD_B + len_B;
}

/* --- names --- */

const char *net_drop_text(enum net_drop cause)
{
    static const char *const text[NET_DROPS] = {"short", "long", "others", "type", "arp",
        "arp_others", "arp_conflict", "arp_unasked", "ip", "ip_options", "ip_sum", "ip_others",
        "fragment", "protocol", "stranger", "udp", "port", "empty", "too_long", "udp_sum"};
    return cause < NET_DROPS ? text[cause] : "?";
}

int net_address(const char *text, uint32_t *ip)
{
    uint32_t all_of = 0;
    for (unsigned part = 0; part < 4; part++) {
        unsigned value = 0, digits = 0;
        for (; *text >= '0' && *text <= '9' && digits < 4; text++, digits++) {
            value = value * 10 + (unsigned)(*text - '0');
        }
        if (digits == 0 || digits > 3 || value > 255 || *text != (part < 3 ? '.' : '\0')) {
            return -1;
        }
        text += part < 3;
        all_of = all_of << 8 | value;
    }
    if (all_of >> 24 == 0 || all_of >> 24 == 127 || all_of >> 24 >= 224) { return -1; }
    *ip = all_of;
    return 0;
}
