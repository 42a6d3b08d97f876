/* SPDX-License-Identifier: MIT */
/* peers errors | sweep [few] | sines | count | time | ram | twins: ours and others' low-passes and
 * sines in one program, on the same inputs; CSV for peers.sh.
 *
 * errors: peer, then errors in ppm of full scale for fc/fs 0.1, 0.01, 0.001, 0.0001.
 * They are: worst error at 0 Hz after 30 periods at +-0.37, +-0.01 and released; rms over a step
 * of 0.37; rms of a settled sine of 0.37 at fc. Then 1 if a step to 0.98 at 0.01 stays wrong.
 * Reference: the same filter in long double, with the input as the peer could take it.
 *
 * sweep: peer, fc/fs 10^-5 to 0.45, input, largest and rms error in ppm of full scale. Inputs: a
 * step to 0.37, a square wave from end to end of full scale, white noise of full scale. Values
 * beyond full scale count as full scale. few: four cut-offs.
 *
 * count: as kernels count does; each peer by 22 channels of one sample at fc/fs 0.01 and 0.4, then
 * by one channel of 64. time: peer, ns of one op by 22 channels or of one sine and cosine.
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
    &idsp_peers,
};
#define GROUPS (sizeof groups / sizeof groups[0])

long double peer_round(long double x, unsigned q)
{
    const long double one = (long double)(UINT64_C(1) << q);
    return bench_clamp(rintl(x * one), -one, one - 1) / one;
}

static struct butterworth design(uint32_t fc, uint32_t fs)
{
    const long double g = tanl(PI * fc / fs), k = sqrtl(2), d = 1 + g * (g + k);
    const struct butterworth f = {
        fc, fs, g * g / d, 2 * g * g / d, g * g / d, 2 * (g * g - 1) / d, (1 + g * (g - k)) / d};
    return f;
}

/* The reference: state-variable form, in which nothing cancels. */
static struct {
    long double g, d, s1, s2;
} ref;

static void ref_start(const struct butterworth *f)
{
    ref.g = tanl(PI * f->fc / f->fs);
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

static void start(const struct filter_peer *p, uint32_t fc, uint32_t fs)
{
    const struct butterworth f = design(fc, fs);
    p->setup(&f);
    ref_start(&f);
}

/* ppm of full scale */
static double worst_at_rest(const struct filter_peer *p, uint32_t ticks)
{
    static const long double level[] = {LEVEL, -LEVEL, 0.01L, -0.01L, 0};
    long double worst = 0;
    start(p, 1, ticks);
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
    start(p, 1, ticks);
    for (uint32_t t = 0; t < 30 * ticks; t++) { error_add(&e, p->step(x) - ref_step(x)); }
    return (double)(1e6L * sqrtl(e.sum_squares / (long double)e.n));
}

static double rms_of_sine(const struct filter_peer *p, uint32_t ticks)
{
    struct error e = {0, 0, 0};
    start(p, 1, ticks);
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
    start(p, 1, 100);
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

/* --- over fc/fs --- */

static const struct {
    uint32_t fc, fs;
} sweep[] = {{1, 100000}, {1, 10000}, {1, 100}, {2, 5}, /* few end here */
    {1, 50000}, {1, 20000}, {1, 5000}, {1, 2000}, {1, 1000}, {1, 500}, {1, 200}, {1, 50}, {1, 20},
    {1, 10}, {3, 20}, {1, 5}, {3, 10}, {9, 20}};
#define FEW 4u

enum { STEP, SQUARE, NOISE };

static long double input_of(int kind, uint32_t t, uint32_t half)
{
    if (kind == STEP) { return LEVEL; }
    if (kind == SQUARE) { return t / half % 2 == 0 ? 1 : -1; }
    return bench_i32() / 2147483648.0L;
}

/* Ten periods of the cut-off, of a square wave two halves. Continuing inputs last 20000 ticks. */
static void print_swept(const struct filter_peer *p, uint32_t fc, uint32_t fs)
{
    static const char *const name[] = {"step", "square", "noise"};
    const uint32_t ten = 10 * fs / fc;
    if (p->most > 0 && fc > p->most * fs) { return; }
    for (int kind = STEP; kind <= NOISE; kind++) {
        const uint32_t n = kind == STEP || ten > 20000 ? ten : 20000;
        struct error e = {0, 0, 0};
        start(p, fc, fs);
        bench_seed();
        for (uint32_t t = 0; t < n; t++) {
            const long double x = p->native(input_of(kind, t, ten / 2));
            error_add(&e, bench_clamp(p->step(x), -1, 1) - bench_clamp(ref_step(x), -1, 1));
        }
        printf("%s,%.6g,%s,%.3g,%.3g\n", p->name, fc / (double)fs, name[kind], 1e6 * (double)e.max,
            (double)(1e6L * sqrtl(e.sum_squares / (long double)e.n)));
    }
}

static size_t sweep_most = sizeof sweep / sizeof sweep[0];

static void print_sweep(const struct filter_peer *p)
{
    for (size_t i = 0; i < sweep_most; i++) { print_swept(p, sweep[i].fc, sweep[i].fs); }
}

static int twins(void)
{
#ifdef PEERS_RUST
    for (size_t i = 0; i < sizeof sweep / sizeof sweep[0]; i++) {
        const struct butterworth f = design(sweep[i].fc, sweep[i].fs);
        if (!idsp_twins_same(&f)) { return 1; }
    }
#endif
    return 0;
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
    start(p, 1, 100);
    run(p->name, p->tick, 1);
    if (p->most == 0) { start(p, 2, 5); }
    run(p->name, p->tick, 1);
    start(p, 1, 100);
    run(p->name, p->block, BLOCK);
}

static void time_filter(const struct filter_peer *p)
{
    start(p, 1, 100);
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

static void each_sine(void (*visit)(const struct sine_peer *p))
{
    for (size_t g = 0; g < GROUPS; g++) {
        for (size_t i = 0; i < groups[g]->sines; i++) { visit(&groups[g]->sine[i]); }
    }
}

static void each_filter(void (*visit)(const struct filter_peer *p))
{
    for (size_t g = 0; g < GROUPS; g++) {
        for (size_t i = 0; i < groups[g]->filters; i++) { visit(&groups[g]->filter[i]); }
    }
}

static void count_sine(const struct sine_peer *p) { run(p->name, p->op, 1); }

static void time_sine(const struct sine_peer *p)
{
    printf("%s,%.2f\n", p->name, bench_least_ns(p->op) - bench_least_ns(empty));
}

static const struct {
    const char *name;
    void (*filter)(const struct filter_peer *p);
    void (*sine)(const struct sine_peer *p);
} modes[] = {
    {"errors", print_errors, NULL},
    {"sweep", print_sweep, NULL},
    {"sines", NULL, print_sine},
    {"count", count_filter, count_sine},
    {"time", time_filter, time_sine},
    {"ram", print_ram, NULL},
};

int main(int argc, char **argv)
{
    const char *mode = argc >= 2 ? argv[1] : "";
    inputs();
    if (argc == 3 && strcmp(argv[2], "few") == 0) { sweep_most = FEW; }
    if (strcmp(mode, "twins") == 0) { return twins(); }
    if (strcmp(mode, "count") == 0) { run("empty", empty, 1); }
    for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++) {
        if (strcmp(mode, modes[i].name) != 0) { continue; }
        if (modes[i].filter != NULL) { each_filter(modes[i].filter); }
        if (modes[i].sine != NULL) { each_sine(modes[i].sine); }
        return 0;
    }
    fprintf(stderr, "usage: peers errors|sweep|sines|count|time|ram|twins\n");
    return 2;
}
