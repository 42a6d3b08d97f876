/* SPDX-License-Identifier: MIT */
/* One branch: a copy of the process goes on with a fault, and is watched. */
#include "lab/faults/faults.h"

#include "posix.h"

#include "exhand/board.h"
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#define SMALL_A 0.02 /* in the motor: none */
#define AFTER_S \
    2e-3 /* and so much after the code and two ticks: delay, servo, current loop \
          */
#define BACK_S   0.05
#define ASTRAY_A 0.26  /* more than tracking tolerates, and its noise */
#define ASTRAY_S 20e-3 /* and that for so long, and some ticks */
#define DAC_ZERO 32768
#define DAC_SPAN 12184

/* of the child */
static struct {
    int to; /* its parent */
    const struct faults_base *base;
    const struct faults_case *c; /* NULL: this is no child */
    struct faults_case own;
    struct faults_seen *seen;
    struct faults_view last;
    uint32_t at_tick, tick; /* of the branch; now */
    uint32_t missed;        /* before this tick */
    uint32_t gone[2];       /* ticks since the causes began, this one too */
    int closing;            /* since a tick that saw a cause nothing may rise any more */
    uint32_t steps, came;   /* since then, missed ones too; and without */
    int zero, cut;
    double from_s, close_s, zero_s; /* the branch, the tick that saw it, no code */
    double cut_s;                   /* the drives were disabled */
    double v_mps, a_mps2;
    int known; /* how many of these two */
} in;

static int has(unsigned source)
{
    return in.c->what[0].source == source || in.c->what[1].source == source;
}

/* --- the device --- */

static const struct plant *device(void)
{
    return in.base->scene == FAULTS_DROP ? posix_plant() : &posix_finger(FAULTS_FINGER)->plant;
}

static int flows(double more_A)
{
    const double cur_A = device()->cur_A;
    return cur_A > more_A || cur_A < -more_A;
}

static int current_flows(void) { return flows(SMALL_A); }

/* A damaged zero of the D/A is believed: a drive with code 0 pulls by it until the guard disables
 * it. A current beyond the tolerance of tracking must have been reported before. */
static double believed_s(double due_s)
{
    const struct exh_signal *row = faults_source_row();
    const double astray_s = due_s + ASTRAY_S + 6.0 / in.base->rate_Hz;
    double until_s = in.cut ? in.cut_s : posix_time_s();
    if (row == NULL || strcmp(row->name, "dac_zero") != 0) { return due_s; }
    if (flows(ASTRAY_A) && until_s > astray_s) { until_s = astray_s; }
    return until_s > due_s ? until_s : due_s;
}

static double more(double a, double b) { return b < 0 ? (-b > a ? -b : a) : b > a ? b : a; }

/* Speed and jerk of finger or mass, from tick to tick. */
static void watch_back(void)
{
    const double T_s = (1.0 + in.missed) / in.base->rate_Hz, v_mps = device()->v_mps;
    const double a_mps2 = (v_mps - in.v_mps) / T_s;
    if (in.closing && posix_time_s() < in.close_s + BACK_S) {
        in.seen->back_mps = more(in.seen->back_mps, v_mps);
        if (in.known > 1) {
            in.seen->jerk_mps3 = more(in.seen->jerk_mps3, (a_mps2 - in.a_mps2) / T_s);
        }
    }
    in.v_mps = v_mps;
    in.a_mps2 = a_mps2;
    in.known += in.known < 2;
}

static void watch_current(void)
{
    const double T_s = 1.0 / in.base->rate_Hz;
    /* A D/A that does not update is off when the release has ended and the drive with it. */
    const int stands = has(FAULTS_DA);
    const double end_s = in.close_s + T_s * faults_zero_ticks(in.base->rate_Hz);
    const double none_s = stands && end_s > in.zero_s ? end_s : in.zero_s;
    const double due_s = believed_s(none_s);
    if (current_flows()) {
        if (in.closing) { in.seen->zero_s = posix_time_s() - in.close_s; }
        if (in.zero && posix_time_s() > due_s + 2 * T_s + AFTER_S) {
            in.seen->bad |= FAULTS_BAD_DEVICE;
        }
    }
}

void faults_dead_tick(double fed_s)
{
    if (in.c == NULL) { return; }
    /* The watchdog has three periods from when it was last fed. */
    if (current_flows() && posix_time_s() > fed_s + 3.0 / in.base->rate_Hz + AFTER_S) {
        in.seen->bad |= FAULTS_BAD_DEVICE;
    }
    watch_current();
}

/* --- the box --- */

static int64_t all_of(const int32_t *v)
{
    int64_t sum = 0;
    for (unsigned f = 0; f < EXH_FINGERS; f++) { sum += v[f] < 0 ? -(int64_t)v[f] : v[f]; }
    return sum;
}

