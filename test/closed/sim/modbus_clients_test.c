/* SPDX-License-Identifier: MIT */
/* exhand run --modbus: clients that do harm, and threads that must not. */
#define _XOPEN_SOURCE 700

#include "modbus_rig.h"

#ifdef EXH_MODBUS

#include <dirent.h>
#include <sys/socket.h>

/* Asks for all there is and fetches nothing, until its connection ends or nobody takes more. */
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

/* Others are answered on, and the program ends when told. */
TEST(a_client_that_fetches_no_answer)
{
    struct rig r;
    modbus_t *bad;
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
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

/* Sixteen who say nothing more keep nobody out: who is silent longest goes. */
TEST(silent_clients_keep_nobody_out)
{
    struct rig r;
    modbus_t *silent[20];
    uint16_t word[2];
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
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
    rig_start(&r, WORDS("run", "--pace", "--modbus", "tcp:127.0.0.1:0"));
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
    no_thread_blocks_the_signals_of_a_crash);
#else
RIG_NONE("modbus_clients");
#endif
