/* The link, over loopback: either end may come, go and come back. */
#include "check.h"

#include "world/link.h"

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
    if (type == EXH_WIRE_STATE) { p.u.state.joint_turn_q32[0][0] = joint; }
    n = exh_wire_write(&c->tx, &p, 1234, buf, sizeof buf);
    CHECK(n > 0 && sendto(c->fd, buf, (size_t)n, 0, (struct sockaddr *)&c->to, sizeof c->to) == n, "%d", (int)n);
}

static void hear(struct controller *c)
{
    unsigned char buf[2 * EXH_WIRE_MAX_B];
    struct exh_wire_packet p;
    ssize_t n;
    while ((n = recv(c->fd, buf, sizeof buf, MSG_DONTWAIT)) > 0) {
        const int type = exh_wire_take(&c->rx, &p, buf, (size_t)n);
        c->hellos += type == EXH_WIRE_HELLO;
        c->answers += type == EXH_WIRE_PLANES;
        if (type == EXH_WIRE_PLANES) { c->planes = p.u.planes; }
    }
}

/* One frame of the world at t_us. */
static int frame(struct exh_wire_state *state, int64_t t_us)
{
    struct exh_wire_planes planes;
    const int newer = link_receive(&world, state, t_us);
    memset(&planes, 0, sizeof planes);
    planes.fingers = 1;
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
    CHECK(c.planes.echo_seq == 2 && c.planes.echo_stamp_us == 1234, "echo %u", (unsigned)c.planes.echo_seq);
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
    CHECK(frame(&s, 2000) && s.joint_turn_q32[0][0] == 8, "the controller's second life is not heard");
    hear(&c);
    CHECK(c.answers > 0, "nor answered");

    link_close(&world); /* and now the world */
    CHECK(link_open(&world, port, NULL, 9, why, sizeof why) == 0, "%s", why);
    say(&c, EXH_WIRE_HELLO, 0);
    say(&c, EXH_WIRE_STATE, 9);
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
        CHECK(link_open(&world, bad[i], NULL, 1, why, sizeof why) == 1 && strstr(why, ": "), "%s: %s", bad[i], why);
        link_close(&world);
    }
}

TEST_MAIN("world: the link", a_state_is_taken_and_answered_with_its_own_number, either_end_may_start_anew,
          without_planes_it_says_hello_alone,
          noise_changes_nothing, a_given_peer_is_the_only_one_listened_to, bad_addresses_are_refused_in_words);
