/* SPDX-License-Identifier: MIT */
/* peers errors | sines | count | time | ram: ours and others' low-passes and sines in one program,
 * on the same inputs; CSV for peers.sh.
 *
 * errors: peer, then for fc/fs 0.1, 0.01, 0.001, 0.0001 in ppm of full scale: worst error at
 * 0 Hz after 30 periods at +-0.37, +-0.01 and released; rms over a step of 0.37; rms of a
 * settled sine of 0.37 at fc; then 1 if a step to 0.98 at 0.01 stays wrong. Reference: the
 * same filter in long double, fed with the input as the peer could take it.
 * count: as kernels count does; each peer by 22 channels of one sample, then by one channel
 * of 64. time: peer, ns of one op by 22 channels or of one sine and cosine.
 */
#define _POSIX_C_SOURCE 200809L
#include "peers.h"
#include "clock.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI     3.141592653589793238462643383279502884L
#define LEVEL  0.37L
#define ANGLES 1048576u

int32_t peer_x_q31[BENCH_OPS + BLOCK];
int16_t peer_x_q15[BENCH_OPS + BLOCK];
float peer_x_f32[BENCH_OPS + BLOCK];
double peer_x_f64[BENCH_OPS + BLOCK];

static const struct peer_group *const groups[] = {
    &plain_peers,
#ifdef PEERS_CMSIS
    &cmsis_peers,
#endif
#ifdef PEERS_FIXMATH
    &fixmath_peers,
#endif
#ifdef PEERS_RUST
    &rust_peers,
#endif
};
#define GROUPS (sizeof groups / sizeof groups[0])

long double peer_round(long double x, unsigned q)
{
    const long double one = (long double)(UINT64_C(1) << q);
    return bench_clamp(rintl(x * one), -one, one - 1) / one;
}

static struct butterworth design(uint32_t ticks)
{
    const long double g = tanl(PI / ticks), k = sqrtl(2), d = 1 + g * (g + k);
    const struct butterworth f = {
        ticks, g * g / d, 2 * g * g / d, g * g / d, 2 * (g * g - 1) / d, (1 + g * (g - k)) / d};
    return f;
}

/* The reference: state-variable form, in which nothing cancels. */
static struct {
    long double g, d, s1, s2;
} ref;

static void ref_start(uint32_t ticks)
{
    ref.g = tanl(PI / ticks);
    ref.d = 1 + ref.g * (ref.g + sqrtl(2));
    ref.s1 = ref.s2 = 0;
}

static long double ref_step(long double x)
{
    const long double band = (ref.s1 + ref.g * (x - ref.s2)) / ref.d;
    const long double low = ref.s2 + ref.g * band;
    ref.s1 = 2 * band - ref.s1;
    ref.s2 = 2 * low - ref.s2;
    return low;
}

static void start(const struct filter_peer *p, uint32_t ticks)
{
    const struct butterworth f = design(ticks);
    p->setup(&f);
    ref_start(ticks);
}

/* ppm of full scale */
static double worst_at_rest(const struct filter_peer *p, uint32_t ticks)
{
    static const long double level[] = {LEVEL, -LEVEL, 0.01L, -0.01L, 0};
    long double worst = 0;
    start(p, ticks);
    for (size_t i = 0; i < sizeof level / sizeof level[0]; i++) {
        const long double x = p->native(level[i]);
        long double y = 0;
        for (uint32_t t = 0; t < 30 * ticks; t++) { y = p->step(x); }
        worst = fabsl(y - x) > worst ? fabsl(y - x) : worst;
    }
    return (double)(1e6L * worst);
}

static double rms_of_step(const struct filter_peer *p, uint32_t ticks)
{
    const long double x = p->native(LEVEL);
    struct error e = {0, 0, 0};
    start(p, ticks);
    for (uint32_t t = 0; t < 30 * ticks; t++) { error_add(&e, p->step(x) - ref_step(x)); }
    return (double)(1e6L * sqrtl(e.sum_squares / (long double)e.n));
}

static double rms_of_sine(const struct filter_peer *p, uint32_t ticks)
{
    struct error e = {0, 0, 0};
    start(p, ticks);
    for (uint32_t t = 0; t < 40 * ticks; t++) {
        const long double x = p->native(LEVEL * sinl(2 * PI * (t % ticks) / ticks));
        const long double off = p->step(x) - ref_step(x);
        if (t >= 20 * ticks) { error_add(&e, off); }
    }
    return (double)(1e6L * sqrtl(e.sum_squares / (long double)e.n));
}

