/* SPDX-License-Identifier: MIT */
/* Modbus over TCP or a serial line by libmodbus, which receives, frames and sends. The library
 * (exhand/modbus.h) defines registers and permissions. A request's registers are copied to
 * libmodbus's mapping before it answers, and exceptions are sent before it writes. Counts and
 * lengths are checked before, because libmodbus 3.1.6 deviates from the specification
 * (docs/MODBUS.md). So it does not wait for missing bytes, does not take the rest of one request
 * for the next, and does not discard requests after a bad one. */
#include "slave/libmodbus.h"

#include "slave/slave.h"

#include "base/option.h"
#include "base/thread.h"
#include "base/until.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <unistd.h>

#define CLIENTS   16
#define ADDRESS   1 /* on a serial line */
#define WAIT_MS   20
#define PATIENCE  2000 /* rounds, of a millisecond at least: for the rest of a request */
#define CRC_B     2
#define MBAP_B    7
#define PDU_MAX_B 253
#define WHERE_B   256
#define PORT      1502

struct client {
    int fd;
    int waits; /* rounds for the rest of a request */
};

static struct {
    modbus_t *ctx;
    int rtu, listener;
    int stop[2]; /* a pipe: closed, it ends the thread */
    struct client client[CLIENTS];
    struct place place[CLIENTS]; /* of the same */
    int clients;
    pthread_t thread;
    int serves;
} server = {.listener = -1, .stop = {-1, -1}};

/* --- TCP --- */

static void drop(int i)
{
    close(server.client[i].fd);
    server.client[i] = server.client[--server.clients];
    server.place[i] = server.place[server.clients];
}

/* One request of client i, if all of it is there: 1 answered, 0 not yet, -1 the connection ends. */
static int one_request(int i)
{
    struct client *c = &server.client[i];
    uint8_t req[MODBUS_MAX_ADU_LENGTH];
    struct request q = {server.ctx, req, MBAP_B, 0, 0, 0};
    const ssize_t got = recv(c->fd, req, sizeof req, MSG_PEEK | MSG_DONTWAIT);
    int len;
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) { return -1; }
    if (got < MBAP_B + 1) { return 0; }
    len = MBAP_B - 1 + (int)request_be16(req + 4);
    if (request_be16(req + 2) != 0 || len < MBAP_B + 1 || len > MBAP_B + PDU_MAX_B) { return -1; }
    if (got < len) { return 0; }
    c->waits = 0;
    server.place[i].asked = 1;
    server.place[i].heard_s = until_now_s();
    modbus_set_socket(server.ctx, c->fd);
    if (request_shape(req + MBAP_B, (unsigned)(len - MBAP_B)) !=
        0) { /* nothing that libmodbus could measure */
        if (recv(c->fd, req, (size_t)len, 0) != len) { return -1; }
    } else {
        memset(req, 0, sizeof req);
        if (modbus_receive(server.ctx, req) != len) { return -1; }
    }
    q.len_B = len;
    return request_answer(&q) < 0 ? -1 : 1;
}

/* Never blocking: an answer that a client does not fetch would hold up all others, and the end of
 * the program. */
static void accept_one(void)
{
    const int on = 1;
    struct sockaddr_in from = {.sin_family = AF_INET};
    socklen_t len = sizeof from;
    const double now_s = until_now_s();
    int fd = accept(server.listener, (struct sockaddr *)&from, &len), out;
    if (fd < 0) { return; }
    if (fd >= FD_SETSIZE ||
        fcntl(fd, F_SETFL, O_NONBLOCK) < 0) { /* libmodbus would write beyond its set */
        close(fd);
        return;
    }
    (void)setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (server.clients == CLIENTS) {
        out = place_to_clear(server.place, CLIENTS, from.sin_addr.s_addr, now_s);
        if (out < 0) {
            close(fd);
            return;
        }
        drop(out);
    }
    server.place[server.clients] = (struct place){from.sin_addr.s_addr, 0, now_s};
    server.client[server.clients++] = (struct client){fd, 0};
}

/* In turn, one request each, so that none keeps the others waiting. */
static void serve_clients(const struct pollfd *f)
{
    for (int i = server.clients - 1; i >= 0; i--) {
        struct client *c = &server.client[i];
        int did = f[i].revents ? one_request(i) : 0;
        if (did == 0 && f[i].revents) { c->waits++; }
        if (did < 0 || c->waits > PATIENCE) { drop(i); }
    }
}

static void *serve_tcp(void *unused)
{
    struct pollfd f[CLIENTS + 2];
    (void)unused;
    for (;;) {
        int partial = 0, n = server.clients;
        for (int i = 0; i < n; i++) {
            f[i] = (struct pollfd){server.client[i].fd, POLLIN, 0};
            partial |= server.client[i].waits > 0;
        }
        f[n] = (struct pollfd){server.listener, POLLIN, 0};
        f[n + 1] = (struct pollfd){server.stop[0], POLLIN, 0};
        if (partial) { (void)poll(NULL, 0, 1); } /* the rest of a request wakes no thread */
        (void)poll(f, (nfds_t)n + 2, WAIT_MS);
        if (f[n + 1].revents) { return NULL; }
        serve_clients(f);
        if (f[n].revents) { accept_one(); }
        mail_save();
    }
}

/* --- a serial line --- */

static int told_to_stop(void)
{
    struct pollfd f = {server.stop[0], POLLIN, 0};
    return poll(&f, 1, 0) > 0;
}

