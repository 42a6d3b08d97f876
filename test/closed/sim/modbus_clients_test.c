/* SPDX-License-Identifier: MIT */
/* exhand run --modbus: clients that do harm, and threads that must not. */
#define _XOPEN_SOURCE 700

#include "modbus_rig.h"

#ifdef EXH_MODBUS

#include "slave/libmodbus.h"

#include <arpa/inet.h>
#include <dirent.h>
#include <netinet/in.h>
#include <sys/socket.h>

/* Requests everything and reads no answer, until its connection ends or is full. */
static void ask_and_never_read(modbus_t *bad)
{
    static const uint8_t ask[12] = {0, 1, 0, 0, 0, 6, 1, 4, 0x04, 0x40, 0, 125};
    uint8_t many[100 * sizeof ask];
    for (size_t i = 0; i < sizeof many; i++) { many[i] = ask[i % sizeof ask]; }
    for (int idle = 0; idle < 100;) {
        const ssize_t n =
            send(modbus_get_socket(bad), many, sizeof many, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (n < 0 && errno != EAGAIN) { return; }
        idle = n < 0 ? idle + 1 : 0;
        if (n < 0) { rig_sleep(0.01); }
    }
}

/* Other clients still get answers, and the program ends on command. */
TEST(a_client_that_fetches_no_answer)
{
    struct rig r;
    modbus_t *bad;
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0", "--modbus-write"));
    bad = rig_client(r.port);
    ask_and_never_read(bad);
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_TEST_INT)), 0x12345678);
    CHECK(rig_coil(&r, EXH_COIL_OFF) == 0 &&
              rig_wait(&r, RIG_HEAD(EXH_HEAD_STATE), EXH_STATE_OFF) == 0,
        "not off");
    rig_end(&r, 130);
    modbus_close(bad);
    modbus_free(bad);
    said_clean(r.dir);
}

/* Sixteen idle clients exclude no new one: the longest idle is replaced. */
TEST(silent_clients_keep_nobody_out)
{
    struct rig r;
    modbus_t *silent[20];
    uint16_t word[2];
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0", "--modbus-write"));
    for (int i = 0; i < 20; i++) {
        silent[i] = rig_client(r.port);
        rig_sleep(0.05);
        CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_TEST_INT)), 0x12345678);
    }
    CHECK(modbus_read_input_registers(silent[19], 4, 2, word) == 2, "%s", modbus_strerror(errno));
    CHECK(modbus_read_input_registers(silent[0], 4, 2, word) == -1, "more than 16");
    rig_end(&r, 130);
    for (int i = 0; i < 20; i++) {
        modbus_close(silent[i]);
        modbus_free(silent[i]);
    }
    said_clean(r.dir);
}

/* Who goes for one more, of three: the n-th, or none. */
TEST(who_gives_up_a_place)
{
    enum { A = 1, B, C };
    static const struct {
        struct place p[3];
        uint32_t from;
        int out;
    } row[] = {
        {{{A, 1, 99}, {A, 0, 50}, {A, 0, 40}}, A, 2},  /* never asked; silent longest */
        {{{A, 1, 90}, {A, 1, 80}, {A, 0, 99}}, A, 2},  /* a reader stays */
        {{{A, 1, 99}, {B, 0, 98}, {B, 0, 50}}, A, 2},  /* before the own reader */
        {{{A, 1, 39}, {B, 0, 20}, {B, 1, 30}}, A, 0},  /* of the same address first; 61 s */
        {{{A, 1, 99}, {B, 1, 39}, {B, 1, 99}}, C, 1},  /* silent for 61 s is idle */
        {{{A, 1, 99}, {B, 1, 98}, {B, 1, 97}}, A, 0},  /* all read: its own */
        {{{A, 1, 99}, {B, 1, 98}, {B, 1, 97}}, B, 2},  /* and of these the longest silent */
        {{{A, 1, 99}, {B, 1, 98}, {B, 1, 97}}, C, -1}, /* all read, none its own */
    };
    for (unsigned i = 0; i < sizeof row / sizeof row[0]; i++) {
        const int out = place_to_clear(row[i].p, 3, row[i].from, 100);
        CHECK(out == row[i].out, "row %u: %d", i, out);
    }
}

