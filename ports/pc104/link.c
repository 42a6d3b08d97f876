/* SPDX-License-Identifier: MIT */
/* The link of a scene and a way out for its log, as UDP over the network card. Without ip= there
 * is none, and none is looked for. Frames are taken once a tick, behind its outputs, and no more
 * than IN_A_TICK of them: what a flood leaves is dropped by the card. */
#include "pc104.h"

#include "io.h"
#include "net.h"
#include "nic.h"
#include "exhand/run/stream.h"
#include "exhand/keyed.h"

#include "cards/io.h"
#include "cards/wait.h"

#include "exhand/error.h"

#include <string.h>

#define IN_A_TICK 12u
#define QUEUE     16u /* datagrams that wait for the scene: a power of two */
#define PORT      4747
#define LOG_PORT  4748
#define CABLE_US  4000000u /* both sides agree on a speed */
#define PEER_US   1000000u
#define FLUSH_US  20000u
#define CLOCK_AT  0x70 /* register number, then data (MC146818) */

static struct {
    uint32_t ip, peer;
    int32_t port, log_port;
} par = {.port = PORT, .log_port = LOG_PORT};

static struct exh_mac_key key;
static int has_key;
static struct exh_keyed keyed;
static struct net net;
static uint8_t mac[NET_MAC_B];
static uint8_t open, asked_for;
static struct {
    uint16_t len_B;
    uint8_t byte[EXH_SCENE_PACKET_B];
} queue[QUEUE];
static uint32_t put, got;
static uint32_t overrun, unsent; /* datagrams: no room here, no room in the card */
static uint32_t unanswered;      /* questions behind the first of their tick */

/* --- options --- */

static void refuse(const char *name, const char *value, const char *allowed)
{
    pc104_say("option ");
    pc104_say(name);
    pc104_say("=");
    pc104_say(value);
    pc104_say(": ");
    pc104_say(allowed);
    pc104_say("\n");
    pc104_halt(PC104_EXIT_OPTION, "option refused: nothing was started");
}

static void take_address(uint32_t *to, const char *name, const char *value)
{
    if (net_address(value, to) < 0) { refuse(name, value, "a host's address, as 10.0.0.2"); }
}

static void take_port(int32_t *to, const char *name, const char *value)
{
    if (pc104_number(value, 0, to) < 0 || *to < 1 || *to > 65535) {
        refuse(name, value, "allowed 1..65535");
    }
}

/* What was given is not said again, right or wrong. */
static void take_key(const char *value)
{
    uint8_t byte[EXH_MAC_KEY_B] = {0};
    unsigned n = 0;
    for (; value[n] && n < 2 * EXH_MAC_KEY_B; n++) {
        const char c = value[n], low = (char)(c | 0x20);
        const int digit = c >= '0' && c <= '9'       ? c - '0'
                          : low >= 'a' && low <= 'f' ? low - 'a' + 10
                                                     : -1;
        if (digit < 0) { break; }
        byte[n / 2] = (uint8_t)(byte[n / 2] << 4 | digit);
    }
    if (n != 2 * EXH_MAC_KEY_B || value[n]) {
        refuse("key", "(not shown)", "32 hexadecimal digits");
    }
    key = exh_mac_key(byte);
    has_key = 1;
}

int pc104_link_option(const char *name, const char *value)
{
    if (pc104_same_text(name, "ip")) {
        take_address(&par.ip, name, value);
    } else if (pc104_same_text(name, "peer")) {
        take_address(&par.peer, name, value);
    } else if (pc104_same_text(name, "port")) {
        take_port(&par.port, name, value);
    } else if (pc104_same_text(name, "log_port")) {
        take_port(&par.log_port, name, value);
    } else if (pc104_same_text(name, "key")) {
        take_key(value);
    } else {
        return 0;
    }
    return 1;
}

/* --- start --- */

static void check_options(void)
{
    if (par.peer == 0) { refuse("peer", "", "missing: whom to talk to"); }
    if (par.ip == 0) { refuse("ip", "", "missing: our own address"); }
    if (par.ip == par.peer) { refuse("peer", "", "the same as ip"); }
    if (par.port == par.log_port) { refuse("log_port", "", "the same as port"); }
}

static void ask(void)
{
    uint8_t *const to = pc104_nic_room();
    size_t n;
    if (to == NULL) { return; }
    n = net_ask(&net, to, exh_io_time_us());
    if (n > 0) { pc104_nic_send(n); }
}

/* While nothing moves yet: a cable takes seconds, and records would be lost. */
static void wait_for_peer(void)
{
    struct exh_wait cable = exh_wait_us(CABLE_US), answer = exh_wait_us(PEER_US);
    struct pc104_nic_counts c;
    do {
        pc104_nic_counts(&c);
    } while (!c.up && exh_wait_more(&cable));
    if (!c.up) {
        pc104_say("link: no cable yet: goes on without\n");
        return;
    }
    do {
        pc104_link_poll();
    } while (!net.known && exh_wait_more(&answer));
    pc104_say(
        net.known ? "link: the peer answers\n" : "link: the peer does not answer yet: goes on\n");
}

