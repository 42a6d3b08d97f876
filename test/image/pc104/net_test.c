/* SPDX-License-Identifier: MIT */
/* Frames taken and made: by examples byte for byte, every cause of a drop, and anything at all. */
#include "check.h"
#include "frames.h"

#include "pc104/net.h"

#define OUR_IP  0x0A000002u
#define PEER_IP 0x0A000001u
#define MS      1000u

static const struct net_cfg cfg = {{0x52, 0x54, 0, 1, 2, 3}, OUR_IP, PEER_IP, 4747, 256};
static struct frames peer = {
    1, {{0x52, 0x54, 0, 1, 2, 3}, OUR_IP, PEER_IP, 4747, 256}, {2, 0, 0, 0, 0, 9}};
static struct net net;
static uint8_t frame[FRAMES_MAX_B], sent[NET_FRAME_B];
static const uint8_t *at;
static size_t payload_B;

static enum net_take take_at(size_t n, uint32_t now_us)
{
    return net_take(&net, frame, n, now_us, &at, &payload_B);
}

static enum net_take take(size_t n) { return take_at(n, 0); }

static void fresh(void)
{
    net_open(&net, &cfg);
    memset(frame, 0xEE, sizeof frame);
}

/* Asked and answered: the peer is known from here on. */
static void meet(void)
{
    fresh();
    CHECK_EQ_I64((int64_t)net_ask(&net, sent, 0), NET_ARP_B);
    CHECK_EQ_I64(take(frames_arp(&peer, frame, 2)), NET_NOTHING);
    CHECK(net.known && net.counts.arp_heard == 1, "heard %" PRIu32, net.counts.arp_heard);
}

static void dropped_at(size_t n, uint32_t now_us, enum net_drop why)
{
    const uint32_t before = net.counts.drop[why], frames = net.counts.frames;
    const enum net_take got = take_at(n, now_us);
    CHECK(
        got == NET_NOTHING && net.counts.drop[why] == before + 1 && net.counts.frames == frames + 1,
        "%s: %d", net_drop_text(why), got);
    CHECK(at == NULL && payload_B == 0, "%s: hands over", net_drop_text(why));
}

static void dropped(size_t n, enum net_drop why) { dropped_at(n, 0, why); }

/* ---- worked examples: written down by hand, sums by hand ----------------------------- */

static const uint8_t hello[] = {0x52, 0x54, 0x00, 0x01, 0x02, 0x03, 0x02, 0x00, 0x00, 0x00, 0x00,
    0x09, 0x08, 0x00, /* Ethernet
                       */
    0x45, 0x00, 0x00, 0x1F, 0x00, 0x00, 0x40, 0x00, 0x40, 0x11, 0x26, 0xCC, 0x0A, 0x00, 0x00, 0x01,
    0x0A, 0x00, 0x00, 0x02,                         /* IPv4: 31 bytes, do not fragment, UDP */
    0x12, 0x8B, 0x12, 0x8B, 0x00, 0x0B, 0x02, 0x5D, /* UDP: 4747 to 4747, 11 bytes */
    0x61, 0x62, 0x63};                              /* abc */

TEST(a_datagram_by_example)
{
    fresh();
    memcpy(frame, hello, sizeof hello);
    CHECK_EQ_I64(take(sizeof hello), NET_DATAGRAM);
    CHECK(at == frame + 42 && payload_B == 3, "%zu bytes", payload_B);
    CHECK_EQ_I64(take(60), NET_DATAGRAM); /* filled up by the cable */
    CHECK_EQ_I64((int64_t)payload_B, 3);
    frame[40] = frame[41] = 0; /* without a sum */
    CHECK_EQ_I64(take(sizeof hello), NET_DATAGRAM);
    CHECK_EQ_I64(net.counts.datagrams, 3);
}

