/* SPDX-License-Identifier: MIT */
/* One step of each kind of limiter with everything watched, as it is counted on every CPU. */
#ifndef BENCH_LIMITER_OPS_H
#define BENCH_LIMITER_OPS_H

#include "exhand/error.h"
#include "exhand/limiter.h"

#define UNIT 1000000

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

#endif
