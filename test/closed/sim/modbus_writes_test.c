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

static void running(struct rig *r)
{
    for (int i = 0; i < 100 * RIG_PATIENCE_S; i++) {
        const int32_t now = rig_input(r, RIG_HEAD(EXH_HEAD_STATE));
        if (now == EXH_STATE_RUN || now == EXH_STATE_LIMIT) { return; }
        rig_sleep(0.01);
    }
    CHECK(0, "it does not run");
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
                      "tcp:127.0.0.1:0", "--modbus-write"));
    for (int i = 0; i < 60; i++) {
        const int32_t done = rig_input(&r, RIG_HEAD(EXH_HEAD_DONE));
        uint32_t k;
        CHECK(cli_signal_find(exh_scene_bilateral.params->table, "mat_k", &k) != NULL, "no mat_k");
        CHECK_EQ_I64(rig_write(&r, RIG_FLOAT + 2 * k, rig_float(15000 - 100 * i)), 0);
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
    CHECK(times(s.out, ", by register") >= 60, "it does not say who: %s", s.out);
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
    rig_start(&r,
        WORDS("run", "--pace", "--save", image, "--modbus", "tcp:127.0.0.1:0", "--modbus-write"));
    CHECK_EQ_I64(rig_write(&r, RIG_FLOAT + 2 * k, rig_float(432.5)), 0); /* less than it was */
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_APPLY), 0);
    CHECK(rig_wait(&r, RIG_HEAD(EXH_HEAD_DONE), 1) == 0, "not applied");
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_SAVE), 0);
    CHECK(rig_wait(&r, RIG_HEAD(EXH_HEAD_DONE), 2) == 0, "not saved");
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_RESULT)), 0);
    rig_end(&r, 130);
    said_clean(r.dir);
    rig_start(&r, WORDS("run", "--pace", "--load-params", image, "--modbus", "tcp:127.0.0.1:0",
                      "--modbus-write"));
    CHECK_EQ_I64((uint32_t)rig_input(&r, RIG_FLOAT + 2 * k), rig_float(432.5));
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
    rig_start(&r,
        WORDS("run", "--pace", "--save", path, "--modbus", "tcp:127.0.0.1:0", "--modbus-write"));
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
                      "--modbus", "tcp:127.0.0.1:0", "--modbus-write"));
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
    rig_start(&r, WORDS("run", "--scene", "guarded", "--pace", "--rate", "500", "--set",
                      "rule_on=1", "--set", "rule_rate=500", "--set", "rule_b1=30", "--set",
                      "rule_k0=9000", "--set", "rule_k1=2000", "--set", "k=5000", "--set", "b=15",
                      "--modbus", "tcp:127.0.0.1:0", "--modbus-write"));
    CHECK(cli_signal_find(exh_scene_guarded.params->table, "k", &k) != NULL, "no k");
    was = rig_input(&r, RIG_RAW + 2 * k);
    running(&r); /* its hand starts it once: it stays in OFF after that */
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_OFF), 0);
    CHECK(rig_wait(&r, RIG_HEAD(EXH_HEAD_STATE), EXH_STATE_OFF) == 0, "not off");
    CHECK_EQ_I64(rig_write(&r, RIG_FLOAT + 2 * k, rig_float(1e6)), 0); /* in OFF it may rise */
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_APPLY), 0);
    CHECK(rig_wait(&r, RIG_HEAD(EXH_HEAD_DONE), 2) == 0, "nothing came of it");
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_RESULT)), -EXH_E_GAINS);
    CHECK_EQ_I64(rig_input(&r, RIG_RAW + 2 * k), was);
    rig_sleep(1); /* a round of the guard and more: a refusal is no damage */
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_PRESENT)) & EXH_FAULT_CONFIG, 0);
    rig_end(&r, 130);
    said_clean(r.dir);
}

/* --- a person's force limit against any client of the port --- */

static uint32_t value_named(const char *name)
{
    uint32_t i = 0;
    CHECK(cli_signal_find(exh_scene_drop.params->table, name, &i) != NULL, "no %s", name);
    return i;
}

static int ask(struct rig *r, const char *name, double v)
{
    return rig_write(r, RIG_FLOAT + 2 * value_named(name), rig_float(v));
}

/* For a second it pulls, and never by more than 1 N. */
static void within_a_newton(struct rig *r)
{
    int32_t most = 0;
    for (int i = 0; i < 100; i++) {
        const int32_t now = rig_input(r, RIG_OUT + 2 * 2); /* f_des */
        if (now > most) { most = now; }
        rig_sleep(0.01);
    }
    CHECK(most > 1 << 18 && most <= 1 << 20, "%d LSB of 1 uN", (int)most);
}

