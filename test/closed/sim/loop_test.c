/* SPDX-License-Identifier: MIT */
/* The loop under a script: what is staged, commanded, missed or broken is in the log, acts
 * at its tick, and comes out of the replay bit for bit. */
#include "logs.h"

#include "box/arming.h"
#include "base/logfile.h"
#include "posix.h"

#include "drop/drop.h"
#include "exhand/run/log.h"
#include "exhand/run/scene.h"

#include "exhand/board.h"
#include "exhand/exhand.h"

/* The simulated board is never late, nor broken. So this is the loop itself, compiled
 * once more over a wait, inputs and a description that say what a test wants. */
static int late_wait(void);
static int odd_read(struct exh_drive_in *in);
static int odd_write(const struct exh_drive_out *out);
static void odd_safe(void);
static struct exh_board_info odd_info;
void late_assert_failed(const char *file, int line);
#define exh_loop              late_loop
#define exh_board_wait        late_wait
#define exh_board_info        odd_info
#define exh_board_read_drive  odd_read
#define exh_board_write_drive odd_write
#define exh_board_safe        odd_safe
#define exh_assert_failed     late_assert_failed
#include "../../lib/src/run/loop.c"
#undef exh_loop
#undef exh_board_wait
#undef exh_board_info
#undef exh_board_read_drive
#undef exh_board_write_drive
#undef exh_board_safe
#undef exh_assert_failed

#define DAC_ZERO        32768
#define ID_K            0x0401
#define ID_STEP         0x0201
#define ID_Q_LIM        0x8001
#define ID_ARM          0x0603
#define ID_TUNE         0x1301
#define ID_RAMP         0x0604
#define ID_UNCALIBRATED 0x8903
#define AWAY            EXH_Q(70, 1000, EXH_Q_POS)
/* At 1 kHz, armed in so short a time: commanded at tick n, it runs from n + 4. */
#define ARMED    4
#define RELEASED 15 /* ticks of the release law, 15 ms */

/* ---- Scripted runs --------------------------------------------------------------- */

/* What happens at a tick, before it. */
struct act {
    uint32_t tick;
    /* OPEN: these inputs; JUMP: counts; NO_READ, NO_WRITE: the board fails */
    enum { STAGE, COMMAND, MISS, OPEN, JUMP, NO_READ, NO_WRITE } what;
    uint16_t id; /* STAGE: of the parameter */
    int32_t value;
    int want; /* STAGE: what it must return */
};

/* What the scene gave at a tick. */
struct seen {
    struct exh_drive_out out;
    struct drop_signals sig;
};
#define TICKS_MAX 4000

static struct {
    const struct act *act;
    unsigned acts;
    uint32_t ticks;
    uint32_t writes;  /* that went well */
    uint32_t safe_at; /* ticks when the outputs were first made safe */
    struct seen at[TICKS_MAX];
} script;

static int late_wait(void)
{
    const int missed = exh_board_wait();
    for (unsigned i = 0; missed == 0 && i < script.acts; i++) {
        if (script.act[i].what == MISS && script.act[i].tick == script.ticks) {
            return script.act[i].value;
        }
    }
    return missed;
}

static int happens(int what)
{
    for (unsigned i = 0; i < script.acts; i++) {
        if ((int)script.act[i].what == what && script.act[i].tick == script.ticks) { return 1; }
    }
    return 0;
}

static int odd_write(const struct exh_drive_out *out)
{
    const int err = happens(NO_WRITE) ? -EXH_E_IO : exh_board_write_drive(out);
    script.writes += err == 0;
    return err;
}

static void odd_safe(void)
{
    if (script.safe_at == UINT32_MAX) { script.safe_at = script.ticks; }
    exh_board_safe();
}

/* OPEN lasts one tick, JUMP for good. A board that fails leaves rubbish. */
static int odd_read(struct exh_drive_in *in)
{
    const int err = exh_board_read_drive(in);
    if (happens(NO_READ)) {
        memset(in, 0xA5, sizeof *in);
        return -EXH_E_IO;
    }
    for (unsigned i = 0; i < script.acts; i++) {
        const struct act *a = &script.act[i];
        if (a->what == OPEN && a->tick == script.ticks) { in->din &= ~(uint32_t)a->value; }
        if (a->what == JUMP && a->tick <= script.ticks) { in->enc_raw[0] += (uint32_t)a->value; }
    }
    return err;
}

