/* SPDX-License-Identifier: MIT */
/* The limiter: one step of each kind with everything watched, and what it sends where nothing
 * limits. */
#include "bench.h"
#include "limiter_ops.h"

#define CASES 20000

/* An effort below all limits is sent unchanged. */
static void error_effort(struct error *e)
{
    int32_t last = 0;
    bench_seed();
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
    bench_seed();
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
    bench_seed();
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