/* Wrapped and not come back: still wrong 50 periods on, while the input stays. */
static int latches(const struct filter_peer *p)
{
    const long double x = p->native(0.98L);
    int wrong = 0;
    start(p, 100);
    for (int t = 0; t < 6000; t++) { wrong += fabsl(p->step(x) - x) > 0.5L && t >= 5000; }
    return wrong > 0;
}

static void print_errors(const struct filter_peer *p)
{
    printf("%s", p->name);
    for (uint32_t ticks = 10; ticks <= 10000; ticks *= 10) {
        printf(",%.2g,%.2g,%.2g", worst_at_rest(p, ticks), rms_of_step(p, ticks),
            rms_of_sine(p, ticks));
    }
    printf(",%d\n", latches(p));
}

/* peer, worst and rms error of sine and cosine in ppm, table bytes */
static void print_sine(const struct sine_peer *p)
{
    struct error e = {0, 0, 0};
    for (uint32_t i = 0; i < ANGLES; i++) {
        const uint32_t turn = i * 4096u + (i * 2654435761u >> 20);
        const long double a = 2 * PI * turn / 4294967296.0L;
        long double s, c;
        p->both(turn, &s, &c);
        error_add(&e, 1e6L * (s - sinl(a)));
        error_add(&e, 1e6L * (c - cosl(a)));
    }
    printf("%s,%.3g,%.3g,%u\n", p->name, (double)e.max,
        (double)sqrtl(e.sum_squares / (long double)e.n), (unsigned)p->table_B);
}

/* --- counts --- */

static void empty(uint32_t i) { (void)i; }

static void run(const char *name, void (*op)(uint32_t i), uint32_t per)
{
    for (uint32_t i = 0; i < BENCH_OPS; i++) { op(i); }
    bench_measure(op, BENCH_OPS);
    printf("%s,%lu\n", name, (unsigned long)(BENCH_OPS * per));
}

static void count_filter(const struct filter_peer *p)
{
    const struct butterworth f = design(100);
    p->setup(&f);
    run(p->name, p->tick, 1);
    run(p->name, p->block, BLOCK);
}

static void time_filter(const struct filter_peer *p)
{
    const struct butterworth f = design(100);
    p->setup(&f);
    printf("%s,%.2f\n", p->name, bench_least_ns(p->tick) - bench_least_ns(empty));
}

static void inputs(void)
{
    bench_seed();
    for (uint32_t i = 0; i < BENCH_OPS + BLOCK; i++) {
        const int32_t x = bench_in(-794568949, 794568949);
        peer_x_q31[i] = x;
        peer_x_q15[i] = (int16_t)(x / 65536);
        peer_x_f64[i] = x / 2147483648.0;
        peer_x_f32[i] = (float)peer_x_f64[i];
    }
}

static void print_ram(const struct filter_peer *p)
{
    printf("%s,%u\n", p->name, (unsigned)p->ram_B);
}

static void each_filter(void (*visit)(const struct filter_peer *p))
{
    for (size_t g = 0; g < GROUPS; g++) {
        for (size_t i = 0; i < groups[g]->filters; i++) { visit(&groups[g]->filter[i]); }
    }
}

int main(int argc, char **argv)
{
    const char *mode = argc == 2 ? argv[1] : "";
    inputs();
    if (strcmp(mode, "errors") == 0) {
        each_filter(print_errors);
    } else if (strcmp(mode, "ram") == 0) {
        each_filter(print_ram);
    } else if (strcmp(mode, "sines") == 0 || strcmp(mode, "count") == 0 ||
               strcmp(mode, "time") == 0) {
        if (mode[0] == 'c') {
            run("empty", empty, 1);
            each_filter(count_filter);
        } else if (mode[0] == 't') {
            each_filter(time_filter);
        }
        for (size_t g = 0; g < GROUPS; g++) {
            for (size_t i = 0; i < groups[g]->sines; i++) {
                const struct sine_peer *p = &groups[g]->sine[i];
                if (mode[0] == 'c') {
                    run(p->name, p->op, 1);
                } else if (mode[0] == 't') {
                    printf("%s,%.2f\n", p->name, bench_least_ns(p->op) - bench_least_ns(empty));
                } else {
                    print_sine(p);
                }
            }
        }
    } else {
        fprintf(stderr, "usage: peers errors|sines|count|time|ram\n");
        return 2;
    }
    return 0;
}
