/* SPDX-License-Identifier: MIT */
/* The board's link functions. One peer is in this process in virtual time, one in another process
 * over UDP. Either may come, go and come again in any order. */
#include "check.h"

#include "posix.h"
#include "udp.h"

#include "exhand/board.h"
#include "exhand/error.h"
#include "exhand/wire.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define TICKS 2001 /* the last is a frame's instant, too */
#define RATE  1000

static struct posix_config linked(void)
{
    struct posix_config c = posix_config_default();
    c.bench = 1;
    c.line.on = 1;
    return c;
}

static void start(const struct posix_config *c)
{
    struct exh_period T;
    posix_configure(c);
    CHECK_EQ_I64(exh_board_init(RATE, &T), 0);
}

/* ---- In this process ------------------------------------------------------------------------ */

/* a state and its answer */
struct note {
    int number;
    double frame_s; /* of the peer */
};

static struct {
    double at_s[4 * TICKS];
    int frames;
    int lazy; /* takes nothing */
    int last; /* of what it received */
} peer;

/* Answers the newest state once a frame, as a world does. */
static void frame(void *ctx, struct sim_link *link, double t_s)
{
    struct note n, newest = {-1, 0};
    CHECK(ctx == &peer, "context");
    peer.at_s[peer.frames++] = t_s;
    if (peer.lazy) { return; }
    while (sim_link_recv(&link->way[SIM_LINK_OUT], t_s, &n, sizeof n) == sizeof n) { newest = n; }
    if (newest.number < 0) { return; }
    CHECK(newest.number > peer.last, "%d after %d", newest.number, peer.last);
    peer.last = newest.number;
    newest.frame_s = t_s;
    CHECK_EQ_I64(
        sim_link_send(&link->way[SIM_LINK_IN], t_s, &newest, sizeof newest), sizeof newest);
}

/* Every tick sends its number; how many answers came, and the worst and best round trip. */
static int ticks(double *least_s, double *most_s)
{
    int answers = 0;
    *least_s = 1e9;
    *most_s = 0;
    memset(&peer, 0, sizeof peer);
    peer.last = -1;
    for (int n = 0; n < TICKS; n++) {
        struct note out = {n, 0}, in;
        CHECK_EQ_I64(exh_board_wait(), 0);
        while (exh_board_link_recv(&in, sizeof in) == sizeof in) {
            const double trip_s = posix_time_s() - (double)in.number / RATE;
            *least_s = trip_s < *least_s ? trip_s : *least_s;
            *most_s = trip_s > *most_s ? trip_s : *most_s;
            answers++;
        }
        CHECK_EQ_I64(exh_board_link_send(&out, sizeof out), sizeof out);
    }
    return answers;
}

TEST(a_link_that_is_off_takes_nothing)
{
    struct posix_config c = linked();
    uint8_t buf[8] = {0};
    c.line.on = 0;
    start(&c);
    CHECK_EQ_I64(exh_board_wait(), 0);
    CHECK_EQ_I64(exh_board_link_send(buf, sizeof buf), 0);
    CHECK_EQ_I64(exh_board_link_recv(buf, sizeof buf), 0);
}

/* The answer comes after both ways, on the next tick. A peer with frames answers the newest packet
 * that arrived, so old packets add no age but that to the frame. */
TEST(a_peer_in_this_process_answers_in_virtual_time)
{
    static const struct {
        double delay_s, frame_s, least_s, most_s;
        int answers;
    } row[] = {
        {0, 0, 0.001, 0.001, TICKS - 1},
        {0.0103, 0, 0.021, 0.021, TICKS - 21},
        {0.0004, 0, 0.001, 0.001, TICKS - 1},
        {0.0103, 0.00251, 0.021, 0.022, 790},
        {0, 0.01, 0.001, 0.001, TICKS / 10 - 1},
        {0.2505, 0.01, 0.502, 0.502, 150},
    };
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        struct posix_config c = linked();
        double least_s, most_s;
        int answers;
        c.line.frame = frame;
        c.line.ctx = &peer;
        c.line.frame_s = row[i].frame_s;
        c.line.way[SIM_LINK_OUT].delay_s = c.line.way[SIM_LINK_IN].delay_s = row[i].delay_s;
        start(&c);
        answers = ticks(&least_s, &most_s);
        CHECK(answers >= row[i].answers - 6 && answers <= row[i].answers + 6, "row %zu: %d answers",
            i, answers);
        CHECK(least_s > row[i].least_s - 1e-9 && least_s < row[i].least_s + 0.0010001,
            "row %zu: %.6f s", i, least_s);
        CHECK(most_s > row[i].most_s - 0.0010001 && most_s < row[i].most_s + 1e-9,
            "row %zu: %.6f s", i, most_s);
        for (int n = 0; row[i].frame_s > 0 && n < peer.frames; n++) {
            CHECK(peer.at_s[n] == n * row[i].frame_s, "frame %d at %.9f", n, peer.at_s[n]);
        }
        CHECK(row[i].frame_s != 0.01 || peer.frames == 201, "%d frames in 2 s", peer.frames);
    }
}

