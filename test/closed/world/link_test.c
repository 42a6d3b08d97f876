/* SPDX-License-Identifier: MIT */
/* The link, over loopback: either end may come, go and come back. */
#include "check.h"

#include "world/link.h"

#include "exhand/exhand.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

struct controller {
    int fd;
    struct exh_wire_tx tx;
    struct exh_wire_rx rx;
    struct sockaddr_in to;
    struct exh_wire_planes planes;
    int hellos, answers;
};

static struct link world;
static struct exh_wire_hello said_hello = {
    .role = EXH_WIRE_CONTROLLER, .lib_version = EXH_VERSION_NUMBER, .table_crc = 0};
static char port[16];

static void open_world(uint32_t session)
{
    char why[300] = "";
    for (int p = 20000 + (int)(getpid() % 20000); p < 65000; p++) {
        snprintf(port, sizeof port, "%d", p);
        if (link_open(&world, port, NULL, session, why, sizeof why) == 0) { return; }
    }
    CHECK(0, "%s", why);
}

static void open_controller(struct controller *c, uint32_t session)
{
    memset(c, 0, sizeof *c);
    c->fd = socket(AF_INET, SOCK_DGRAM, 0);
    c->tx.session = session;
    c->to.sin_family = AF_INET;
    c->to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    c->to.sin_port = htons((uint16_t)strtol(port, NULL, 10));
}

static void say(struct controller *c, int type, int32_t joint)
{
    unsigned char buf[EXH_WIRE_MAX_B];
    struct exh_wire_packet p;
    int32_t n;
    memset(&p, 0, sizeof p);
    p.type = (uint8_t)type;
    if (type == EXH_WIRE_HELLO) { p.u.hello = said_hello; }
    if (type == EXH_WIRE_STATE) { p.u.state.joint_turn_q32[0][0] = joint; }
    n = exh_wire_encode(&c->tx, &p, 1234, buf, sizeof buf);
    CHECK(n > 0 && sendto(c->fd, buf, (size_t)n, 0, (struct sockaddr *)&c->to, sizeof c->to) == n,
        "%d", (int)n);
}

static void hear(struct controller *c)
{
    unsigned char buf[2 * EXH_WIRE_MAX_B];
    struct exh_wire_packet p;
    ssize_t n;
    while ((n = recv(c->fd, buf, sizeof buf, MSG_DONTWAIT)) > 0) {
        const int type = exh_wire_decode(&c->rx, &p, buf, (size_t)n);
        c->hellos += type == EXH_WIRE_HELLO;
        if (type != EXH_WIRE_PLANES) { continue; }
        c->planes = p.u.planes;
        c->answers += p.u.planes.plane[0].kind != EXH_PLANE_UNTOLD;
    }
}

/* One frame of the world at t_us. */
static int frame(struct exh_wire_state *state, int64_t t_us)
{
    struct exh_wire_planes planes;
    const int newer = link_receive(&world, state, t_us);
    memset(&planes, 0, sizeof planes);
    planes.fingers = 1;
    planes.plane[0].kind = EXH_PLANE_HIT;
    link_answer(&world, &planes, t_us);
    return newer;
}

TEST(a_state_is_taken_and_answered_with_its_own_number)
{
    struct exh_wire_state s;
    struct controller c;
    open_world(1);
    open_controller(&c, 2);
    CHECK(!frame(&s, 0) && world.sent == 0, "nobody there, and it talks");
    say(&c, EXH_WIRE_HELLO, 0);
    say(&c, EXH_WIRE_STATE, 41);
    say(&c, EXH_WIRE_STATE, 42);
    CHECK(frame(&s, 1000) && s.joint_turn_q32[0][0] == 42, "not the newest");
    hear(&c);
    CHECK(c.hellos == 1 && c.answers == 1, "%d hellos, %d answers", c.hellos, c.answers);
    CHECK(c.planes.echo_seq == 2 && c.planes.echo_stamp_us == 1234, "echo %u",
        (unsigned)c.planes.echo_seq);
    CHECK(!frame(&s, 2000), "an old state is new");
    hear(&c);
    CHECK_EQ_I64(c.answers, 2);
    close(c.fd), link_close(&world);
}