/* The same bytes the other way round. */
TEST(a_datagram_is_made_as_in_the_example)
{
    struct net other;
    struct net_cfg theirs = {{2, 0, 0, 0, 0, 9}, PEER_IP, OUR_IP, 4747, 256};
    const struct frames us = {1, theirs, {0x52, 0x54, 0, 1, 2, 3}};
    net_open(&other, &theirs);
    CHECK_EQ_I64((int64_t)net_datagram(&other, sent, 4747, "abc", 3), 0); /* knows no peer */
    CHECK_EQ_I64((int64_t)net_ask(&other, sent, 0), NET_ARP_B);
    (void)net_take(&other, frame, frames_arp(&us, frame, 2), 0, &at, &payload_B);
    CHECK_EQ_I64((int64_t)net_datagram(&other, sent, 4747, "abc", 3), (int64_t)sizeof hello);
    CHECK(memcmp(sent, hello, sizeof hello) == 0, "another frame");
    CHECK_EQ_I64((int64_t)net_datagram(&other, sent, 4748, "abc", 3), (int64_t)sizeof hello);
    CHECK(sent[37] == 0x8C && sent[19] == 1, "port %u, id %u", sent[37], sent[19]);
    CHECK_EQ_I64((int64_t)net_datagram(&other, sent, 1, frame, NET_PAYLOAD_B), NET_FRAME_B);
    CHECK_EQ_I64((int64_t)net_datagram(&other, sent, 1, frame, NET_PAYLOAD_B + 1), 0);
}

TEST(arp_by_example)
{
    static const uint8_t ask[] = {255, 255, 255, 255, 255, 255, 0x52, 0x54, 0, 1, 2, 3, 8, 6, 0, 1,
        8, 0, 6, 4, 0, 1, 0x52, 0x54, 0, 1, 2, 3, 10, 0, 0, 2, 0, 0, 0, 0, 0, 0, 10, 0, 0, 1};
    static const uint8_t answer[] = {2, 0, 0, 0, 0, 9, 0x52, 0x54, 0, 1, 2, 3, 8, 6, 0, 1, 8, 0, 6,
        4, 0, 2, 0x52, 0x54, 0, 1, 2, 3, 10, 0, 0, 2, 2, 0, 0, 0, 0, 9, 10, 0, 0, 1};
    fresh();
    CHECK_EQ_I64((int64_t)net_ask(&net, sent, 0), (int64_t)sizeof ask);
    CHECK(memcmp(sent, ask, sizeof ask) == 0, "asks otherwise");
    CHECK_EQ_I64(take(frames_arp(&peer, frame, 1)), NET_ANSWER);
    CHECK_EQ_I64((int64_t)net_answer(&net, sent), (int64_t)sizeof answer);
    CHECK(memcmp(sent, answer, sizeof answer) == 0, "answers otherwise");
    CHECK(!net.known, "a question says nothing of where the peer is");
}

/* ---- ARP ---------------------------------------------------------------------------- */

TEST(only_an_answer_that_was_asked_for_is_believed)
{
    struct frames thief = peer;
    thief.mac[5] = 66;
    fresh();
    dropped(frames_arp(&peer, frame, 2), NET_ARP_UNASKED);
    CHECK(!net.known, "known");
    meet();
    dropped(frames_arp(&thief, frame, 2), NET_ARP_UNASKED);
    CHECK_EQ_I64(net.peer_mac[5], 9);
    CHECK_EQ_I64((int64_t)net_ask(&net, sent, 1000 * MS), NET_ARP_B);
    thief.to.peer_ip += 5; /* another host answers */
    dropped_at(frames_arp(&thief, frame, 2), 1001 * MS, NET_ARP_UNASKED);
    thief.to.peer_ip -= 5;
    (void)frames_arp(&thief, frame, 2);
    frame[0] = frame[1] = frame[2] = frame[3] = frame[4] = frame[5] = 255; /* to all */
    dropped_at(60, 1001 * MS, NET_ARP_UNASKED);
    CHECK_EQ_I64(net.peer_mac[5], 9);
}

