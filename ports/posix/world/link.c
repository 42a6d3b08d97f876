/* SPDX-License-Identifier: MIT */
#include "link_part.h"

#include "exhand/exhand.h"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define HELLO_EVERY_US 500000
#define QUIET_US       1000000 /* silence after which any HELLO starts a session */
#define BURST          64      /* datagrams taken a frame, at most: a flood can't hold a frame up */

/* Splits "[HOST:]PORT"; host is "" if missing. */
static int part(const char *text, char host[128], char port[16])
{
    const char *colon = strrchr(text, ':');
    const size_t len = colon ? (size_t)(colon - text) : 0;
    if (len >= 128 || strlen(colon ? colon + 1 : text) >= 16) { return 1; }
    memcpy(host, text, len);
    host[len] = '\0';
    strcpy(port, colon ? colon + 1 : text);
    return port[0] == '\0';
}

static int look_up(const char *text, const char *host_if_none, int passive, struct addrinfo **to,
    char *error, size_t error_B)
{
    const struct addrinfo want = {.ai_socktype = SOCK_DGRAM, .ai_flags = passive ? AI_PASSIVE : 0};
    char host[128], port[16];
    int err;
    if (part(text, host, port)) {
        snprintf(
            error, error_B, "%.60s: give it as ADDRESS:PORT, such as 127.0.0.1:" LINK_PORT, text);
        return 1;
    }
    err = getaddrinfo(host[0] ? host : host_if_none, port, &want, to);
    if (err) {
        snprintf(error, error_B, "%.60s: %s: give it as ADDRESS:PORT", text, gai_strerror(err));
    }
    return err != 0;
}

static int open_socket(
    struct link *l, const char *listen, const struct addrinfo *peer, char *error, size_t error_B)
{
    struct addrinfo *own = NULL;
    const int family = peer ? peer->ai_family : AF_INET;
    if (listen && look_up(listen, "127.0.0.1", 1, &own, error, error_B)) { return 1; }
    l->fd = socket(own ? own->ai_family : family, SOCK_DGRAM, 0);
    if (l->fd < 0 || fcntl(l->fd, F_SETFL, O_NONBLOCK) != 0 ||
        (own && bind(l->fd, own->ai_addr, own->ai_addrlen) != 0)) {
        snprintf(error, error_B, "%.60s: %s: choose another address or port",
            listen ? listen : "socket", strerror(errno));
        freeaddrinfo(own);
        return 1;
    }
    if (own) { freeaddrinfo(own); }
    return 0;
}

int link_open(struct link *l, const char *listen, const char *peer, uint32_t session, char *error,
    size_t error_B)
{
    struct addrinfo *to = NULL;
    int bad;
    memset(l, 0, sizeof *l);
    l->fd = -1;
    l->tx.session = session;
    l->hello_us = -HELLO_EVERY_US;
    if (peer && look_up(peer, "127.0.0.1", 0, &to, error, error_B)) { return 1; }
    bad = open_socket(l, listen, to, error, error_B);
    if (!bad && to) {
        memcpy(&l->peer, to->ai_addr, to->ai_addrlen);
        l->peer_B = to->ai_addrlen;
        l->fixed = 1;
    }
    if (to) { freeaddrinfo(to); }
    return bad;
}

void link_close(struct link *l)
{
    if (l->fd >= 0) { close(l->fd); }
    l->fd = -1;
}

void link_key(struct link *l, const struct exh_mac_key *key, uint64_t start)
{
    exh_keyed_setup(&l->keyed, key, EXH_WIRE_WORLD, start);
    l->has_key = 1;
}

static int same_peer(const struct sockaddr_storage *a, const struct sockaddr_storage *b)
{
    const struct sockaddr_in *a4 = (const void *)a, *b4 = (const void *)b;
    const struct sockaddr_in6 *a6 = (const void *)a, *b6 = (const void *)b;
    if (a->ss_family != b->ss_family) { return 0; }
    if (a->ss_family == AF_INET) {
        return a4->sin_port == b4->sin_port && a4->sin_addr.s_addr == b4->sin_addr.s_addr;
    }
    return a6->sin6_port == b6->sin6_port &&
           memcmp(&a6->sin6_addr, &b6->sin6_addr, sizeof a6->sin6_addr) == 0;
}

static struct exh_wire_hello hello_of_ours(const struct link *l)
{
    const struct exh_wire_hello h = {
        .role = EXH_WIRE_WORLD, .lib_version = EXH_VERSION_NUMBER, .table_crc = l->table_crc};
    return h;
}

static void take_hello(struct link *l, const struct exh_wire_hello *theirs)
{
    const struct exh_wire_hello ours = hello_of_ours(l);
    l->theirs = *theirs;
    l->differs = exh_wire_compare(&ours, theirs);
    l->odd += l->differs != 0;
    l->hello_us = -HELLO_EVERY_US; /* it is new here: answer */
}

