/* The loop under a script: what is staged, commanded, missed or broken is in the log, acts
 * at its tick, and comes out of the replay bit for bit. */
#include "logs.h"

#include "cli/logfile.h"
#include "posix.h"

#include "drop/drop.h"
#include "log.h"
#include "scene.h"

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
#define exh_loop          late_loop
#define exh_board_wait    late_wait
#define exh_board_info    odd_info
#define exh_board_read_drive odd_read
#define exh_board_write_drive odd_write
#define exh_board_safe    odd_safe
#define exh_assert_failed late_assert_failed
#include "loop.c"
#undef exh_loop
#undef exh_board_wait
#undef exh_board_info
#undef exh_board_read_drive
#undef exh_board_write_drive
#undef exh_board_safe
#undef exh_assert_failed

#define LEN(a)   (sizeof(a) / sizeof((a)[0]))
#define DAC_ZERO 32768
#define ID_K     0x0401
#define ID_STEP  0x0201
#define ID_Q_LIM 0x8001

/* ---- Scripted runs --------------------------------------------------------------- */

/* What happens at a tick, before it. */
struct act {
    uint32_t tick;
    /* OPEN: these inputs; JUMP: counts; NO_READ, NO_WRITE: the board fails */
    enum { STAGE, COMMAND, MISS, OPEN, JUMP, NO_READ, NO_WRITE } what;
    uint16_t id; /* STAGE: of the parameter                                     */
    int32_t value;
    int want; /* STAGE: what it must return                                     */
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
    uint32_t writes; /* that went well                                          */
    uint32_t safe_at; /* ticks when the outputs were first made safe            */
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
        memcpy(&script.at[tick].sig, exh_scene_drop.signal, sizeof script.at[tick].sig);
    }
    script.ticks++;
}

/* Runs the drop scene at 1 kHz for so many ticks over the script; the log to path. It must end
 * with `want`. */