TEST(either_end_may_start_anew)
{
    struct exh_wire_state s;
    struct controller c;
    char why[300];
    open_world(1);
    open_controller(&c, 2);
    say(&c, EXH_WIRE_HELLO, 0);
    for (int k = 0; k < 100; k++) { say(&c, EXH_WIRE_STATE, k); }
    CHECK(frame(&s, 0) | frame(&s, 1), "taken");
    close(c.fd);
    open_controller(&c, 3); /* counts from 0 again */
    say(&c, EXH_WIRE_STATE, 7);
    CHECK(!frame(&s, 1000), "of a stranger");
    say(&c, EXH_WIRE_HELLO, 0);
    say(&c, EXH_WIRE_STATE, 8);
    CHECK(!frame(&s, 500000), "the one before was heard half a second ago");
    say(&c, EXH_WIRE_HELLO, 0);
    say(&c, EXH_WIRE_STATE, 8);
    CHECK(frame(&s, 1000001) && s.joint_turn_q32[0][0] == 8,
        "the controller's second life is not heard");
    hear(&c);
    CHECK(c.answers > 0, "nor answered");

    link_close(&world); /* and now the world */
    CHECK(link_open(&world, port, NULL, 9, why, sizeof why) == 0, "%s", why);
    say(&c, EXH_WIRE_HELLO, 0);
    say(&c, EXH_WIRE_STATE, 9);
    (void)exh_wire_poll(&c.rx, UINT32_MAX, 1); /* it has heard nothing for long */
    CHECK(frame(&s, 0) && s.joint_turn_q32[0][0] == 9, "the world's second life does not hear");
    c.answers = 0;
    hear(&c);
    CHECK(c.answers == 1, "nor is it heard");
    close(c.fd), link_close(&world);
}

TEST(without_planes_it_says_hello_alone)
{
    struct exh_wire_state s;
    struct controller c;
    open_world(1);
    open_controller(&c, 2);
    say(&c, EXH_WIRE_HELLO, 0);
    CHECK(!link_receive(&world, &s, 0), "a hello is no state");
    for (int64_t t_us = 0; t_us < 2000000; t_us += 10000) { link_answer(&world, NULL, t_us); }
    hear(&c);
    CHECK(c.hellos == 4 && c.answers == 0, "%d hellos, %d answers", c.hellos, c.answers);
    close(c.fd), link_close(&world);
}

/* --- what the controller is to have --- */

static char heard[2000];
static struct scene scene;
static struct scene_material material[3] = {
    {"wood", 50000, 60, 10, {0}}, {"tar", 1500, 2000, 6, {0}}, {"air", 0, 0, 0, {0}}};

static void listen_to(const char *text)
{
    strncat(heard, text, sizeof heard - strlen(heard) - 2);
    strcat(heard, "\n");
}

static void open_wanting(uint32_t session)
{
    open_world(session);
    heard[0] = '\0';
    scene.material = material;
    scene.materials = 3;
    world.say = listen_to;
    link_materials(&world, &scene);
}

/* Takes the packets that came. For lose of ten PARAM packets the answer is lost. */
static int params(struct controller *c, struct exh_wire_param asked[200], unsigned lose)
{
    unsigned char buf[2 * EXH_WIRE_MAX_B];
    struct exh_wire_packet p;
    ssize_t n;
    int k = 0;
    while ((n = recv(c->fd, buf, sizeof buf, MSG_DONTWAIT)) > 0) {
        const int type = exh_wire_decode(&c->rx, &p, buf, (size_t)n);
        struct exh_wire_packet ack;
        int32_t len;
        c->answers += type == EXH_WIRE_PLANES && p.u.planes.plane[0].kind != EXH_PLANE_UNTOLD;
        if (type != EXH_WIRE_PARAM || k == 200) { continue; }
        asked[k++] = p.u.param;
        if (check_u64() % 10 < lose) { continue; }
        memset(&ack, 0, sizeof ack);
        ack.type = EXH_WIRE_ACK;
        ack.u.ack.param = p.u.param;
        ack.u.ack.result = p.u.param.instance == 2 ? -EXH_E_UNKNOWN : 0; /* has no third material */
        len = exh_wire_encode(&c->tx, &ack, 0, buf, sizeof buf);
        (void)!sendto(c->fd, buf, (size_t)len, 0, (struct sockaddr *)&c->to, sizeof c->to);
    }
    return k;
}

/* All of material 0, which the plane has. */
static int wood_is_answered(void)
{
    int open = 0;
    for (int i = 0; i < world.wants; i++) {
        open += world.want[i].param.instance == 0 && !world.want[i].answered;
    }
    return open == 0;
}

