/* SPDX-License-Identifier: MIT */
/* The same bytes to the libmodbus server and to the library's slave, from the same state of the
 * map: the same bytes come back. */
#ifndef EXH_MODBUS
#include "check.h"

TEST(nothing_without_the_package)
{
    check_note("libmodbus is not here: nothing was tested");
    CHECK_EQ_I64(1, 1);
}

TEST_MAIN("modbus_fuzz", nothing_without_the_package);
#else

#include "check.h"

#include "slave/slave.h"

#include "guarded/guarded.h"

#include "exhand/error.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define VALUES 256
#define PDU_B  253

/* The slave of lib, over these arrays. */
static struct {
    struct exh_params p;
    struct exh_regs r;
    int32_t active[VALUES], wanted[VALUES], staged[VALUES];
    uint32_t touched[EXH_REGS_WORDS(VALUES)];
} ours;

static const struct exh_scene *const sc = &exh_scene_guarded;
static int fd; /* to the server, which runs in a thread of this process */

static int open_server(void)
{
    const int on = 1;
    struct sockaddr_in at = {.sin_family = AF_INET};
    int port, s = -1;
    /* The server prints a free port on standard output only: try some ports. */
    for (port = 20000 + (int)(getpid() % 20000); s != 0 && port < 65536; port += 7) {
        char where[64];
        snprintf(where, sizeof where, "tcp:127.0.0.1:%d", port);
        s = live_modbus_open(where);
        if (s == 0) { break; }
    }
    CHECK(s == 0 && live_modbus_serve() == 0, "no server");
    at.sin_port = htons((uint16_t)port);
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    s = socket(AF_INET, SOCK_STREAM, 0);
    CHECK(connect(s, (struct sockaddr *)&at, sizeof at) == 0, "no connection");
    setsockopt(s, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return s;
}

/* Both maps show the same box, at rest and locked as while it runs. */
static void begin(void)
{
    static const struct mail_cfg cfg = {NULL, 1, 1}; /* SAVE is done when it is done */
    const struct exh_scene_board board = {{1, 2000}, 24};
    const uint32_t n = (sc->defaults(), exh_signal_count(sc->params->table));
    CHECK(n <= VALUES, "more values");
    sc->params->locked = 1;
    exh_params_setup(&ours.p, sc->params->table, ours.active, ours.wanted);
    ours.p.locked = 1;
    for (uint32_t i = 0; i < exh_signal_count(sc->signals); i++) {
        exh_scene_signals(sc)[i] = (int32_t)check_u64();
    }
    mail_open(&cfg);
    CHECK_EQ_I64(mail_start(sc, board), 0);
    ours.r = *mail_take();
    mail_give();
    ours.r.active = ours.active;
    ours.r.wanted = ours.wanted;
    ours.r.staged = ours.staged;
    ours.r.touched = ours.touched;
    CHECK_EQ_I64(exh_regs_setup(&ours.r), 0);
    fd = open_server();
}

/* --- requests --- */

static uint32_t below(uint32_t n) { return (uint32_t)(check_u64() % n); }

/* In a block that this function has, or at its edges; or anywhere. */
static uint32_t some_address(uint32_t f)
{
    static const uint32_t input[] = {0, 0x400, 0x1000, 0x3000, 0x5000, 0x7000};
    const uint32_t values = f == 4 && below(2) ? ours.r.signals_n : ours.r.params_n;
    const uint32_t at = f == 4 ? input[below(6)] : f == 2 ? 0 : 0x5000 + 0x2000 * below(2);
    switch (below(12)) {
    case 0: return below(65536);
    case 1: return (at + 2 * values - below(4)) & 0xFFFF;
    case 2: return (at - below(3)) & 0xFFFF;
    default: return f == 2 ? below(192) : at + 2 * below(values) + (below(4) == 0);
    }
}

static uint32_t some_count(uint32_t f, uint32_t most)
{
    switch (below(8)) {
    case 0: return below(65536);
    case 1: return most - 2 + below(5);
    case 2: return below(3);
    default: return f == 1 ? 1 + below(3) : 2 * (1 + below(4));
    }
}

static void put16(uint8_t *p, uint32_t v)
{
    p[0] = (uint8_t)(v >> 8 & 0xFF);
    p[1] = (uint8_t)(v & 0xFF);
}

/* Registers to write: mostly their present values, with some bits changed, or anything. */
static void some_registers(uint8_t *to, uint32_t at, uint32_t n)
{
    const int as_it_is = below(4) != 0 && exh_regs_read(&ours.r, EXH_REGS_HOLDING, (uint16_t)at,
                                              (uint16_t)n, to) == 0;
    for (uint32_t i = 0; i < 2 * n; i++) {
        if (!as_it_is) { to[i] = (uint8_t)check_u64(); }
    }
    for (uint32_t k = below(4); n > 0 && k > 0; k--) {
        to[below(2 * n)] ^= (uint8_t)(1u << below(8));
    }
}

static uint32_t some_pdu(uint8_t *p)
{
    static const uint8_t function[] = {1, 2, 3, 3, 4, 4, 5, 6, 6, 15, 16, 16, 16, 22, 23, 23};
    static const uint32_t most[24] = {
        [1] = 2000, [2] = 2000, [3] = 125, [4] = 125, [15] = 1968, [16] = 123, [23] = 125};
    const uint32_t f = below(25) ? function[below(sizeof function)] : 1 + below(127);
    const uint32_t at = f == 5 || f == 15 || f == 1 ? below(8) : some_address(f);
    uint32_t n = f < 24 && most[f] ? some_count(f, most[f])
                 : below(2)        ? 0xFF00
                                   : below(65536) & 0xFF;
    uint32_t len = 5;
    memset(p, 0, PDU_B);
    p[0] = (uint8_t)f;
    put16(p + 1, at);
    if (f == 6) { some_registers(p + 3, at, 1); }
    if (f != 6) { put16(p + 3, n); }
    if (f == 22) {
        put16(p + 3, below(65536) | 0xFF00);
        put16(p + 5, below(256));
        len = 7;
    }
    if (f == 15) {
        const uint32_t bytes = ((n + 7) / 8) & 0xFF;
        p[5] = (uint8_t)bytes;
        for (uint32_t i = 0; i < bytes && i < PDU_B - 6; i++) {
            p[6 + i] = (uint8_t)(check_u64() & check_u64());
        }
        len = 6 + bytes;
    }
    if (f == 16) {
        p[5] = (uint8_t)(2 * n & 0xFF);
        some_registers(p + 6, at, n <= 123 ? n : 0);
        len = 6u + p[5];
    }
    if (f == 23) {
        const uint32_t put = some_count(f, 121), put_at = below(2) ? at : some_address(f);
        put16(p + 5, put_at);
        put16(p + 7, put);
        p[9] = (uint8_t)(2 * put & 0xFF);
        some_registers(p + 10, put_at, put <= 121 ? put : 0);
        len = 10u + p[9];
    }
    if (below(20) == 0) { len += below(5); }                 /* longer, */
    if (below(20) == 0) { len -= below(len < 5 ? len : 5); } /* or shorter than it says, */
    if (below(30) == 0) { p[below(12)] ^= (uint8_t)(1u << below(8)); } /* or a bit of it turned */
    p[0] &= 0x7F; /* functions of 128 and more are for answers */
    return len > PDU_B ? PDU_B : len;
}

/* --- both --- */

static uint32_t from_server(const uint8_t *pdu, uint32_t len, uint8_t *answer)
{
    uint8_t adu[7 + PDU_B], got[300];
    const uint16_t id = (uint16_t)check_u64();
    uint32_t have = 0;
    put16(adu, id);
    put16(adu + 2, 0);
    put16(adu + 4, len + 1);
    adu[6] = 17;
    memcpy(adu + 7, pdu, len);
    CHECK(send(fd, adu, 7 + len, MSG_NOSIGNAL) == (ssize_t)(7 + len), "the connection is gone");
    while (have < 7 || have < 6u + (uint32_t)(got[4] << 8 | got[5])) {
        struct pollfd f = {fd, POLLIN, 0};
        ssize_t n;
        if (poll(&f, 1, 5000) <= 0) { return 0; }
        n = recv(fd, got + have, sizeof got - have, 0);
        if (n <= 0) { return 0; }
        have += (uint32_t)n;
    }
    CHECK(memcmp(got, adu, 4) == 0 && got[6] == 17, "another head");
    memcpy(answer, got + 7, have - 7);
    return have - 7;
}

/* Between two ticks, on both sides. */
static void tick(void)
{
    struct exh_scene_in in = {.command = EXH_CMD_NONE};
    const uint32_t asked = exh_regs_poll(&ours.r);
    const uint8_t command = exh_regs_command(asked);
    while (!mail_before(&in)) {} /* the server may not have put them down yet */
    if (asked & 1u << EXH_COIL_APPLY) {
        exh_regs_complete(&ours.r, exh_regs_apply(&ours.r, &ours.p));
    }
    if (command != EXH_CMD_NONE) { exh_regs_complete(&ours.r, 0); }
    CHECK_EQ_I64(in.command, command);
    exh_params_apply(&ours.p);
    exh_params_apply(sc->params);
    /* the copy, as behind a tick: nothing has moved but the parameters */
    CHECK(memcmp(sc->params->active, ours.active, 4 * ours.r.params_n) == 0, "other parameters");
    mail_after(&in);
    while (!mail_show(&in)) {}
    exh_regs_update(&ours.r, sc->safety, in.drive.din);
}

TEST(the_same_bytes_come_back)
{
    const char *text = getenv("EXH_REQUESTS");
    const long n = text ? atol(text) : 100000;
    long exceptions[8] = {0};
    begin();
    for (long i = 0; i < n; i++) {
        uint8_t pdu[PDU_B + 8], here[EXH_MODBUS_PDU_B], there[300];
        const uint32_t len = some_pdu(pdu);
        uint32_t got;
        int want;
        if (below(30) == 0) { tick(); }
        if (pdu[0] == 43) { continue; } /* libmodbus has no identification */
        want = exh_modbus_answer(&ours.r, pdu, len, here, sizeof here);
        got = from_server(pdu, len, there);
        CHECK(got == (uint32_t)want && memcmp(here, there, got) == 0,
            "request %ld, function %u, address %#x, %u bytes: ours %d: %02x %02x %02x, the "
            "server's %u: %02x %02x %02x",
            i, pdu[0], (unsigned)(pdu[1] << 8 | pdu[2]), len, want, here[0], here[1], here[2], got,
            there[0], there[1], there[2]);
        exceptions[here[0] & 0x80 ? here[1] & 7 : 0]++;
    }
    check_note("%ld requests: %ld answers, exceptions 1: %ld, 2: %ld, 3: %ld, 6: %ld; all the same",
        n, exceptions[0], exceptions[1], exceptions[2], exceptions[3], exceptions[6]);
    CHECK(
        exceptions[0] > n / 5 && exceptions[1] && exceptions[2] && exceptions[3], "too few kinds");
    close(fd);
    live_modbus_close();
}

TEST_MAIN("modbus_fuzz", the_same_bytes_come_back);
#endif
