/* SPDX-License-Identifier: MIT */
/* The full box and a world in another process, over UDP. Time is virtual. The controller's ticks
 * lead, and the world does a frame on command while the controller waits. So a slow machine makes
 * the test slow, and nothing else. */
#include "felt.h"

#include "udp.h"

#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#define TICKS_A_FRAME 5     /* 400 frames a second at 2 kHz */
#define PATIENCE_MS   60000 /* for one frame; a longer one hangs */

/* ---- The world's process -------------------------------------------------------------------- */

struct world_cfg {
    const char *at;
    const struct peer_world *world;
    int confuse_at; /* in this frame; 0: never */
};

/* What a network may still have held: a HELLO of a world long gone; and a number far ahead. */
static void confuse(struct udp *udp, const struct peer *peer)
{
    struct exh_wire_tx gone = {3, 77}, far = {peer->tx.session, peer->tx.seq + 60000};
    struct exh_wire_packet p = {.type = EXH_WIRE_PLANES};
    uint8_t buf[EXH_WIRE_MAX_B];
    int32_t n = exh_wire_encode(&far, &p, 0, buf, sizeof buf);
    (void)udp_send(udp, buf, (size_t)n);
    p.type = EXH_WIRE_HELLO;
    p.u.hello = (struct exh_wire_hello){
        .role = EXH_WIRE_WORLD, .lib_version = EXH_VERSION_NUMBER, .table_crc = 0};
    n = exh_wire_encode(&gone, &p, 0, buf, sizeof buf);
    (void)udp_send(udp, buf, (size_t)n);
}

/* A frame at t_s: everything that has come, and the answers. */
static void one_frame(struct udp *udp, struct peer *peer, struct sim_link *link, double t_s)
{
    static struct exh_wire_rx rx;
    static double before_s;
    uint8_t buf[SIM_LINK_PACKET_B];
    int n;
    (void)exh_wire_poll(&rx, (uint32_t)(1e6 * (t_s - before_s)), 1000000);
    before_s = t_s;
    while ((n = udp_recv(udp, buf, sizeof buf)) > 0) {
        struct exh_wire_packet p;
        if (exh_wire_decode(&rx, &p, buf, (size_t)n) > 0) { udp_learn(udp); }
        (void)sim_link_send(&link->way[SIM_LINK_OUT], t_s, buf, (size_t)n);
    }
    peer_frame(peer, link, t_s);
    while ((n = sim_link_recv(&link->way[SIM_LINK_IN], t_s, buf, sizeof buf)) > 0) {
        (void)udp_send(udp, buf, (size_t)n);
    }
}

/* A frame for each time that is read, until it is killed or the writer has gone. */
static void be_world(const struct world_cfg *w, uint32_t session, int told)
{
    static struct sim_link link;
    static struct peer peer;
    const struct peer_cfg cfg = {.world = w->world, .until_s = 1e30};
    struct udp udp;
    double t_s;
    if (udp_open(&udp, w->at, NULL) < 0) { _exit(9); }
    for (int k = 0; k < SIM_LINK_WAYS; k++) {
        const struct sim_link_par p = sim_link_default();
        sim_link_start(&link.way[k], &p, NULL, 1);
    }
    peer_start(&peer, &cfg, session);
    for (int i = 0; read(told, &t_s, sizeof t_s) == sizeof t_s; i++) {
        one_frame(&udp, &peer, &link, t_s);
        if (i == w->confuse_at && i > 0) { confuse(&udp, &peer); }
        if (write(told, "", 1) != 1) { break; }
    }
    _exit(0);
}

/* ---- The controller's process -----------------------------------------------------------------
 */

static struct {
    struct world_cfg cfg;
    pid_t pid; /* 0: there is none */
    int tell;
    uint32_t session;
    long ticks, die_at, rise_at; /* of this run of the controller; < 0: never */
    double before_s;             /* what the runs before have taken */
    double t_s;
} world;

