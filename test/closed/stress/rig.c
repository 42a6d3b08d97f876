/* SPDX-License-Identifier: MIT */
/* The rig: set-up, inputs, and the table of what was seen. */
#include "stress.h"

#include "sim/random.h"

#include "exhand/board.h"

#include <stdarg.h>
#include <stdlib.h>

#define HEALTHY \
    (EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS | EXH_DIN_DRIVE0)

struct rig rig;
static struct sim_random rng = {1};
static int failed;

void exh_assert_failed(const char *file, int line)
{
    printf("%s:%d: the library's assertion\n", file, line);
    abort();
}

#ifdef EXH_FIX_AUDIT
void exh_fix_saturated(const char *file, int line)
{
    (void)file;
    (void)line;
}
#endif

void must(int holds, const char *rule, const char *fmt, ...)
{
    struct watch *w = &rig.w;
    va_list ap;
    int n;
    if (holds) { return; }
    if (w->broken++ > 0) { return; }
    n = snprintf(w->first, sizeof w->first, "%s at tick %" PRIu64 ": ", rule, w->ticks);
    va_start(ap, fmt);
    vsnprintf(w->first + n, sizeof w->first - (size_t)n, fmt, ap);
    va_end(ap);
}

/* --- set-up --- */

void fresh(void)
{
    memset(&rig, 0, sizeof rig);
    rig.enc_bits = 24;
    rig.w.q_min = INT32_MAX;
    rig.w.q_max = INT32_MIN;
    exh_params_setup(
        &rig.params, exh_scene_drop.params->table, (int32_t *)&rig.active, (int32_t *)&rig.staged);
    rig.active.calib.uncalibrated = rig.staged.calib.uncalibrated = 1; /* there is no image here */
}

void set(uint16_t id, int32_t raw)
{
    const int err = exh_params_stage(&rig.params, id, 0, raw);
    must(err == 0, "setting", "id %#x = %ld: %d", (unsigned)id, (long)raw, err);
}

void set_gains(double k_Npm, double b_Nspm)
{
    set(ID_K, (int32_t)(k_Npm * (1 << EXH_Q_K)));
    set(ID_B, (int32_t)(b_Nspm * (1 << EXH_Q_B)));
}

int ready(struct exh_period T)
{
    int err;
    exh_params_apply(&rig.params);
    rig.params.locked = 1;
    rig.T = T;
    err = drop_setup(&rig.cfg, &rig.active, (struct exh_scene_board){T, rig.enc_bits}, NULL);
    exh_params_slew_setup(&rig.params, &rig.active.tune, T);
    if (err != 0) { return err; }
    rig.times = box_times(&rig.active.safety, &rig.active.watch, T);
    rig.box.calm = 1; /* before the first tick no law has commanded anything */
    if (rig.blind) {
        rig.cfg.quad.jump_cnt = INT32_MAX;
        rig.cfg.watch.speed_ticks = UINT32_MAX;
        rig.times.fast = UINT32_MAX;
    }
    return 0;
}

void start(struct exh_period T)
{
    const int err = ready(T);
    if (err == 0) { return; }
    printf("set-up refused: %d\n", err); /* and nothing there to go on with */
    exit(1);
}

void arm(void)
{
    struct exh_drive_out out;
    const uint64_t most = rig.times.arm + rig.times.ramp + 2;
    for (uint64_t n = 0; n < most && rig.sig.state != EXH_STATE_RUN; n++) {
        const struct exh_scene_in in = idle_in(n, 0);
        tick(&in, &out);
    }
    must(rig.sig.state == EXH_STATE_RUN, "arming", "state %ld", (long)rig.sig.state);
}

/* What a value that goes little by little is next. 2^s ticks are the first power of two no shorter
 * than tune_time. */
static int64_t next_of(int64_t now, int64_t goal, int slewed)
{
    const double T_ms = 1000.0 * rig.T.num / rig.T.den;
    int64_t ticks = 1, left = goal < now ? now - goal : goal - now;
    while (slewed && (double)ticks * T_ms < rig.active.tune.time_ms && ticks < 32768) {
        ticks *= 2;
    }
    left = (left + ticks - 1) / ticks;
    return goal < now ? now - left : now + left;
}

void apply(void)
{
    const struct drop_par before = rig.active;
    const int32_t *was = (const int32_t *)&before, *is = (const int32_t *)&rig.active;
    const int32_t *goal = (const int32_t *)&rig.staged;
    exh_params_apply(&rig.params);
    for (uint32_t i = 0; i < exh_signal_count(rig.params.table); i++) {
        const struct exh_signal *row = exh_signal_at(rig.params.table, i, NULL);
        const int up = goal[i] > was[i];
        const int64_t next = next_of(
            was[i], goal[i], exh_signal_is_slewed(row) && (row->when != EXH_WHEN_LIMIT || up));
        must(is[i] == next, "slewed", "%s: %ld, from %ld to %ld is %" PRId64, row->name,
            (long)is[i], (long)was[i], (long)goal[i], next);
    }
}

