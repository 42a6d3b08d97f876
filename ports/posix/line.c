/* SPDX-License-Identifier: MIT */
#include "line.h"

#include "udp.h"

#include "exhand/wire.h"

#include <math.h>
#include <string.h>

#define PUMP 64 /* datagrams taken a call, at most: a flood holds no tick up */

static struct {
    struct posix_line cfg;
    struct sim_link link;
    struct udp udp;
    int udp_open;
    uint64_t frames;
    struct exh_wire_rx rx; /* packets at the socket, for the sender check */
    double heard_s;
    struct exh_keyed keyed;
} line;

struct posix_line posix_line_default(void)
{
    struct posix_line c;
    memset(&c, 0, sizeof c);
    for (int k = 0; k < SIM_LINK_WAYS; k++) { c.way[k] = sim_link_default(); }
    return c;
}

void line_stop(void)
{
    if (line.udp_open) { udp_close(&line.udp); }
    line.udp_open = 0;
}

int line_start(const struct posix_line *cfg, uint64_t seed)
{
    line_stop();
    line.cfg = *cfg;
    line.frames = 0;
    memset(&line.rx, 0, sizeof line.rx);
    if (cfg->key) {
        exh_keyed_setup(&line.keyed, cfg->key, EXH_WIRE_CONTROLLER,
            line.keyed.next ? line.keyed.next : cfg->key_start);
    }
    line.heard_s = 0;
    if (!cfg->on) { return 0; }
    for (unsigned k = 0; k < SIM_LINK_WAYS; k++) {
        sim_link_start(&line.link.way[k], &cfg->way[k], cfg->trace[k],
            seed ^ UINT64_C(0xD1B54A32D192ED03) * (k + 1));
    }
    if (cfg->udp_local != NULL) {
        if (udp_open(&line.udp, cfg->udp_local, cfg->udp_peer) < 0) { return -1; }
        line.udp_open = 1;
    }
    return 0;
}

const struct exh_keyed *posix_line_keyed(void)
{
    return line.udp_open && line.cfg.key ? &line.keyed : NULL;
}

struct posix_line_drops posix_line_drops(void)
{
    const struct posix_line_drops none = {0, 0},
                                  some = {line.udp.strangers,
                                      line.udp.bad_length +
                                          line.link.way[SIM_LINK_IN].counts.too_long};
    return line.udp_open ? some : none;
}

struct sim_link *posix_link(void) { return &line.link; }

/* Answers go to the sender of the newest valid packet. A flood of others cannot redirect them. */
static void learn(const void *buf, size_t len_B)
{
    struct exh_wire_packet p;
    if (exh_wire_decode(&line.rx, &p, buf, len_B) > 0) { udp_learn(&line.udp); }
}

/* Checks a datagram on a socket with a key: > 0 bytes to pass on. A sender with the key that starts
 * is answered while no other is accepted; otherwise neither end could start. */
static int opened(const void *buf, int n)
{
    const int r = line.cfg.key ? (int)exh_keyed_decode(&line.keyed, buf, (size_t)n) : n;
    if (r == 0 && (line.rx.session == 0 || line.rx.open)) { udp_learn(&line.udp); }
    return r;
}

static void put(uint8_t *buf, int n, size_t cap_B)
{
    if (line.cfg.key) { n = (int)exh_keyed_encode(&line.keyed, buf, (size_t)n, cap_B); }
    (void)udp_send(&line.udp, buf, (size_t)n);
}

/* Between the ways and the socket. */
static void pump(double now_s)
{
    uint8_t buf[SIM_LINK_PACKET_B + EXH_KEYED_B];
    int n;
    (void)exh_wire_poll(
        &line.rx, (uint32_t)fmin(1e6 * (now_s - line.heard_s), 4e9), 1000u * EXH_WIRE_QUIET_MS);
    line.heard_s = now_s;
    while ((n = sim_link_recv(&line.link.way[SIM_LINK_OUT], now_s, buf, SIM_LINK_PACKET_B)) > 0) {
        put(buf, n, sizeof buf);
    }
    for (int k = 0; k < PUMP && (n = udp_recv(&line.udp, buf, sizeof buf)) > 0; k++) {
        n = opened(buf, n);
        if (n <= 0) { continue; }
        if (line.udp.learns) { learn(buf, (size_t)n); }
        (void)sim_link_send(&line.link.way[SIM_LINK_IN], now_s, buf, (size_t)n);
    }
}

/* When the peer is next called. */
static double frame_at_s(void)
{
    return line.cfg.frame_s > 0 ? line.cfg.frame_first_s + (double)line.frames * line.cfg.frame_s
                                : sim_link_next_s(&line.link.way[SIM_LINK_OUT]);
}

static void frame(double t_s)
{
    line.frames++;
    line.cfg.frame(line.cfg.ctx, &line.link, t_s);
    if (line.cfg.frame_s > 0) { return; }
    /* What it leaves would call it for ever: drop it all as too long. */
    (void)sim_link_take(&line.link.way[SIM_LINK_OUT], t_s, 0);
}

void line_advance(double now_s)
{
    if (!line.cfg.on) { return; }
    if (line.udp_open) {
        pump(now_s);
    } else if (line.cfg.frame != NULL) {
        double t_s;
        while ((t_s = frame_at_s()) <= now_s) { frame(t_s); }
    }
}

int line_send(double now_s, const void *buf, size_t len_B)
{
    int n;
    if (!line.cfg.on) { return 0; }
    n = sim_link_send(&line.link.way[SIM_LINK_OUT], now_s, buf, len_B);
    if (line.udp_open) { pump(now_s); }
    return n;
}

int line_recv(double now_s, void *buf, size_t cap_B)
{
    if (!line.cfg.on) { return 0; }
    if (line.udp_open) { pump(now_s); }
    return sim_link_recv(&line.link.way[SIM_LINK_IN], now_s, buf, cap_B);
}
