/* SPDX-License-Identifier: MIT */
/* The eleven functions over a simulated device, single-threaded, in virtual time. exh_board_wait()
 * advances the plant to the next tick and stops exactly at every event between: tick, D/A output,
 * servo sample, actions of the experimenter. */
#include "posix.h"

#include "cards.h"
#include "glove_tty.h"
#include "gpio.h"
#include "line.h"
#include "pace.h"
#include "sim/codes.h"
#include "sim/exo.h"
#include "sim/mass.h"
#include "sim/operator.h"
#include "sim/still.h"

#include "exhand/board.h"
#include "exhand/error.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

const struct exh_board_info exh_board_info = {"posix", EXH_BOARD_VERSION, EXH_FINGERS, 24, 20000};

#define OUTPUTS_MAX 256 /* on their way to the drive: 3 ticks + 10 ms at 20 kHz are 203 */

struct output {
    double at_s;
    double ref_A[EXH_FINGERS]; /* 0 when disabled */
};

static struct {
    struct posix_config cfg;
    struct exh_period T;
    double T_s;
    double load_A; /* what supply_raw is of; < 0: nothing yet */
    int16_t supply_raw;
    struct sim_mass mass;
    struct sim_exo exo; /* if it has fingers, instead of the mass */
    unsigned drives;    /* there are, and ready: one bit each */
    struct sim_glove glove;
    struct sim_operator hand;
    int16_t frame[SIM_GLOVE_SENSORS]; /* the glove's last, */
    uint64_t frame_tick;              /* converted for this tick */
    double frame_s;                   /* at this time; < 0: none yet */
    long frames;                      /* read of a recording */
    int16_t line[SIM_GLOVE_SENSORS];  /* of a stock glove: on its way, */
    uint64_t line_tick;               /* converted for this tick, */
    int on_line;                      /* if there is one */
    uint64_t tick;
    double now_s;
    struct output queue[OUTPUTS_MAX];
    unsigned head, queued;
    int configured;
} sim;

static int stop;                          /* this run */
static volatile sig_atomic_t interrupted; /* and every later one: never cleared */

struct posix_config posix_config_default(void)
{
    struct posix_config c;
    memset(&c, 0, sizeof c);
    c.device = sim_device_default();
    c.seed = 1;
    c.falls = 1;
    c.glove_par = sim_glove_default();
    c.hand = sim_operator_default();
    c.exo = sim_exo_default();
    c.drives = 1;
    c.line = posix_line_default();
    return c;
}

void posix_configure(const struct posix_config *c)
{
    sim.cfg = *c;
    sim.configured = 1;
}

void posix_stop(void) { stop = 1; }

void posix_interrupt(void) { interrupted = 1; }

int posix_interrupted(void) { return interrupted; }

int posix_fall(void)
{
    return !sim.exo.fingers && sim.mass.fall.phase == FALL_FREE ? sim.mass.fall.number : 0;
}

const struct sim_finger *posix_finger(unsigned i)
{
    return sim.exo.fingers >> i & 1 ? &sim.exo.finger[i] : NULL;
}

double posix_time_s(void) { return sim.now_s; }

const struct plant *posix_plant(void) { return &sim.mass.plant; }

static double tick_time_s(uint64_t tick)
{
    return (double)tick * (double)sim.T.num / (double)sim.T.den;
}

/* One axis, and perhaps a hand in a glove beside it. */
static void start_mass(void)
{
    const struct posix_config *c = &sim.cfg;
    if (c->bench) {
        sim_mass_bench(&sim.mass, &c->device, c->seed, c->wrong);
    } else {
        sim_mass_fall(&sim.mass, &c->device, c->seed, c->falls, sim.T_s);
    }
    sim.mass.fall.waits = c->wait;
    if (c->from_here) { sim_mass_put(&sim.mass, c->from_x_m, c->from_q_m); }
    if (c->glove) { sim_operator_start(&sim.hand, &c->hand, &sim.glove, &c->glove_par, c->seed); }
}

/* A hand in exoskeleton and glove; what no finger in use bends rests as the operator's pose says.
 */