static void begin_world(void)
{
    int ends[2];
    CHECK_EQ_I64(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    world.session++;
    world.pid = fork();
    CHECK(world.pid >= 0, "no process");
    if (world.pid == 0) {
        (void)close(ends[0]);
        be_world(&world.cfg, world.session, ends[1]);
    }
    (void)close(ends[1]);
    world.tell = ends[0];
}

static void kill_world(void)
{
    CHECK(kill(world.pid, SIGKILL) == 0 && waitpid(world.pid, NULL, 0) == world.pid,
        "the world had ended");
    (void)close(world.tell);
    world.pid = 0;
}

/* Whatever the world sends in it is at the socket when it says that it has done. */
static void step_world(double t_s)
{
    struct pollfd done = {world.tell, POLLIN, 0};
    char c;
    CHECK(write(world.tell, &t_s, sizeof t_s) == sizeof t_s, "the world does not listen");
    CHECK(poll(&done, 1, PATIENCE_MS) == 1 && read(world.tell, &c, 1) == 1,
        "the world hangs or has died at %g s", t_s);
}

/* Every tick of the controller, before it reads. */
static void with_the_world(struct exh_drive_in *in)
{
    const long tick = world.ticks++;
    (void)in;
    if (tick == world.die_at) { kill_world(); }
    if (tick == world.rise_at) { begin_world(); }
    world.t_s = world.before_s + posix_time_s();
    if (world.pid && tick % TICKS_A_FRAME == 0) { step_world(world.t_s); }
}

/* A run against it; with it killed and another begun in these ticks, or never. */
static struct bilateral_run meet(struct bilateral_run_cfg c, long die_at, long rise_at)
{
    struct bilateral_run r;
    world.ticks = 0;
    world.die_at = die_at;
    world.rise_at = rise_at;
    c.board.wires_in = with_the_world;
    c.board.line.on = 1;
    c.board.line.udp_local = "127.0.0.1:0";
    c.board.line.udp_peer = world.cfg.at;
    r = run(&c);
    world.before_s = world.t_s + 1.0; /* another is heard when this one was silent for 0.5 s */
    return r;
}

/* A wall for the index finger of this run, in a process at a port that is free just now. */
static void put_up(const struct bilateral_run_cfg *c, int confuse_at)
{
    static struct peer_world wall;
    static char at[32];
    const struct bilateral_finger_is w = {
        EXH_INDEX, c->board.exo.finger[EXH_INDEX].arm_m, c->board.hand.pose};
    struct udp probe;
    CHECK_EQ_I64(udp_open(&probe, "127.0.0.1:0", NULL), 0);
    (void)snprintf(at, sizeof at, "127.0.0.1:%u", udp_port(&probe));
    udp_close(&probe);
    memset(&wall, 0, sizeof wall);
    wall.wall.fingers = 1u << EXH_INDEX;
    bilateral_wall(&wall.wall.plane[EXH_INDEX], &w, c->at_m);
    world.cfg = (struct world_cfg){at, &wall, confuse_at};
    world.session = 10;
    world.before_s = 0;
    begin_world();
}

/* ---- What they do -----------------------------------------------------------------------------
 */

/* The world dies in the contact and another comes; then the controller is started anew, of the same
 * seed. */
TEST(two_processes_survive_each_others_restart)
{
    struct bilateral_run_cfg c =
        plain(1u << EXH_INDEX, 0.87, 2); /* heard again 0.5 s later, before the second */
    struct bilateral_run alone;
    c.board.exo.path[EXH_INDEX].hold_s = 0.3;
    alone = run(&c); /* with a world in this process */
    put_up(&c, 0);
    for (int k = 1; k <= 2; k++) {
        struct bilateral_run r = k == 1 ? meet(c, 1800, 2000) : meet(c, -1, -1);
        const struct bilateral_track *s = &alone.finger[EXH_INDEX], *t = &r.finger[EXH_INDEX];
        size_t i = 0;
        CHECK(t->freezes >= 1 && t->contacts >= 1, "run %d: %ld freezes, %ld contacts", k,
            t->freezes, t->contacts);
        CHECK(k == 2 || (contact_of(t) < 1800 && t->n > 2000), "run %d: killed out of contact", k);
        CHECK(r.box.age < 2 * TICKS_A_FRAME, "run %d: nothing has come for %d ticks", k, r.box.age);
        CHECK(s->n == t->n, "run %d: %zu ticks, %zu", k, t->n, s->n);
        while (i < s->n && i < t->n && same_felt(&s->at[i].raw, &t->at[i].raw)) { i++; }
        CHECK(i == s->n, "run %d: tick %zu is not what it is in one process", k, i);
        bilateral_run_free(&r);
    }
    kill_world();
    bilateral_run_free(&alone);
}

/* After 0.75 s come packets that would make a simple receiver deaf for good. This one is deaf for
 * `quiet` and a HELLO's time, and later contacts are felt as usual. */
TEST(two_processes_are_not_deaf_for_good)
{
    struct bilateral_run_cfg c = plain(1u << EXH_INDEX, 0.1, 2);
    struct bilateral_run r;
    int32_t late;
    put_up(&c, 300);
    r = meet(c, -1, -1);
    CHECK(r.ticks > 5 * c.rate_Hz, "%d ticks: over too soon to tell", (int)r.ticks);
    CHECK_EQ_I64(r.box.silences, 1);
    CHECK(r.box.age < 2 * TICKS_A_FRAME, "nothing has come for %d ticks", r.box.age);
    late = r.box.old + r.box.duplicate + r.box.reordered;
    CHECK(late >= 200 && late <= 410, "%d old: of 400 a second, deaf for 0.5 to 1 s", late);
    CHECK_EQ_I64(r.finger[EXH_INDEX].freezes, 2);
    kill_world();
    bilateral_run_free(&r);
}

TEST_MAIN("bilateral_two", two_processes_survive_each_others_restart,
    two_processes_are_not_deaf_for_good);