TEST(materials_are_asked_for_until_answered)
{
    struct exh_wire_state s;
    struct controller c;
    struct exh_wire_param asked[200];
    open_wanting(1);
    CHECK(world.wants == 8 &&
              strcmp(heard,
                  "material tar: mat_b 2000 ns_per_m: not between 0 and 1000: not sent, the "
                  "controller's own holds\n") == 0,
        "%s", heard);
    for (uint32_t life = 2; life < 5; life++) {
        unsigned seen = 0, most = 0;
        int t = 0;
        open_controller(&c, life);
        heard[0] = '\0';
        say(&c, EXH_WIRE_HELLO, 0);
        for (; t < 800 && (t == 0 || world.waiting); t++) {
            int k;
            say(&c, EXH_WIRE_STATE, t);
            (void)frame(&s, (int64_t)life * 100000000 + t * 2500);
            CHECK(c.answers == 0 || wood_is_answered(), "planes before their material");
            k = params(&c, asked, 5);
            most = k > (int)most ? (unsigned)k : most;
            for (int i = 0; i < k; i++) {
                seen |= 1u << (3 * asked[i].instance + (asked[i].id & 15) - 1);
                if (asked[i].instance == 0 && asked[i].id == exh_material_rows[0].id) {
                    CHECK_EQ_I64(asked[i].value, 50000 << 10);
                }
            }
        }
        CHECK(seen == 0x1EF && world.waiting == 0 && t < 800, "life %d: %#x, %d wait", (int)life,
            seen, world.waiting);
        CHECK(most <= 2, "%u at once", most);
        CHECK(strstr(heard, "material air: mat_k 0 n_per_m: refused by the controller: ") &&
                  !strstr(heard, "wood") && !strstr(heard, "tar"),
            "%s", heard);
        (void)frame(&s, (int64_t)life * 100000000 + t * 2500);
        CHECK(params(&c, asked, 0) == 0 && c.answers > 0, "it asks on, or tells no planes");
        for (int k = 0; k < 100; k++) {
            (void)frame(&s, (int64_t)life * 100000000 + (t + k) * 2500);
        }
        CHECK_EQ_I64(params(&c, asked, 0), 0);
        close(c.fd);
    }
    link_close(&world);
}

TEST(who_answers_nothing_gets_planes_all_the_same)
{
    struct exh_wire_state s;
    struct controller c;
    struct exh_wire_param asked[200];
    int first = -1, n = 0;
    open_wanting(1);
    open_controller(&c, 2);
    heard[0] = '\0';
    say(&c, EXH_WIRE_HELLO, 0);
    for (int t = 0; t < 1000; t++) {
        say(&c, EXH_WIRE_STATE, t);
        (void)frame(&s, t * 2500);
        n += params(&c, asked, 10);
        if (first < 0 && c.answers > 0) { first = t; }
    }
    CHECK_EQ_I64(first, 400);                           /* a second */
    CHECK(n > 180 && n <= 200, "%d asked in 2.5 s", n); /* 8 ten times a second */
    CHECK(strstr(heard, "no answer (8 of 8 are without)"), "%s", heard);
    close(c.fd), link_close(&world);
}

TEST(a_peer_that_differs_is_named)
{
    struct exh_wire_state s;
    struct controller c;
    open_wanting(1);
    world.table_crc = 0x1234;
    open_controller(&c, 2);
    said_hello = (struct exh_wire_hello){
        .role = EXH_WIRE_WORLD, .lib_version = EXH_VERSION_NUMBER + 1, .table_crc = 0x4321};
    heard[0] = '\0';
    say(&c, EXH_WIRE_HELLO, 0);
    (void)frame(&s, 0);
    CHECK(strstr(heard, "is a world, too") && strstr(heard, "of the library") &&
              strstr(heard, "00004321"),
        "%s", heard);
    CHECK_EQ_I64((int64_t)world.odd, 1);
    said_hello = (struct exh_wire_hello){
        .role = EXH_WIRE_CONTROLLER, .lib_version = EXH_VERSION_NUMBER, .table_crc = 0};
    close(c.fd), link_close(&world);
}