static int start_fingers(void)
{
    if (sim_exo_start(&sim.exo, &sim.cfg.exo, &sim.cfg.device, sim.cfg.seed, sim.cfg.glove) < 0) {
        return -1;
    }
    sim.drives |= sim.cfg.exo.fingers;
    if (sim.cfg.glove) {
        double rest_rad[SIM_GLOVE_SENSORS];
        for (unsigned i = 0; i < SIM_GLOVE_SENSORS; i++) {
            rest_rad[i] = sim_pose[sim.cfg.hand.pose].deg[i] * (6.283185307179586 / 360);
        }
        sim_exo_glove(&sim.exo, &sim.glove, &sim.cfg.glove_par, sim.cfg.seed, rest_rad);
    }
    return 0;
}

/* The cards of the fingers that are there, from the thumb on. */
static int start_cards(void)
{
    unsigned fingers = 1;
    while (fingers < EXH_FINGERS && sim.drives >> fingers) { fingers++; }
    return cards_start(&sim.cfg.cards, fingers, sim.cfg.glove);
}

int exh_board_init(uint32_t rate_Hz, struct exh_period *achieved)
{
    int err = 0;
    if (!sim.configured) { /* a box at rest, complete */
        sim.cfg = posix_config_default();
        sim.cfg.drives = (1u << EXH_FINGERS) - 1;
    }
    if (sim.cfg.T.num != 0) {
        sim.T = sim.cfg.T;
    } else {
        sim.T = (struct exh_period){1, rate_Hz};
    }
    if (sim.T.num == 0 || sim.T.num > sim.T.den ||
        sim.T.den > (uint64_t)exh_board_info.rate_max_Hz * sim.T.num) {
        return -EXH_E_RATE;
    }
    sim.T_s = (double)sim.T.num / (double)sim.T.den;
    sim.load_A = -1;
    sim.tick = 0;
    sim.now_s = 0;
    sim.head = sim.queued = 0;
    sim.frame_s = -1;
    sim.frames = 0;
    sim.on_line = 0;
    sim.exo.fingers = 0;
    sim.drives = sim.cfg.drives;
    if (sim.cfg.exo.fingers) {
        if (start_fingers() < 0) { return -EXH_E_ABSENT; }
    } else {
        start_mass();
    }
    if (line_start(&sim.cfg.line, sim.cfg.seed) < 0) { return -EXH_E_IO; }
    if (sim.cfg.gpio) { gpio_start(sim.T); }
    pace_start(sim.T, sim.cfg.slack_s);
    stop = 0;
    *achieved = sim.T;
    if (sim.cfg.cards.how) { err = start_cards(); }
    return err;
}

void posix_ready(void) { fall_ready(&sim.mass.fall, sim.now_s); }

void posix_hold(void) { fall_catch(&sim.mass.fall, sim.now_s); }

void posix_bench(enum bench_place place, double mass_kg)
{
    bench_prepare(&sim.mass.bench, &sim.mass.plant, &sim.mass.rng, place, mass_kg);
}

int posix_bench_ready(void) { return bench_ready(&sim.mass.bench); }

/* Nothing but a fall and the box, in virtual time. */
static int plain(void)
{
    const struct posix_config *c = &sim.cfg;
    return !sim.exo.fingers && !c->pace && !c->max_ticks && !c->cards.how && !c->line.on &&
           !c->gpio && !c->glove && c->let_go_s <= 0 && c->enc_jitter_cnt <= 0 && !c->wires_out &&
           !c->wires_in && !c->late;
}

/* When the device gets what is put out now. */
static double due_s(double now_s)
{
    const struct sim_device *d = &sim.cfg.device;
    return now_s + d->delay_tick * sim.T_s + d->delay_s;
}

/* Of the plant. */
static double longest_step_s(void)
{
    const double most_s = sim.cfg.device.substep_s;
    return sim.T_s < most_s ? sim.T_s : most_s;
}