TEST(a_peer_that_takes_nothing_stops_nobody)
{
    struct posix_config c = linked();
    double a, b;
    c.line.frame = frame;
    c.line.ctx = &peer;
    start(&c);
    memset(&peer, 0, sizeof peer);
    peer.lazy = 1;
    for (int n = 0; n < 100; n++) {
        CHECK_EQ_I64(exh_board_wait(), 0);
        CHECK_EQ_I64(exh_board_link_send(&n, sizeof n), sizeof n);
    }
    CHECK_EQ_I64(peer.frames, 99);
    c.line.frame = NULL; /* no reader: the queue fills, the loop goes on */
    start(&c);
    CHECK_EQ_I64(ticks(&a, &b), 0);
    CHECK_EQ_I64((int64_t)posix_link()->way[SIM_LINK_OUT].counts.overflow, TICKS - SIM_LINK_QUEUE);
}

TEST(too_long_a_packet_is_an_error)
{
    static uint8_t buf[SIM_LINK_PACKET_B + 1];
    const struct posix_config c = linked();
    start(&c);
    CHECK_EQ_I64(exh_board_link_send(buf, sizeof buf), -EXH_E_IO);
    CHECK_EQ_I64(exh_board_link_send(buf, sizeof buf - 1), SIM_LINK_PACKET_B);
}

/* What crosses is its seed's, whatever happens to it on the way. */
TEST(a_bad_line_is_its_seed)
{
    double first[2] = {0, 0};
    for (int k = 0; k < 3; k++) {
        struct posix_config c = linked();
        double least_s, most_s;
        int answers;
        c.seed = k < 2 ? 3 : 4;
        c.line.frame = frame;
        c.line.ctx = &peer;
        c.line.frame_s = 0.01;
        for (int w = 0; w < SIM_LINK_WAYS; w++) {
            c.line.way[w].delay_s = 0.03;
            c.line.way[w].jitter = SIM_LINK_CORRELATED;
            c.line.way[w].jitter_s = 0.03;
            c.line.way[w].loss = 0.2;
            c.line.way[w].in_order = 1;
        }
        start(&c);
        answers = ticks(&least_s, &most_s);
        CHECK(answers > 100 && answers < 190, "%d answers", answers);
        if (k == 0) {
            first[0] = answers;
            first[1] = most_s;
        } else {
            CHECK((answers == first[0] && most_s == first[1]) == (k == 1), "seed %d", (int)c.seed);
        }
    }
}

/* ---- Addresses ---------------------------------------------------------------------------------
 */

TEST(bad_addresses_are_refused)
{
    static const char *const bad[] = {"", "127.0.0.1", ":80", "127.0.0.1:", "127.0.0.1:x",
        "127.0.0.1:65536", "localhost:80", "127.0.0.1:-1", "1.2.3:4", "127.0.0.1:80 "};
    struct udp u;
    struct posix_config c = linked();
    struct exh_period T;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        CHECK(udp_open(&u, bad[i], NULL) == -1 && u.fd < 0, "local \"%s\"", bad[i]);
        CHECK(udp_open(&u, "127.0.0.1:0", bad[i]) == -1 && u.fd < 0, "peer \"%s\"", bad[i]);
    }
    c.line.udp_local = "nowhere";
    posix_configure(&c);
    CHECK_EQ_I64(exh_board_init(RATE, &T), -EXH_E_IO);
}