/* --- inputs --- */

uint64_t any_u64(void) { return sim_random_u64(&rng); }

uint32_t any(uint32_t n) { return (uint32_t)(any_u64() % n); }

/* The monitor of the current coded last, as far as it has a code. */
static int16_t met(void)
{
    const struct exh_drive_par *p = &rig.active.drive;
    const int32_t step = p->mon_A_q40 > 0 ? p->mon_A_q40 : 1; /* before the first set-up: nothing */
    const int64_t up = (int64_t)rig.sig.i_des_A_q26 * (1 << (EXH_Q_MON - EXH_Q_CUR)) / step;
    return (int16_t)exh_clamp(p->mon_zero_raw + up, INT16_MIN, INT16_MAX);
}

struct exh_scene_in idle_in(uint64_t n, uint32_t enc_raw)
{
    struct exh_scene_in in;
    memset(&in, 0, sizeof in);
    in.drive.enc_raw[0] = enc_raw;
    in.drive.mon_raw[0] = met();
    in.drive.din = HEALTHY;
    in.command = n == 0 ? EXH_CMD_RUN : EXH_CMD_NONE;
    return in;
}

/* Ends and middles of 16, 24 and 32 bits. */
static const uint32_t enc_extreme[] = {
    0, 0x7FFF, 0x8000, 0xFFFF, 0x7FFFFF, 0x800000, 0xFFFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 1};
static const int16_t mon_extreme[] = {INT16_MIN, INT16_MAX, 0, -1};

/* idle_in() with encoder and monitor at their ends or anywhere, turn and turn about. */
static struct exh_scene_in wild_in(uint64_t n)
{
    struct exh_scene_in in =
        idle_in(n, enc_extreme[n % 2 ? n / 2 % LEN(enc_extreme) : any(LEN(enc_extreme))]);
    if (n % 5 == 0) { in.drive.enc_raw[0] = (uint32_t)any_u64(); }
    if (n % 4 == 3) { /* not in consecutive ticks: a current that does not follow is a fault */
        in.drive.mon_raw[0] = n % 3 ? mon_extreme[n / 4 % 4] : (int16_t)((int)any(65536) - 32768);
    }
    in.drive.supply_raw = mon_extreme[n % 4];
    return in;
}

/* The string a piece in or out. No jump if the box reports jumps. */
static uint32_t drawn(int in)
{
    const uint32_t quarter = UINT32_C(1) << (rig.enc_bits - 2);
    const uint32_t legal = (uint32_t)rig.cfg.quad.jump_cnt / 8;
    const uint32_t piece = legal < quarter ? legal : quarter;
    return rig.state.quad.raw + (in ? 0u - piece : piece);
}

/* Far in, where no wall can be behind it. */
static uint32_t far_in(void)
{
    return rig.sig.q_m_q30 < -EXH_Q(101, 100, EXH_Q_POS) ? rig.state.quad.raw : drawn(1);
}

struct exh_scene_in handled_in(uint64_t n)
{
    const int shut = rig.box.state == EXH_STATE_OFF || rig.box.state == EXH_STATE_FAULT ||
                     (rig.box.state == EXH_STATE_ARM && rig.box.ramped == 0);
    struct exh_scene_in in = wild_in(n);
    in.command = EXH_CMD_NONE;
    if (!shut && any(4) == 0) {
        in.drive.enc_raw[0] = drawn(rig.sig.q_m_q30 > rig.active.own.q_lim_m_q30);
    }
    if (!shut || any(64) == 0) { return in; }
    in = idle_in(1, far_in());
    in.drive.supply_raw = rig.cfg.supply.max_raw;
    if (rig.box.state == EXH_STATE_OFF) { in.command = EXH_CMD_RUN; }
    if (rig.box.state == EXH_STATE_FAULT) {
        in.command = EXH_CMD_CLEAR;
        /* Now and then no hand is seen open before: that may not clear. */
        if (!rig.box.opened && any(2)) { in.drive.din &= ~(uint32_t)EXH_DIN_DEADMAN; }
    }
    return in;
}

/* --- the table --- */

void report(const char *name, const char *besides)
{
    const struct watch *w = &rig.w;
    char held[160];
    snprintf(held, sizeof held,
        "%8" PRIu64 " ticks F %6.2f N slew %3.0f %% code %5d i %5.3f A heat %3.0f %% "
        "q %+7.1f..%+7.1f mm",
        w->ticks, w->force_max / 1048576.0, 100 * w->slew_share, w->code_max, w->cur_max_A,
        100 * w->heat_share, w->q_min / 1073741.824, w->q_max / 1073741.824);
    printf("%-38s | %-46s | %s | %s\n", name, besides, held, w->broken ? "FAIL" : "ok");
    if (w->broken) { printf("    %" PRIu64 " broken, first %s\n", w->broken, w->first); }
    fflush(stdout);
    failed += w->broken != 0;
}

int failures(void) { return failed; }