static void before(uint32_t tick, struct exh_scene_in *in)
{
    CHECK_EQ_I64(tick, script.ticks);
    for (unsigned i = 0; i < script.acts; i++) {
        const struct act *a = &script.act[i];
        if (a->tick != tick) { continue; }
        if (a->what == COMMAND) { in->command = (uint8_t)a->value; }
        if (a->what == STAGE) {
            const int err = exh_params_stage(exh_scene_drop.params, a->id, 0, a->value);
            CHECK(err == a->want, "tick %lu, id %#x: %d, want %d", (unsigned long)tick,
                (unsigned)a->id, err, a->want);
        }
    }
    exh_log_before(tick, in);
}

static void after(uint32_t tick, const struct exh_scene_in *in, const struct exh_drive_out *out)
{
    exh_log_after(tick, in, out);
    if (tick < TICKS_MAX) {
        script.at[tick].out = *out;
        memcpy(
            &script.at[tick].sig, exh_scene_signals(&exh_scene_drop), sizeof script.at[tick].sig);
    }
    script.ticks++;
}

/* Runs the drop scene at 1 kHz for so many ticks over the script; the log to path. It must end
 * with `want`. */
static void run_until(
    const struct act *act, unsigned acts, uint32_t ticks, const char *path, int want)
{
    static const struct exh_loop_hooks hooks = {exh_log_start, before, after};
    struct posix_config c = posix_config_default();
    memset(&script, 0, sizeof script);
    script.act = act;
    script.acts = acts;
    script.safe_at = UINT32_MAX;
    c.max_ticks = ticks;
    c.wait = 1; /* the mass is held for ever */
    odd_info = exh_board_info;
    c.log = fopen(path, "wb");
    CHECK(c.log != NULL, "%s", path);
    posix_configure(&c);
    exh_scene_drop.defaults();
    CHECK_EQ_I64(exh_params_stage(exh_scene_drop.params, ID_ARM, 0, 1), 0);
    CHECK_EQ_I64(exh_params_stage(exh_scene_drop.params, ID_RAMP, 0, 1), 0);
    CHECK_EQ_I64(exh_params_stage(exh_scene_drop.params, ID_UNCALIBRATED, 0, 1), 0);
    CHECK_EQ_I64(exh_params_stage(exh_scene_drop.params, ID_TUNE, 0, 0), 0); /* no slew */
    CHECK_EQ_I64(late_loop(&exh_scene_drop, 1000, &hooks), want);
    CHECK_EQ_I64(exh_log_end(script.ticks), 0);
    CHECK_EQ_I64(fclose(c.log), 0);
    CHECK_EQ_I64(script.ticks, ticks);
}

static void run_script(const struct act *act, unsigned acts, uint32_t ticks, const char *path)
{
    run_until(act, acts, ticks, path, 0);
}

/* The events of a log must be these, in this order. */
static void check_events(
    const char *path, const struct exh_event *want, const uint32_t *tick, size_t n)
{
    struct logfile l;
    struct exh_record r;
    size_t i = 0;
    CHECK_EQ_I64(logfile_open(&l, path), 0);
    while (logfile_next(&l, &r)) {
        struct exh_bytes c = exh_bytes_reader(r.payload, r.len_B);
        struct exh_event e;
        if (r.type != EXH_RECORD_EVENT) { continue; }
        exh_event_serialize(&c, &e);
        CHECK(i < n, "event %zu too many: type %u at tick %lu", i, e.type, (unsigned long)r.tick);
        CHECK(r.tick == tick[i] && e.type == want[i].type && e.id == want[i].id &&
                  e.instance == want[i].instance && e.value == want[i].value &&
                  e.source == want[i].source,
            "event %zu: type %u id %#x value %ld at tick %lu", i, e.type, (unsigned)e.id,
            (long)e.value, (unsigned long)r.tick);
        i++;
    }
    CHECK(i == n, "%zu events, want %zu", i, n);
    logfile_close(&l);
}