TEST(strangers_and_cut_packets_are_dropped)
{
    struct udp a, b, c;
    char at[32], to[32];
    uint8_t buf[64] = {0};
    CHECK_EQ_I64(udp_open(&a, "127.0.0.1:0", NULL), 0);
    snprintf(at, sizeof at, "127.0.0.1:%u", udp_port(&a));
    CHECK_EQ_I64(udp_open(&b, "127.0.0.1:0", at), 0);
    snprintf(to, sizeof to, "127.0.0.1:%u", udp_port(&b));
    CHECK_EQ_I64(udp_send(&a, buf, 8), 0); /* no peer known yet */
    CHECK_EQ_I64((int64_t)a.unsent, 1);
    CHECK_EQ_I64(udp_open(&c, "127.0.0.1:0", to), 0);
    CHECK_EQ_I64(udp_send(&c, buf, 8), 8);
    CHECK_EQ_I64(udp_recv(&b, buf, sizeof buf), 0);
    CHECK_EQ_I64((int64_t)b.strangers, 1);
    CHECK_EQ_I64(udp_send(&b, buf, 64), 64);
    CHECK_EQ_I64(udp_send(&b, buf, 10), 10);
    CHECK_EQ_I64(udp_recv(&a, buf, 63), 10); /* the one that does not fit is gone */
    CHECK_EQ_I64((int64_t)a.bad_length, 1);
    CHECK_EQ_I64(udp_send(&a, buf, 8), 0); /* not yet accepted */
    udp_learn(&a);
    udp_learn(&b); /* has its peer */
    CHECK_EQ_I64(udp_send(&a, buf, 8), 8);
    CHECK_EQ_I64(udp_recv(&b, buf, sizeof buf), 8);
    CHECK_EQ_I64(udp_open(&c, at, NULL), -1); /* taken; and c leaks nothing */
    udp_close(&a);
    udp_close(&b);
}

/* As many as a socket keeps of them, and then the one that counts: no call takes them all. */
TEST(a_flood_is_taken_in_parts)
{
    struct udp a, b, c;
    char at[32], to[32];
    uint8_t buf[8] = {0};
    int calls = 1;
    CHECK_EQ_I64(udp_open(&a, "127.0.0.1:0", NULL), 0);
    snprintf(at, sizeof at, "127.0.0.1:%u", udp_port(&a));
    CHECK_EQ_I64(udp_open(&b, "127.0.0.1:0", at), 0);
    snprintf(to, sizeof to, "127.0.0.1:%u", udp_port(&b));
    CHECK_EQ_I64(udp_open(&c, "127.0.0.1:0", to), 0);
    CHECK_EQ_I64(udp_send(&b, buf, 8), 8); /* a knows b now */
    CHECK_EQ_I64(udp_recv(&a, buf, sizeof buf), 8);
    udp_learn(&a);
    for (int i = 0; i < 150; i++) { CHECK_EQ_I64(udp_send(&c, buf, 8), 8); }
    CHECK_EQ_I64(udp_send(&a, buf, 8), 8);
    while (calls < 10 && udp_recv(&b, buf, sizeof buf) == 0) { calls++; }
    CHECK_EQ_I64(calls, 3);
    CHECK_EQ_I64((int64_t)b.strangers, 150);
    udp_close(&a);
    udp_close(&b);
    udp_close(&c);
}

static void post(struct udp *u, struct exh_wire_tx *tx, uint8_t type, int spoil)
{
    struct exh_wire_packet p;
    uint8_t buf[EXH_WIRE_MAX_B];
    int32_t n;
    memset(&p, 0, sizeof p);
    p.type = type;
    n = exh_wire_encode(tx, &p, 0, buf, sizeof buf);
    if (spoil) { buf[n - 1] ^= 1; }
    CHECK_EQ_I64(udp_send(u, buf, (size_t)n), n);
}

