/* The eleven functions over a simulated device, single-threaded, in virtual time:
 * exh_board_wait() advances the plant to the next tick, hitting every event in
 * between exactly (tick, D/A output, servo sample, what the experimenter does). */
#include "posix.h"

#include "sim/bench.h"
#include "sim/fall.h"
#include "sim/operator.h"
#include "sim/plant.h"
#include "sim/random.h"

#include "exhand/board.h"
#include "exhand/error.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

const struct exh_board_info exh_board_info = {"posix", EXH_BOARD_VERSION, 1, 24, 20000};

#define FAR_S 1e30
#define OUTPUTS_MAX 256 /* on their way to the drive: 3 ticks + 10 ms at 20 kHz are 203 */

struct output {
    double at_s;
    double ref_A; /* 0 when disabled */
};

static struct {
    struct posix_config cfg;
    struct exh_period T;
    struct sim_random rng;
    struct plant plant;
    struct fall fall;
    struct bench bench; /* instead of the fall, if configured */
    struct sim_glove glove;
    struct sim_operator hand;
    int16_t frame[SIM_GLOVE_SENSORS]; /* the glove's last, */
    uint64_t frame_tick;              /* converted for this tick */
    double frame_s;                   /* at this time; < 0: none yet */
    long frames;                      /* read of a recording */
    uint64_t tick;
    double now_s;
    double grid; /* encoder phase, counts */
    double latched_A;  /* D/A output */
    double ref_A;      /* what the servo last sampled */
    double servo_s;    /* its next sample */
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
    return c;
}

void posix_configure(const struct posix_config *c)
{
    sim.cfg = *c;
    sim.configured = 1;
}

void posix_stop(void)
{
    stop = 1;
}

void posix_interrupt(void)
{
    interrupted = 1;
}

int posix_interrupted(void)
{
    return interrupted;
}

int posix_fall(void)
{
    return sim.fall.phase == FALL_FREE ? sim.fall.number : 0;
}

double posix_time_s(void)
{
    return sim.now_s;
}

const struct plant *posix_plant(void)
{
    return &sim.plant;
}

static double tick_time_s(uint64_t tick)
{
    return (double)tick * (double)sim.T.num / (double)sim.T.den;
}

int exh_board_init(uint32_t rate_Hz, struct exh_period *achieved)
{
    if (!sim.configured) { sim.cfg = posix_config_default(); }
    if (sim.cfg.T.num != 0) {
        sim.T = sim.cfg.T;
    } else {
        sim.T = (struct exh_period){1, rate_Hz};
    }
    if (sim.T.num == 0 || sim.T.num > sim.T.den ||
        sim.T.den > (uint64_t)exh_board_info.rate_max_Hz * sim.T.num) {
        return -EXH_E_RATE;
    }
    sim.rng.state = sim.cfg.seed;
    sim.tick = 0;
    sim.now_s = 0;
    sim.latched_A = sim.ref_A = 0;
    sim.head = sim.queued = 0;
    sim.grid = sim_random_unit(&sim.rng);
    if (sim.cfg.bench) {
        bench_start(&sim.bench, &sim.plant, &sim.cfg.device, sim.cfg.wrong);
        sim.fall.phase = FALL_HOLD; /* and stays so: the end comes by posix_stop() */
    } else {
        fall_start(&sim.fall, &sim.plant, &sim.cfg.device, &sim.rng, sim.cfg.falls,
                   (double)sim.T.num / (double)sim.T.den);
    }
    if (sim.cfg.from_here) {
        sim.plant.x_m = sim.cfg.from_x_m;
        sim.plant.q_m = sim.cfg.from_q_m;
    }
    sim.servo_s = sim_random_unit(&sim.rng) / sim.cfg.device.servo_hz;
    sim.frame_s = -1;
    sim.frames = 0;
    if (sim.cfg.glove) {
        sim_operator_start(&sim.hand, &sim.cfg.hand, &sim.glove, &sim.cfg.glove_par, sim.cfg.seed);
    }
    stop = 0;
    *achieved = sim.T;
    return 0;
}