/* A force may rise in it. */
static int is_open(const struct faults_view *v) { return v->open && v->state != EXH_STATE_RELEASE; }

/* Causes that are reported for the first time. */
static void see_causes(const struct faults_view *v)
{
    for (unsigned k = 0; k < 2; k++) {
        const struct faults_what *w = &in.c->what[k];
        const uint32_t bits = faults_spec_of(w->source)->bits;
        if (w->source == FAULTS_NOTHING || in.tick <= in.at_tick + w->after_ticks) { continue; }
        in.gone[k]++;
        if (in.seen->seen_ticks[k] >= 0 || !((v->present | (v->faults & ~in.last.faults)) & bits)) {
            continue;
        }
        in.seen->seen_ticks[k] = (int32_t)in.gone[k] - 1;
        in.seen->state[k] = v->state;
        in.seen->before[k] = in.last;
        if (!in.last.open && !v->open) { in.closing = in.zero = 1; } /* must stay so */
        in.seen->present |= v->present;
    }
}

/* Force in a tick of a release: falls by its steps, no more. */
static void check_release(const struct faults_view *v)
{
    const double law =
        in.seen->force_N * (1 << EXH_Q_FORCE) / faults_release_ticks(in.base->rate_Hz);
    const double fell = (double)(all_of(in.last.force_N_q20) - all_of(v->force_N_q20));
    const double steps = 1.0 + in.missed;
    if (fell > steps * (law + 1) + 0.5) { in.seen->bad |= FAULTS_BAD_SLOPE; }
    if (law >= 1 << 10 && fell / (steps * law) > in.seen->slope) {
        in.seen->slope = fell / (steps * law);
    }
    if (in.steps > faults_zero_ticks(in.base->rate_Hz) && all_of(v->force_N_q20) > 0) {
        in.seen->bad |= FAULTS_BAD_ZERO;
    }
}

static void check_box(const struct faults_view *v, const struct exh_drive_out *out)
{
    const int none = all_of(v->force_N_q20) == 0 && all_of(v->coded_A_q26) == 0;
    const uint32_t told = v->present | v->faults;
    const uint32_t before = in.steps;
    in.came++;
    in.steps += 1 + (in.steps ? in.missed : 0); /* what was missed before it was seen is no delay */
    if (all_of(v->force_N_q20) > all_of(in.last.force_N_q20) ||
        all_of(v->coded_A_q26) > all_of(in.last.coded_A_q26)) {
        in.seen->bad |= in.zero ? FAULTS_BAD_OPEN : FAULTS_BAD_RISE;
    }
    if (!in.cut) { in.cut_s = posix_time_s(); }
    in.cut |= (told & FAULTS_CUTS) != 0;
    if (in.cut) {
        if (!none || out->enable) { in.seen->bad |= FAULTS_BAD_CUT; }
    } else {
        check_release(v);
    }
    /* A force that was next to none is gone before its release has ended. */
    if (out->enable &&
        (v->state != EXH_STATE_RELEASE || before >= faults_zero_ticks(in.base->rate_Hz))) {
        in.seen->bad |= FAULTS_BAD_ENABLE;
    }
    if (none && !in.zero) {
        in.zero = 1;
        in.zero_s = posix_time_s();
        in.seen->zero_ticks = (int32_t)in.came;
        if (in.seen->seen_ticks[0] >= 0) {
            in.seen->after_ticks = (int32_t)in.gone[0] - in.seen->seen_ticks[0];
        }
    }
}

/* Zero, span and scale of the D/A are believed until the guard has checked them. A zero outside its
 * range stays the code of drives, which are disabled by then. */
static int believes_codes(const struct faults_view *v, const struct exh_drive_out *out)
{
    const struct exh_signal *row = faults_source_row();
    return row && strncmp(row->name, "dac_", 4) == 0 &&
           (!(v->present & EXH_FAULT_CONFIG) || !out->enable);
}

static void check_codes(const struct faults_view *v, const struct exh_drive_out *out)
{
    if (believes_codes(v, out)) { return; }
    for (unsigned f = 0; f < EXH_FINGERS; f++) {
        const int32_t off = (int32_t)out->dac_raw[f] - DAC_ZERO;
        if (off > DAC_SPAN || off < -DAC_SPAN) { in.seen->bad |= FAULTS_BAD_CODE; }
    }
}

static void finish(int done)
{
    in.seen->end = in.last;
    if (in.c->trace) { fflush(in.c->trace); }
    _exit(done && write(in.to, in.seen, sizeof *in.seen) == (ssize_t)sizeof *in.seen ? 0 : 1);
}