/* A late HELLO of one that is long gone, then a number far ahead. */
TEST(it_is_not_deaf_for_good)
{
    struct exh_wire_state s;
    struct controller c, old;
    int64_t t_us = 0;
    open_world(1);
    open_controller(&old, 7), say(&old, EXH_WIRE_HELLO, 0), (void)frame(&s, t_us);
    open_controller(&c, 8), say(&c, EXH_WIRE_HELLO, 0), (void)frame(&s, t_us);
    close(c.fd), open_controller(&c, 9), say(&c, EXH_WIRE_HELLO, 0), (void)frame(&s, t_us);
    for (int how = 0; how < 2; how++) {
        int k = 0, heard_it = 0;
        if (how == 0) {
            say(&old, EXH_WIRE_HELLO, 0);
        } else {
            c.tx.seq += 60000, say(&c, EXH_WIRE_STATE, 1), c.tx.seq -= 60001;
        }
        (void)frame(&s, t_us);
        for (; k < 1000 && !heard_it; k++) {
            t_us += 2500;
            if (k % 50 == 49) { say(&c, EXH_WIRE_HELLO, 0); }
            say(&c, EXH_WIRE_STATE, 2);
            heard_it = frame(&s, t_us);
        }
        CHECK(heard_it && k > 380 && k <= 451, "deaf for %d frames", k);
    }
    close(old.fd), close(c.fd), link_close(&world);
}

TEST(noise_changes_nothing)
{
    struct exh_wire_state s, before;
    struct controller c;
    open_world(1);
    open_controller(&c, 2);
    say(&c, EXH_WIRE_HELLO, 0);
    say(&c, EXH_WIRE_STATE, 5);
    CHECK(frame(&s, 0), "taken");
    before = s;
    while (check_case(2000)) {
        unsigned char junk[400];
        const size_t n = check_u64() % sizeof junk;
        for (size_t i = 0; i < n; i++) { junk[i] = (unsigned char)check_u64(); }
        (void)!sendto(c.fd, junk, n, 0, (struct sockaddr *)&c.to, sizeof c.to);
        CHECK(!frame(&s, 0) && memcmp(&s, &before, sizeof s) == 0, "junk was taken");
    }
    close(c.fd), link_close(&world);
}

/* --- traces --- */

static struct exh_wire_trace_request asked;
static uint32_t ask_seq;
static int asks;

static void hear_asks(struct controller *c)
{
    unsigned char buf[2 * EXH_WIRE_MAX_B];
    struct exh_wire_packet p;
    ssize_t n;
    while ((n = recv(c->fd, buf, sizeof buf, MSG_DONTWAIT)) > 0) {
        if (exh_wire_decode(&c->rx, &p, buf, (size_t)n) != EXH_WIRE_TRACE_ASK) { continue; }
        asked = p.u.trace_ask;
        ask_seq = p.seq;
        asks++;
    }
}

static void send_trace(
    struct controller *c, uint32_t request_seq, uint32_t first, uint8_t frames, int16_t result)
{
    unsigned char buf[EXH_WIRE_MAX_B];
    struct exh_wire_packet p;
    int32_t n;
    memset(&p, 0, sizeof p);
    p.type = EXH_WIRE_TRACE;
    p.u.trace.request_seq = request_seq;
    p.u.trace.first = first;
    p.u.trace.frames = frames;
    p.u.trace.result = result;
    for (unsigned i = 0; i < frames; i++) {
        p.u.trace.frame[i].tick = 100 + 3 * (first + i);
        p.u.trace.frame[i].raw[0] = -3 * (1 << 8);
        p.u.trace.frame[i].raw[1] = 5;
        p.u.trace.frame[i].raw[2] = INT32_MIN;
    }
    n = exh_wire_encode(&c->tx, &p, 1234, buf, sizeof buf);
    CHECK(n > 0 && sendto(c->fd, buf, (size_t)n, 0, (struct sockaddr *)&c->to, sizeof c->to) == n,
        "%d", (int)n);
}

static const struct exh_signal traced_rows[] = {
    {1, 10, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "q", "m", ""},
    {2, 0, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "c", "", ""}};
static const struct exh_signal box_row = {3, 0, EXH_WHEN_OUTPUT, 0, 5, 0, "state", "", ""};
static const struct exh_signal d_row = {/* the scene's: INT32_MIN is no plane */
    0x8707, 30, EXH_WHEN_OUTPUT, INT32_MIN, INT32_MAX, 0, "d", "m", ""};
static const struct exh_signal_group traced_groups[] = {
    {traced_rows, 2, 3}, {&box_row, 1, 1}, {&d_row, 1, 1}};
static const struct exh_signal_table traced = {traced_groups, 3};