int posix_still(void)
{
    const double ref_A = sim.mass.ref_A;
    if (sim.mass.plant.w_mps != 0 || !plain() || !sim_mass_still(&sim.mass, longest_step_s())) {
        return 0;
    }
    for (unsigned i = 0; i < sim.queued; i++) {
        if (sim.queue[(sim.head + i) % OUTPUTS_MAX].ref_A[0] != ref_A) { return 0; }
    }
    return 1;
}

void posix_monitor(int16_t *low_raw, int16_t *high_raw)
{
    sim_mass_monitor(&sim.mass, low_raw, high_raw);
}

int posix_pass(int16_t *mon_raw)
{
    const double now_s = tick_time_s(sim.tick);
    uint32_t enc_raw;
    if (!sim_mass_pass(&sim.mass, now_s)) { return 0; }
    while (sim.queued && sim.queue[sim.head].at_s <= now_s) {
        sim.head = (sim.head + 1) % OUTPUTS_MAX;
        sim.queued--;
    }
    sim.now_s = now_s;
    sim.tick++;
    sim_mass_read(&sim.mass, 0, &enc_raw, mon_raw);
    sim.queue[(sim.head + sim.queued) % OUTPUTS_MAX].at_s = due_s(now_s);
    sim.queue[(sim.head + sim.queued++) % OUTPUTS_MAX].ref_A[0] = sim.mass.ref_A;
    return 1;
}

static void advance_device(double until_s)
{
    if (sim.exo.fingers) {
        sim_exo_advance(&sim.exo, until_s);
    } else {
        sim_mass_advance(&sim.mass, until_s);
    }
}

/* What the line has brought, at this tick. */
static void take_serial(void)
{
    struct glove_tty *t = sim.cfg.glove_tty;
    if (t == NULL || !glove_tty_poll(t, sim.now_s)) { return; }
    for (unsigned i = 0; i < SIM_GLOVE_SENSORS; i++) {
        sim.frame[i] = cyberglove_raw(t->in.sample[i]);
    }
    sim.frame_tick = sim.tick;
    sim.frame_s = sim.now_s;
}

/* Everything that happens up to and at end_s: outputs on their instants, whatever the device
 * does between on its own. */
static void advance_to(double end_s)
{
    while (sim.queued && sim.queue[sim.head].at_s <= end_s) {
        const struct output *o = &sim.queue[sim.head];
        if (sim.exo.fingers) {
            sim_exo_latch(&sim.exo, o->at_s, o->ref_A);
        } else {
            sim_mass_latch(&sim.mass, o->at_s, o->ref_A[0]);
        }
        sim.head = (sim.head + 1) % OUTPUTS_MAX;
        sim.queued--;
    }
    advance_device(end_s);
    sim.now_s = end_s;
}

/* The falls, or the fingers' scripts. */
static int done(void)
{
    return sim.exo.fingers ? sim_exo_done(&sim.exo) : sim.mass.fall.phase == FALL_DONE;
}

static int time_is_up(void) { return sim.cfg.max_ticks && sim.tick >= sim.cfg.max_ticks; }

/* Ticks that go by unseen; the outputs stay as they are. */
static uint32_t pass(uint32_t ticks)
{
    uint32_t n = 0;
    while (n < ticks && !interrupted && !time_is_up()) {
        advance_to(tick_time_s(++sim.tick));
        n++;
    }
    return n;
}

int exh_board_wait(void)
{
    uint32_t missed = sim.cfg.late ? sim.cfg.late(sim.tick) : 0;
    sim.tick += missed;
    advance_to(tick_time_s(sim.tick));
    if (sim.cfg.pace) { missed += pass(pace_wait(sim.tick, &interrupted)); }
    line_advance(sim.now_s);
    if (sim.cfg.cards.how) { cards_at(sim.now_s); }
    if (time_is_up()) { return -1; }
    sim.tick++;
    take_serial();
    return stop || interrupted || done() ? -1 : (int)missed;
}

/* What the motors take in all. */
static double load_A(void)
{
    double sum_A = 0;
    if (!sim.exo.fingers) { return fabs(sim.mass.ref_A); }
    for (unsigned k = 0; k < sim.exo.used; k++) {
        sum_A += fabs(sim.exo.finger[sim.exo.at[k]].ref_A);
    }
    return sum_A;
}