/* Not for ever: it ends with a datagram of the peer's own card, and after a second. */
TEST(a_question_does_not_stay_open)
{
    struct frames thief = peer;
    thief.mac[5] = 66;
    meet();
    CHECK_EQ_I64((int64_t)net_ask(&net, sent, 1000 * MS), NET_ARP_B);
    CHECK_EQ_I64(take_at(frames_datagram(&peer, frame, "x", 1), 1001 * MS), NET_DATAGRAM);
    CHECK_EQ_I64((int64_t)net_ask(&net, sent, 1500 * MS), 0);
    dropped_at(frames_arp(&thief, frame, 2), 1501 * MS, NET_ARP_UNASKED);
    CHECK_EQ_I64(net.peer_mac[5], 9);
    CHECK_EQ_I64((int64_t)net_ask(&net, sent, 2100 * MS), NET_ARP_B);
    CHECK_EQ_I64(take_at(frames_datagram(&thief, frame, "x", 1), 2101 * MS), NET_DATAGRAM);
    dropped_at(frames_arp(&thief, frame, 2), 3100 * MS + 1, NET_ARP_UNASKED); /* too late */
    CHECK_EQ_I64((int64_t)net_ask(&net, sent, 3200 * MS), NET_ARP_B);
    CHECK_EQ_I64(take_at(frames_arp(&peer, frame, 2), 4200 * MS), NET_NOTHING);
    CHECK_EQ_I64(net.counts.arp_heard, 2);
}

TEST(it_asks_quickly_then_slowly_and_again_when_nothing_is_heard)
{
    unsigned asks = 0;
    fresh();
    for (uint32_t t = 0; t < 10000; t++) { asks += net_ask(&net, sent, t * MS) > 0; }
    CHECK_EQ_I64(asks, 20 + 8); /* at 0, 100, .. 1900 ms, then 2900, .. 9900 */
    meet();
    for (uint32_t t = 0; t < 1000; t++) {
        CHECK_EQ_I64((int64_t)net_ask(&net, sent, t * MS), 0); /* heard just now */
    }
    (void)take_at(frames_datagram(&peer, frame, "x", 1), 900 * MS);
    CHECK_EQ_I64((int64_t)net_ask(&net, sent, 1800 * MS), 0);
    CHECK_EQ_I64((int64_t)net_ask(&net, sent, 1900 * MS), NET_ARP_B);
    CHECK_EQ_I64((int64_t)net_ask(&net, sent, 2899 * MS), 0);
    CHECK(net_datagram(&net, sent, 1, "x", 1) > 0, "forgets the peer while it asks");
}

TEST(a_new_card_of_the_peer_is_found_by_asking)
{
    struct frames anew = peer;
    anew.mac[5] = 10;
    meet();
    CHECK_EQ_I64((int64_t)net_ask(&net, sent, 1000 * MS), NET_ARP_B);
    CHECK_EQ_I64(take_at(frames_arp(&anew, frame, 2), 1001 * MS), NET_NOTHING);
    CHECK_EQ_I64(net.peer_mac[5], 10);
}

TEST(arp_that_cannot_be_is_dropped)
{
    static const struct {
        uint8_t at, value;
    } wrong[] = {
        {15, 2}, {16, 9}, {18, 5}, {19, 6}, {21, 3}, {21, 0}, {22, 1}, {22, 0xFF}, {11, 8}};
    struct frames odd = peer;
    fresh();
    for (unsigned i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        (void)frames_arp(&peer, frame, 1);
        frame[wrong[i].at] = wrong[i].value;
        dropped(60, NET_ARP);
    }
    memset(odd.mac, 0, 6);
    dropped(frames_arp(&odd, frame, 1), NET_ARP);
    (void)frames_arp(&peer, frame, 1);
    dropped(41, NET_SHORT);
    frame[41]++;
    dropped(42, NET_ARP_OTHERS);
    odd = peer;
    odd.to.peer_ip = OUR_IP;
    dropped(frames_arp(&odd, frame, 1), NET_ARP_CONFLICT);
    odd = peer;
    memcpy(odd.mac, cfg.mac, 6);
    dropped(frames_arp(&odd, frame, 1), NET_ARP_CONFLICT); /* a cable in a circle */
}

/* ---- IPv4 and UDP -------------------------------------------------------------------- */