/* f_max, k and the wall, each to pull harder; and what makes a code mean another current. */
static void attack(struct rig *r)
{
    static const struct {
        const char *name;
        double v;
    } by[] = {{"f_max", 40}, {"k", 20000}, {"q_lim", -0.5}, {"slew_up", 10000000}, {"person_f", 40},
        {"person_i", 1}, {"dac_span", 32767}, {"kf", 0.5}, {"uncalibrated", 0}};
    const int32_t refused = rig_input(r, RIG_HEAD(EXH_HEAD_REFUSED));
    for (size_t i = 0; i < sizeof by / sizeof by[0]; i++) {
        CHECK(ask(r, by[i].name, by[i].v) == EMBXILVAL, "%s := %g", by[i].name, by[i].v);
    }
    CHECK_EQ_I64(rig_input(r, RIG_HEAD(EXH_HEAD_REFUSED)), refused + 9);
}

TEST(who_only_reads_commands_nothing)
{
    struct rig r;
    rig_tables();
    rig_start(&r, WORDS("run", "--pace", "--rate", "500", "--set", "f_max=1", "--set", "person_f=1",
                      "--modbus", "tcp:127.0.0.1:0"));
    running(&r);
    attack(&r);
    CHECK_EQ_I64(ask(&r, "f_max", 0.5), EMBXILVAL);
    for (int coil = 0; coil < EXH_COILS; coil++) { CHECK_EQ_I64(rig_coil(&r, coil), EMBXILVAL); }
    within_a_newton(&r);
    rig_end(&r, 130);
    said_clean(r.dir);
}

TEST(who_may_write_asks_for_less_only_while_it_runs)
{
    struct rig r;
    rig_tables();
    rig_start(&r, WORDS("run", "--pace", "--rate", "500", "--set", "f_max=1", "--set", "person_f=1",
                      "--modbus", "tcp:127.0.0.1:0", "--modbus-write"));
    running(&r);
    attack(&r);
    within_a_newton(&r);
    CHECK_EQ_I64(ask(&r, "f_max", 0.5), 0);
    CHECK_EQ_I64(ask(&r, "k", 100), 0);
    CHECK_EQ_I64(ask(&r, "q_lim", 0.2), 0);
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_APPLY), 0);
    CHECK(rig_wait(&r, RIG_HEAD(EXH_HEAD_DONE), 1) == 0, "not applied");
    CHECK_EQ_I64(rig_input(&r, RIG_HEAD(EXH_HEAD_RESULT)), 0);
    CHECK_EQ_I64(rig_input(&r, RIG_RAW + 2 * value_named("f_max")), 1 << 19);
    /* in OFF it rises, but for what the person set */
    CHECK_EQ_I64(rig_coil(&r, EXH_COIL_OFF), 0);
    CHECK(rig_wait(&r, RIG_HEAD(EXH_HEAD_STATE), EXH_STATE_OFF) == 0, "not off");
    CHECK_EQ_I64(ask(&r, "f_max", 40), 0);
    CHECK_EQ_I64(ask(&r, "person_f", 40), EMBXILVAL);
    rig_end(&r, 130);
    said_clean(r.dir);
}

/* Whatever the other parameters are, the ceiling holds, and says that it does. */
TEST(the_persons_ceiling_holds_above_all)
{
    struct rig r;
    int32_t limits = 0;
    rig_tables();
    rig_start(&r, WORDS("run", "--pace", "--rate", "500", "--set", "f_max=40", "--set", "k=20000",
                      "--set", "person_f=1", "--modbus", "tcp:127.0.0.1:0"));
    running(&r);
    within_a_newton(&r);
    for (int i = 0; i < 100; i++) { limits |= rig_input(&r, RIG_HEAD(EXH_HEAD_LIMITS)); }
    CHECK(limits & EXH_LIMIT_PERSON, "limits %x", (unsigned)limits);
    rig_end(&r, 130);
    said_clean(r.dir);
}

TEST_MAIN("modbus_writes", a_run_with_a_writing_client_replays, saved_parameters_come_back,
    a_place_that_cannot_be_written_is_a_result, commands_run_and_stop_the_box,
    the_rule_of_gains_holds_here_too, who_only_reads_commands_nothing,
    who_may_write_asks_for_less_only_while_it_runs, the_persons_ceiling_holds_above_all);
#else
RIG_NONE("modbus_writes");
#endif