/* The mass is held for 100 ms: position 0. A wall 1 mm before it makes k times 1 mm. */
TEST(a_parameter_acts_at_the_tick_it_is_logged)
{
    static const int32_t lim = -EXH_Q(1, 1000, EXH_Q_POS);
    static const struct act act[] = {
        {0, COMMAND, 0, EXH_CMD_RUN, 0},
        {30, STAGE, ID_Q_LIM, -EXH_Q(1, 1000, EXH_Q_POS), 0},
        {40, STAGE, ID_K, EXH_Q(3000, 1, EXH_Q_K), 0},
        {41, STAGE, ID_K, EXH_Q(9, 1, EXH_Q_K), 0},
        {41, STAGE, ID_K, EXH_Q(4000, 1, EXH_Q_K), 0}, /* the last one counts */
        {45, STAGE, ID_K, EXH_Q(4000, 1, EXH_Q_K), 0}, /* no change: no event */
        {50, STAGE, ID_K, -1, -EXH_E_RANGE},
        {50, STAGE, 0x7777, 0, -EXH_E_UNKNOWN},
    };
    static const struct exh_event event[] = {
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_RUN, 0},
        {EXH_EVENT_PARAM, ID_Q_LIM, 0, -EXH_Q(1, 1000, EXH_Q_POS), 1 << EXH_FROM_PERSON},
        {EXH_EVENT_PARAM, ID_K, 0, EXH_Q(3000, 1, EXH_Q_K), 1 << EXH_FROM_PERSON},
        {EXH_EVENT_PARAM, ID_K, 0, EXH_Q(4000, 1, EXH_Q_K), 1 << EXH_FROM_PERSON},
    };
    static const uint32_t tick[] = {0, 30, 40, 41};
    const char *path = log_path();
    run_script(act, LEN(act), 90, path);
    check_events(path, event, tick, LEN(event));
    for (uint32_t n = 0; n < 90; n++) {
        const struct drop_signals *s = &script.at[n].sig;
        const int32_t k = n < 40 ? 1500 : n < 41 ? 3000 : 4000;
        const int64_t force =
            n < 30 ? 0
                   : exh_mul_shr(k << EXH_Q_K, s->q_m_q30 - lim, EXH_Q_K + EXH_Q_POS - EXH_Q_FORCE);
        CHECK(s->c == (n >= 30), "tick %lu: c = %ld", (unsigned long)n, (long)s->c);
        CHECK(s->f_des_N_q20 == force, "tick %lu: %.6f N, want %.6f", (unsigned long)n,
            s->f_des_N_q20 / 1048576.0, (double)force / 1048576.0);
    }
    CHECK_EQ_I64(replay(path, NULL), 0);
    remove(path);
}

TEST(setup_values_are_refused_while_locked)
{
    static const struct act act[] = {
        {0, COMMAND, 0, EXH_CMD_RUN, 0},
        {0, STAGE, ID_STEP, EXH_Q(50, 1000000, EXH_Q_STEP), -EXH_E_STATE},
        {1, STAGE, 0x0301, 0, -EXH_E_STATE},                        /* vel_p */
        {1, STAGE, 0x0504, EXH_Q(5, 1, EXH_Q_CUR), -EXH_E_STATE},   /* i_peak */
        {2, STAGE, 0x0507, 0, -EXH_E_STATE},                        /* dac_zero */
        {3, STAGE, 0x8002, EXH_Q(5, 1, EXH_Q_FORCE), -EXH_E_STATE}, /* kf */
    };
    static const struct exh_event event[] = {{EXH_EVENT_COMMAND, 0, 0, EXH_CMD_RUN, 0}};
    static const uint32_t tick[] = {0};
    const char *path = log_path();
    struct exh_params *p = exh_scene_drop.params;
    exh_scene_drop.defaults();
    CHECK_EQ_I64(
        exh_params_stage(p, ID_STEP, 0, EXH_Q(50, 1000000, EXH_Q_STEP)), 0); /* before: fine */
    run_script(act, LEN(act), 10, path);
    CHECK_EQ_I64(exh_params_stage(p, ID_STEP, 0, EXH_Q(50, 1000000, EXH_Q_STEP)), -EXH_E_STATE);
    check_events(path, event, tick, LEN(event));
    remove(path);
}

/* missed_max is 1: one missed tick is tolerated, two are a fault. The force falls from that tick
 * on, and the missed ticks count as steps of the fall. It is zero until the fault is cleared. */