/* A field of the machine's clock, two decimal digits. */
static unsigned clock_field(uint8_t at)
{
    pc104_out8(CLOCK_AT, at);
    at = pc104_in8(CLOCK_AT + 1);
    return 10u * (at >> 4) + (at & 15u);
}

/* Seconds of the machine's clock, with months of 32 days: it goes on while the power is off. Each
 * is 2^26 numbers, more than a run sends: no start takes a number of another. */
static void open_key(void)
{
    static const struct {
        uint8_t at, values;
    } field[] = {{9, 100}, {8, 13}, {7, 32}, {4, 24}, {2, 60}, {0, 60}};
    uint64_t start = 0;
    for (unsigned i = 0; i < sizeof field / sizeof field[0]; i++) {
        start = start * field[i].values + clock_field(field[i].at);
    }
    exh_keyed_setup(&keyed, &key, EXH_WIRE_CONTROLLER, start << 26 | exh_board_cycles() >> 6);
    stream_key(&key);
    pc104_say("link: with a key\n");
}

void pc104_link_open(const struct exh_scene *sc)
{
    asked_for = par.ip != 0 || par.peer != 0;
    if (!asked_for) {
        if (pc104_par.log == PC104_LOG_UDP) { refuse("log", "udp", "needs ip= and peer="); }
        if (pc104_par.dump == PC104_LOG_UDP) { refuse("dump", "udp", "needs ip= and peer="); }
        if (sc->link) { pc104_say("link: none, as no ip= is given\n"); }
        return;
    }
    check_options();
    if (pc104_nic_open(mac) < 0) {
        pc104_say("link: none: the scene goes on as with a peer that is silent\n");
        return;
    }
    {
        struct net_cfg cfg = {.ip = par.ip,
            .peer_ip = par.peer,
            .port = (uint16_t)par.port,
            .longest_B = has_key ? EXH_KEYED_MAX_B : EXH_SCENE_PACKET_B};
        memcpy(cfg.mac, mac, sizeof cfg.mac);
        net_open(&net, &cfg);
    }
    open = 1;
    if (has_key) { open_key(); }
    stream_open(exh_board_cycles());
    wait_for_peer();
}

/* --- in --- */

/* What is newest says most of the peer: the oldest goes. */
static void keep(const uint8_t *at, size_t len_B)
{
    if (put - got == QUEUE) {
        overrun++;
        got++;
    }
    queue[put % QUEUE].len_B = (uint16_t)len_B;
    memcpy(queue[put % QUEUE].byte, at, len_B);
    put++;
}

static void answer(void)
{
    uint8_t *const to = pc104_nic_room();
    if (to == NULL) {
        unsent++;
        return;
    }
    pc104_nic_send(net_answer(&net, to));
}

/* One question is answered a tick: a flood of them leaves the transmit ring to the scene. */
static void take(const uint8_t *frame, size_t len_B, uint32_t now_us, unsigned *answers)
{
    const uint8_t *at;
    size_t n;
    const enum net_take what = net_take(&net, frame, len_B, now_us, &at, &n);
    if (what == NET_DATAGRAM && has_key) {
        const int32_t whole_B = exh_keyed_decode(&keyed, at, n);
        if (whole_B > 0) { keep(at, (size_t)whole_B); }
    } else if (what == NET_DATAGRAM) {
        keep(at, n);
    }
    if (what == NET_ANSWER && (*answers)++ == 0) { answer(); }
}

void pc104_link_poll(void)
{
    uint32_t now_us;
    unsigned answers = 0;
    if (!open) { return; }
    now_us = exh_io_time_us();
    for (unsigned i = 0; i < IN_A_TICK; i++) {
        const uint8_t *frame;
        const int n = pc104_nic_next(&frame);
        if (n == 0) { break; }
        if (n > 0) { take(frame, (size_t)n, now_us, &answers); }
        pc104_nic_done();
    }
    if (answers > 1) { unanswered += answers - 1; }
    pc104_nic_back();
    ask();
}

int exh_board_link_recv(void *buf, size_t cap_B)
{
    while (put != got) {
        const unsigned at = got++ % QUEUE;
        if (queue[at].len_B <= cap_B) {
            memcpy(buf, queue[at].byte, queue[at].len_B);
            return queue[at].len_B;
        }
    }
    return 0;
}

/* --- out --- */

static int send_to(uint16_t port, const void *buf, size_t len_B)
{
    uint8_t *const to = open ? pc104_nic_room() : NULL;
    const size_t n = to ? net_datagram(&net, to, port, buf, len_B) : 0;
    if (n == 0) { return 0; }
    pc104_nic_send(n);
    return 1;
}