/* A controller that waits for its world: a stranger's junk does not redirect its answers. */
TEST(the_peer_is_whose_packet_was_good)
{
    struct posix_config c = linked();
    struct exh_wire_tx good = {5, 0}, bad = {6, 0}, ours = {7, 0};
    struct udp u, world, other;
    char at[32];
    uint8_t buf[EXH_WIRE_MAX_B];
    CHECK_EQ_I64(udp_open(&u, "127.0.0.1:0", NULL), 0); /* a port that is free */
    snprintf(at, sizeof at, "127.0.0.1:%u", udp_port(&u));
    udp_close(&u);
    c.line.udp_local = at;
    start(&c);
    CHECK(udp_open(&world, "127.0.0.1:0", at) == 0 && udp_open(&other, "127.0.0.1:0", at) == 0,
        "sockets");
    post(&world, &good, EXH_WIRE_HELLO, 0);
    for (int n = 0; n < 20; n++) {
        post(&other, &bad, EXH_WIRE_HELLO, 1);  /* damaged */
        post(&other, &bad, EXH_WIRE_PLANES, 0); /* from a peer without HELLO */
        CHECK_EQ_I64(exh_board_wait(), 0);
        while (exh_board_link_recv(buf, sizeof buf) > 0) {}
        CHECK_EQ_I64(exh_board_link_send(&ours, sizeof ours), sizeof ours);
        CHECK(udp_recv(&world, buf, sizeof buf) == sizeof ours, "tick %d: no answer", n);
        CHECK_EQ_I64(udp_recv(&other, buf, sizeof buf), 0);
    }
    post(&other, &bad, EXH_WIRE_HELLO, 0); /* while the world is heard no other begins */
    CHECK_EQ_I64(exh_board_wait(), 0);
    while (exh_board_link_recv(buf, sizeof buf) > 0) {}
    CHECK_EQ_I64(exh_board_link_send(&ours, sizeof ours), sizeof ours);
    CHECK(
        udp_recv(&other, buf, sizeof buf) == 0 && udp_recv(&world, buf, sizeof buf) > 0, "turned");
    for (int n = 0; n < 2100; n++) { CHECK_EQ_I64(exh_board_wait(), 0); }
    post(&other, &bad, EXH_WIRE_HELLO, 0); /* it has started anew, elsewhere */
    CHECK_EQ_I64(exh_board_wait(), 0);
    while (exh_board_link_recv(buf, sizeof buf) > 0) {}
    CHECK_EQ_I64(exh_board_link_send(&ours, sizeof ours), sizeof ours);
    CHECK_EQ_I64(udp_recv(&other, buf, sizeof buf), sizeof ours);
    udp_close(&world);
    udp_close(&other);
    line_stop();
}

/* ---- Two processes
 * -------------------------------------------------------------------------------- */

static void sleep_ms(long ms)
{
    struct timespec t = {0, ms * 1000000L};
    (void)nanosleep(&t, NULL);
}

/* The other side: adds a mark to what it gets and sends it back, until it is killed. */
static void be_world(const char *at, int mark)
{
    struct udp u;
    if (udp_open(&u, at, NULL) < 0) { _exit(1); }
    for (int ms = 0; ms < 60000; ms++) { /* never for ever */
        int v[2];
        while (udp_recv(&u, v, sizeof v) == sizeof v) {
            udp_learn(&u);
            v[1] = mark;
            (void)udp_send(&u, v, sizeof v);
        }
        sleep_ms(1);
    }
    _exit(0);
}

static pid_t begin_world(unsigned port, int mark)
{
    const pid_t pid = fork();
    if (pid == 0) {
        char at[32];
        snprintf(at, sizeof at, "127.0.0.1:%u", port);
        be_world(at, mark);
    }
    CHECK(pid > 0, "no process");
    return pid;
}

static void end_world(pid_t pid)
{
    int status;
    CHECK_EQ_I64(kill(pid, SIGKILL), 0);
    CHECK(waitpid(pid, &status, 0) == pid && WIFSIGNALED(status), "it had ended by itself: %#x",
        (unsigned)status);
}

/* Ticks of the board, sending, until one answer with this mark comes: 1; 0 after patience_ms. */
static int answered(int mark, int patience_ms)
{
    static int number;
    for (int ms = 0; ms < patience_ms; ms++) {
        int out[2] = {++number, 0}, in[2];
        CHECK_EQ_I64(exh_board_wait(), 0);
        CHECK_EQ_I64(exh_board_link_send(out, sizeof out), sizeof out);
        while (exh_board_link_recv(in, sizeof in) == sizeof in) {
            CHECK(in[0] > 0 && in[0] <= number, "%d was never sent", in[0]);
            if (in[1] == mark) { return 1; }
        }
        sleep_ms(1);
    }
    return 0;
}

TEST(two_processes_survive_each_others_restart)
{
    struct posix_config c = linked();
    struct udp u;
    char at[32];
    unsigned port;
    pid_t world;
    CHECK_EQ_I64(udp_open(&u, "127.0.0.1:0", NULL), 0); /* a port that is free */
    port = udp_port(&u);
    udp_close(&u);
    snprintf(at, sizeof at, "127.0.0.1:%u", port);
    c.line.udp_local = "127.0.0.1:0";
    c.line.udp_peer = at;
    start(&c);
    CHECK(!answered(1, 20), "an answer from nobody"); /* the controller is first */
    world = begin_world(port, 1);
    CHECK(answered(1, 5000), "no answer from the first world");
    end_world(world);
    CHECK(!answered(2, 20), "an answer from a world that has gone");
    world = begin_world(port, 2);
    CHECK(answered(2, 5000), "no answer from the second world");
    start(&c); /* the controller anew, at another port */
    CHECK(answered(2, 5000), "no answer to the second controller");
    end_world(world);
    line_stop();
    world = begin_world(port, 3); /* the world is first */
    sleep_ms(20);
    start(&c);
    CHECK(answered(3, 5000), "no answer to the third controller");
    end_world(world);
    line_stop();
}