static int open_trace(const char *path, const char *signals, char why[300])
{
    const struct link_trace_want want = {&traced, path, signals, 3};
    return link_trace_open(&world, &want, why, 300);
}

static void read_all(const char *path, char *to, size_t cap_B)
{
    FILE *f = fopen(path, "r");
    size_t n = 0;
    if (f) {
        n = fread(to, 1, cap_B - 1, f);
        fclose(f);
    }
    to[n] = '\0';
}

/* A request is repeated until the answer. Each frame gives a line, a missing frame is counted. A
 * controller that has started again gets a new request, and frames of the old one are ignored. */
TEST(a_trace_is_asked_for_and_written)
{
    static const char want[] =
        "number,tick,q[1]_m,state,d_m\n7,121,-0.75,5,\n8,124,-0.75,5,\n10,130,-0.75,5,\n"
        "0,100,-0.75,5,\n";
    char path[] = "/tmp/exhand-trace-XXXXXX", why[300] = "", text[400];
    struct exh_wire_state s;
    struct controller c;
    const int fd = mkstemp(path);
    uint32_t before;
    close(fd);
    asks = 0;
    heard[0] = '\0';
    open_world(1);
    world.say = listen_to;
    CHECK(open_trace(path, "q[1],state,d", why) == 0, "%s", why);
    open_controller(&c, 2);
    say(&c, EXH_WIRE_HELLO, 0);
    for (int64_t t_us = 0; t_us < 250000; t_us += 10000) { (void)frame(&s, t_us); }
    hear_asks(&c);
    CHECK(asks == 3 && asked.every == 3 && asked.index[0] == 2 && asked.index[1] == 6, "%d, %d, %d",
        asks, asked.index[0], asked.index[1]);
    send_trace(&c, ask_seq + 1, 1, 1, 0); /* of nothing that was asked */
    send_trace(&c, ask_seq - 1, 7, 2, 0);
    send_trace(&c, ask_seq, 10, 1, 0);
    for (int64_t t_us = 250000; t_us < 900000; t_us += 10000) { (void)frame(&s, t_us); }
    hear_asks(&c);
    CHECK(asks == 3 && world.trace.frames == 3 && world.trace.missed == 1,
        "%d asks, %lu frames, %lu missed", asks, world.trace.frames, world.trace.missed);
    before = ask_seq;
    close(c.fd);
    open_controller(&c, 3);
    say(&c, EXH_WIRE_HELLO, 0);
    (void)frame(&s, 2000000);
    hear_asks(&c);
    CHECK(asks == 4 && ask_seq != before, "another controller is not asked");
    send_trace(&c, before, 55, 1, 0);
    send_trace(&c, ask_seq, 0, 1, 0);
    (void)frame(&s, 2010000);
    CHECK_EQ_I64(link_trace_close(&world), 0);
    read_all(path, text, sizeof text);
    CHECK(strcmp(text, want) == 0, "%s", text);
    CHECK(strstr(heard, "4 frames, 1 missed") != NULL, "%s", heard);
    close(c.fd), link_close(&world);
    remove(path);
}

TEST(a_trace_that_cannot_be_is_refused_in_words)
{
    static const char *const bad[] = {
        "", "w", "q[3]", "q[1", "q[]", "q[1]x", "state[1]", "c,c,c,c,c"};
    char path[] = "/tmp/exhand-trace-XXXXXX", why[300];
    struct exh_wire_state s;
    struct controller c;
    close(mkstemp(path));
    open_world(1);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        CHECK(open_trace(path, bad[i], why) == 2 && strstr(why, "--trace-signals: "), "%s: %s",
            bad[i], why);
    }
    CHECK_EQ_I64(open_trace("/nowhere/at/all", "c", why), 1); /* said on stderr */
    heard[0] = '\0';
    world.say = listen_to;
    CHECK(open_trace(path, "c", why) == 0, "%s", why);
    open_controller(&c, 2);
    say(&c, EXH_WIRE_HELLO, 0);
    (void)frame(&s, 0);
    hear_asks(&c);
    send_trace(&c, ask_seq, 0, 0, -EXH_E_RANGE);
    (void)frame(&s, 1000);
    CHECK(strstr(heard, "refused by the controller") != NULL, "%s", heard);
    CHECK_EQ_I64(link_trace_close(&world), 0);
    close(c.fd), link_close(&world);
    remove(path);
}