int exh_board_link_send(const void *buf, size_t len_B)
{
    static uint8_t room[EXH_KEYED_MAX_B];
    size_t all_B = len_B;
    if (has_key && open && len_B <= EXH_SCENE_PACKET_B) {
        memcpy(room, buf, len_B);
        all_B = (size_t)exh_keyed_encode(&keyed, room, len_B, sizeof room);
        buf = room;
    }
    if (len_B > 0 && send_to((uint16_t)par.port, buf, all_B)) { return (int)len_B; }
    unsent += open;
    return 0;
}

int pc104_link_up(void) { return open; }

unsigned pc104_link_log(const uint8_t *byte, unsigned n, int now)
{
    static uint8_t piece[STREAM_PIECE_B];
    static uint32_t last_us;
    const uint32_t now_us = exh_io_time_us();
    if (!open || !net.known || (n < STREAM_DATA_B && !now && now_us - last_us < FLUSH_US)) {
        return 0;
    }
    n = n < STREAM_DATA_B ? n : STREAM_DATA_B;
    if (!send_to((uint16_t)par.log_port, piece, stream_piece(piece, byte, n, now > 1))) {
        return 0;
    }
    stream_sent(n);
    last_us = now_us;
    return n;
}

void pc104_link_log_new(void) { stream_open(exh_board_cycles()); }

/* --- what it costs --- */

/* The worst case with a key: each packet sent gets a tag, and each one received has a wrong tag. */
static void dry_key(void)
{
    static uint8_t longest[EXH_KEYED_MAX_B] = {
        [4] = (EXH_SCENE_PACKET_B - EXH_WIRE_OVERHEAD) & 0xFF};
    struct exh_keyed twin = keyed;
    for (unsigned i = 0; has_key && i < EXH_SCENE_PACKETS; i++) {
        (void)exh_keyed_encode(&twin, longest, EXH_SCENE_PACKET_B, sizeof longest);
    }
    twin.key.k[0]++;
    for (unsigned i = 0; has_key && i < IN_A_TICK; i++) {
        (void)exh_keyed_decode(&twin, longest, sizeof longest);
    }
}

/* As much as a tick can bring and take, for the clock: the longest datagrams that are taken, as
 * many as the scene sends. The card sees none of it. */
void pc104_link_dry(void)
{
    static struct net twin;
    static uint8_t frame[NET_FRAME_B];
    static const uint8_t longest[EXH_SCENE_PACKET_B];
    const struct net_cfg cfg = net.cfg;
    size_t n = 0;
    if (!open) { return; }
    net_open(&twin, &cfg);
    twin.known = 1; /* to ourselves */
    memcpy(twin.peer_mac, cfg.mac, sizeof twin.peer_mac);
    for (unsigned i = 0; i < EXH_SCENE_PACKETS; i++) {
        n = net_datagram(&twin, frame, cfg.port, longest, sizeof longest);
    }
    dry_key();
    twin.cfg.ip = cfg.peer_ip;
    twin.cfg.peer_ip = cfg.ip;
    got = put; /* room */
    for (unsigned i = 0; i < IN_A_TICK; i++) {
        const uint8_t *at;
        size_t payload_B;
        if (net_take(&twin, frame, n, 0, &at, &payload_B) == NET_DATAGRAM) { keep(at, payload_B); }
    }
    got = put; /* none of it reaches the scene */
}

/* --- report --- */

static void say_count(const char *what, const char *more, uint32_t n)
{
    if (n == 0) { return; }
    pc104_say(what);
    pc104_say(more);
    pc104_say(" ");
    pc104_say_u32(n);
    pc104_say("\n");
}

void pc104_link_report(void)
{
    struct pc104_nic_counts c;
    if (!open) { return; }
    pc104_nic_counts(&c);
    pc104_say(c.gone ? "nic gone\n" : c.up ? "" : "nic without a cable\n");
    say_count("nic ", "sent", c.sent);
    say_count("nic ", "damaged", c.damaged);
    say_count("nic ", "missed", c.missed);
    say_count("nic ", "crc", c.crc);
    say_count("link ", "frames", net.counts.frames);
    say_count("link ", "datagrams", net.counts.datagrams);
    say_count("link ", "arp_asked", net.counts.arp_asked);
    say_count("link ", "arp_heard", net.counts.arp_heard);
    for (unsigned i = 0; i < NET_DROPS; i++) {
        say_count("link drop_", net_drop_text((enum net_drop)i), net.counts.drop[i]);
    }
    say_count("link ", "arp_unanswered", unanswered);
    say_count("link ", "no_key", keyed.no_key);
    say_count("link ", "other_key", keyed.other_key);
    say_count("link ", "unproved", keyed.unproved);
    say_count("link ", "again", keyed.again);
    say_count("link ", "damaged", keyed.damaged);
    say_count("link ", "overrun", overrun);
    say_count("link ", "unsent", unsent);
    say_count("log ", "pieces", stream_pieces());
}
