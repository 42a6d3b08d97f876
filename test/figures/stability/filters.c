/* SPDX-License-Identifier: MIT */
/* Filters at rest. A constant input must bring each filter from any reachable state to a state that
 * no longer changes, or to a cycle of states with a constant output. Direct forms, as
 * others build them, run beside them. */
#include "stability.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI      3.14159265358979323846
#define STARTS  6
#define LIMIT   70      /* time constants: 64 bits are 44 */
#define LSB_ADC 32768.0 /* of 16 bits, in a signal of 2^30 */

/* One that is looked at: its state, bytes that are equal when it is. */
union state {
    struct exh_filter filter;
    struct exh_velocity_pole pole;
    struct exh_velocity_track track;
};

struct kind {
    int32_t (*step)(union state *s, const void *cfg, int32_t x);
    void (*start)(union state *s, int32_t x);
    const void *cfg;
    double tau; /* ticks */
};

/* Ticks until the state is constant, x held. -1: not within 70 time constants and 200 ticks. */
static int64_t to_rest(const struct kind *k, union state *s, int32_t x)
{
    const int64_t most = (int64_t)(LIMIT * k->tau) + 200, block = (int64_t)(k->tau / 8) + 1;
    union state before;
    for (int64_t n = 0; n < most; n += block) {
        for (int64_t i = 1; i < block; i++) { k->step(s, k->cfg, x); }
        before = *s;
        k->step(s, k->cfg, x);
        if (memcmp(&before, s, sizeof before) == 0) { return n + block; }
    }
    return -1;
}

/* How many states follow each other in a circle from here on; 0: more than 10000. *exact: in all of
 * them the output is `at`. */
static int circle(const struct kind *k, union state *s, int32_t x, int32_t at, int *exact)
{
    const union state first = *s;
    *exact = 1;
    for (int n = 1; n <= 10000; n++) {
        *exact &= k->step(s, k->cfg, x) == at;
        if (memcmp(&first, s, sizeof first) == 0) { return n; }
    }
    return 0;
}

/* Somewhere: rail to rail, at random, or a step, for a few time constants. */
static void stir(const struct kind *k, union state *s, int how, int32_t end)
{
    const int64_t n = (int64_t)(fmin(3 * k->tau, 50000)) + 20, half = (int64_t)(PI * k->tau) + 1;
    memset(s, 0, sizeof *s);
    k->start(s, 0);
    for (int64_t i = 0; i < n; i++) {
        int32_t x = how % 2 ? end : (i / half) % 2 ? INT32_MIN : INT32_MAX;
        if (how % 3 == 2) { x = (int32_t)(any_u64() >> 33) - (INT32_C(1) << 30); }
        k->step(s, k->cfg, x);
    }
}

/* --- the library's --- */

static int32_t filter_step(union state *s, const void *cfg, int32_t x)
{
    int32_t y;
    exh_filter_step(&s->filter, cfg, &x, &y, 1);
    return y;
}

static void filter_start(union state *s, int32_t x) { exh_filter_reset(&s->filter, &x, 1); }

static int32_t pole_step(union state *s, const void *cfg, int32_t x)
{
    return exh_velocity_pole_step(&s->pole, cfg, x / 65536);
}

static int32_t track_step(union state *s, const void *cfg, int32_t x)
{
    return exh_velocity_track_step(&s->track, cfg, x / 65536);
}

static void count_start(union state *s, int32_t x)
{
    (void)s;
    (void)x;
}

/* Ticks in which the poles shrink by e: beyond a quarter of the rate they alternate, and near half
 * of it they last. */
static double time_constant(double ratio, int order)
{
    const double g = tan(PI * ratio);
    const double pole = order == 1 ? fabs((1 - g) / (1 + g))
                                   : sqrt((1 - sqrt(2) * g + g * g) / (1 + sqrt(2) * g + g * g));
    return fmax(1 / (2 * PI * ratio), pole > 0 ? -1 / log(pole) : 0);
}

/* --- direct form 1, 32 bits of state, coefficients of q30 --- */

struct direct {
    int64_t b[3], a[2];
    int64_t half; /* 2^29 rounds, 0 truncates */
    int32_t x[2], y[2];
};

static void direct_setup(struct direct *d, double fc_per_fs, int rounds)
{
    const double g = tan(PI * fc_per_fs), n = 1 / (1 + sqrt(2) * g + g * g);
    memset(d, 0, sizeof *d);
    d->b[0] = d->b[2] = llrint(g * g * n * 1073741824);
    d->b[1] = 2 * d->b[0];
    d->a[0] = llrint(2 * (g * g - 1) * n * 1073741824);
    d->a[1] = llrint((1 - sqrt(2) * g + g * g) * n * 1073741824);
    d->half = rounds ? INT64_C(1) << 29 : 0;
}

static int32_t direct_step(struct direct *d, int32_t x)
{
    const int64_t sum =
        d->b[0] * x + d->b[1] * d->x[0] + d->b[2] * d->x[1] - d->a[0] * d->y[0] - d->a[1] * d->y[1];
    const int32_t y = exh_sat32((sum + d->half) >> 30);
    d->x[1] = d->x[0];
    d->x[0] = x;
    d->y[1] = d->y[0];
    return d->y[0] = y;
}

/* The most that is left 60 time constants after a step of 10923 codes and back to 0, in codes of 16
 * bits. */