static void run_until(const struct act *act, unsigned acts, uint32_t ticks, const char *path,
                      int want)
{
    static const struct exh_loop_hooks hooks = {exh_log_start, before, after};
    struct posix_config c = posix_config_default();
    memset(&script, 0, sizeof script);
    script.act = act;
    script.acts = acts;
    script.safe_at = UINT32_MAX;
    c.max_ticks = ticks;
    odd_info = exh_board_info;
    c.log = fopen(path, "wb");
    CHECK(c.log != NULL, "%s", path);
    posix_configure(&c);
    exh_scene_drop.defaults();
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
static void check_events(const char *path, const struct exh_event *want, const uint32_t *tick,
                         size_t n)
{
    struct logfile l;
    struct exh_record r;
    size_t i = 0;
    CHECK_EQ_I64(logfile_open(&l, path), 0);
    while (logfile_next(&l, &r)) {
        struct exh_bytes c = exh_bytes_reader(r.payload, r.len_B);
        struct exh_event e;
        if (r.type != EXH_RECORD_EVENT) { continue; }
        exh_event_bytes(&c, &e);
        CHECK(i < n, "event %zu too many: type %u at tick %lu", i, e.type, (unsigned long)r.tick);
        CHECK(r.tick == tick[i] && e.type == want[i].type && e.id == want[i].id &&
                  e.instance == want[i].instance && e.value == want[i].value,
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
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_RUN},
        {EXH_EVENT_PARAM, ID_Q_LIM, 0, -EXH_Q(1, 1000, EXH_Q_POS)},
        {EXH_EVENT_PARAM, ID_K, 0, EXH_Q(3000, 1, EXH_Q_K)},
        {EXH_EVENT_PARAM, ID_K, 0, EXH_Q(4000, 1, EXH_Q_K)},
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
        {1, STAGE, 0x0301, 0, -EXH_E_STATE}, /* vel_p     */
        {1, STAGE, 0x0504, EXH_Q(5, 1, EXH_Q_CUR), -EXH_E_STATE}, /* i_peak */
        {2, STAGE, 0x0507, 0, -EXH_E_STATE}, /* dac_zero  */
        {3, STAGE, 0x8002, EXH_Q(5, 1, EXH_Q_FORCE), -EXH_E_STATE}, /* kf */
    };
    static const struct exh_event event[] = {{EXH_EVENT_COMMAND, 0, 0, EXH_CMD_RUN}};
    static const uint32_t tick[] = {0};
    const char *path = log_path();
    struct exh_params *p = exh_scene_drop.params;
    exh_scene_drop.defaults();
    CHECK_EQ_I64(exh_params_stage(p, ID_STEP, 0, EXH_Q(50, 1000000, EXH_Q_STEP)),
                 0); /* before: fine */
    run_script(act, LEN(act), 10, path);
    CHECK_EQ_I64(exh_params_stage(p, ID_STEP, 0, EXH_Q(50, 1000000, EXH_Q_STEP)), -EXH_E_STATE);
    check_events(path, event, tick, LEN(event));
    remove(path);
}

/* missed_max is 1: one missed tick is tolerated, two are a fault, with no current in that
 * very tick and until somebody clears it. */
TEST(missed_ticks_reach_safety)
{
    static const struct act act[] = {
        {0, COMMAND, 0, EXH_CMD_RUN, 0},
        {10, STAGE, ID_Q_LIM, -EXH_Q(1, 1000, EXH_Q_POS), 0}, /* so that there is force */
        {20, MISS, 0, 1, 0},
        {30, MISS, 0, 2, 0},
        {40, COMMAND, 0, EXH_CMD_RUN, 0}, /* not from FAULT */
        {45, MISS, 0, 7, 0},
        {45, COMMAND, 0, EXH_CMD_CLEAR, 0}, /* not while the cause is there, which is 64 ticks long */
        {300, COMMAND, 0, EXH_CMD_CLEAR, 0},
        {310, COMMAND, 0, EXH_CMD_RUN, 0},
        {320, COMMAND, 0, EXH_CMD_OFF, 0},
    };
    static const struct exh_event event[] = {
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_RUN},
        {EXH_EVENT_PARAM, ID_Q_LIM, 0, -EXH_Q(1, 1000, EXH_Q_POS)},
        {EXH_EVENT_MISSED, 0, 0, 1},
        {EXH_EVENT_MISSED, 0, 0, 2},
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_RUN},
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_CLEAR},
        {EXH_EVENT_MISSED, 0, 0, 7},
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_CLEAR},
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_RUN},
        {EXH_EVENT_COMMAND, 0, 0, EXH_CMD_OFF},
    };
    static const uint32_t tick[] = {0, 10, 20, 30, 40, 45, 45, 300, 310, 320};
    const char *path = log_path();
    run_script(act, LEN(act), 340, path);
    for (uint32_t n = 0; n < 340; n++) {
        const struct seen *s = &script.at[n];
        const int32_t state = n < 30   ? EXH_STATE_RUN
                              : n < 300 ? EXH_STATE_FAULT
                              : n < 310 ? EXH_STATE_OFF
                              : n < 320 ? EXH_STATE_RUN
                                       : EXH_STATE_OFF;
        CHECK(s->sig.state == state, "tick %lu: state %ld, want %ld", (unsigned long)n,
              (long)s->sig.state, (long)state);
        CHECK(s->sig.faults == (state == EXH_STATE_FAULT ? EXH_FAULT_OVERRUN : 0),
              "tick %lu: faults %#lx", (unsigned long)n, (unsigned long)s->sig.faults);
        CHECK(s->out.enable == (state == EXH_STATE_RUN), "tick %lu: enable %u", (unsigned long)n,
              (unsigned)s->out.enable);
        CHECK((s->out.dac_raw[0] > DAC_ZERO) == (state == EXH_STATE_RUN && n >= 10) &&
                  (s->out.dac_raw[0] == DAC_ZERO) == (s->sig.i_des_A_q26 == 0),
              "tick %lu: code %u, %ld", (unsigned long)n, (unsigned)s->out.dac_raw[0],
              (long)s->sig.i_des_A_q26);
        CHECK_EQ_I64(s->out.alive, (uint8_t)(n + 1));
    }
    check_events(path, event, tick, LEN(event));
    CHECK_EQ_I64(replay(path, NULL), 0);
    remove(path);
}

