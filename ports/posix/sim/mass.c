/* SPDX-License-Identifier: MIT */
#include "mass.h"

#include "codes.h"
#include "grid.h"

#define FAR_S  1e30
#define LOOK_S 250e-6 /* so often for the contact: it may not depend on when ticks are */

static void start(struct sim_mass *m, const struct sim_device *d, uint64_t seed)
{
    const struct sim_mass none = {.now_s = 0};
    *m = none;
    m->device = *d;
    m->sample_s = FAR_S;
    m->rng.state = seed;
    m->grid = sim_random_unit(&m->rng);
}

void sim_mass_fall(
    struct sim_mass *m, const struct sim_device *d, uint64_t seed, int falls, double T_s)
{
    start(m, d, seed);
    fall_start(&m->fall, &m->plant, d, &m->rng, falls, T_s);
    m->servo_s = sim_random_unit(&m->rng) / d->servo_hz;
}

void sim_mass_bench(struct sim_mass *m, const struct sim_device *d, uint64_t seed, unsigned wrong)
{
    start(m, d, seed);
    m->benched = 1;
    m->fall.phase = FALL_HOLD; /* and stays so */
    bench_start(&m->bench, &m->plant, d, wrong);
    m->servo_s = sim_random_unit(&m->rng) / d->servo_hz;
}

void sim_mass_put(struct sim_mass *m, double x_m, double q_m)
{
    m->plant.x_m = x_m;
    m->plant.q_m = q_m;
}

static double earlier(double a, double b) { return a < b ? a : b; }

/* Advances the plant alone to the next event. */
static void advance_plant(struct sim_mass *m, double dt_s)
{
    const struct plant_piece *piece;
    if (!(dt_s > 0)) { return; }
    piece = plant_pieces_find(&m->pieces, &m->device, dt_s, 0);
    if (m->fall.phase == FALL_FREE) {
        plant_advance_piece(&m->plant, &m->device, piece, m->ref_A);
    } else {
        plant_hold_piece(&m->plant, piece, m->ref_A);
    }
}

/* On a bench each of the servo's samples ends a step. */
static void advance_bench(struct sim_mass *m, double until_s)
{
    while (m->now_s < until_s) {
        const double next_s = earlier(until_s, m->servo_s);
        if (next_s > m->now_s) {
            bench_advance(&m->bench, &m->plant, next_s - m->now_s, m->ref_A);
            m->now_s = next_s;
        }
        if (m->servo_s > m->now_s) { continue; }
        m->ref_A = m->latched_A;
        m->servo_s += 1 / m->device.servo_hz;
    }
}

/* Before a fall only those that change ref_A do. */
static void wait_for_sample(struct sim_mass *m, double at_s)
{
    m->sample_s =
        m->latched_A != m->ref_A ? sim_servo_s(m->servo_s, m->device.servo_hz, at_s) : FAR_S;
}

static void advance_fall(struct sim_mass *m, double until_s)
{
    const struct sim_device *d = &m->device;
    double now_s = m->now_s, grid_s = sim_grid(now_s), phase_s = fall_next_s(&m->fall);
    int busy = fall_busy(&m->fall);
    while (now_s < until_s) {
        const double step_s = fall_looks(&m->fall) ? now_s + LOOK_S : until_s;
        const double next_s = earlier(earlier(earlier(until_s, step_s), m->sample_s), phase_s);
        if (next_s > now_s) {
            const double to_s = sim_grid(next_s);
            advance_plant(m, to_s - grid_s);
            grid_s = to_s;
            m->now_s = now_s = next_s;
        }
        if (m->sample_s <= now_s) {
            m->ref_A = m->latched_A;
            m->sample_s = FAR_S;
        }
        if (!busy && now_s < phase_s) { continue; }
        if (fall_step(&m->fall, &m->plant, d, &m->rng, now_s)) {
            /* The servo's clock is not ours: its phase is chance at each fall. */
            m->servo_s = now_s + sim_random_unit(&m->rng) / d->servo_hz;
            wait_for_sample(m, now_s);
        }
        phase_s = fall_next_s(&m->fall);
        busy = fall_busy(&m->fall);
    }
}

void sim_mass_advance(struct sim_mass *m, double until_s)
{
    if (m->benched) {
        advance_bench(m, until_s);
    } else {
        advance_fall(m, until_s);
    }
}

void sim_mass_latch(struct sim_mass *m, double at_s, double ref_A)
{
    if (m->benched || m->sample_s <= at_s || fall_next_s(&m->fall) <= at_s) {
        sim_mass_advance(m, at_s);
    }
    m->latched_A = ref_A;
    wait_for_sample(m, at_s);
}

void sim_mass_safe(struct sim_mass *m)
{
    m->latched_A = m->ref_A = 0;
    m->sample_s = FAR_S;
}

void sim_mass_read(struct sim_mass *m, double jitter_cnt, uint32_t *enc_raw, int16_t *mon_raw)
{
    const double q_m = m->benched ? bench_encoder_m(&m->bench, &m->plant) : m->plant.q_m;
    double jitter = 0;
    *mon_raw = sim_monitor_raw(&m->device, m->plant.mon_A, &m->rng);
    if (jitter_cnt > 0) { jitter = jitter_cnt * (sim_random_unit(&m->rng) - 0.5); }
    *enc_raw = sim_encoder_raw(&m->device, q_m, m->grid, jitter);
}