TEST(missed_ticks_reach_safety)
{
    static const struct act act[] = {
        {0, COMMAND, 0, EXH_CMD_RUN, 0},
        {10, STAGE, ID_Q_LIM, -EXH_Q(1, 1000, EXH_Q_POS), 0}, /* so that there is force */
        {20, MISS, 0, 1, 0},
        {30, MISS, 0, 2, 0},
        {50, COMMAND, 0, EXH_CMD_RUN, 0}, /* not from FAULT */
        {55, MISS, 0, 7, 0},
        {55, COMMAND, 0, EXH_CMD_CLEAR,
            0}, /* not while the cause is there, which is 64 ticks long */
        {240, COMMAND, 0, EXH_CMD_CLEAR, 0}, /* nor before the dead-man was let go */
        {250, OPEN, 0, EXH_DIN_DEADMAN, 0},
        {300, COMMAND, 0, EXH_CMD_CLEAR, 0},
        {305, STAGE, ID_Q_LIM, AWAY, 0},
        {310, COMMAND, 0, EXH_CMD_RUN, 0},
        {318, STAGE, ID_Q_LIM, -EXH_Q(1, 1000, EXH_Q_POS), 0},
        {325, COMMAND, 0, EXH_CMD_OFF, 0},
    };
    static const struct exh_event event[] = {
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_RUN, 0},
        {EXH_EVENT_PARAM, ID_Q_LIM, 0, -EXH_Q(1, 1000, EXH_Q_POS), 1 << EXH_FROM_PERSON},
        {EXH_EVENT_MISSED, 0, 0, 1, 0},
        {EXH_EVENT_MISSED, 0, 0, 2, 0},
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_RUN, 0},
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_CLEAR, 0},
        {EXH_EVENT_MISSED, 0, 0, 7, 0},
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_CLEAR, 0},
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_CLEAR, 0},
        {EXH_EVENT_PARAM, ID_Q_LIM, 0, AWAY, 1 << EXH_FROM_PERSON},
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_RUN, 0},
        {EXH_EVENT_PARAM, ID_Q_LIM, 0, -EXH_Q(1, 1000, EXH_Q_POS), 1 << EXH_FROM_PERSON},
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_OFF, 0},
    };
    static const uint32_t tick[] = {0, 10, 20, 30, 50, 55, 55, 240, 300, 305, 310, 318, 325};
    const char *path = log_path();
    run_script(act, LEN(act), 360, path);
    for (uint32_t n = 0; n < 360; n++) {
        const struct seen *s = &script.at[n];
        const uint32_t let_go = 30 + RELEASED - 2, off = 325 + RELEASED; /* two were missed */
        const int32_t state = n < ARMED         ? EXH_STATE_ARM
                              : n < 30          ? EXH_STATE_RUN
                              : n < let_go      ? EXH_STATE_RELEASE
                              : n < 300         ? EXH_STATE_FAULT
                              : n < 310         ? EXH_STATE_OFF
                              : n < 310 + ARMED ? EXH_STATE_ARM
                              : n < 325         ? EXH_STATE_RUN
                              : n < off         ? EXH_STATE_RELEASE
                                                : EXH_STATE_OFF;
        const int32_t faults =
            n < 30 || n >= 300 ? 0 : EXH_FAULT_OVERRUN | (n >= 250 ? EXH_FAULT_DEADMAN : 0);
        const int ramp = n == 2 || n == 3 || n == 312 || n == 313;
        const int open = state == EXH_STATE_RUN || state == EXH_STATE_RELEASE || ramp;
        const int force = (n >= 10 && n < let_go - 1) || (n >= 318 && n < off - 1);
        CHECK(s->sig.state == state, "tick %lu: state %ld, want %ld", (unsigned long)n,
            (long)s->sig.state, (long)state);
        CHECK(s->sig.faults == faults, "tick %lu: faults %#lx", (unsigned long)n,
            (unsigned long)s->sig.faults);
        CHECK(s->out.enable == open, "tick %lu: enable %u", (unsigned long)n,
            (unsigned)s->out.enable);
        CHECK((s->out.dac_raw[0] > DAC_ZERO) == force &&
                  (s->out.dac_raw[0] == DAC_ZERO) == (s->sig.i_des_A_q26 == 0),
            "tick %lu: code %u, %ld", (unsigned long)n, (unsigned)s->out.dac_raw[0],
            (long)s->sig.i_des_A_q26);
        CHECK_EQ_I64(s->out.alive, (uint8_t)(n + 1));
    }
    check_events(path, event, tick, LEN(event));
    CHECK_EQ_I64(replay(path, NULL), 0);
    remove(path);
}

/* A cause through the whole scene: its effect on the force, and its name. No force follows until a
 * person lets go, holds, clears, and runs outside the wall. */