/* It has just begun: what is odd about it. */
static void say_what_differs(const struct link *l)
{
    const struct exh_wire_hello ours = hello_of_ours(l);
    char text[200];
    if (l->say == NULL) { return; }
    if (l->differs & EXH_WIRE_ROLE) {
        l->say("the peer is a world, too: give the address of a controller");
    }
    if (l->differs & EXH_WIRE_LIB) {
        snprintf(text, sizeof text,
            "the controller has version %#lx of the library, this world %#lx: build both of one",
            (unsigned long)l->theirs.lib_version, (unsigned long)ours.lib_version);
        l->say(text);
    }
    if (l->differs & EXH_WIRE_TABLE) {
        snprintf(text, sizeof text,
            "the controller's table of parameters is %08lx, this world's %08lx: build both of one",
            (unsigned long)l->theirs.table_crc, (unsigned long)ours.table_crc);
        l->say(text);
    }
}

/* Once each: packets come, and the keys do not fit. */
static void say_misfit(struct link *l)
{
    const struct {
        uint32_t n;
        const char *text;
    } what[] = {
        {l->keyed.no_key, "--key: packets come without a key: start the controller with --key, or "
                          "leave --key out here"},
        {l->keyed.other_key, "--key: packets come with another key: give both the same file"},
        {l->has_key ? 0 : l->rx.version,
            "packets come of another version, or with a key: build both of one source, or give "
            "--key"}};
    for (unsigned i = 0; i < sizeof what / sizeof what[0]; i++) {
        if (what[i].n == 0 || l->misfits >> i & 1) { continue; }
        l->misfits |= 1u << i;
        if (l->say) { l->say(what[i].text); }
    }
}

static void answer_to(struct link *l, const struct sockaddr_storage *from, socklen_t from_B)
{
    l->peer = *from;
    l->peer_B = from_B;
}

/* With a key; > 0: bytes to pass on. A sender with the key that starts is answered while no other
 * is accepted; otherwise neither end could start. */
static int32_t opened(struct link *l, const unsigned char *buf, ssize_t n,
    const struct sockaddr_storage *from, socklen_t from_B)
{
    const int32_t r = exh_keyed_decode(&l->keyed, buf, (size_t)n);
    if (r == 0 && (l->rx.session == 0 || l->rx.open)) { answer_to(l, from, from_B); }
    return r;
}

static void let_pass(struct link *l, int64_t now_us)
{
    const int64_t us = now_us - l->heard_us;
    const uint32_t passed_us = us < 0 ? 0 : us < UINT32_MAX ? (uint32_t)us : UINT32_MAX;
    (void)exh_wire_poll(&l->rx, passed_us, QUIET_US);
    l->heard_us = now_us;
}

int link_receive(struct link *l, struct exh_wire_state *state, int64_t now_us)
{
    int newer = 0;
    let_pass(l, now_us);
    for (int i = 0; i < BURST; i++) {
        unsigned char buf[2 * EXH_WIRE_MAX_B];
        struct sockaddr_storage from;
        socklen_t from_B = sizeof from;
        struct exh_wire_packet p;
        const uint32_t session = l->rx.session, was_open = l->rx.open;
        ssize_t n = recvfrom(l->fd, buf, sizeof buf, 0, (struct sockaddr *)&from, &from_B);
        if (n < 0) { break; }
        if (l->fixed && !same_peer(&from, &l->peer)) {
            l->strangers++;
            continue;
        }
        if (l->has_key) { n = opened(l, buf, n, &from, from_B); }
        if (l->has_key && n <= 0) { continue; }
        if (exh_wire_decode(&l->rx, &p, buf, (size_t)n) <= 0) { continue; }
        answer_to(l, &from, from_B);
        if (p.type == EXH_WIRE_HELLO) { take_hello(l, &p.u.hello); }
        if (l->rx.session != session || (p.type == EXH_WIRE_HELLO && was_open)) {
            say_what_differs(l);
            link_params_anew(l, now_us);
            link_trace_anew(l, now_us);
        }
        if (p.type == EXH_WIRE_ACK) { link_params_answered(l, &p.u.ack); }
        if (p.type == EXH_WIRE_TRACE) { link_trace_take(l, &p.u.trace); }
        if (p.type != EXH_WIRE_STATE) { continue; }
        *state = p.u.state;
        l->echo_seq = p.seq;
        l->echo_stamp_us = p.stamp_us;
        newer = 1;
    }
    say_misfit(l);
    return newer;
}

void link_answer(struct link *l, const struct exh_wire_planes *planes, int64_t now_us)
{
    struct exh_wire_packet p;
    if (l->peer_B == 0) { return; }
    memset(&p, 0, sizeof p);
    if (now_us - l->hello_us >= HELLO_EVERY_US) {
        p.type = EXH_WIRE_HELLO;
        p.u.hello = hello_of_ours(l);
        link_put(l, &p, now_us);
        l->hello_us = now_us;
    }
    if (l->rx.session == 0) { return; }
    link_params_ask(l, now_us);
    link_trace_ask(l, now_us);
    if (planes == NULL) { return; }
    p.type = EXH_WIRE_PLANES;
    p.u.planes = *planes;
    link_params_hide(l, &p.u.planes, now_us);
    p.u.planes.echo_seq = l->echo_seq;
    p.u.planes.echo_stamp_us = l->echo_stamp_us;
    link_put(l, &p, now_us);
}