/* Worked out where the load has changed. */
static int16_t supply_raw(void)
{
    const double now_A = load_A();
    if (now_A != sim.load_A) {
        sim.load_A = now_A;
        sim.supply_raw = sim_supply_raw(&sim.cfg.device, now_A);
    }
    return sim.supply_raw;
}

/* What the simulated device, or its cards, show. */
static int read_device(struct exh_drive_in *in)
{
    const double jitter_cnt = sim.cfg.enc_jitter_cnt;
    const unsigned n = sim.exo.fingers ? sim.exo.used : 0;
    memset(in, 0, sizeof *in);
    if (n == 0) { sim_mass_read(&sim.mass, jitter_cnt, &in->enc_raw[0], &in->mon_raw[0]); }
    for (unsigned k = 0; k < n; k++) {
        const unsigned i = sim.exo.at[k];
        sim_finger_read(&sim.exo.finger[i], jitter_cnt, &in->enc_raw[i], &in->mon_raw[i]);
    }
    in->din = EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_WATCHDOG | EXH_DIN_CARDS |
              EXH_DIN_DRIVE0 * sim.drives;
    in->supply_raw = supply_raw();
    if (sim.cfg.let_go_s > 0 && sim.now_s >= sim.cfg.let_go_s) {
        in->din &= ~(uint32_t)EXH_DIN_DEADMAN;
    }
    if (sim.cfg.wires_in) { sim.cfg.wires_in(in); }
    return sim.cfg.cards.how ? cards_read_drive(in) : 0;
}

/* Contacts that are wired are closed when they and the device's both are. */
int exh_board_read_drive(struct exh_drive_in *in)
{
    const int err = read_device(in);
    const int wired = sim.cfg.gpio ? gpio_read(&in->din) : 0;
    return err ? err : wired;
}

/* The device gets these codes, when its delay is over. */
static int put_out(const struct exh_drive_out *out)
{
    struct exh_drive_out wired;
    const struct sim_device *d = &sim.cfg.device;
    const unsigned n = sim.exo.fingers ? sim.exo.used : 1;
    struct output *o = &sim.queue[(sim.head + sim.queued) % OUTPUTS_MAX];

    if (sim.queued == OUTPUTS_MAX) { return -EXH_E_IO; }
    if (sim.cfg.wires_out) {
        wired = *out;
        sim.cfg.wires_out(&wired);
        out = &wired;
    }
    o->at_s = due_s(sim.now_s);
    for (unsigned k = 0; k < n; k++) {
        const unsigned i = sim.exo.fingers ? sim.exo.at[k] : 0;
        o->ref_A[i] = sim_drive_A(d, out->dac_raw[i], out->enable >> i & 1);
    }
    sim.queued++;
    return 0;
}

static int write_device(const struct exh_drive_out *out)
{
    struct exh_drive_out seen;
    int err, put;
    if (!sim.cfg.cards.how) { return put_out(out); }
    err = cards_write_drive(out, &seen);
    put = put_out(&seen);
    return err ? err : put;
}

int exh_board_write_drive(const struct exh_drive_out *out)
{
    const int err = write_device(out);
    const int wired = sim.cfg.gpio ? gpio_write(out) : 0;
    return err ? err : wired;
}

void exh_board_safe(void)
{
    if (sim.cfg.gpio) { gpio_safe(); }
    if (sim.cfg.cards.how) {
        struct exh_drive_out seen;
        cards_safe(&seen);
        if (seen.enable) { return; } /* the device is not */
    }
    sim.queued = 0;
    sim_mass_safe(&sim.mass);
    for (unsigned i = 0; i < EXH_FINGERS; i++) {
        if (sim.exo.fingers >> i & 1) { sim_finger_safe(&sim.exo.finger[i]); }
    }
}

void exh_board_halt(const char *why)
{
    exh_board_safe();
    fprintf(stderr, "exhand: %s\n", why);
    exit(strcmp(why, "done") == 0 ? 0 : 1);
}