void posix_bench(enum bench_place place, double mass_kg)
{
    bench_prepare(&sim.bench, &sim.plant, &sim.rng, place, mass_kg);
}

int posix_bench_ready(void)
{
    return bench_ready(&sim.bench);
}

static double earlier(double a, double b)
{
    return a < b ? a : b;
}

/* The plant by itself, up to the next event. */
static void advance_plant(double dt_s)
{
    if (sim.cfg.bench) {
        bench_advance(&sim.bench, &sim.plant, dt_s, sim.ref_A);
    } else {
        plant_advance(&sim.plant, &sim.cfg.device, dt_s, sim.ref_A, sim.fall.phase != FALL_FREE);
    }
}

/* Everything that happens up to and at end_s. */
static void advance_to(double end_s)
{
    const struct sim_device *d = &sim.cfg.device;
    while (sim.now_s < end_s) {
        const double output_s = sim.queued ? sim.queue[sim.head].at_s : FAR_S;
        double next_s = earlier(end_s, earlier(sim.servo_s, output_s));
        if (!sim.cfg.bench) { next_s = earlier(next_s, fall_next_s(&sim.fall)); }
        if (next_s > sim.now_s) {
            advance_plant(next_s - sim.now_s);
            sim.now_s = next_s;
        }
        if (output_s <= sim.now_s) {
            sim.latched_A = sim.queue[sim.head].ref_A;
            sim.head = (sim.head + 1) % OUTPUTS_MAX;
            sim.queued--;
        }
        if (sim.servo_s <= sim.now_s) {
            sim.ref_A = sim.latched_A;
            sim.servo_s += 1 / d->servo_hz;
        }
        if (!sim.cfg.bench && fall_step(&sim.fall, &sim.plant, d, &sim.rng, sim.now_s)) {
            /* The servo's clock is not ours: its phase is chance at each fall. */
            sim.servo_s = sim.now_s + sim_random_unit(&sim.rng) / d->servo_hz;
        }
    }
}

static void follow_wall_clock(double t_s)
{
    static struct timespec start;
    struct timespec at;
    if (sim.tick == 0) { clock_gettime(CLOCK_MONOTONIC, &start); }
    at.tv_sec = start.tv_sec + (time_t)t_s;
    at.tv_nsec = start.tv_nsec + (long)((t_s - (double)(time_t)t_s) * 1e9);
    if (at.tv_nsec >= 1000000000L) {
        at.tv_nsec -= 1000000000L;
        at.tv_sec++;
    }
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, NULL) != 0 && !interrupted) {}
}

int exh_board_wait(void)
{
    const double at_s = tick_time_s(sim.tick);
    advance_to(at_s);
    if (sim.cfg.pace) { follow_wall_clock(at_s); }
    sim.tick++;
    if (sim.cfg.max_ticks && sim.tick > sim.cfg.max_ticks) { return -1; }
    return stop || interrupted || sim.fall.phase == FALL_DONE ? -1 : 0;
}

static int64_t floor_count(double v)
{
    const int64_t i = (int64_t)v;
    return (double)i > v ? i - 1 : i;
}