TEST(a_given_peer_is_the_only_one_listened_to)
{
    struct exh_wire_state s;
    struct controller c;
    char why[300], own[16];
    open_world(1);
    strcpy(own, port);
    link_close(&world);
    CHECK(link_open(&world, own, "127.0.0.1:1", 1, why, sizeof why) == 0, "%s", why);
    open_controller(&c, 2);
    say(&c, EXH_WIRE_HELLO, 0);
    say(&c, EXH_WIRE_STATE, 5);
    CHECK(!frame(&s, 0), "another one was heard");
    close(c.fd), link_close(&world);
}

TEST(bad_addresses_are_refused_in_words)
{
    static const char *const bad[] = {"", "x:y:z", "127.0.0.1:", "999.999.1.1:7", "8.8.8.8:70"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char why[300] = "";
        CHECK(link_open(&world, bad[i], NULL, 1, why, sizeof why) == 1 && strstr(why, ": "),
            "%s: %s", bad[i], why);
        link_close(&world);
    }
}

/* --- with a key --- */

static struct exh_keyed box_key;

static struct exh_mac_key key_of(uint8_t first)
{
    const uint8_t byte[EXH_MAC_KEY_B] = {first};
    return exh_mac_key(byte);
}

/* One packet of a controller with this key; what the world sends is heard. */
static void say_keyed(struct controller *c, int type, int32_t joint)
{
    unsigned char buf[EXH_KEYED_MAX_B];
    struct exh_wire_packet p;
    int32_t n;
    memset(&p, 0, sizeof p);
    p.type = (uint8_t)type;
    if (type == EXH_WIRE_HELLO) { p.u.hello = said_hello; }
    if (type == EXH_WIRE_STATE) { p.u.state.joint_turn_q32[0][0] = joint; }
    while ((n = (int32_t)recv(c->fd, buf, sizeof buf, MSG_DONTWAIT)) > 0) {
        (void)exh_keyed_decode(&box_key, buf, (size_t)n);
    }
    n = exh_wire_encode(&c->tx, &p, 1234, buf, sizeof buf);
    n = exh_keyed_encode(&box_key, buf, (size_t)n, sizeof buf);
    CHECK(n > 0 && sendto(c->fd, buf, (size_t)n, 0, (struct sockaddr *)&c->to, sizeof c->to) == n,
        "%d", (int)n);
}

/* Recorded from the socket, a stranger without a key, another key: none of them acts. */
TEST(only_who_has_the_key_is_heard)
{
    const struct exh_mac_key ours = key_of(1), other = key_of(2);
    struct exh_wire_state s = {0};
    struct controller c;
    open_world(1);
    link_key(&world, &ours, 77);
    open_controller(&c, 2);
    say(&c, EXH_WIRE_HELLO, 0);
    say(&c, EXH_WIRE_STATE, 1);
    CHECK(!frame(&s, 1000) && world.keyed.no_key == 2 && world.sent == 0, "without a key");
    exh_keyed_setup(&box_key, &other, EXH_WIRE_CONTROLLER, 5);
    say_keyed(&c, EXH_WIRE_HELLO, 0);
    say_keyed(&c, EXH_WIRE_STATE, 2);
    CHECK(!frame(&s, 2000) && world.keyed.other_key == 2 && world.sent == 0, "another key");
    exh_keyed_setup(&box_key, &ours, EXH_WIRE_CONTROLLER, 6);
    say_keyed(&c, EXH_WIRE_HELLO, 0);
    CHECK(!frame(&s, 3000) && world.keyed.unproved == 1 && world.sent == 1, "it begins");
    say_keyed(&c, EXH_WIRE_HELLO, 0);
    say_keyed(&c, EXH_WIRE_STATE, 3);
    CHECK(frame(&s, 4000) && s.joint_turn_q32[0][0] == 3, "it is heard");
    CHECK(world.rx.accepted == 2 && world.keyed.taken == 2, "that alone");
    close(c.fd), link_close(&world);
}

TEST_MAIN("world: the link", only_who_has_the_key_is_heard,
    a_state_is_taken_and_answered_with_its_own_number, either_end_may_start_anew,
    without_planes_it_says_hello_alone, materials_are_asked_for_until_answered,
    who_answers_nothing_gets_planes_all_the_same, a_peer_that_differs_is_named,
    it_is_not_deaf_for_good, noise_changes_nothing, a_trace_is_asked_for_and_written,
    a_trace_that_cannot_be_is_refused_in_words, a_given_peer_is_the_only_one_listened_to,
    bad_addresses_are_refused_in_words);