/* ---- Two computers, nearly: network namespaces with a cable between
 * ------------------------------------ */

#define WORLD_AT "10.77.0.2:4747"

/* What this binary does in a namespace, by EXH_TEST and a variable; nothing otherwise. */
TEST(world_in_a_namespace)
{
    if (getenv("LINE_WORLD") != NULL) { be_world(WORLD_AT, 7); }
}

TEST(controller_in_a_namespace)
{
    struct posix_config c = linked();
    if (getenv("LINE_CONTROLLER") == NULL) { return; }
    c.line.udp_local = "10.77.0.1:0";
    c.line.udp_peer = WORLD_AT;
    start(&c);
    CHECK(answered(7, 5000), "no answer from the other namespace");
    line_stop();
}

TEST(two_network_namespaces)
{
    static const char build[] =
        "{ ip netns add xc$N && ip netns add xw$N && "
        "ip -n xc$N link add v0 type veth peer name v1 netns xw$N && "
        "ip -n xc$N addr add 10.77.0.1/24 dev v0 && ip -n xw$N addr add 10.77.0.2/24 dev v1 && "
        "ip -n xc$N link set v0 up && ip -n xw$N link set v1 up; } >/dev/null 2>&1";
    static const char meet[] =
        "LINE_WORLD=1 EXH_TEST=world_in_a_namespace ip netns exec xw$N \"$SELF\" >/dev/null 2>&1 & "
        "world=$!; LINE_CONTROLLER=1 EXH_TEST=controller_in_a_namespace ip netns exec xc$N "
        "\"$SELF\" "
        ">/dev/null 2>&1; s=$?; kill $world; wait $world; exit $s";
    static const char clear[] = "{ ip netns del xc$N; ip netns del xw$N; } >/dev/null 2>&1";
    char self[512], id[32];
    const ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
    int met = 0;
    CHECK(n > 0, "no /proc/self/exe");
    self[n] = '\0';
    snprintf(id, sizeof id, "%ld", (long)getpid());
    CHECK(setenv("SELF", self, 1) == 0 && setenv("N", id, 1) == 0, "environment");
    if (system(build) == 0) {
        met = system(meet);
    } else {
        check_note("network namespaces need root and `ip`: not tried");
    }
    (void)!system(clear);
    CHECK(met == 0, "status %#x", (unsigned)met);
}

/* The socket behind an impaired way: what is delayed in virtual time leaves late, what is lost
 * never does. */
TEST(a_socket_behind_a_bad_way)
{
    struct posix_config c = linked();
    struct udp u;
    char at[32];
    int v, got = 0;
    CHECK_EQ_I64(udp_open(&u, "127.0.0.1:0", NULL), 0);
    snprintf(at, sizeof at, "127.0.0.1:%u", udp_port(&u));
    c.line.udp_local = "127.0.0.1:0";
    c.line.udp_peer = at;
    c.line.way[SIM_LINK_OUT].delay_s = 0.0105;
    c.line.way[SIM_LINK_OUT].loss = 0.5;
    start(&c);
    for (int n = 0; n < 1000; n++) {
        CHECK_EQ_I64(exh_board_wait(), 0);
        CHECK_EQ_I64(exh_board_link_send(&n, sizeof n), sizeof n);
        while (udp_recv(&u, &v, sizeof v) == sizeof v) {
            CHECK(v == n - 11, "tick %d: packet %d", n, v);
            got++;
        }
    }
    CHECK(got > 420 && got < 570, "%d of 989", got);
    udp_close(&u);
    line_stop();
}

TEST_MAIN("line", a_link_that_is_off_takes_nothing, a_peer_in_this_process_answers_in_virtual_time,
    a_peer_that_takes_nothing_stops_nobody, too_long_a_packet_is_an_error, a_bad_line_is_its_seed,
    bad_addresses_are_refused, strangers_and_cut_packets_are_dropped, a_flood_is_taken_in_parts,
    the_peer_is_whose_packet_was_good, two_processes_survive_each_others_restart,
    world_in_a_namespace, controller_in_a_namespace, two_network_namespaces,
    a_socket_behind_a_bad_way);