int exh_board_read_drive(struct exh_drive_in *in)
{
    const struct sim_device *d = &sim.cfg.device;
    const double mon_A = sim.plant.mon_A + d->mon_noise_a * sim_random_bell(&sim.rng);
    const int64_t mon_raw = floor_count(mon_A / d->mon_apc + 0.5);
    const double q_m = sim.cfg.bench ? bench_encoder_m(&sim.bench, &sim.plant) : sim.plant.q_m;
    double jitter = 0;
    int64_t cnt;

    if (sim.cfg.enc_jitter_cnt > 0) {
        jitter = sim.cfg.enc_jitter_cnt * (sim_random_unit(&sim.rng) - 0.5);
    }
    cnt = floor_count(q_m * d->decode / d->step_m + sim.grid + d->enc_start + jitter);
    memset(in, 0, sizeof *in);
    in->enc_raw[0] = (uint32_t)((uint64_t)cnt & 0xFFFFFF);
    in->mon_raw[0] = (int16_t)(mon_raw > 32767 ? 32767 : mon_raw < -32768 ? -32768 : mon_raw);
    in->din = EXH_DIN_ESTOP | EXH_DIN_DEADMAN | EXH_DIN_DRIVE0;
    return 0;
}

int exh_board_write_drive(const struct exh_drive_out *out)
{
    const struct sim_device *d = &sim.cfg.device;
    const double asked_A = ((double)out->dac_raw[0] - d->dac_zero) / d->dac_perA;
    const double ref_A = asked_A > d->peak_a ? d->peak_a : asked_A < -d->peak_a ? -d->peak_a : asked_A;
    const double T_s = (double)sim.T.num / (double)sim.T.den;
    struct output *o = &sim.queue[(sim.head + sim.queued) % OUTPUTS_MAX];

    if (sim.queued == OUTPUTS_MAX) { return -EXH_E_IO; }
    o->at_s = sim.now_s + d->delay_tick * T_s + d->delay_s;
    o->ref_A = out->enable & 1 ? ref_A : 0;
    sim.queued++;
    return 0;
}

void exh_board_safe(void)
{
    sim.queued = 0;
    sim.latched_A = sim.ref_A = 0;
}

void exh_board_halt(const char *why)
{
    exh_board_safe();
    fprintf(stderr, "exhand: %s\n", why);
    exit(strcmp(why, "done") == 0 ? 0 : 1);
}

static void next_frame(void)
{
    if (sim.cfg.frame == NULL) {
        sim_operator_frame(&sim.hand, &sim.glove, sim.now_s, sim.frame);
    } else {
        memcpy(sim.frame, sim.cfg.frame[sim.frames], sizeof sim.frame);
        if (sim.frames + 1 < sim.cfg.frames) { sim.frames++; }
    }
    sim.frame_tick = sim.tick;
    sim.frame_s = sim.now_s;
}

/* A scan that ends at this tick, if it could begin after the last had ended. */
int exh_board_read_glove(struct exh_glove_in *in)
{
    const double scan_s = SIM_GLOVE_SENSORS * sim.cfg.glove_par.interval_s;
    uint64_t age;
    if (!sim.cfg.glove) { return -EXH_E_ABSENT; }
    if (sim.frame_s < 0 || sim.now_s >= sim.frame_s + scan_s * 0.999999) { next_frame(); }
    memcpy(in->raw, sim.frame, sizeof sim.frame);
    age = sim.tick - sim.frame_tick;
    in->age_ticks = (uint16_t)(age < UINT16_MAX ? age : UINT16_MAX);
    return 0;
}

void posix_hand(int pose)
{
    sim_operator_go(&sim.hand, pose);
}

int posix_hand_ready(void)
{
    return sim_operator_at_rest(&sim.hand, sim.now_s - 5e-3 /* behind the low-pass too */);
}

struct sim_glove *posix_glove(void)
{
    return &sim.glove;
}

uint32_t exh_board_cycles(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint32_t)((uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec);
}

int exh_board_log(const void *rec, size_t len_B)
{
    if (sim.cfg.log == NULL) { return (int)len_B; }
    return fwrite(rec, 1, len_B, sim.cfg.log) == len_B ? (int)len_B : 0;
}

int exh_board_link_send(const void *buf, size_t len_B)
{
    (void)buf;
    (void)len_B;
    return 0;
}

int exh_board_link_recv(void *buf, size_t cap_B)
{
    (void)buf;
    (void)cap_B;
    return 0;
}