static void write_trace(const struct faults_view *v)
{
    const unsigned f = faults_finger(in.base->scene);
    if (in.c->trace == NULL) { return; }
    fprintf(in.c->trace, "%.9f,%.9g,%.9g,%.9g,%d\n",
        posix_time_s() - in.from_s - (1.0 + in.c->what[0].after_ticks) / in.base->rate_Hz,
        (double)v->force_N_q20[f] / (1 << EXH_Q_FORCE),
        (double)v->coded_A_q26[f] / (1 << EXH_Q_CUR), device()->cur_A, v->state);
}

int faults_after(uint32_t tick, const struct faults_view *v, const struct exh_drive_out *out)
{
    if (in.c == NULL) { return 0; }
    in.tick = tick;
    see_causes(v);
    if (!in.closing && !is_open(v) && is_open(&in.last)) {
        in.closing = 1;
        in.steps = in.came = 0;
        in.close_s = posix_time_s();
        in.seen->force_N = (double)all_of(in.last.force_N_q20) / (1 << EXH_Q_FORCE);
    }
    if (in.closing) { check_box(v, out); }
    in.seen->opened |= v->open != 0;
    in.seen->released |= v->state == EXH_STATE_RELEASE;
    check_codes(v, out);
    if (out->enable & ~(1u << faults_finger(in.base->scene))) { /* of a finger not in use */
        in.seen->bad |= FAULTS_BAD_ENABLE;
    }
    in.seen->digest = exh_crc32(in.seen->digest, out->dac_raw, sizeof out->dac_raw);
    in.seen->digest = exh_crc32(in.seen->digest, &out->enable, 1);
    watch_current();
    watch_back();
    write_trace(v);
    in.last = *v;
    if (tick - in.at_tick >= in.c->follow_ticks) { finish(1); }
    faults_source_step(tick);
    return 1;
}

void faults_before(uint32_t tick, struct exh_scene_in *to)
{
    if (in.c == NULL) { return; }
    to->missed += faults_source_gone();
    in.missed = to->missed;
    to->command = in.c->run_tick == tick ? EXH_CMD_RUN : EXH_CMD_NONE;
    if (in.c->eager) { to->command = tick & 1 ? EXH_CMD_RUN : EXH_CMD_CLEAR; }
    if (faults_source_off()) { to->command = EXH_CMD_OFF; }
}

/* The loop has ended: a card's error. What it left behind must be safe. */
void faults_ended(void)
{
    if (in.c == NULL) { return; }
    for (double k = 0; k < 4 + 2 * AFTER_S * in.base->rate_Hz; k++) {
        (void)exh_board_wait();
        watch_current();
    }
    if (current_flows()) { in.seen->bad |= FAULTS_BAD_DEVICE; }
    in.seen->ended = 1;
    finish(has(FAULTS_CARD) || has(FAULTS_PAR)); /* a rest code that is none is a card's error */
}

/* --- parent and child --- */

static void become(const struct faults_base *b, const struct faults_case *c, uint32_t tick,
    const struct faults_view *v, struct faults_seen *seen, int to)
{
    close(2); /* what is wrong is not said to people */
    memset(&in, 0, sizeof in);
    in.base = b;
    in.own = *c; /* its caller's is gone soon */
    in.c = &in.own;
    in.seen = seen;
    in.to = to;
    in.last = *v;
    in.at_tick = tick;
    in.from_s = posix_time_s();
    in.closing = v->state == EXH_STATE_RELEASE || v->state == EXH_STATE_FAULT;
    in.zero = in.closing && !v->open;
    in.zero_s = in.from_s;
    if (!c->whole) { faults_through_bytes(b->scene); }
    if (c->loses) { faults_lose(b->scene, c->loses); }
    faults_source_start(b, c->what, tick);
}

int faults_branch(const struct faults_base *b, const struct faults_case *c, uint32_t tick,
    const struct faults_view *v, struct faults_seen *seen)
{
    static struct faults_seen s; /* the child's, when its caller's is gone */
    int status, fd[2];
    pid_t pid;
    memset(&s, 0, sizeof s);
    s.from = *v;
    s.seen_ticks[0] = s.seen_ticks[1] = -1;
    s.state[0] = s.state[1] = -1;
    *seen = s;
    seen->bad = FAULTS_BAD_LOST;
    if (pipe(fd) != 0) { return 0; }
    fflush(NULL);
    pid = fork();
    if (pid == 0) {
        become(b, c, tick, v, &s, fd[1]);
        return 1;
    }
    close(fd[1]);
    if (pid > 0 && waitpid(pid, &status, 0) == pid &&
        read(fd[0], &s, sizeof s) == (ssize_t)sizeof s) {
        *seen = s;
    }
    close(fd[0]);
    return 0;
}
