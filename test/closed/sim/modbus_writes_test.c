/* SPDX-License-Identifier: MIT */
/* exhand run --modbus: what clients write and command, in the log, in an image, and refused. */
#define _XOPEN_SOURCE 700

#include "modbus_rig.h"

#ifdef EXH_MODBUS

#include "base/param.h"

#include "drop/drop.h"

#include "exhand/error.h"
#include "exhand/safety.h"

static int times(const char *text, const char *part)
{
    int n = 0;
    for (const char *at = strstr(text, part); at; at = strstr(at + 1, part)) { n++; }
    return n;
}

/* What clients changed is in the log, and the log replays. */
TEST(a_run_with_a_writing_client_replays)
{
    char *dir = said_dir();
    const char *log = said_path(dir, "a.exh");
    struct said s;
    struct rig r;
    rig_tables();
    rig_start(&r, WORDS("run", "--scene", "bilateral", "--pace", "--log", log, "--modbus",
                      "tcp:127.0.0.1:0"));
    for (int i = 0; i < 60; i++) {
        const int32_t done = rig_input(&r, RIG_HEAD(EXH_HEAD_DONE));
        uint32_t k;
        CHECK(cli_signal_find(exh_scene_bilateral.params->table, "mat_k", &k) != NULL, "no mat_k");
        CHECK_EQ_I64(rig_write(&r, RIG_FLOAT + 2 * k, rig_float(5000 + 100 * i)), 0);
        CHECK_EQ_I64(rig_coil(&r, EXH_COIL_APPLY), 0);
        CHECK(rig_wait(&r, RIG_HEAD(EXH_HEAD_DONE), done + 1) == 0, "not applied");
    }
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_OFF), 0);
    CHECK(rig_wait(&r, RIG_HEAD(EXH_HEAD_STATE), EXH_STATE_OFF) == 0, "not off");
    rig_end(&r, 130);
    said(&s, dir, cli_replay, WORDS("replay", log));
    CHECK(s.status == 0, "%s", s.err);
    said(&s, dir, cli_replay, WORDS("replay", log, "--timeline"));
    CHECK(times(s.out, "mat_k") >= 60, "%d changes of mat_k", times(s.out, "mat_k"));
    CHECK(times(s.out, "command: off") == 1, "no OFF");
    said_clean(r.dir);
    said_clean(dir);
}

/* The other half of SAVE: a box that starts where the last one was left. */
TEST(saved_parameters_come_back)
{
    char *dir = said_dir();
    const char *image = said_path(dir, "p.img");
    uint32_t k;
    struct rig r;
    rig_tables();
    CHECK(cli_signal_find(exh_scene_drop.params->table, "k", &k) != NULL, "no k");
    rig_start(&r, WORDS("run", "--pace", "--save", image, "--modbus", "tcp:127.0.0.1:0"));
    CHECK_EQ_I64(rig_write(&r, RIG_FLOAT + 2 * k, rig_float(4321.5)), 0);
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_APPLY), 0);
    CHECK(rig_wait(&r, RIG_HEAD(EXH_HEAD_DONE), 1) == 0, "not applied");
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_SAVE), 0);
    CHECK(rig_wait(&r, RIG_HEAD(EXH_HEAD_DONE), 2) == 0, "not saved");
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_RESULT)), 0);
    rig_end(&r, 130);
    said_clean(r.dir);
    rig_start(&r, WORDS("run", "--pace", "--load-params", image, "--modbus", "tcp:127.0.0.1:0"));
    CHECK_EQ_I64((uint32_t)rig_input(&r, RIG_FLOAT + 2 * k), rig_float(4321.5));
    rig_end(&r, 130);
    said_clean(r.dir);
    said_clean(dir);
}

TEST(a_place_that_cannot_be_written_is_a_result)
{
    char dir[] = "/tmp/exhand-save-XXXXXX", path[64];
    struct rig r;
    CHECK(mkdtemp(dir) != NULL, "no temporary directory");
    (void)snprintf(path, sizeof path, "%s/at.all", dir);
    rig_start(&r, WORDS("run", "--pace", "--save", path, "--modbus", "tcp:127.0.0.1:0"));
    CHECK_EQ_I64(rmdir(dir), 0); /* while the box runs */
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_SAVE), 0);
    CHECK(rig_wait(&r, RIG_HEAD(EXH_HEAD_DONE), 1) == 0, "nothing came of it");
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_RESULT)), -EXH_E_IO);
    rig_end(&r, 130);
    CHECK(strstr(r.said.err, "at.all") && strstr(r.said.err, "--save"), "%s", r.said.err);
    said_clean(r.dir);
}

/* RUN over the wire, where that was allowed, and the dead-man is held. */
TEST(commands_run_and_stop_the_box)
{
    struct rig r;
    rig_start(&r, WORDS("run", "--scene", "bilateral", "--pace", "--rate", "500", "--remote",
                      "--modbus", "tcp:127.0.0.1:0"));
    rig_sleep(0.3);
    CHECK(rig_coil(&r, EXH_COIL_OFF) == 0 &&
              rig_wait(&r, RIG_HEAD(EXH_HEAD_STATE), EXH_STATE_OFF) == 0,
        "not off");
    for (int i = 0; i < 20 && rig_input(&r, RIG_HEAD(EXH_HEAD_STATE)) == EXH_STATE_OFF; i++) {
        CHECK_EQ_I64(rig_coil(&r, EXH_COIL_RUN), 0); /* refused while a finger presses */
        rig_sleep(0.1);
    }
    CHECK(rig_input(&r, RIG_HEAD(EXH_HEAD_STATE)) != EXH_STATE_OFF, "it does not run");
    rig_end(&r, 130);
    said_clean(r.dir);
}

/* With the rule of gains on, a pair outside it is refused, and neither value is taken. */
TEST(the_rule_of_gains_holds_here_too)
{
    uint32_t k;
    int32_t was;
    struct rig r;
    rig_tables();
    rig_start(
        &r, WORDS("run", "--scene", "guarded", "--pace", "--rate", "500", "--set", "rule_on=1",
                "--set", "rule_rate=500", "--set", "rule_b1=30", "--set", "rule_k0=9000", "--set",
                "rule_k1=2000", "--set", "k=5000", "--set", "b=15", "--modbus", "tcp:127.0.0.1:0"));
    CHECK(cli_signal_find(exh_scene_guarded.params->table, "k", &k) != NULL, "no k");
    was = rig_input(&r, RIG_RAW + 2 * k);
    CHECK_EQ_I64(rig_write(&r, RIG_FLOAT + 2 * k, rig_float(1e6)), 0);
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_APPLY), 0);
    CHECK(rig_wait(&r, RIG_HEAD(EXH_HEAD_DONE), 1) == 0, "nothing came of it");
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_RESULT)), -EXH_E_GAINS);
    CHECK_EQ_I64(rig_input(&r, RIG_RAW + 2 * k), was);
    rig_sleep(1); /* a round of the guard and more: a refusal is no damage */
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_PRESENT)) & EXH_FAULT_CONFIG, 0);
    rig_end(&r, 130);
    said_clean(r.dir);
}

TEST_MAIN("modbus_writes", a_run_with_a_writing_client_replays, saved_parameters_come_back,
    a_place_that_cannot_be_written_is_a_result, commands_run_and_stop_the_box,
    the_rule_of_gains_holds_here_too);
#else
RIG_NONE("modbus_writes");
#endif