static void next_frame(void)
{
    if (sim.exo.fingers && sim.cfg.frame == NULL) {
        sim_exo_frame(&sim.exo, &sim.glove, sim.now_s, sim.frame);
    } else if (sim.cfg.frame == NULL) {
        sim_operator_frame(&sim.hand, &sim.glove, sim.now_s, sim.frame);
    } else {
        memcpy(sim.frame, sim.cfg.frame[sim.frames], sizeof sim.frame);
        if (sim.frames + 1 < sim.cfg.frames) { sim.frames++; }
    }
    sim.frame_tick = sim.tick;
    sim.frame_s = sim.now_s;
}

/* A sample of 8 bits, 1 .. 255 at -9 .. 9 V, as the code of its middle. */
static int16_t coarse(int16_t code)
{
    const double step = 2 * 29491.2 / 254;
    const double sample = (double)sim_floor((code + 29491.2) / step + 0.5);
    return (int16_t)sim_floor(fmin(fmax(sample, 0), 254) * step - 29491.2 + 0.5);
}

/* The frame before, if there is one: this one is still on its line. */
static void as_stock(void)
{
    const uint64_t tick = sim.frame_tick;
    int16_t now[SIM_GLOVE_SENSORS];
    for (unsigned i = 0; i < SIM_GLOVE_SENSORS; i++) { now[i] = coarse(sim.frame[i]); }
    memcpy(sim.frame, sim.on_line ? sim.line : now, sizeof now);
    sim.frame_tick = sim.on_line ? sim.line_tick : tick;
    memcpy(sim.line, now, sizeof now);
    sim.line_tick = tick;
    sim.on_line = 1;
}

/* A scan that ends at this tick, if it could begin after the last had ended. */
static int scan(void)
{
    const double scan_s = SIM_GLOVE_SENSORS * sim.cfg.glove_par.interval_s;
    if (sim.frame_s >= 0 && sim.now_s < sim.frame_s + scan_s * 0.999999) { return 0; }
    next_frame();
    if (sim.cfg.stock) { as_stock(); }
    return sim.cfg.cards.how ? cards_read_glove(sim.frame) : 0;
}

/* On a serial line it travels for whole ticks; before the first frame there is none. */
static uint64_t frame_age(void)
{
    const uint64_t age = sim.tick - sim.frame_tick;
    const double way = GLOVE_TTY_FRAME_S * sim.T.den / sim.T.num;
    if (sim.cfg.glove_tty == NULL) { return age; }
    return sim.frame_s < 0 ? UINT16_MAX : age + (uint64_t)way + 1;
}

int exh_board_read_glove(struct exh_glove_in *in)
{
    const int serial = sim.cfg.glove_tty != NULL;
    const int err = !sim.cfg.glove ? -EXH_E_ABSENT : serial ? 0 : scan();
    uint64_t age;
    if (err < 0) { return err; }
    memcpy(in->raw, sim.frame, sizeof sim.frame);
    age = frame_age();
    in->age_ticks = (uint16_t)(age < UINT16_MAX ? age : UINT16_MAX);
    return 0;
}

void posix_hand(int pose) { sim_operator_go(&sim.hand, pose); }

int posix_hand_ready(void)
{
    return sim_operator_at_rest(&sim.hand, sim.now_s - 5e-3 /* behind the low-pass too */);
}

void posix_glove_stop(void) { sim.frame_s = 1e30; }

struct sim_glove *posix_glove(void) { return &sim.glove; }

uint32_t exh_board_cycles(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint32_t)((uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec);
}

int exh_board_log(const void *rec, size_t len_B)
{
    if (sim.cfg.log_put) { return sim.cfg.log_put(rec, len_B) ? (int)len_B : 0; }
    if (sim.cfg.log == NULL) { return (int)len_B; }
    return fwrite(rec, 1, len_B, sim.cfg.log) == len_B ? (int)len_B : 0;
}

int exh_board_link_send(const void *buf, size_t len_B)
{
    const int n = line_send(sim.now_s, buf, len_B);
    return n < 0 ? -EXH_E_IO : n;
}

int exh_board_link_recv(void *buf, size_t cap_B) { return line_recv(sim.now_s, buf, cap_B); }
