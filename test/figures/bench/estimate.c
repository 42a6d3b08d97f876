/* SPDX-License-Identifier: MIT */
/* The velocity estimators: error of the arithmetic alone, against the same recursion
 * in long double with exact coefficients. What quantised positions do to an estimator is
 * another question: velocity.c. */
#include "bench.h"

#include "estimators.h"

#define TICKS  1000000
#define TAU_US 1354 /* the pole at 100 Hz that exp(-2 pi 100 Hz T) has */
#define TF_US  4500 /* theta = 0.9 at 2 kHz */

static const struct exh_velocity_scale scale = {EXH_Q(6632, 100000000, EXH_Q_STEP), {1, 2000}};

static int32_t hump[BENCH_OPS]; /* counts of a throw: up 70 mm and back in 0.5 s */

/* m/s q27 of one count per tick. */
static long double count_per_tick(void)
{
    return bench_q(scale.step_m_q42, EXH_Q_STEP - EXH_Q_VEL) * scale.T.den / scale.T.num;
}

static void setup_all(int32_t p)
{
    int err = window_start(scale, p);
    err |= pole_start(scale, TAU_US);
    err |= foaw_start(scale, 16);
    err |= track_start(scale, TF_US);
    EXH_ASSERT(err == 0);
    for (int32_t i = 0; i < (int32_t)BENCH_OPS; i++) {
        hump[i] = (int32_t)(4 * 1056 * (int64_t)i * (1024 - i) / (1024 * 1024));
    }
    bench_seed();
}

static void setup_1(void) { setup_all(0); }

static void setup_2(void) { setup_all(1); }

static void setup_16(void) { setup_all(4); }

static void window_op(uint32_t i) { bench_sink = window_step(hump[i]); }

static void pole_op(uint32_t i) { bench_sink = pole_step(hump[i]); }

static void foaw_op(uint32_t i) { bench_sink = foaw_step(hump[i]); }

static void track_op(uint32_t i) { bench_sink = track_step(hump[i]); }

/* A hand: up to +-12 m/s, +-1 count of noise, through the wrap of the count; now and
 * then a jump beyond full scale. Changes since the last 17 ticks in y[0..16], newest 0,
 * as counts from an origin that never wraps. */
struct hand {
    int64_t cnt[17];
    int32_t v_q8; /* counts per tick */
};

static int32_t move(struct hand *h)
{
    const int32_t jump = bench_in(0, 9999) == 0 ? bench_in(-2000, 2000) : 0;
    const int32_t v = h->v_q8 + bench_in(-512, 512);
    for (int j = 16; j > 0; j--) { h->cnt[j] = h->cnt[j - 1]; }
    h->v_q8 = v > 23000 ? 23000 : v < -23000 ? -23000 : v;
    h->cnt[0] += h->v_q8 / 256 + bench_in(-1, 1) + jump;
    return exh_from_u32((uint32_t)((uint64_t)(h->cnt[0] + INT32_MAX) & UINT32_MAX));
}

static void judge(struct error *e, int32_t got, long double exact)
{
    error_add(e, got - bench_clamp(exact, INT32_MIN, INT32_MAX));
}

static void window_error(struct error *e, int32_t p)
{
    struct hand h = {{0}, 0};
    const int n = 1 << p;
    setup_all(p);
    for (int i = 0; i < TICKS; i++) {
        const int32_t got = window_step(move(&h));
        const int64_t moved = h.cnt[0] - h.cnt[n];
        if (i > n) { judge(e, got, count_per_tick() * moved / n); }
    }
}

static void error_1(struct error *e) { window_error(e, 0); }

static void error_2(struct error *e) { window_error(e, 1); }

static void error_16(struct error *e) { window_error(e, 4); }

static void pole_error(struct error *e)
{
    const long double T_us = 1e6L * scale.T.num / scale.T.den, a = T_us / (T_us + TAU_US);
    struct hand h = {{0}, 0};
    long double v = 0;
    setup_all(0);
    for (int i = 0; i < TICKS; i++) {
        const int32_t got = pole_step(move(&h));
        const long double diff = i ? count_per_tick() * (h.cnt[0] - h.cnt[1]) : 0;
        v += a * (bench_clamp(diff, INT32_MIN, INT32_MAX) - v);
        judge(e, got, v);
    }
}

/* Sum over the window of i of its m = n*S0 - 2*S1, and whether all samples fit. */
static int fit(const int64_t *y, int64_t n, int64_t *m)
{
    const int64_t den = n * (n + 1) * (n + 2);
    int fits = 1;
    *m = 0;
    for (int64_t j = 0; j <= n; j++) { *m += (n - 2 * j) * y[j]; }
    for (int64_t j = 1; j <= n; j++) {
        const int64_t off = (y[j] - y[0]) * den + 6 * j * *m;
        fits &= off <= den && off >= -den;
    }
    return fits || n == 1;
}

static void foaw_error(struct error *e)
{
    struct hand h = {{0}, 0};
    setup_all(0);
    for (int i = 0; i < TICKS; i++) {
        const int32_t got = foaw_step(move(&h));
        int64_t best = 0, m;
        int64_t n = 0;
        while (n < 16 && fit(h.cnt, n + 1, &m)) {
            n++;
            best = m;
        }
        if (i > 16) { judge(e, got, count_per_tick() * best * 6 / (n * (n + 1) * (n + 2))); }
    }
}

static void track_error(struct error *e)
{
    const long double T_us = 1e6L * scale.T.num / scale.T.den, theta = TF_US / (TF_US + T_us);
    struct hand h = {{0}, 0};
    long double err = 0, v = 0;
    setup_all(0);
    for (int i = 0; i < TICKS; i++) {
        const int32_t got = track_step(move(&h));
        const long double off = err + v - (i ? h.cnt[0] - h.cnt[1] : 0);
        err = theta * theta * off;
        v -= (1 - theta) * (1 - theta) * off;
        judge(e, got, count_per_tick() * v);
    }
}

#define MPS  (1.0 / (1 << EXH_Q_VEL))
#define HAND "hand to +-12 m/s, noise, jumps beyond full scale, count wraps"

static const struct kernel kernels[] = {
    {"velocity_window_1", "m/s", MPS, 1.5, 1, setup_1, window_op, error_1,
        "half LSB + 2^-31 of the gain; " HAND, 0, NULL},
    {"velocity_window_2", "m/s", MPS, 1.5, 1, setup_2, window_op, error_2, "as above", 0, NULL},
    {"velocity_window_16", "m/s", MPS, 1.5, 1, setup_16, window_op, error_16, "as above", 0, NULL},
    {"velocity_pole", "m/s", MPS, 4, 1, setup_1, pole_op, pole_error,
        "1.5 + coefficient rounded at 2^-32; " HAND, 0, NULL},
    {"velocity_foaw_16", "m/s", MPS, 1.5, 1, setup_1, foaw_op, foaw_error,
        "window chosen exactly, then as window; " HAND, 0, NULL},
    {"velocity_track", "m/s", MPS, 64, 1, setup_1, track_op, track_error,
        "coefficients rounded at 2^-32, jumps of 2000 counts; " HAND, 0, NULL},
};
const struct kernel_group estimate_group = {kernels, sizeof kernels / sizeof kernels[0]};