/* From another address of this machine. */
static modbus_t *client_of_2(int port)
{
    struct sockaddr_in at = {.sin_family = AF_INET};
    modbus_t *c = modbus_new_tcp("127.0.0.1", port);
    const int fd = socket(AF_INET, SOCK_STREAM, 0);
    at.sin_addr.s_addr = htonl(0x7F000002);
    CHECK(bind(fd, (struct sockaddr *)&at, sizeof at) == 0, "bind: %s", strerror(errno));
    at.sin_addr.s_addr = htonl(0x7F000001);
    at.sin_port = htons((uint16_t)port);
    CHECK(connect(fd, (struct sockaddr *)&at, sizeof at) == 0, "connect: %s", strerror(errno));
    modbus_set_socket(c, fd);
    modbus_set_response_timeout(c, RIG_PATIENCE_S, 0);
    return c;
}

/* It reads every 0.4 s, while 50 connect and say nothing: 25 beside it, 25 from elsewhere. */
TEST(idle_connections_push_out_no_reader)
{
    struct rig r;
    modbus_t *idle[50];
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_TEST_INT)), 0x12345678);
    for (int i = 0; i < 50; i++) {
        idle[i] = i % 2 ? client_of_2(r.port) : rig_client(r.port);
        rig_sleep(0.01);
        if (i % 40 != 39) { continue; }
        CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_TEST_INT)), 0x12345678);
    }
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_TEST_INT)), 0x12345678);
    rig_end(&r, 130);
    for (int i = 0; i < 50; i++) {
        modbus_close(idle[i]);
        modbus_free(idle[i]);
    }
    said_clean(r.dir);
}

/* Sixteen that read: one more from elsewhere is turned away. */
TEST(readers_stay_before_others)
{
    struct rig r;
    modbus_t *reader[15], *late;
    uint16_t word[2];
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
    for (int i = 0; i < 15; i++) {
        reader[i] = rig_client(r.port);
        CHECK(
            modbus_read_input_registers(reader[i], 4, 2, word) == 2, "%s", modbus_strerror(errno));
    }
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_TEST_INT)), 0x12345678);
    late = client_of_2(r.port);
    CHECK(modbus_read_input_registers(late, 4, 2, word) == -1, "a seventeenth is served");
    for (int i = 0; i < 15; i++) {
        CHECK(modbus_read_input_registers(reader[i], 4, 2, word) == 2, "reader %d: %s", i,
            modbus_strerror(errno));
    }
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_TEST_INT)), 0x12345678);
    rig_end(&r, 130);
    for (int i = 0; i < 15; i++) {
        modbus_close(reader[i]);
        modbus_free(reader[i]);
    }
    modbus_close(late);
    modbus_free(late);
    said_clean(r.dir);
}

/* Signals that a thread of pid blocks, by the kernel. */
static unsigned long long blocked_by(pid_t pid, const char *task)
{
    char path[300], line[200];
    unsigned long long mask = 0;
    FILE *f;
    snprintf(path, sizeof path, "/proc/%d/task/%s/status", (int)pid, task);
    f = fopen(path, "r");
    while (f && fgets(line, sizeof line, f)) { (void)sscanf(line, "SigBlk: %llx", &mask); }
    if (f) { fclose(f); }
    return mask;
}

/* A crash in the thread that answers takes its handler's way, as any other: outputs low. */
TEST(no_thread_blocks_the_signals_of_a_crash)
{
    static const int crash[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
    struct rig r;
    char path[64];
    DIR *d;
    int threads = 0, block = 0;
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0", "--modbus-write"));
    (void)rig_input(&r, RIG_HEAD(EXH_HEAD_TICK));
    snprintf(path, sizeof path, "/proc/%d/task", (int)r.pid);
    d = opendir(path);
    for (struct dirent *e; d && (e = readdir(d)) != NULL;) {
        if (e->d_name[0] == '.') { continue; }
        threads++;
        block += (int)(blocked_by(r.pid, e->d_name) >> (SIGINT - 1) & 1);
        for (size_t i = 0; i < sizeof crash / sizeof crash[0]; i++) {
            CHECK(!(blocked_by(r.pid, e->d_name) >> (crash[i] - 1) & 1), "signal %d", crash[i]);
        }
    }
    if (d) { closedir(d); }
    CHECK(threads == 0 || (threads >= 2 && block >= 1), "%d threads, %d answer", threads, block);
    rig_end(&r, 130);
    said_clean(r.dir);
}

TEST_MAIN("modbus_clients", a_client_that_fetches_no_answer, silent_clients_keep_nobody_out,
    who_gives_up_a_place, idle_connections_push_out_no_reader, readers_stay_before_others,
    no_thread_blocks_the_signals_of_a_crash);
#else
RIG_NONE("modbus_clients");
#endif