/* One byte of a whole datagram, sums put right or not. */
static void bent(unsigned where, unsigned value, int right, enum net_drop why)
{
    const size_t n = frames_datagram(&peer, frame, "abcdef", 6);
    frame[where] = (uint8_t)value;
    if (right) { frames_sums(frame, n); }
    dropped(n, why);
}

TEST(every_cause_of_a_drop)
{
    size_t n;
    fresh();
    for (n = 0; n < 14; n++) { dropped(n, NET_SHORT); }
    bent(5, 4, 1, NET_OTHERS);
    bent(0, 0x53, 1, NET_OTHERS); /* a group's */
    bent(13, 1, 1, NET_TYPE);
    bent(12, 0x81, 1, NET_TYPE);
    bent(14, 0x65, 1, NET_IP);
    bent(14, 0x44, 1, NET_IP);
    bent(17, 35, 1, NET_IP); /* longer than the frame */
    bent(17, 19, 1, NET_IP);
    bent(16, 0xFF, 1, NET_IP);
    bent(14, 0x46, 1, NET_IP_OPTIONS);
    bent(25, frame[25] ^ 1, 0, NET_IP_SUM);
    bent(22, 63, 0, NET_IP_SUM);
    bent(33, 3, 1, NET_IP_OTHERS);
    bent(33, 255, 1, NET_IP_OTHERS); /* to all of the net */
    bent(20, 0x20, 1, NET_FRAGMENT);
    bent(21, 1, 1, NET_FRAGMENT);
    bent(20, 0x80, 1, NET_FRAGMENT);
    bent(23, 1, 1, NET_PROTOCOL);
    bent(23, 6, 1, NET_PROTOCOL);
    bent(29, 9, 1, NET_STRANGER);
    bent(39, 7, 1, NET_UDP);
    bent(39, 13, 1, NET_UDP);
    bent(39, 15, 0, NET_UDP);
    bent(44, 'z', 0, NET_UDP_SUM);
    bent(41, frame[41] ^ 1, 0, NET_UDP_SUM);
    bent(37, 0x8C, 1, NET_PORT);
    bent(35, 0x8C, 1, NET_PORT);
    dropped(frames_datagram(&peer, frame, "", 0), NET_EMPTY);
    CHECK_EQ_I64(take(frames_datagram(&peer, frame, sent, 256)), NET_DATAGRAM);
    dropped(frames_datagram(&peer, frame, sent, 257), NET_TOO_LONG);
    n = frames_datagram(&peer, frame, "abc", 3);
    dropped(33, NET_SHORT);
    dropped(NET_FRAME_B + 1, NET_LONG);
    CHECK_EQ_I64(take(NET_FRAME_B), NET_DATAGRAM);
    memset(frame, 255, 6);
    dropped(n, NET_OTHERS); /* to all: only ARP is */
    for (unsigned k = 0; k < NET_DROPS; k++) {
        CHECK(net_drop_text((enum net_drop)k)[0] != '?', "cause %u has no name", k);
    }
}

/* IPv4 with no room for UDP, and a length that ends before it. */
TEST(no_room_for_udp)
{
    fresh();
    for (unsigned length = 20; length < 28; length++) {
        (void)frames_datagram(&peer, frame, "abcdef", 6);
        frame[17] = (uint8_t)length;
        frames_sums(frame, 48);
        dropped(48, NET_UDP);
        dropped(14 + length, NET_UDP);
        dropped(14 + length - 1, length == 20 ? NET_SHORT : NET_IP);
    }
}

/* ---- anything ----------------------------------------------------------------------- */

static uint64_t counted(const struct net_counts *c)
{
    uint64_t n = (uint64_t)c->datagrams + c->arp_asked + c->arp_heard;
    for (unsigned i = 0; i < NET_DROPS; i++) { n += c->drop[i]; }
    return n;
}