static void *serve_rtu(void *unused)
{
    (void)unused;
    while (!told_to_stop()) {
        uint8_t req[MODBUS_MAX_ADU_LENGTH] = {0};
        const int len = modbus_receive(server.ctx, req);
        if (len >= 2 + CRC_B) { /* of a broadcast, writes are executed without a response */
            const int all = req[0] == MODBUS_BROADCAST_ADDRESS;
            if (!all ||
                (req[1] != 1 && req[1] != 2 && req[1] != 3 && req[1] != 4 && req[1] != 23)) {
                struct request q = {server.ctx, req, 1, len - CRC_B, CRC_B, all};
                (void)request_answer(&q);
            }
        } else if (len < 0 && errno != ETIMEDOUT) {
            const int damaged = errno == EMBBADCRC;
            (void)modbus_flush(server.ctx);
            if (!damaged) { (void)poll(NULL, 0, WAIT_MS); } /* a closed line fails immediately */
        }
        mail_save();
    }
    return NULL;
}

/* --- opening --- */

static int complain(const char *where, const char *what, const char *advice)
{
    cli_complain("--modbus: %s: %s: %s", where, what, advice);
    return 3;
}

static int bad(const char *where)
{
    cli_complain("--modbus: %s: give tcp:ADDRESS:PORT (as tcp:127.0.0.1:%d; this machine's, a port "
                 "0..65535) or "
                 "rtu:DEVICE:BAUD (as rtu:/dev/ttyUSB0:115200; 300..4000000)",
        where, PORT);
    return 2;
}

long modbus_cut_number(char *text, long most)
{
    char *colon = strrchr(text, ':'), *end;
    long v;
    if (colon == NULL || colon[1] < '0' || colon[1] > '9') { return -1; }
    v = strtol(colon + 1, &end, 10);
    *colon = '\0';
    return *end == '\0' && v <= most ? v : -1;
}

static int open_tcp(const char *where, const char *host, int port)
{
    struct sockaddr_in at;
    socklen_t len = sizeof at;
    server.ctx = modbus_new_tcp(host, port);
    if (server.ctx == NULL) {
        return complain(where, modbus_strerror(errno), "give another address");
    }
    server.listener = modbus_tcp_listen(server.ctx, CLIENTS);
    if (server.listener < 0) {
        return complain(where, modbus_strerror(errno),
            errno == EADDRINUSE ? "another program serves there: give another port"
            : errno == EACCES   ? "ports below 1024 are the system's: give another"
                                : "give an address of this machine");
    }
    memset(&at, 0, sizeof at);
    (void)getsockname(server.listener, (struct sockaddr *)&at, &len);
    printf("modbus: tcp:%s:%u\n", host, (unsigned)ntohs(at.sin_port));
    fflush(stdout);
    return 0;
}

static int open_rtu(const char *where, const char *device, int baud)
{
    server.rtu = 1;
    server.ctx = modbus_new_rtu(device, baud, 'E', 8, 1);
    if (server.ctx == NULL) {
        return complain(where, modbus_strerror(errno), "give another device");
    }
    (void)modbus_set_slave(server.ctx, ADDRESS);
    (void)modbus_set_byte_timeout(server.ctx, 0, 50000);
    if (modbus_connect(server.ctx) < 0) {
        return complain(where, modbus_strerror(errno),
            errno == EACCES ? "only who may open it: the group dialout, as a rule"
                            : "give a serial line that is here");
    }
    printf("modbus: rtu:%s:%d, address %d, 8E1\n", device, baud, ADDRESS);
    fflush(stdout);
    return 0;
}

static int open_where(const char *where)
{
    char text[WHERE_B];
    struct in_addr any;
    long number;
    if (strlen(where) >= sizeof text) { return bad(where); }
    strcpy(text, where);
    if (strncmp(text, "tcp:", 4) == 0) {
        number = modbus_cut_number(text, 65535);
        if (number < 0 || inet_pton(AF_INET, text + 4, &any) != 1) { return bad(where); }
        return open_tcp(where, text + 4, (int)number);
    }
    number = modbus_cut_number(text, 4000000);
    if (strncmp(text, "rtu:", 4) != 0 || number < 300 || text[4] == '\0') { return bad(where); }
    return open_rtu(where, text + 4, (int)number);
}

int live_modbus_open(const char *where)
{
    const int err = open_where(where);
    if (err == 0) {
        if (request_open() < 0 || pipe(server.stop) != 0) {
            return complain(where, strerror(errno), "free some memory");
        }
        (void)modbus_set_indication_timeout(server.ctx, 0, WAIT_MS * 1000);
    }
    return err;
}

int live_modbus_serve(void)
{
    server.serves = thread_start(&server.thread, server.rtu ? serve_rtu : serve_tcp, NULL) == 0;
    return server.serves ? 0 : complain("a thread", "can't be started", "free some memory");
}

void live_modbus_close(void)
{
    if (server.serves) {
        close(server.stop[1]);
        pthread_join(server.thread, NULL);
        mail_end();
        close(server.stop[0]);
    }
    server.serves = 0;
    while (server.clients > 0) { drop(0); }
    if (server.listener >= 0) { close(server.listener); }
    if (server.rtu && server.ctx) { modbus_close(server.ctx); }
    request_close();
    if (server.ctx) { modbus_free(server.ctx); }
}