/* Each cause through the whole scene: no current in the very tick it is seen, the cause
 * named, and nothing before somebody clears it. */
TEST(causes_reach_the_gate)
{
    static const struct {
        struct act act;
        int32_t fault;
    } row[] = {
        {{30, OPEN, 0, EXH_DIN_ESTOP, 0}, EXH_FAULT_ESTOP},
        {{30, OPEN, 0, EXH_DIN_DEADMAN, 0}, EXH_FAULT_DEADMAN},
        {{30, OPEN, 0, EXH_DIN_DRIVE0, 0}, EXH_FAULT_DRIVE},
        {{30, JUMP, 0, 200, 0}, EXH_FAULT_ENCODER}, /* 13 mm in 1 ms */
        {{30, JUMP, 0, -200, 0}, EXH_FAULT_ENCODER},
        {{30, JUMP, 0, 100, 0}, 0},
    };
    for (size_t i = 0; i < LEN(row); i++) {
        const struct act act[] = {
            {0, COMMAND, 0, EXH_CMD_RUN, 0},
            {10, STAGE, ID_Q_LIM, -EXH_Q(20, 1000, EXH_Q_POS), 0}, /* so that there is force */
            row[i].act,
            {50, COMMAND, 0, EXH_CMD_CLEAR, 0},
            {60, COMMAND, 0, EXH_CMD_RUN, 0},
        };
        const char *path = log_path();
        run_script(act, LEN(act), 90, path);
        for (uint32_t n = 11; n < 90; n++) {
            const struct seen *s = &script.at[n];
            /* A lost position stays a cause; the others are gone at once. */
            const int lost = row[i].fault == EXH_FAULT_ENCODER && n >= 30;
            const int faulty = lost || (row[i].fault != 0 && n >= 30 && n < 60);
            CHECK((s->out.dac_raw[0] == DAC_ZERO) == faulty && (s->sig.f_des_N_q20 == 0) == faulty,
                  "cause %zu, tick %lu: code %u", i, (unsigned long)n,
                  (unsigned)s->out.dac_raw[0]);
            CHECK(s->sig.faults == (lost || (faulty && n < 50) ? row[i].fault : 0), "cause %zu, tick %lu", i,
                  (unsigned long)n);
            CHECK(s->sig.present == (lost || n == 30 ? row[i].fault : 0), "cause %zu, tick %lu: present", i,
                  (unsigned long)n);
        }
        CHECK_EQ_I64(replay(path, NULL), 0);
        remove(path);
    }
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
        exh_log_frame_bytes(&c, &exh_scene_drop, &got, &out, signal);
        CHECK(exh_bytes_ok(&c), "a frame that is none at tick %lu", (unsigned long)r.tick);
        in[0] = in[1];
        in[1] = got.drive;
    }
    logfile_close(&l);
}

/* A board that fails ends the run, by a tick more: the scene and its log have the cause, the
 * outputs are safe before, and nothing of that tick goes out. */
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
        CHECK_EQ_I64(script.at[last - 1].sig.state, EXH_STATE_RUN);
        CHECK_EQ_I64(replay(path, NULL), 0);
        remove(path);
    }
}

/* Nobody commands RUN: the box stays off and says why not. */
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
          missed_ticks_reach_safety, causes_reach_the_gate, a_card_that_fails_is_seen_by_one_last_tick, the_loop_commands_nothing_by_itself,
          a_board_that_does_not_fit_is_refused);