/* In a block of exactly its size, so that a read beyond its end is seen. */
TEST(whatever_comes_is_counted_once_and_never_read_beyond_its_end)
{
    static uint8_t block[FRAMES_MAX_B];
    unsigned causes = 0;
    struct frames f = peer;
    fresh();
    for (unsigned i = 0; i < 300000; i++) {
        const size_t n = frames_bad(&f, frame);
        uint8_t *const end = block + sizeof block - n;
        enum net_take got;
        memcpy(end, frame, n);
        got = net_take(&net, end, n, i * 100, &at, &payload_B);
        CHECK((got == NET_DATAGRAM) == (at != NULL), "frame %u: %d", i, got);
        CHECK(got != NET_DATAGRAM ||
                  (at == end + 42 && payload_B > 0 && payload_B <= 256 && 42 + payload_B <= n),
            "frame %u: %zu of %zu bytes", i, payload_B, n);
        if (got == NET_ANSWER) { CHECK_EQ_I64((int64_t)net_answer(&net, sent), NET_ARP_B); }
        (void)net_ask(&net, sent, i * 100);
    }
    CHECK_EQ_I64(net.counts.frames, 300000);
    CHECK_EQ_I64((int64_t)counted(&net.counts), 300000);
    for (unsigned k = 0; k < NET_DROPS; k++) {
        causes += net.counts.drop[k] > 0;
        if (net.counts.drop[k] == 0) {
            check_note("never dropped: %s", net_drop_text((enum net_drop)k));
        }
    }
    CHECK_EQ_I64(causes, NET_DROPS);
}

TEST(what_we_make_a_peer_like_us_takes)
{
    struct frames f = peer;
    struct net other;
    const struct net_cfg theirs = {{2, 0, 0, 0, 0, 9}, PEER_IP, OUR_IP, 4747, NET_PAYLOAD_B};
    meet();
    net_open(&other, &theirs);
    for (size_t n = 1; n <= NET_PAYLOAD_B; n++) {
        uint8_t payload[NET_PAYLOAD_B];
        size_t len;
        for (size_t i = 0; i < n; i++) { payload[i] = (uint8_t)frames_u64(&f); }
        len = net_datagram(&net, sent, 4747, payload, n);
        CHECK_EQ_I64(net_take(&other, sent, len, 0, &at, &payload_B), NET_DATAGRAM);
        CHECK(payload_B == n && memcmp(at, payload, n) == 0, "%zu bytes", n);
    }
}

/* A sum of ones alone must be written as all ones: zero would say that there is none. */
TEST(a_sum_of_zero_is_written_as_all_ones)
{
    meet();
    for (unsigned v = 0; v < 65536; v++) {
        const uint8_t payload[] = {(uint8_t)(v >> 8), (uint8_t)v};
        (void)net_datagram(&net, sent, 4747, payload, 2);
        CHECK(sent[40] | sent[41], "no sum for %u", v);
    }
}

TEST(addresses)
{
    static const char *const bad[] = {"", "1", "1.2.3", "1.2.3.4.5", "1.2.3.", "1..2.3",
        "1.2.3.256", "1.2.3.4 ", "0.1.2.3", "127.0.0.1", "224.0.0.1", "255.255.255.255",
        "1.2.3.0004", "-1.2.3.4", "1.2.3.4x", "a.b.c.d"};
    uint32_t ip = 7;
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        CHECK(net_address(bad[i], &ip) < 0 && ip == 7, "\"%s\" is taken", bad[i]);
    }
    CHECK_EQ_I64(net_address("192.168.0.1", &ip), 0);
    CHECK_EQ_I64(ip, 0xC0A80001);
    CHECK_EQ_I64(net_address("10.0.2.255", &ip), 0);
    CHECK_EQ_I64(ip, 0x0A0002FF);
}

TEST_MAIN("net", a_datagram_by_example, a_datagram_is_made_as_in_the_example, arp_by_example,
    only_an_answer_that_was_asked_for_is_believed, a_question_does_not_stay_open,
    it_asks_quickly_then_slowly_and_again_when_nothing_is_heard,
    a_new_card_of_the_peer_is_found_by_asking, arp_that_cannot_be_is_dropped, every_cause_of_a_drop,
    no_room_for_udp, whatever_comes_is_counted_once_and_never_read_beyond_its_end,
    what_we_make_a_peer_like_us_takes, a_sum_of_zero_is_written_as_all_ones, addresses);