static void cause(struct act what, int32_t fault)
{
    const struct act act[] = {
        {0, COMMAND, 0, EXH_CMD_RUN, 0},
        {10, STAGE, ID_Q_LIM, -EXH_Q(20, 1000, EXH_Q_POS), 0}, /* so that there is force */
        what,
        {48, OPEN, 0, EXH_DIN_DEADMAN, 0},
        {50, COMMAND, 0, EXH_CMD_CLEAR, 0},
        {60, COMMAND, 0, EXH_CMD_RUN, 0}, /* in the wall */
        {62, STAGE, ID_Q_LIM, AWAY, 0},
        {64, COMMAND, 0, EXH_CMD_RUN, 0},
        {70, STAGE, ID_Q_LIM, -EXH_Q(20, 1000, EXH_Q_POS), 0},
    };
    /* A lost position stays a cause. The others end with their cause. */
    const int lost = fault == EXH_FAULT_ENCODER;
    const uint32_t gone = fault & (int32_t)EXH_FAULT_CUT ? 30 : 30 + RELEASED - 1;
    const char *path = log_path();
    run_script(act, LEN(act), 90, path);
    for (uint32_t n = 11; n < 90; n++) {
        const struct seen *s = &script.at[n];
        const int force = n < gone || (n >= 70 && !lost);
        CHECK((s->out.dac_raw[0] > DAC_ZERO) == force && (s->sig.f_des_N_q20 > 0) == force,
            "fault %#lx, tick %lu: code %u", (unsigned long)fault, (unsigned long)n,
            (unsigned)s->out.dac_raw[0]);
        if (n >= 30 && n < gone) {
            CHECK(s->sig.f_des_N_q20 < script.at[n - 1].sig.f_des_N_q20,
                "tick %lu: it does not fall", (unsigned long)n);
        }
        CHECK((s->sig.faults & fault) == (lost || n < 50 ? (n >= 30 ? fault : 0) : 0),
            "fault %#lx, tick %lu: %#lx", (unsigned long)fault, (unsigned long)n,
            (unsigned long)s->sig.faults);
        CHECK((s->sig.present & fault) == (lost ? (n >= 30 ? fault : 0)
                                              : n == 30 || (n == 48 && fault == EXH_FAULT_DEADMAN)
                                                  ? fault
                                                  : 0),
            "fault %#lx, tick %lu: present", (unsigned long)fault, (unsigned long)n);
    }
    if (!lost) {
        CHECK_EQ_I64(script.at[60].sig.state, EXH_STATE_OFF);
        CHECK_EQ_I64(script.at[60].sig.arm_step, EXH_ARM_SMALL_FORCE);
    }
    CHECK_EQ_I64(replay(path, NULL), 0);
    remove(path);
}

TEST(causes_reach_the_gate)
{
    cause((struct act){30, OPEN, 0, EXH_DIN_ESTOP, 0}, EXH_FAULT_ESTOP);
    cause((struct act){30, OPEN, 0, EXH_DIN_DEADMAN, 0}, EXH_FAULT_DEADMAN);
    cause((struct act){30, OPEN, 0, EXH_DIN_DRIVE0, 0}, EXH_FAULT_DRIVE);
    cause((struct act){30, OPEN, 0, EXH_DIN_WATCHDOG, 0}, EXH_FAULT_WATCHDOG);
    cause((struct act){30, OPEN, 0, EXH_DIN_CARDS, 0}, EXH_FAULT_CARD);
    cause((struct act){30, JUMP, 0, 200, 0}, EXH_FAULT_ENCODER); /* 13 mm in 1 ms */
    cause((struct act){30, JUMP, 0, -200, 0}, EXH_FAULT_ENCODER);
}

TEST(what_a_hand_can_do_is_no_cause)
{
    static const struct act act[] = {
        {0, COMMAND, 0, EXH_CMD_RUN, 0},
        {10, STAGE, ID_Q_LIM, -EXH_Q(20, 1000, EXH_Q_POS), 0},
        {30, JUMP, 0, 100, 0},
    };
    const char *path = log_path();
    run_script(act, LEN(act), 90, path);
    for (uint32_t n = 11; n < 90; n++) {
        const struct seen *s = &script.at[n];
        CHECK(s->out.dac_raw[0] > DAC_ZERO && s->sig.faults == 0 && s->sig.present == 0, "tick %lu",
            (unsigned long)n);
    }
    remove(path);
}