static double direct_left(double fc_per_fs, int rounds)
{
    struct direct d;
    const int64_t n = (int64_t)(60 * time_constant(fc_per_fs, 2)) + 100;
    double most = 0;
    direct_setup(&d, fc_per_fs, rounds);
    for (int64_t i = 0; i < n; i++) { direct_step(&d, 10923 * 32768); }
    for (int64_t i = 0; i < n; i++) { direct_step(&d, 0); }
    for (int i = 0; i < 2000; i++) { most = fmax(most, fabs(direct_step(&d, 0) / LSB_ADC)); }
    return most;
}

/* --- all of them --- */

struct rest {
    long runs, stand, circles, exact;
    double most_tau;
    int longest;
};

/* The rest of the observer's speed at a constant state is documented in velocity.h. */
static int stands_right(const struct kind *k, union state *s, int32_t x)
{
    const int32_t y = k->step(s, k->cfg, x);
    if (k->step == track_step) { return fabs((double)s->track.vel_cnt_q32) <= k->tau + 1; }
    return y == (k->step == filter_step ? x : 0);
}

static double all_starts(const struct kind *k, struct rest *r)
{
    static const int32_t held[STARTS] = {0, INT32_MAX, INT32_MIN, 1, -1, 123456789};
    double most = 0;
    for (int i = 0; i < STARTS; i++) {
        union state s;
        int64_t n;
        stir(k, &s, i, held[(i + 1) % STARTS]);
        n = to_rest(k, &s, held[i]);
        r->runs++;
        if (n >= 0) {
            r->stand++;
            r->exact += stands_right(k, &s, held[i]);
            most = fmax(most, (double)n / k->tau);
        } else {
            int exact,
                states = circle(k, &s, held[i], k->step == filter_step ? held[i] : 0, &exact);
            r->circles += states > 0;
            r->exact += states > 0 && exact;
            if (states > r->longest) { r->longest = states; }
        }
    }
    r->most_tau = fmax(r->most_tau, most);
    return most;
}

static int low_passes(enum size size)
{
    static const int points[] = {8, 40, 100};
    FILE *csv = csv_open("filters",
        "fc_per_fs,order,tau_to_rest,left_adc,left_direct_truncated,left_direct_rounded");
    struct rest r = {0, 0, 0, 0, 0, 0};
    const double low = size == SHORT ? 1e-5 : 1e-6;
    for (int order = 1; order <= 2; order++) {
        for (int i = 0; i < points[size]; i++) {
            const double ratio = spaced(low, 0.49, i, points[size]);
            const struct exh_filter_par par = {order, (int32_t)(ratio * 20000 * 65536)};
            struct exh_filter_cfg cfg;
            const struct kind k = {filter_step, filter_start, &cfg, time_constant(ratio, order)};
            const double before = (double)(r.runs - r.exact);
            double tau;
            if (exh_filter_setup(&cfg, &par, (struct exh_period){1, 20000}) != 0) { abort(); }
            tau = all_starts(&k, &r);
            /* At rest is exactly at the input: nothing is left. */
            fprintf(
                csv, "%.5g,%d,%.1f,%g,", ratio, order, tau, (double)(r.runs - r.exact) - before);
            if (order == 2 && ratio >= 1e-5) {
                fprintf(csv, "%.3g,%.3g\n", direct_left(ratio, 0), direct_left(ratio, 1));
            } else {
                fprintf(csv, "NaN,NaN\n");
            }
        }
    }
    csv_close(csv);
    return must(r.exact == r.runs,
        "filters: the output of every low-pass comes to stand at its input, fc/fs to 0.49",
        "%ld of %ld; the state, too, in %ld, in %.0f time constants; else circles of up to %d",
        r.exact, r.runs, r.stand, r.most_tau, r.longest);
}

static int velocities(enum size size)
{
    static const uint32_t rate_Hz[] = {1, 90, 1000, 2000, 20000};
    static const uint32_t tau_us[] = {0, 50, 300, 1000, 5000, 33000, 200000, 1000000};
    struct rest pole = {0, 0, 0, 0, 0, 0}, track = {0, 0, 0, 0, 0, 0};
    for (size_t i = 0; i < LEN(rate_Hz) * LEN(tau_us); i++) {
        const uint32_t us = tau_us[i % LEN(tau_us)], Hz = rate_Hz[i / LEN(tau_us)];
        const struct exh_velocity_scale scale = {EXH_Q(20, 1000000, EXH_Q_STEP), {1, Hz}};
        struct exh_velocity_pole_cfg p;
        struct exh_velocity_track_cfg t;
        const double tau = us * 1e-6 * Hz + 1;
        const struct kind kp = {pole_step, count_start, &p, tau},
                          kt = {track_step, count_start, &t, tau};
        if (exh_velocity_pole_setup(&p, scale, us) != 0 ||
            exh_velocity_track_setup(&t, scale, us) != 0) {
            abort();
        }
        if (size == SHORT && tau > 500) { continue; }
        all_starts(&kp, &pole);
        all_starts(&kt, &track);
    }
    return must(pole.stand == pole.runs && pole.exact == pole.runs,
               "filters: velocity through a pole comes to stand at 0",
               "%ld, %ld of %ld; in %.0f time constants", pole.stand, pole.exact, pole.runs,
               pole.most_tau) +
           must(track.stand == track.runs && track.exact == track.runs,
               "filters: the observer comes to stand within (T_f/T + 1) 2^-32 counts",
               "%ld, %ld of %ld; in %.0f time constants", track.stand, track.exact, track.runs,
               track.most_tau);
}

int filters_at_rest(enum size size) { return low_passes(size) + velocities(size); }
