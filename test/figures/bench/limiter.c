/* SPDX-License-Identifier: MIT */
/* The limiter: one step of each kind with everything watched, and what it sends where nothing
 * limits. */
#include "bench.h"

#include "exhand/error.h"
#include "exhand/limiter.h"

#define UNIT  1000000
#define CASES 20000

static struct exh_limiter_cfg cfg;
static struct exh_limiter state;
static struct exh_limiter_in in;
static struct exh_limiter_out out;

static void step(int32_t command, int32_t pos, int32_t vel)
{
    in.now_us += 1000;
    in.command = command;
    in.pos = pos;
    in.vel = vel;
    exh_limiter_step(&state, &cfg, &in, &out);
    bench_sink = out.send;
}

/* Set up at 1 kHz, and armed. */
static void start(int32_t kind)
{
    const struct exh_limiter_par par = {kind, EXH_LIMITER_USE_ALL, UNIT, 5 * UNIT, 100000, 100000,
        50, 15, -UNIT, UNIT, UNIT / 10, UNIT, 10000, UNIT / 10, EXH_LIMITER_APPROACH,
        EXH_LIMITER_LIMP, 50000, 20000, 20 * UNIT, 10, 4 * UNIT, 1000, 500, 2 * UNIT, 5 * UNIT,
        3000, 0, 1234567, 123456, UNIT / 10};
    static const struct exh_limiter none;
    static const struct exh_limiter_in rest;
    bench_seed();
    state = none;
    in = rest;
    EXH_ASSERT(exh_limiter_setup(&cfg, &par) == 0);
    step(0, 0, 0);
    in.run = in.deadman = 1;
    for (int32_t i = 0; i < 100; i++) { step(0, -i * 100, 0); }
    EXH_ASSERT(out.state == EXH_STATE_RUN);
}

static void start_effort(void) { start(EXH_LIMITER_EFFORT); }
static void start_position(void) { start(EXH_LIMITER_POSITION); }
static void start_wall(void) { start(EXH_LIMITER_WALL); }

/* Up and down by more than the slew; to and fro; in and out. */
static void op_effort(uint32_t i)
{
    step((int32_t)(i & 255) * 12000 - 3 * UNIT / 2, (int32_t)(i & 63) * 100, (int32_t)i);
}
static void op_position(uint32_t i)
{
    step(i & 256 ? UNIT / 2 : -UNIT / 3, (int32_t)(i & 63) * 100, (int32_t)i);
}
static void op_wall(uint32_t i) { step(0, (int32_t)(i & 511) * 4000 - UNIT, (int32_t)i); }

/* An effort that nothing limits is sent as it is asked for. */
static void error_effort(struct error *e)
{
    int32_t last = 0;
    start_effort();
    for (int32_t i = 0; i < CASES; i++) {
        const int32_t next = exh_clamp32(last + bench_in(-100000, 100000), -UNIT, UNIT);
        const int32_t want = (next < 0) == (last < 0) ? next : 0;
        step(want, (int32_t)(i % 50) * 100, 0);
        error_add(e, (long double)out.send - want);
        last = want;
    }
}

/* A position is reached. */
static void error_position(struct error *e)
{
    start_position();
    for (int32_t i = 0; i < CASES / 500; i++) {
        const int32_t want = bench_in(-UNIT / 4, UNIT / 4);
        for (int32_t k = 0; k < 1000; k++) { step(want, k % 50 * 100, 0); }
        error_add(e, (long double)out.send - want);
    }
}

/* F = b v + k x + F0, where neither size nor slew limits it. */
static void error_wall(struct error *e)
{
    start_wall();
    for (int32_t i = 0; i < CASES; i++) {
        const int32_t x = bench_in(0, 70000), v = bench_in(-70000, 70000);
        long double want = 1234.567L * x + 0.123456L * v + (v < 0 ? UNIT / 10 : 0);
        for (int k = 0; k < 60 && out.state != EXH_STATE_RUN; k++) { step(UNIT, k * 2000, 0); }
        for (int k = 0; k < 60; k++) { step(-x, 0, v); }
        want = bench_clamp(want, 0, 5 * UNIT);
        if (want < 2 * UNIT) { error_add(e, -(long double)out.send - want); }
    }
}

static const struct kernel kernels[] = {
    {"limiter_effort", "N", 1e-6, 0, 1, start_effort, op_effort, error_effort,
        "limiter.h; an effort within its limits", 0, NULL},
    {"limiter_position", "m", 1e-6, 0, 1, start_position, op_position, error_position,
        "limiter.h; a position, a second after it was commanded", 0, NULL},
    {"limiter_wall", "N", 1e-6, 2, 1, start_wall, op_wall, error_wall,
        "limiter.h; gains of 2^-20 and 2^-27 in the law's formats", 0, NULL},
};
const struct kernel_group limiter_group = {kernels, sizeof kernels / sizeof kernels[0]};
