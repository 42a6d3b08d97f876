/* SPDX-License-Identifier: MIT */
/* `exhand run --modbus` in a separate process, and its libmodbus clients. */
#ifndef TEST_SIM_MODBUS_RIG_H
#define TEST_SIM_MODBUS_RIG_H

#include "said.h"

#ifndef EXH_MODBUS
/* Where libmodbus is not. sim/modbus says what the command says then. */
#define RIG_NONE(name) \
    TEST(without_libmodbus) { check_note("libmodbus is not here: nothing was tested"); } \
    TEST_MAIN(name, without_libmodbus)
#else

#include "bilateral/bilateral.h"
#include "drop/drop.h"
#include "guarded/guarded.h"

#include "exhand/modbus.h"

#include <errno.h>
#include <modbus/modbus.h>
#include <time.h>

/* What a busy machine may take before a test fails. */
#define RIG_PATIENCE_S 60

/* Where blocks begin, in registers. */
#define RIG_RAW        0x5000u
#define RIG_FLOAT      0x7000u
#define RIG_OUT        0x1000u
#define RIG_OUT_F      0x3000u
#define RIG_HEAD(h)    (2 * (unsigned)(h))

static inline uint32_t rig_float(double v)
{
    const float f = (float)v;
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    return bits;
}

/* Tables are there when a scene has had its defaults. */
static inline void rig_tables(void)
{
    exh_scene_drop.defaults();
    exh_scene_guarded.defaults();
    exh_scene_bilateral.defaults();
}

struct rig {
    const char *dir;
    pid_t pid;
    int port;
    modbus_t *c;
    struct said said;
};

static inline void rig_sleep(double s)
{
    const struct timespec t = {(time_t)s, (long)((s - (double)(time_t)s) * 1e9)};
    nanosleep(&t, NULL);
}

static inline modbus_t *rig_client(int port)
{
    modbus_t *c = modbus_new_tcp("127.0.0.1", port);
    CHECK(c != NULL && modbus_connect(c) == 0, "no connection: %s", modbus_strerror(errno));
    modbus_set_response_timeout(c, RIG_PATIENCE_S, 0);
    return c;
}

/* word: the command line, its place to serve at being tcp:127.0.0.1:0. A paced one makes up for
 * what is late: these tests are of registers, on machines with other work. */
static inline void rig_start(struct rig *r, const char *const *word)
{
    const char *more[32] = {NULL};
    char said[SAID_B];
    int n = 0;
    for (int i = 0; word[i] != NULL && n < 28; i++) {
        more[n++] = word[i];
        if (strcmp(word[i], "--pace") != 0) { continue; }
        more[n++] = "--slack";
        more[n++] = "60";
    }
    memset(r, 0, sizeof *r);
    r->dir = said_dir();
    r->pid = said_start(r->dir, cli_run, more);
    for (int i = 0; i < 100 * RIG_PATIENCE_S && r->port == 0; i++) {
        const char *at;
        said_read(said, said_path(r->dir, "said.out"));
        at = strstr(said, "tcp:127.0.0.1:");
        if (at != NULL && strchr(at, '\n')) { r->port = atoi(at + 14); }
        rig_sleep(0.01);
    }
    CHECK(r->port > 0, "it does not serve");
    r->c = rig_client(r->port);
}

/* Ends it as by Ctrl-C, unless it has already ended. */
static inline void rig_end(struct rig *r, int status)
{
    modbus_close(r->c);
    modbus_free(r->c);
    if (status == 130) { kill(r->pid, SIGINT); }
    said_end(&r->said, r->dir, r->pid);
    CHECK(r->said.status == status, "%d: %s", r->said.status, r->said.err);
}

/* Value i behind the address, as raw. */
static inline int32_t rig_value(const uint16_t *word, unsigned i)
{
    return (int32_t)((uint32_t)word[2 * i] << 16 | word[2 * i + 1]);
}

static inline int32_t rig_input(struct rig *r, unsigned at)
{
    uint16_t word[2] = {0, 0};
    CHECK(modbus_read_input_registers(r->c, (int)at, 2, word) == 2, "%#x: %s", at,
        modbus_strerror(errno));
    return rig_value(word, 0);
}

static inline int rig_write(struct rig *r, unsigned at, uint32_t v)
{
    const uint16_t word[2] = {(uint16_t)(v >> 16), (uint16_t)(v & 0xFFFF)};
    return modbus_write_registers(r->c, (int)at, 2, word) == 2 ? 0 : errno;
}

static inline int rig_coil(struct rig *r, int coil)
{
    return modbus_write_bit(r->c, coil, 1) == 1 ? 0 : errno;
}

/* Until input value `at` is v; 0 if it was in time, else what it is is said. */
static inline int rig_wait(struct rig *r, unsigned at, int32_t v)
{
    for (int i = 0; i < 100 * RIG_PATIENCE_S; i++) {
        if (rig_input(r, at) == v) { return 0; }
        rig_sleep(0.01);
    }
    check_note("value %#x is %d", at, (int)rig_input(r, at));
    return -1;
}

#endif
#endif