/* The inputs of the last two frames of a log. */
static void last_frames(const char *path, struct exh_drive_in in[2])
{
    struct logfile l;
    struct exh_record r;
    memset(in, 0, 2 * sizeof in[0]);
    CHECK_EQ_I64(logfile_open(&l, path), 0);
    while (logfile_next(&l, &r)) {
        struct exh_bytes c = exh_bytes_reader(r.payload, r.len_B);
        struct exh_scene_in got;
        struct exh_drive_out out;
        int32_t signal[sizeof(struct drop_signals) / sizeof(int32_t)];
        if (r.type != EXH_RECORD_FRAME) { continue; }
        memset(&got, 0, sizeof got);
        exh_log_frame_serialize(&c, &exh_scene_drop, &got, &out, signal);
        CHECK(exh_bytes_ok(&c), "a frame that is none at tick %lu", (unsigned long)r.tick);
        in[0] = in[1];
        in[1] = got.drive;
    }
    logfile_close(&l);
}

/* A board that fails ends the run after one more tick. The scene and its log have the cause, the
 * outputs are safe before, and nothing of that tick is written. */
TEST(a_card_that_fails_is_seen_by_one_last_tick)
{
    static const struct act row[] = {{30, NO_READ, 0, 0, 0}, {30, NO_WRITE, 0, 0, 0}};
    for (size_t i = 0; i < LEN(row); i++) {
        const struct act act[] = {
            {0, COMMAND, 0, EXH_CMD_RUN, 0},
            {10, STAGE, ID_Q_LIM, -EXH_Q(20, 1000, EXH_Q_POS), 0}, /* so that there is force */
            {29, MISS, 0, 1, 0},
            row[i],
        };
        const uint32_t last = row[i].what == NO_READ ? 30 : 31;
        const char *path = log_path();
        struct exh_drive_in in[2];
        run_until(act, LEN(act), last + 1, path, -EXH_E_IO);
        last_frames(path, in);
        CHECK_EQ_I64(script.writes, 30);
        CHECK_EQ_I64(script.safe_at, last);
        CHECK(in[0].din & EXH_DIN_CARDS, "inputs %#lx before", (unsigned long)in[0].din);
        in[0].din &= ~(uint32_t)EXH_DIN_CARDS;
        CHECK(memcmp(&in[0], &in[1], sizeof in[0]) == 0, "the last tick's inputs are others");
        CHECK(script.at[last - 1].out.dac_raw[0] > DAC_ZERO, "no current before");
        CHECK(arming_runs(script.at[last - 1].sig.state), "it did not run");
        CHECK_EQ_I64(script.at[last].sig.state, EXH_STATE_FAULT);
        CHECK_EQ_I64(script.at[last].sig.faults, EXH_FAULT_CARD);
        CHECK(script.at[last].out.dac_raw[0] == DAC_ZERO && script.at[last].out.enable == 0,
            "current");
        CHECK_EQ_I64(replay(path, NULL), 0);
        remove(path);
    }
}

/* Without the command RUN the box stays off and gives the reason. */
TEST(the_loop_commands_nothing_by_itself)
{
    const char *path = log_path();
    run_script(NULL, 0, 20, path);
    for (uint32_t n = 0; n < 20; n++) {
        CHECK_EQ_I64(script.at[n].sig.state, EXH_STATE_OFF);
        CHECK_EQ_I64(script.at[n].out.enable, 0);
    }
    remove(path);
}

TEST(a_board_that_does_not_fit_is_refused)
{
    static const struct {
        struct exh_board_info info;
        int want;
    } row[] = {
        {{"same", EXH_BOARD_VERSION, 1, 24, 20000}, 0},
        {{"16 bit", EXH_BOARD_VERSION, 5, 16, 20000}, 0},
        {{"other", EXH_BOARD_VERSION + 1, 1, 24, 20000}, -EXH_E_VERSION},
        {{"no axis", EXH_BOARD_VERSION, 0, 24, 20000}, -EXH_E_ABSENT},
        {{"8 bit", EXH_BOARD_VERSION, 1, 8, 20000}, -EXH_E_RANGE},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        struct posix_config c = posix_config_default();
        c.max_ticks = 10;
        posix_configure(&c);
        memset(&script, 0, sizeof script);
        odd_info = row[i].info;
        exh_scene_drop.defaults();
        CHECK(late_loop(&exh_scene_drop, 1000, NULL) == row[i].want, "board %s", row[i].info.name);
    }
}

TEST_MAIN("loop", a_parameter_acts_at_the_tick_it_is_logged, setup_values_are_refused_while_locked,
    missed_ticks_reach_safety, causes_reach_the_gate, what_a_hand_can_do_is_no_cause,
    a_card_that_fails_is_seen_by_one_last_tick, the_loop_commands_nothing_by_itself,
    a_board_that_does_not_fit_is_refused);
